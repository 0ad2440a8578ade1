"""Exits: lines and polygons that stand for the free cells that they touch, or that lead through them."""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, DrawnGround
from trihex.formats.areas.options import NoRoomError

_SAMPLES_A_CELL, _MOST_SAMPLES = 8, 20_000
# How far behind its robots' radius the first free cell beside a wall may begin: 1.55 cells on triangles, one elsewhere.
_CELLS_AWAY = 2.0
_DEEPEST = 0.6  # metres in a wall: what lies deeper leads nowhere


def cells_of_exit(area: Area, where: str, exit_: Any) -> NDArray[np.int64]:
    """Return the numbers of the free cells that a line or polygon touches, or that lead through it.

    Cells that touch a wall are barriers, so an exit that is drawn on one touches no free cell. Then the row of cells
    counts that comes first on the way from the exit into the place: those of which it is as wide as half a cell.

    Raises
    ------
    NoRoomError
        If there are none; `where` is the exit, for the message.
    """
    import shapely

    free = np.flatnonzero(~area.barriers.reshape(-1))
    x, y = area.cell_to_metres(free)
    # No cell is wider than two edge steps.
    reach = area.metres.robot_radius + (2 + _CELLS_AWAY) * area.metres.cell_size
    west, south, east, north = exit_.bounds
    near = np.flatnonzero((x > west - reach) & (x < east + reach) & (y > south - reach) & (y < north + reach))
    corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(free[near]))
    polygons = shapely.polygons(np.stack(area.metres.point_to_metres(corners[..., 0], corners[..., 1]), axis=-1))
    shapely.prepare(exit_)
    touched = shapely.intersects(exit_, polygons)
    if touched.any():
        return np.asarray(free[near][touched])
    behind = _row_behind(area, exit_, shapely.points(x[near], y[near]), polygons)
    if behind.size == 0:
        raise NoRoomError(f"{where}: {_why_none(area, exit_, free)}")
    return np.sort(free[near][behind])


def _row_behind(area: Area, exit_: Any, centres: NDArray[Any], polygons: NDArray[Any]) -> NDArray[np.int64]:
    """Return which of some cells come first on the way from an exit into the place."""
    import shapely

    frame, ground = area.metres, area.ground
    ways = shapely.shortest_line(centres, exit_)
    most = frame.robot_radius + _CELLS_AWAY * frame.cell_size
    is_open = shapely.distance(polygons, exit_) <= most
    if isinstance(ground, DrawnGround):
        # A way leaves what is free at most once: where it comes to the wall that the exit is in.
        room = ground.free
        if ground.obstacles is not None:
            room = shapely.difference(room, shapely.buffer(ground.obstacles, 1e-3 * frame.cell_size))
        inside = shapely.intersection(room, ways)
        is_open &= (shapely.get_num_geometries(inside) == 1) & shapely.intersects(inside, centres)
        is_open &= shapely.length(ways) - shapely.length(inside) <= _DEEPEST
    candidates = np.flatnonzero(is_open)
    starts, rays = _rays_from(exit_, frame.cell_size, most)
    tree = shapely.STRtree(polygons[candidates])
    ray, cell = tree.query(rays, predicate="intersects")
    if ray.size == 0:  # a narrow exit beside another wall
        ray, cell = tree.query_nearest(starts, all_matches=False)
    away = shapely.distance(starts[ray], polygons[candidates][cell])
    order = np.lexsort((away, ray))
    first = order[np.flatnonzero(np.diff(ray[order], prepend=-1))]
    seen = np.bincount(cell[first], minlength=candidates.size)
    return np.asarray(candidates[2 * seen >= seen.max(initial=1)])


def _rays_from(exit_: Any, cell_size: float, length: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return points along an exit, and from each a line straight away from it, of a line to both sides."""
    import shapely

    is_line = exit_.geom_type == "LineString"
    outline = exit_ if is_line else exit_.exterior
    if not is_line and not outline.is_ccw:  # then outside is to the left
        outline = shapely.reverse(outline)
    count = min(_MOST_SAMPLES, ceil(_SAMPLES_A_CELL * outline.length / cell_size) + 1)
    at = (np.arange(count) + 0.5) * (outline.length / count)
    part = 1e-3 * outline.length / count
    here, before, after = (
        shapely.get_coordinates(shapely.line_interpolate_point(outline, at + shift)) for shift in (0, -part, part)
    )
    along = (after - before) / np.maximum(np.linalg.norm(after - before, axis=1, keepdims=True), 1e-12)
    right = np.stack([along[:, 1], -along[:, 0]], axis=1) * length
    ends = [here + right, here - right] if is_line else [here + right]
    starts = np.concatenate([here] * len(ends))
    return shapely.points(starts), shapely.linestrings(np.stack([starts, np.concatenate(ends)], axis=1))


def _why_none(area: Area, exit_: Any, free: NDArray[np.int64]) -> str:
    """Return that an exit touches no free cell, and which is the nearest."""
    import shapely

    west, south, east, north = exit_.bounds
    hint = "none is free"
    if free.size:
        away = shapely.distance(exit_, shapely.points(*area.cell_to_metres(free)))
        nearest = int(np.argmin(away))
        cell = area.place_of_cell(int(free[nearest]))
        hint = f"the nearest is {cell}, its centre {away[nearest]:.3g} metres away"
    return (
        f"a destination between ({west:g}, {south:g}) and ({east:g}, {north:g}) metres touches no free cell, and none "
        f"leads through it; {hint}"
    )
