"""Hexagons: offset coordinates (x, y), axial and cube coordinates of hexagonal cells, and ways from one to another.

The cells of a hexagonal area stand in columns and have a flat top, odd columns half a cell lower: offset coordinates
"odd-q". Axial (q, r) and cube coordinates (q, r, s) with q + r + s = 0 are those in which distances, lines and turns
are sums.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.errors import AreaError

Whole = NDArray[np.int64]


def xy_to_axial(x: ArrayLike, y: ArrayLike) -> tuple[Whole, Whole]:
    """Return axial (q, r) of hexagons (x, y), any integers: q = x, r = y - (x - x % 2) / 2.

    Examples
    --------
    >>> [int(number) for number in xy_to_axial(3, 2)]
    [3, 1]
    """
    q, y = np.broadcast_arrays(np.asarray(x, dtype=np.int64), np.asarray(y, dtype=np.int64))
    return q.copy(), np.asarray(y - (q - (q & 1)) // 2)


def axial_to_xy(q: ArrayLike, r: ArrayLike) -> tuple[Whole, Whole]:
    """Return (x, y) of hexagons in axial coordinates; the inverse of `xy_to_axial`."""
    x, r = np.broadcast_arrays(whole("q", q), whole("r", r))
    return x.copy(), np.asarray(r + (x - (x & 1)) // 2)


def whole(parameter: str, values: ArrayLike) -> Whole:
    """Return `values` as integers, else raise AreaError; whole numbers that are kept as floats are taken, too."""
    array = np.asarray(values)
    if array.size == 0 or np.issubdtype(array.dtype, np.integer):
        return array.astype(np.int64, copy=False)
    if np.issubdtype(array.dtype, np.floating):
        is_whole = np.isfinite(array) & (np.abs(array) < 2**53) & (array == np.floor(array))
        if is_whole.all():
            return array.astype(np.int64)
        raise AreaError(f"{parameter} must be whole numbers, the column or row of a cell, not {array[~is_whole][0]:g}")
    raise AreaError(f"{parameter} must be whole numbers, the column or row of a cell, not {array.dtype} values")
