"""Starts: where robots begin, as CSV with the header `x,y` of cells or `x_metres,y_metres` of points in the world."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import AreaError, FormatError, check_type
from trihex.files import new_file
from trihex.formats.registry import STARTS_HEADER, STARTS_HEADER_IN_METRES
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
    if text.partition(b"\n")[0].strip() == STARTS_HEADER_IN_METRES.encode():
        return _parse_metres(text, path, area)
    table = parse_table(text, path, STARTS_HEADER, {})
    check_inside(table[0], table[1], area, path)
    return area.xy_to_cell(table[0], table[1])


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


def write_starts(area: Area, robots: NDArray[np.int64], path: str | os.PathLike[str]) -> None:
    """Write the cells of robots, given by number."""
    check_type("area", area, Area)
    x, y = area.cell_to_xy(robots)
    rows = [f"{one},{other}" for one, other in zip(x.tolist(), y.tolist(), strict=True)]
    with new_file(path) as part:
        part.write_text("\n".join([STARTS_HEADER, *rows, ""]))
