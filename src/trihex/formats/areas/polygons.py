"""Polygons: a place drawn by geometries in metres becomes an area with destinations and robots."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, cover_polygons, import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import AreaError, FormatError
from trihex.formats.areas.options import AreaOptions
from trihex.formats.draft import Draft
from trihex.record import Record

# The Earth is 4e7 metres around.
MOST_METRES = 1e9


class Drawn(NamedTuple):
    """A geometry that a file draws, and where in the file it stands, for messages."""

    where: str
    shape: Any


@dataclass(frozen=True, eq=False)
class Place(Record):
    """What a file draws: geometries in metres, x to the east and y to the north, as `checked_parts` returns them.

    Attributes
    ----------
    path : path
        For messages.
    free : list of Drawn
        Polygons. All else is occupied.
    obstacle : list of Drawn
        What is occupied although it lies in `free`.
    destination : list of Drawn
        A point stands for its cell, anything else for the free cells it touches.
    robot : list of Drawn
        Points.
    """

    path: str | os.PathLike[str]
    free: list[Drawn]
    obstacle: list[Drawn]
    destination: list[Drawn]
    robot: list[Drawn]


def draft_of_place(place: Place, options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area that covers a place; destinations and robots are None where there are none.

    Raises
    ------
    FormatError
        If nothing is free, the place is smaller than a cell, or a destination or robot meets no cell.
    """
    shapely = import_shapely()
    path = place.path
    obstacles = shapely.union_all([drawn.shape for drawn in place.obstacle]) if place.obstacle else None
    free = shapely.union_all([drawn.shape for drawn in place.free])
    if free.area == 0:
        raise FormatError(f"{path}: there must be a polygon that is free; there is none with an area")
    west, south, east, north = free.bounds
    area = cover_polygons(
        free,
        options.covering_of(path, "a place drawn by polygons", east - west, north - south),
        obstacles=obstacles,
        name=Path(path).stem,
        progress=progress,
    )
    destinations = [
        _cells_of_points(area, list(some), "destination") if is_point else _cells_touched(area, some)
        for is_point, some in groupby(place.destination, lambda drawn: drawn.shape.geom_type == "Point")
    ]
    return Draft(
        area,
        np.concatenate(destinations) if destinations else None,
        _cells_of_points(area, place.robot, "robot") if place.robot else None,
    )


def checked_parts(where: str, shape: Any) -> list[Drawn]:
    """Return the points, lines and polygons of a shape in whole nanometres, each apart.

    So polygons of one MultiPolygon may touch and overlap as those of several features may.

    Raises
    ------
    FormatError
        If a coordinate is no number, or a part is invalid.
    """
    import shapely

    if not (np.abs(shapely.get_coordinates(shape)) <= MOST_METRES).all():  # not so for nan
        raise FormatError(f"{where}: coordinates must be finite numbers of at most {MOST_METRES:g} metres")
    # Numbers such as 1e-320 make GEOS divide by 0.
    leaves = [shapely.transform(shapely.force_2d(shape), lambda coordinates: np.round(coordinates, 9))]
    while any(leaf.geom_type.startswith(("Multi", "GeometryCollection")) for leaf in leaves):
        leaves = list(shapely.get_parts(leaves))
    drawn = [Drawn(f"{where}: part {i}" if len(leaves) > 1 else where, leaf) for i, leaf in enumerate(leaves)]
    for i in np.flatnonzero(~shapely.is_valid(leaves)):
        place, leaf = drawn[i]
        raise FormatError(f"{place}: a {leaf.geom_type} is invalid: {shapely.is_valid_reason(leaf)}")
    return drawn


def _cells_of_points(area: Area, points: list[Drawn], what: str) -> NDArray[np.int64]:
    """Return the number of the cell in which each point lies."""
    import shapely

    try:
        return area.metres_to_cell(*shapely.get_coordinates([drawn.shape for drawn in points]).T)
    except AreaError:
        for where, shape in points:
            try:
                area.metres_to_cell(shape.x, shape.y)
            except AreaError as error:
                raise FormatError(f"{where}: a {what}: {error}") from None
        raise


def _cells_touched(area: Area, shapes: Iterable[Drawn]) -> NDArray[np.int64]:
    """Return the numbers of the free cells that lines or polygons touch."""
    import shapely

    free = np.flatnonzero(~area.barriers.reshape(-1))
    x, y = area.cell_to_metres(free)
    reach = 2 * area.metres.cell_size  # no cell is wider
    found = []
    for where, shape in shapes:
        west, south, east, north = shape.bounds
        near = (x > west - reach) & (x < east + reach) & (y > south - reach) & (y < north + reach)
        corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(free[near]))
        polygons = shapely.polygons(np.stack(area.metres.point_to_metres(corners[..., 0], corners[..., 1]), axis=-1))
        shapely.prepare(shape)
        found.append(free[near][shapely.intersects(shape, polygons)])
        if found[-1].size == 0:
            hint = "none is free"
            if free.size:
                away = shapely.distance(shape, shapely.points(x, y))
                nearest = int(np.argmin(away))
                cell = area.place_of_cell(int(free[nearest]))
                hint = f"the nearest is {cell}, its centre {away[nearest]:.3g} metres away"
            raise FormatError(
                f"{where}: a destination between ({west:g}, {south:g}) and ({east:g}, {north:g}) metres touches no "
                f"free cell; {hint}"
            )
    return np.concatenate(found)
