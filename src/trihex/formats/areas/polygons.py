"""Polygons: a place drawn by geometries in metres becomes an area with destinations and robots."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, DrawnGround, Zone, import_shapely
from trihex.areas.coverage import Progress
from trihex.errors import AreaError, FormatError
from trihex.formats.areas.exits import cells_of_exit
from trihex.formats.areas.options import AreaOptions, NoRoomError
from trihex.formats.draft import Draft
from trihex.record import Record

# The Earth is 4e7 metres around.
MOST_METRES = 1e9
_SAMPLES_A_CELL, _MOST_SAMPLES = 64, 100_000
_FIRST_COLLECTION = 4  # of the types of shapely: those before are points, lines and polygons


class Drawn(NamedTuple):
    """A geometry that a file draws, where in the file it stands, for messages, and its name if it has one.

    The last are the whole that it is a part of, and how many robots that lets in, None if nothing is said.
    """

    where: str
    shape: Any
    name: str = ""
    lets_in: tuple[str, Any] = ("", None)


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
        A point stands for its cell, anything else for the free cells it touches, or those that lead through it.
    robot : list of Drawn
        Points.
    door : list of Drawn
        A line stands for the cells that it leads through, anything else as for destinations.
    """

    path: str | os.PathLike[str]
    free: list[Drawn]
    obstacle: list[Drawn]
    destination: list[Drawn]
    robot: list[Drawn]
    door: list[Drawn] = field(default_factory=list)


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
    covering = options.covering_of(path, "a place drawn by polygons", east - west, north - south)
    area = options.area_of(DrawnGround(free, obstacles), covering, Path(path).stem, progress)
    destinations = [
        _cells_of_points(area, [drawn], "destination")
        if drawn.shape.geom_type == "Point"
        else cells_of_exit(area, drawn.where, drawn.shape)
        for drawn in place.destination
    ]
    doors = [_cells_of_door(area, drawn) for drawn in place.door]
    named = list(zip((*place.destination, *place.door), (*destinations, *doors), strict=True))
    zones = [Zone(drawn.name, cells) for drawn, cells in named if drawn.name]
    return Draft(
        replace(area, zones=tuple(zones)),
        np.concatenate(destinations) if destinations else None,
        _cells_of_points(area, place.robot, "robot") if place.robot else None,
        doors=_doors_of(named),
    )


def _doors_of(named: list[tuple[Drawn, NDArray[np.int64]]]) -> tuple[tuple[Any, Any], ...]:
    """Return the flow of each zone that has one, and that of others by their cells; parts of one whole are one."""
    doors: dict[str, tuple[Any, Any]] = {}
    for drawn, cells in named:
        whole, flow = drawn.lets_in
        if flow is None:
            continue
        earlier = doors.get(drawn.name or whole, ([], flow))[0]
        doors[drawn.name or whole] = drawn.name or [*earlier, *cells.tolist()], flow
    return tuple(doors.values())


def _cells_of_door(area: Area, door: Drawn) -> NDArray[np.int64]:
    """Return the free cells of a door: those in which the points of a line lie, a row that no move leads across.

    (All that it touches may be two rows, each of which would let in as few.)
    """
    import shapely

    if door.shape.geom_type == "Point":
        return _cells_of_points(area, [door], "door")
    if door.shape.geom_type != "LineString":
        return cells_of_exit(area, door.where, door.shape)
    count = min(_MOST_SAMPLES, ceil(_SAMPLES_A_CELL * door.shape.length / area.metres.cell_size) + 1)
    points = shapely.line_interpolate_point(door.shape, np.linspace(0, door.shape.length, count))
    x, y = area.metres.cell_at(area.tessellation, *shapely.get_coordinates(points).T)
    is_inside = (x >= 0) & (y >= 0) & (x < area.width) & (y < area.height)
    cells = np.unique(area.xy_to_cell(x[is_inside], y[is_inside]))
    cells = cells[~area.is_barrier(cells)]
    if cells.size == 0:
        raise NoRoomError(f"{door.where}: a door must lead through free cells; it meets none")
    return np.asarray(cells)


def checked_parts(drawn: list[Drawn]) -> list[Drawn]:
    """Return the points, lines and polygons of shapes in whole nanometres, each apart.

    So polygons of one MultiPolygon may touch and overlap as those of several features may. (All shapes are looked at
    together: one by one takes three times as long.)

    Raises
    ------
    FormatError
        If a coordinate is no number, or a part is invalid.
    """
    import shapely

    parts = np.array([one.shape for one in drawn], dtype=object)
    points, owner = shapely.get_coordinates(parts, return_index=True)
    too_far = owner[~(np.abs(points) <= MOST_METRES).all(axis=1)]  # so are those that are nan
    if too_far.size:
        where = drawn[too_far[0]].where
        raise FormatError(f"{where}: coordinates must be finite numbers of at most {MOST_METRES:g} metres")
    # Numbers such as 1e-320 make GEOS divide by 0.
    parts = shapely.transform(shapely.force_2d(parts), lambda coordinates: np.round(coordinates, 9))
    owner = np.arange(len(drawn))
    while (shapely.get_type_id(parts) >= _FIRST_COLLECTION).any():
        parts, index = shapely.get_parts(parts, return_index=True)
        owner = owner[index]
    count = np.bincount(owner, minlength=len(drawn))
    number = np.arange(owner.size) - (np.cumsum(count) - count)[owner]
    place = [
        drawn[i].where if count[i] == 1 else f"{drawn[i].where}: part {k}" for i, k in zip(owner, number, strict=True)
    ]
    for i in np.flatnonzero(~shapely.is_valid(parts)):
        raise FormatError(f"{place[i]}: a {parts[i].geom_type} is invalid: {shapely.is_valid_reason(parts[i])}")
    return [
        Drawn(where, part, drawn[i].name, drawn[i].lets_in) for where, part, i in zip(place, parts, owner, strict=True)
    ]


def _cells_of_points(area: Area, points: list[Drawn], what: str) -> NDArray[np.int64]:
    """Return the number of the cell in which each point lies."""
    import shapely

    try:
        return area.metres_to_cell(*shapely.get_coordinates([drawn.shape for drawn in points]).T)
    except AreaError:
        for where, shape, *_ in points:
            try:
                area.metres_to_cell(shape.x, shape.y)
            except AreaError as error:
                kind = NoRoomError if what == "destination" else FormatError
                raise kind(f"{where}: a {what}: {error}") from None
        raise
