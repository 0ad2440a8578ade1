"""Scen: the starts in a `.scen` file of the MovingAI collection; its goals are not used, for robots share theirs."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import FormatError
from trihex.formats.text import Text

_COLUMNS = ("bucket", "map", "width", "height", "start x", "start y", "goal x", "goal y", "optimal length")
_WHOLE = (0, 2, 3, 4, 5, 6, 7)


def parse_scen(text: Text, path: str | os.PathLike[str], area: Area) -> NDArray[np.int64]:
    """Return the cell numbers of the starts, in the order of the file; repeated ones are kept.

    Raises
    ------
    FormatError
        If a line is not of the form, or was made for an area of another size.
    """
    lines = text.decode().splitlines() or [""]
    if lines[0].split()[:1] != ["version"]:
        raise FormatError(f"{path}: line 1: must be 'version 1', not {lines[0]!r:.60}")
    cells = np.empty(len(lines), dtype=np.int64)
    count = 0
    for number, line in enumerate(lines[1:], start=2):
        if not line.strip():
            continue
        values = _values(line, f"{path}: line {number}")
        if values[1:3] != [area.width, area.height]:
            raise FormatError(
                f"{path}: line {number}: is for an area of {values[1]} x {values[2]} cells, "
                f"not of {area.width} x {area.height}"
            )
        x, y = values[3:5]
        if not (x < area.width and y < area.height):
            raise FormatError(f"{path}: line {number}: start ({x}, {y}) lies outside the area")
        cells[count] = y * area.width + x
        count += 1
    return cells[:count]


def _values(line: str, where: str) -> list[int]:
    """Return the whole numbers of a line: bucket, width, height, start x, start y, goal x, goal y."""
    parts = line.split("\t") if "\t" in line else line.split()
    if len(parts) != len(_COLUMNS):
        raise FormatError(f"{where}: must have {len(_COLUMNS)} columns ({', '.join(_COLUMNS)}), not {len(parts)}")
    for column in _WHOLE:
        if not (parts[column].isdecimal() and parts[column].isascii() and len(parts[column]) <= 10):
            raise FormatError(f"{where}: {_COLUMNS[column]} must be a whole number, not {parts[column]!r:.40}")
    return [int(parts[column]) for column in _WHOLE]
