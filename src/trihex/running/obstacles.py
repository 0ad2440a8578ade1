"""Obstacles: what came to stand in the world since the beginning, each by the cells that it touches."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray


class Obstacles:
    """What stands in cells, so that a cell is free again only when nothing is left in it.

    Examples
    --------
    >>> obstacles = Obstacles()
    >>> obstacles.put([1, 2])
    >>> obstacles.put([2, 3])
    >>> sorted(obstacles.take([1, 2])), sorted(obstacles.cells)
    ([1], [2, 3])
    """

    def __init__(self) -> None:
        self._standing: list[frozenset[int]] = []
        self._filled: set[int] = set()

    @property
    def cells(self) -> set[int]:
        """All cells in which something stands."""
        return self._filled.union(*self._standing)

    def put(self, cells: Iterable[int]) -> None:
        """Note that something stands in cells."""
        if own := frozenset(cells):
            self._standing.append(own)

    def fill(self, cells: Iterable[int]) -> None:
        """Note that cells are filled, each for itself, whatever by."""
        self._filled.update(cells)

    def take(self, cells: Iterable[int]) -> set[int]:
        """Note that what stood in these cells is gone; return those of them in which nothing else stands."""
        own = frozenset(cells)
        self._standing = [other for other in self._standing if other != own]
        return set(own) - self.cells

    def clear(self, cells: Iterable[int]) -> None:
        """Note that nothing stands in cells any more, whatever it was."""
        if own := frozenset(cells):
            self._filled -= own
            self._standing = [rest for other in self._standing if (rest := other - own)]

    def as_array(self) -> NDArray[np.int64]:
        """Return a row for each obstacle and cell, their numbers; -1 for cells that are filled for themselves."""
        pairs = [(-1, cell) for cell in sorted(self._filled)]
        pairs += [(number, cell) for number, own in enumerate(self._standing) for cell in sorted(own)]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    def restore(self, array: NDArray[np.int64]) -> None:
        """Go back to what `as_array` returned."""
        self._filled = set(array[array[:, 0] < 0, 1].tolist())
        numbers = np.unique(array[array[:, 0] >= 0, 0])
        self._standing = [frozenset(array[array[:, 0] == number, 1].tolist()) for number in numbers]
