"""Polygons: a place drawn by geometries in metres becomes an area with destinations and robots."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.area import Area
from trihex.coverage import Progress, cover_polygons, import_shapely
from trihex.errors import AreaError, FormatError
from trihex.formats.draft import Draft
from trihex.formats.options import AreaOptions
from trihex.record import Record


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
    path = place.path
    for shape in [*place.free, *place.obstacle, *place.destination, *place.robot]:
        if not np.isfinite(shapely.get_coordinates(shape)).all():
            raise FormatError(f"{path}: coordinates must be finite numbers")
        if not shapely.is_valid(shape):
            raise FormatError(f"{path}: a {shape.geom_type} is invalid: {shapely.is_valid_reason(shape)}")
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
        area, np.concatenate(destinations) if destinations else None, np.concatenate(robots) if robots else None
    )


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
    corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(cells))
    polygons = shapely.polygons(np.stack(area.metres.point_to_metres(corners[..., 0], corners[..., 1]), axis=-1))
    shapely.prepare(shape)
    touched = cells[shapely.intersects(shape, polygons)]
    if touched.size == 0:
        west, south, east, north = shape.bounds
        raise FormatError(
            f"{path}: a destination between ({west:g}, {south:g}) and ({east:g}, {north:g}) metres touches no free cell"
        )
    return np.asarray(touched)
