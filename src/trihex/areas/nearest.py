"""Nearest: the free cells nearest to a point, for messages about places where no robot can stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas.tessellation import Tessellation

_REACH = 50  # rows and columns that are looked at first


def nearest_free_cell(
    tessellation: Tessellation, barriers: NDArray[np.bool_], px: float, py: float
) -> tuple[int, int] | None:
    """Return (x, y) of the free cell whose centre is nearest to a point in edge steps; None if no cell is free.

    Examples
    --------
    >>> nearest_free_cell(Tessellation("square"), np.array([[False, True, True]]), 99, 0.5)
    (0, 0)
    """
    height, width = barriers.shape
    x, y = (int(number) for number in tessellation.cell_at_point(px, py))
    x, y = min(max(x, 0), width - 1), min(max(y, 0), height - 1)
    for reach in (_REACH, height + width):
        left, top = max(0, x - reach), max(0, y - reach)
        rows, columns = np.nonzero(~barriers[top : y + reach + 1, left : x + reach + 1])
        if rows.size == 0:
            continue
        cx, cy = tessellation.centre_of_cell(columns + left, rows + top)
        nearest = int(np.argmin((cx - px) ** 2 + (cy - py) ** 2))
        return int(columns[nearest]) + left, int(rows[nearest]) + top
    return None
