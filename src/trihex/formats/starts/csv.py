"""Starts: where robots begin, as CSV with the header `x,y` of cells or `x_metres,y_metres` of points in the world.

A column `start` may follow: when each begins to move, in seconds in an area with a frame, else in steps; and then one
`slowness`, how many times as long its moves last as those of the fastest, or `speed`, of which slowness is made.
"""

from __future__ import annotations

import os
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import AreaError, FormatError, check_type
from trihex.files import new_file
from trihex.formats.registry import SLOWNESS_COLUMN, SPEED_COLUMN, START_COLUMN, STARTS_HEADER, STARTS_HEADER_IN_METRES
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
    column = _parted(text, path)[1].get(START_COLUMN)
    if column is None:
        return None
    return _numbers(column, path, "start must be a number from 0", lambda value: value >= 0)


def parse_slowness(text: Text, path: str | os.PathLike[str]) -> NDArray[np.int64] | NDArray[np.float64] | None:
    """Return the column `slowness` of a file, whole numbers, or `speed`, others; None if it has neither.

    Raises
    ------
    FormatError
        If there is something else in it than whole numbers from 1 on, or speeds above 0.
    """
    columns = _parted(text, path)[1]
    if SPEED_COLUMN in columns:
        return _numbers(columns[SPEED_COLUMN], path, "speed must be a number above 0", lambda value: value > 0)
    if SLOWNESS_COLUMN not in columns:
        return None
    rule = "slowness must be a whole number from 1"
    whole = _numbers(columns[SLOWNESS_COLUMN], path, rule, lambda value: value >= 1 and value.is_integer())
    return np.minimum(whole, 2**31).astype(np.int64)


def _numbers(column: list[bytes], path: object, rule: str, is_right: Callable[[float], bool]) -> NDArray[np.float64]:
    """Return a column as numbers; raise FormatError where one is not as the rule says."""
    numbers = np.empty(len(column))
    for number, value in enumerate(column):
        try:
            numbers[number] = float(value)
        except ValueError:
            numbers[number] = float("nan")
        if not (numbers[number] < float("inf") and is_right(float(numbers[number]))):
            raise FormatError(f"{path}: line {number + 2}: {rule}, not {value.decode()!r:.40}")
    return numbers


def _parted(text: Text, path: object) -> tuple[Text, dict[str, list[bytes]]]:
    """Return the text without its columns `start`, `slowness` and `speed`, and those of them that it has, by name."""
    first, _, body = text.partition(b"\n")
    header = first.strip().decode(errors="replace").split(",")
    names = header[2:]
    others = names[1:] if names[:1] == [START_COLUMN] else names
    if not names or others not in ([], [SLOWNESS_COLUMN], [SPEED_COLUMN]):
        return text, {}
    lines = [",".join(header[:2]).encode()]
    columns: list[list[bytes]] = [[] for _ in names]
    for number, line in enumerate(body.rstrip(b"\r\n").splitlines(), start=2):
        values = line.split(b",")
        if len(values) != len(header):
            rule = f"there must be {len(header)} columns ({first.decode()})"
            raise FormatError(f"{path}: line {number}: {rule}, not {len(values)}")
        lines.append(b",".join(values[:2]))
        for column, value in zip(columns, values[2:], strict=True):
            column.append(value.strip())
    return Text(b"\n".join([*lines, b""])), dict(zip(names, columns, strict=True))


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
    slowness: NDArray[np.int64] | NDArray[np.float64] | None = None,
) -> None:
    """Write the cells of robots, given by number, when they begin to move and how slow they are, as is read again."""
    check_type("area", area, Area)
    x, y = area.cell_to_xy(robots)
    rows, header = [f"{one},{other}" for one, other in zip(x.tolist(), y.tolist(), strict=True)], STARTS_HEADER
    if start_times is not None:
        header = f"{header},{START_COLUMN}"
        rows = [f"{row},{time:.15g}" for row, time in zip(rows, start_times.tolist(), strict=True)]
    if slowness is not None:
        header = f"{header},{SPEED_COLUMN if slowness.dtype.kind == 'f' else SLOWNESS_COLUMN}"
        rows = [f"{row},{one:.15g}" for row, one in zip(rows, slowness.tolist(), strict=True)]
    with new_file(path) as part:
        part.write_text("\n".join([header, *rows, ""]))
