"""Touching: the cells that robots of the area's radius cannot use where something stands, wherever it came from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas.coverage import MARGIN, star_of_cell, stars_from
from trihex.areas.ground import import_shapely
from trihex.errors import AreaError

if TYPE_CHECKING:
    from trihex.areas.area import Area

MOST_POINTS = 100_000
_MOST_METRES = 1e9
_AT_ONCE = 20_000


def cells_touched(area: Area, shape: Any) -> NDArray[np.int64]:
    """Return the numbers of the cells whose star comes within the robots' radius of a shape, ascending; see `Area`."""
    shapely = import_shapely()
    frame, tessellation = area.metres, area.tessellation
    shape = shape_from(shape)
    if shape.is_empty:
        return np.empty(0, dtype=np.int64)
    star = star_of_cell(tessellation)
    radius = frame.robot_radius + MARGIN * frame.cell_size
    reach = float(np.hypot(star[..., 0], star[..., 1]).max()) + radius / frame.cell_size
    west, south, east, north = shape.bounds
    px, py = frame.metres_to_point([west, east, east, west], [south, south, north, north])
    # Of cells of one column or row the centres differ by half an edge step at most.
    column_x = tessellation.centre_of_cell(np.arange(area.width), 0)[0]
    row_y = tessellation.centre_of_cell(0, np.arange(area.height))[1]
    columns = np.flatnonzero((column_x > px.min() - reach - 1) & (column_x < px.max() + reach + 1))
    rows = np.flatnonzero((row_y > py.min() - reach - 1) & (row_y < py.max() + reach + 1))
    cells = (rows[:, None] * area.width + columns).reshape(-1)
    shapely.prepare(shape)
    touched = [_touched(area, shape, some, star, radius) for some in np.array_split(cells, cells.size // _AT_ONCE + 1)]
    return np.concatenate(touched)


def _touched(
    area: Area, shape: Any, cells: NDArray[np.int64], star: NDArray[np.float64], radius: float
) -> NDArray[np.int64]:
    import shapely

    if cells.size == 0:
        return cells
    y, x = np.divmod(cells, area.width)
    centres = np.stack(area.tessellation.centre_of_cell(x, y), axis=-1)
    arms = star[area.tessellation.orientation_of_cell(x, y)] + centres[:, None, :]
    ends = np.stack(area.metres.point_to_metres(arms[..., 0], arms[..., 1]), axis=-1)
    own = np.stack(area.metres.point_to_metres(centres[:, 0], centres[:, 1]), axis=-1)
    return np.asarray(cells[shapely.dwithin(shape, stars_from(own, ends), radius)])


def shape_from(given: Any) -> Any:
    """Return a geometry of shapely, or what points in metres draw: a point, a line of two, or the polygon of more.

    Raises
    ------
    AreaError
        If it is none of these, or not valid.
    """
    shapely = import_shapely()
    if not isinstance(given, shapely.Geometry):
        try:
            points = np.asarray(given, dtype=np.float64)
        except (TypeError, ValueError):
            points = np.empty(0)
        points = points[None] if points.shape == (2,) else points
        if points.ndim != 2 or points.shape[1] != 2 or not 0 < len(points) <= MOST_POINTS:
            raise AreaError(f"a shape must be a geometry of shapely or points (x, y) in metres, not {given!r:.80}")
        _check_numbers(points)
        make = (shapely.Point, shapely.LineString, shapely.Polygon)[min(len(points), 3) - 1]
        given = make(points[0] if len(points) == 1 else points)
    _check_numbers(shapely.get_coordinates(given))
    if not shapely.is_valid(given):
        raise AreaError(f"a {given.geom_type} is invalid: {shapely.is_valid_reason(given)}")
    return given


def _check_numbers(points: NDArray[np.float64]) -> None:
    if not (np.abs(points) <= _MOST_METRES).all():  # not so for nan
        raise AreaError(f"a shape must have finite coordinates of at most {_MOST_METRES:g} metres")
