"""Next door: the barrier that saves most if it becomes a destination, sought where most may be saved."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area


@dataclass
class NextDoor:
    """The best door so far, and where a better one may be.

    Groups of barriers are kept in the order of what one of them saves at most; that with the most is halved, until it
    is a barrier alone, which is bounded well and then tried. So most barriers are never looked at alone.

    Parameters
    ----------
    area : Area
    cells : ndarray of int64
        Barriers that may become destinations.
    variations, bounds
        What tells of optima with one cell changed, in its unit; and what bounds them well, in units of time.
    known : container of (kind, cell)
        What is known needs no bound.
    """

    area: Area
    cells: NDArray[np.int64]
    variations: Any
    bounds: Any
    known: Container[tuple[str, int]] = ()

    def __post_init__(self) -> None:
        self.best, self.saved = -1, 0
        self._count = 0  # of groups ever, to tell apart what may save as much
        self._heap: list[tuple[int, int, bool, NDArray[np.int64]]] = []
        if self.cells.size:
            self._add(self.cells, None)

    @property
    def most(self) -> int:
        """What any door saves at most, in units of time."""
        return max(self.saved, -self._heap[0][0] if self._heap else 0)

    @property
    def left(self) -> int:
        """How many barriers may still be better than the best."""
        return sum(group.size for bound, _, _, group in self._heap if -bound > self.saved)

    @property
    def needs_work(self) -> bool:
        """Whether what is looked at next takes longer than to halve a group."""
        group = self._heap[0][3]
        return group.size == 1 and ("door", int(group[0])) not in self.known

    @property
    def best_or_next(self) -> int:
        """The best door so far, or where one may be."""
        return self.best if self.best >= 0 else int(self._heap[0][3][0])

    def look(self, price: Callable[[int], int]) -> None:
        """Look at the group that may save most; `price` tells what a barrier saves, in units of time."""
        bound, _, is_good, group = heappop(self._heap)
        if group.size > 1:
            for half in self._halves(group):
                self._add(half, -bound)
            return
        cell = int(group[0])
        if not is_good and ("door", cell) not in self.known:
            least = min(-bound, int(self.bounds.well_bounded_by_door(cell)))
            self._push(least, group, is_good=True)
            return
        saved = price(cell)
        if saved > self.saved:
            self.best, self.saved = cell, saved

    def _add(self, group: NDArray[np.int64], most: int | None) -> None:
        """Bound a group, a part of one that saves so much at most, and keep it if it may be the best."""
        bound = int(self.variations.most_saved_by_door(group)) * self.variations.unit
        self._push(bound if most is None else min(most, bound), group, is_good=self.variations.is_quick)

    def _push(self, most: int, group: NDArray[np.int64], *, is_good: bool) -> None:
        if most > self.saved:
            heappush(self._heap, (-most, self._count, is_good, group))
            self._count += 1

    def _halves(self, group: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return two halves of a group, apart where it is longest."""
        x, y = self.area.cell_to_xy(group)
        along = x if np.ptp(x) >= np.ptp(y) else y
        order = np.argsort(along, kind="stable")
        return group[order[: group.size // 2]], group[order[group.size // 2 :]]
