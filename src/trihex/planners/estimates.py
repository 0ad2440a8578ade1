"""Estimates: what searches know of the costs of ways; it grows with each of them."""

from __future__ import annotations

from typing import Any

import numpy as np

# Nothing is learned before searches have had so many nodes (a second or two), so that plans of small crowds stay what
# they were; then ways of so many steps are worked out as soon as there has been a node for each 8 of their entries.
_PATIENCE, _ENTRIES_A_NODE = 4_000_000, 8
_AT_ONCE = 1_000_000  # entries, in one call of a kernel


class Estimates:
    """Tables of what a way costs at least from each cell in each step; empty at first, and where memory is short.

    Parameters
    ----------
    terrain : Terrain
        Of the kernels.
    """

    def __init__(self, terrain: Any) -> None:
        self._terrain, self._nodes_had = terrain, 0
        self.forget()

    def forget(self) -> None:
        """Forget all: what has been learned is true only while ever more is reserved."""
        from trihex.kernels.signatures import given
        from trihex.planners.kernels import estimates

        nothing = np.zeros(0, dtype=np.uint16)
        self.tables = given(estimates.Estimates, rows=0, learned=nothing, longer_rows=0, longer=nothing)

    def make_room(self, steps: int, memory_limit: int) -> None:
        """Let the tables have so many rows if they then take no more bytes than the limit."""
        size = self._terrain.distance.size
        if self._nodes_had < _PATIENCE or steps <= self.tables.rows or 4 * steps * size > memory_limit:
            return
        learned = np.zeros(steps * size, dtype=np.uint16)
        learned[: self.tables.learned.size] = self.tables.learned
        self.tables = self.tables._replace(rows=steps, learned=learned)

    def learn(self, nodes: Any, state: Any, *, for_good: bool) -> None:
        """Note that a search has found its way; learn from it if what hindered it will for good."""
        from trihex.planners.kernels import astar

        if for_good:
            astar.learn(self._terrain, nodes, state, self.tables)
        self._nodes_had += int(state[astar.NODES])
        if _ENTRIES_A_NODE * self._nodes_had > self.tables.learned.size > self.tables.longer.size:
            self._lengthen()

    def _lengthen(self) -> None:
        """Work out what ways of as many steps as there are rows cost at least."""
        from trihex.planners.kernels import estimates

        size, rows, first = self._terrain.distance.size, self.tables.rows, max(1, self.tables.longer_rows)
        longer = np.zeros(rows * size, dtype=np.uint16)
        longer[: self.tables.longer.size] = self.tables.longer
        self.tables = self.tables._replace(longer_rows=rows, longer=longer)
        at_once = max(1, _AT_ONCE // size)
        for row in range(first, rows, at_once):
            estimates.fill_longer(row, min(row + at_once, rows), self._terrain, self.tables)
