"""Ways: where the best directions lead, one for each cell: as a number, as the next cell, as a vector."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Area, Tessellation, numbers_from

Directions = NDArray[np.uint16]


def first_of(bits: NDArray[Any]) -> NDArray[np.int64]:
    """Return the number of the first direction in each set of bits, -1 where there is none.

    Examples
    --------
    >>> first_of(np.array([0, 1, 0b110])).tolist()
    [-1, 0, 1]
    """
    bits = np.asarray(bits, dtype=np.int64)
    _, exponent = np.frexp((bits & -bits).astype(np.float64))  # of 2**k it is k + 1, of 0 it is 0
    return np.asarray(exponent, dtype=np.int64) - 1


def direction_of_cell(area: Area, directions: Directions, cells: ArrayLike) -> NDArray[np.int64]:
    """Return the first best direction of cells, -1 where there is none; `directions` has shape (height, width)."""
    y, x = np.divmod(numbers_from(area, cells), area.width)
    return first_of(directions[y, x])


def next_cell(area: Area, directions: Directions, cells: ArrayLike) -> NDArray[np.int64]:
    """Return the numbers of the cells to which the first best directions lead, the same where there is none."""
    numbers = numbers_from(area, cells)
    y, x = np.divmod(numbers, area.width)
    direction = first_of(directions[y, x])
    step = area.tessellation.step_of_direction[area.tessellation.orientation_of_cell(x, y), direction]
    there = numbers + step[..., 1] * np.int64(area.width) + step[..., 0]
    return np.asarray(np.where(direction < 0, numbers, there))


def unit_vectors(tessellation: Tessellation, directions: Directions) -> NDArray[np.float64]:
    """Return unit vectors (east, south) along the first best directions, (0, 0) where there is none."""
    height, width = directions.shape
    x, y = np.arange(width)[None, :], np.arange(height)[:, None]
    table = np.concatenate([tessellation.unit_vector_of_direction, np.zeros((2, 1, 2))], axis=1)  # its last row is -1
    return np.asarray(table[tessellation.orientation_of_cell(x, y), first_of(directions)])
