"""Starts: where robots begin, as CSV with the header `x,y` of cells or `x_metres,y_metres` of points in the world."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import AreaError, FormatError
from trihex.files import check_text, new_file
from trihex.formats.table import parse_table

HEADER = "x,y"
HEADER_IN_METRES = "x_metres,y_metres"


def parse_starts(content: bytes, path: str | os.PathLike[str], area: Area) -> NDArray[np.int64]:
    """Return the cell numbers of the robots in the order of the file.

    Raises
    ------
    FormatError
        If a line is no pair of whole numbers, or a cell lies outside `area`.
    """
    table = parse_table(check_text(content, path), path, HEADER, {})
    check_inside(table[0], table[1], area, path)
    return area.xy_to_cell(table[0], table[1])


def parse_starts_in_metres(content: bytes, path: str | os.PathLike[str], area: Area) -> NDArray[np.int64]:
    """Return the numbers of the cells in which the points of a file with `HEADER_IN_METRES` lie, in its order.

    Raises
    ------
    FormatError
        If a line is no pair of numbers, or a point lies outside `area`.
    AreaError
        If `area` has no frame.
    """
    _ = area.metres  # asked first: without a frame no line is right
    places = []
    for number, line in enumerate(check_text(content, path).decode().splitlines()[1:], start=2):
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


def check_inside(x: NDArray[np.int64], y: NDArray[np.int64], area: Area, path: object) -> None:
    """Raise FormatError for the first line of a table whose cell (x, y) lies outside `area`."""
    outside = (x < 0) | (y < 0) | (x >= area.width) | (y >= area.height)
    if outside.any():
        row = int(np.argmax(outside))
        raise FormatError(
            f"{path}: line {row + 2}: cell ({x[row]}, {y[row]}) lies outside the area: "
            f"x is 0..{area.width - 1}, y is 0..{area.height - 1}"
        )


def write_starts(area: Area, robots: NDArray[np.int64], path: str | os.PathLike[str]) -> None:
    """Write the cells of robots, given by number."""
    x, y = area.cell_to_xy(robots)
    with new_file(path) as part:
        part.write_text(
            "\n".join([HEADER, *(f"{one},{other}" for one, other in zip(x.tolist(), y.tolist(), strict=True)), ""])
        )
