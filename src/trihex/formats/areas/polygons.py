"""Polygons: a place drawn by geometries in metres becomes an area with destinations and robots."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Ground, cover_polygons, import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import AreaError, FormatError
from trihex.formats.areas.options import AreaOptions
from trihex.formats.draft import Draft
from trihex.record import Record

# The Earth is 4e7 metres around.
MOST_METRES = 1e9
_GROUND_PIXELS = 500_000
_PARTS = ("free", "obstacle", "destination", "robot")


@dataclass(frozen=True, eq=False)
class Place(Record):
    """What a file draws: lists of shapely geometries in metres, x to the east and y to the north.

    Attributes
    ----------
    path : path
        For messages.
    free : list of Polygon or MultiPolygon
        All else is occupied.
    obstacle : list of geometries
        What is occupied although it lies in `free`.
    destination : list of geometries
        A point stands for its cell, anything else for the free cells it touches.
    robot : list of Point or MultiPoint
    """

    path: str | os.PathLike[str]
    free: list[Any]
    obstacle: list[Any]
    destination: list[Any]
    robot: list[Any]


def draft_of_place(place: Place, options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area that covers a place; destinations and robots are None where there are none.

    Raises
    ------
    FormatError
        If nothing is free, a geometry is invalid, or a destination or robot meets no cell.
    """
    shapely = import_shapely()
    place, path = _checked(place), place.path
    free = shapely.union_all(place.free)
    if free.area == 0:
        raise FormatError(f"{path}: there must be a polygon that is free; there is none with an area")
    area = cover_polygons(
        free,
        options.covering_of(path, "a place drawn by polygons"),
        obstacles=shapely.union_all(place.obstacle) if place.obstacle else None,
        name=Path(path).stem,
        progress=progress,
    )
    destinations = [_cells_touched(area, shape, path) for shape in place.destination]
    robots = [_cells_of_points(area, shape, path, "robot") for shape in place.robot]
    return Draft(
        area,
        np.concatenate(destinations) if destinations else None,
        np.concatenate(robots) if robots else None,
        ground=_ground(area, free, place.obstacle),
    )


def _ground(area: Area, free: Any, obstacles: list[Any]) -> Ground:
    """Return a raster of what is occupied: pixels whose centre is not free, or half a pixel from an obstacle."""
    import shapely

    across, down = area.tessellation.extent(area.height, area.width)
    square = max(1 / 16, (across * down / _GROUND_PIXELS) ** 0.5)
    py, px = np.mgrid[0:down:square, 0:across:square] + square / 2
    x, y = area.metres.point_to_metres(px, py)
    occupied = ~shapely.contains_xy(free, x, y)
    for obstacle in obstacles:
        shapely.prepare(obstacle)
        occupied |= shapely.dwithin(obstacle, shapely.points(x, y), square * area.metres.cell_size / 2)
    return Ground(occupied, square)


def _checked(place: Place) -> Place:
    """Return the place in whole nanometres; raise FormatError if a coordinate is no number or a shape is invalid."""
    import shapely

    def checked(shape: Any) -> Any:
        if not (np.abs(shapely.get_coordinates(shape)) <= MOST_METRES).all():  # not so for nan
            raise FormatError(f"{place.path}: coordinates must be finite numbers of at most {MOST_METRES:g} metres")
        # Numbers such as 1e-320 make GEOS divide by 0.
        shape = shapely.transform(shape, lambda coordinates: np.round(coordinates, 9))
        if not shapely.is_valid(shape):
            raise FormatError(f"{place.path}: a {shape.geom_type} is invalid: {shapely.is_valid_reason(shape)}")
        return shape

    parts = {name: [checked(shape) for shape in getattr(place, name)] for name in _PARTS}
    return Place(place.path, **parts)


def _cells_of_points(area: Area, points: Any, path: object, what: str) -> NDArray[np.int64]:
    """Return the number of the cell in which each point lies."""
    import shapely

    places = shapely.get_coordinates(points)
    try:
        return area.metres_to_cell(places[:, 0], places[:, 1])
    except AreaError as error:
        raise FormatError(f"{path}: a {what}: {error}") from None


def _cells_touched(area: Area, shape: Any, path: object) -> NDArray[np.int64]:
    """Return the numbers of the free cells that a line or polygon touches; of any cell, where a point lies."""
    import shapely

    if shape.geom_type.endswith("Point"):
        return _cells_of_points(area, shape, path, "destination")
    cells = np.flatnonzero(~area.barriers.reshape(-1))
    x, y = area.cell_to_metres(cells)
    west, south, east, north = shape.bounds
    reach = 2 * area.metres.cell_size  # no cell is wider
    cells = cells[(x > west - reach) & (x < east + reach) & (y > south - reach) & (y < north + reach)]
    corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(cells))
    polygons = shapely.polygons(np.stack(area.metres.point_to_metres(corners[..., 0], corners[..., 1]), axis=-1))
    shapely.prepare(shape)
    touched = cells[shapely.intersects(shape, polygons)]
    if touched.size == 0:
        raise FormatError(
            f"{path}: a destination between ({west:g}, {south:g}) and ({east:g}, {north:g}) metres touches no free cell"
        )
    return np.asarray(touched)
