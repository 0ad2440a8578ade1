"""Preview: an area drawn in letters, small enough for a terminal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area

# A letter in a terminal is about twice as tall as wide.
_ASPECT = 2.0
_LETTERS = np.array(list(".:+#"))


def preview_lines(
    area: Area,
    destinations: NDArray[np.int64] | None = None,
    robots: NDArray[np.int64] | None = None,
    *,
    columns: int = 72,
    rows: int = 24,
) -> list[str]:
    """Return lines of at most `columns` letters, at most `rows` of them.

    An area of at most `columns` x 2 `rows` cells is drawn whole, a letter for each cell, however tall that looks.

    `D` a destination, `o` a robot; else the share of barriers in what a letter stands for: `.` none, `:` less than a
    half, `+` a half and more, `#` all.

    Examples
    --------
    >>> preview_lines(Area("square", [[0, 0, 1, 1], [0, 0, 1, 0]]), np.array([0]))
    ['D.##', '..#.']
    >>> preview_lines(Area("square", [[0, 0, 1, 1], [0, 0, 1, 0]]), np.array([0]), columns=2)
    ['D+']
    """
    if area.width <= columns and area.height <= 2 * rows:
        columns, rows = area.width, area.height
    else:
        across, down = area.tessellation.extent(area.height, area.width)
        columns = min(columns, area.width, max(1, round(_ASPECT * rows * across / down)))
        rows = max(1, min(rows, area.height, round(columns * down / across / _ASPECT)))
    y, x = np.divmod(np.arange(area.cell_count), area.width)
    letter_of_cell = (y * rows // area.height) * columns + x * columns // area.width
    count = np.bincount(letter_of_cell, minlength=rows * columns)
    blocked = np.bincount(letter_of_cell[area.barriers.reshape(-1)], minlength=rows * columns)
    letters = _LETTERS[(blocked > 0) + (2 * blocked >= count).astype(int) + (blocked == count)]
    for cells, letter in ((robots, "o"), (destinations, "D")):
        if cells is not None:
            letters[letter_of_cell[cells]] = letter
    return ["".join(row) for row in letters.reshape(rows, columns)]
