"""Starts: the cells where robots begin, as CSV with the header `x,y`."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from trihex.area import Area
from trihex.errors import FormatError
from trihex.formats.files import check_text, new_file, read_bytes
from trihex.formats.table import parse_table

HEADER = "x,y"


def read_starts(path: str | os.PathLike[str], area: Area) -> NDArray[np.int64]:
    """Return the cell numbers of the robots in the order of the file.

    Raises
    ------
    FormatError
        If a line is no pair of whole numbers, or a cell lies outside `area`.
    OSError
        If the file cannot be read.
    """
    table = parse_table(check_text(read_bytes(path), path), path, HEADER, {})
    check_inside(table[0], table[1], area, path)
    return area.xy_to_cell(table[0], table[1])


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
