"""Starts: where robots begin, as CSV with the header `x,y` of cells or `x_metres,y_metres` of points in the world.

A column `start` may follow: when each begins to move, in seconds in an area with a frame, else in steps.
"""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import AreaError, FormatError, check_type
from trihex.files import new_file
from trihex.formats.registry import START_COLUMN, STARTS_HEADER, STARTS_HEADER_IN_METRES
from trihex.formats.table import check_inside, parse_table
from trihex.formats.text import Text


def parse_starts(text: Text, path: str | os.PathLike[str], area: Area) -> NDArray[np.int64]:
    """Return the cell numbers of the robots in the order of the file.

    Raises
    ------
    FormatError
        If a line is no pair of numbers, or a place lies outside `area`.
    AreaError
        If places are points in metres and `area` has no frame.
    """
    text, _ = _parted(text, path)
    if text.partition(b"\n")[0].strip() == STARTS_HEADER_IN_METRES.encode():
        return _parse_metres(text, path, area)
    table = parse_table(text, path, STARTS_HEADER, {})
    check_inside(table[0], table[1], area, path)
    return area.xy_to_cell(table[0], table[1])


def parse_start_times(text: Text, path: str | os.PathLike[str]) -> NDArray[np.float64] | None:
    """Return the column `start` of a file, None if it has none.

    Raises
    ------
    FormatError
        If there is something else in it than numbers from 0 on.
    """
    _, column = _parted(text, path)
    if column is None:
        return None
    times = np.empty(len(column))
    for number, value in enumerate(column):
        try:
            times[number] = float(value)
        except ValueError:
            times[number] = -1.0
        if not 0 <= times[number] < float("inf"):
            raise FormatError(f"{path}: line {number + 2}: start must be a number from 0, not {value.decode()!r:.40}")
    return times


def _parted(text: Text, path: object) -> tuple[Text, list[bytes] | None]:
    """Return the text without its column `start`, and that column, if it has it."""
    first, _, body = text.partition(b"\n")
    places, comma, name = first.strip().rpartition(b",")
    if name != START_COLUMN.encode() or not comma:
        return text, None
    lines, column = [places], []
    for number, line in enumerate(body.rstrip(b"\r\n").splitlines(), start=2):
        place, comma, value = line.rpartition(b",")
        if line.count(b",") != 2:
            count = line.count(b",") + 1
            raise FormatError(f"{path}: line {number}: there must be 3 columns ({first.decode()}), not {count}")
        lines.append(place)
        column.append(value.strip())
    return Text(b"\n".join([*lines, b""])), column


def _parse_metres(text: Text, path: str | os.PathLike[str], area: Area) -> NDArray[np.int64]:
    """Return the numbers of the cells in which the points of a file lie, in its order."""
    _ = area.metres  # asked first: without a frame no line is right
    places = []
    for number, line in enumerate(text.decode().splitlines()[1:], start=2):
        try:
            x, y = (float(part) for part in line.split(","))
        except ValueError:
            raise FormatError(f"{path}: line {number}: must be two numbers, not {line!r:.60}") from None
        places.append((x, y))
    table = np.array(places, dtype=np.float64).reshape(-1, 2)
    try:
        return area.metres_to_cell(table[:, 0], table[:, 1])
    except AreaError:
        for number, (x, y) in enumerate(places, start=2):
            try:
                area.metres_to_cell(x, y)
            except AreaError as error:
                raise FormatError(f"{path}: line {number}: {error}") from None
        raise


def write_starts(
    area: Area,
    robots: NDArray[np.int64],
    path: str | os.PathLike[str],
    *,
    start_times: NDArray[np.floating] | None = None,
) -> None:
    """Write the cells of robots, given by number, and when they begin to move, as `read_start_times` reads it."""
    check_type("area", area, Area)
    x, y = area.cell_to_xy(robots)
    rows, header = [f"{one},{other}" for one, other in zip(x.tolist(), y.tolist(), strict=True)], STARTS_HEADER
    if start_times is not None:
        header = f"{header},{START_COLUMN}"
        rows = [f"{row},{time:.15g}" for row, time in zip(rows, start_times.tolist(), strict=True)]
    with new_file(path) as part:
        part.write_text("\n".join([header, *rows, ""]))
