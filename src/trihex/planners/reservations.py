"""Reservations: the ways of robots in space and time, and the search for one more."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.memory import GIB, limit_or_default

_BUDGET = 200_000  # nodes looked at in one call of a kernel


class Reservations:
    """Which cell, lattice vertex and destination is taken in which step.

    Parameters
    ----------
    n_scheme : NScheme
    memory_limit : int, optional
        In bytes, of the tables. Default: 80 % of what is available.
    """

    def __init__(self, n_scheme: NScheme, memory_limit: int | None = None) -> None:
        from trihex.planners.kernels import astar as kernels

        scenario = n_scheme.scenario
        self.scenario, self.distance = scenario, n_scheme.distance_of_site
        layout, tessellation = scenario.area.layout, scenario.area.tessellation
        self._limit = limit_or_default(memory_limit)
        offset, back = layout.offset_of_direction, layout.back_of_direction
        self._forbids = scenario.crossing == "forbid" and tessellation.edge_count < tessellation.direction_count
        first_vertex_move = tessellation.edge_count if self._forbids else tessellation.direction_count
        ends = scenario.destinations.size if scenario.destination_capacity is not None else 0
        self._number = np.zeros(layout.size if ends else 0, dtype=np.int32)
        if ends:
            self._number[layout.cell_to_site(scenario.destinations)] = np.arange(ends)
        sites = layout.cell_to_site(scenario.destinations).astype(np.int64)
        around = np.unique(sites[:, None] + offset[sites & 1])
        self._gates = around[(self.distance[around] > 0) & (self.distance[around] != NOT_REACHED)].astype(np.int32)
        self._rules = np.array(
            [scenario.waiting_cost, first_vertex_move, scenario.destination_capacity or 0, 0, layout.size, ends]
        )
        self._moves = (offset, layout.vertex_of_direction, tessellation.cost_of_direction, back)
        self.reserved, self.passed = np.zeros(0, dtype=np.uint8), np.zeros(0, dtype=np.uint8)
        self.entries = np.zeros(0, dtype=np.int32)
        self._state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        self._make_lists(1 << 12)

    def _make_lists(self, size: int) -> None:
        """Make empty lists for searches, of `size` nodes."""
        self._nodes = np.empty((5, size), dtype=np.int32)
        self._lists = (
            np.empty(size, dtype=np.int64),
            np.full(4 * size, -1, dtype=np.int32),
            np.empty(2 * size, dtype=np.int64),
            np.empty(2 * size, dtype=np.int32),
            np.empty(2 * size, dtype=np.int32),
        )
        self._state[:] = 0

    def make_room(self, rows: int) -> None:
        """Let the tables have at least `rows` rows.

        Raises
        ------
        TooLargeError
            If they would take more than the limit.
        """
        have, size, ends = int(self._rules[3]), int(self._rules[4]), int(self._rules[5])
        if rows <= have:
            return
        rows = max(rows, have + have // 2)
        need = rows * (size * (1 + self._forbids) + 4 * ends)
        if need > self._limit:
            raise TooLargeError(
                f"reservations would take {need / GIB:.1f} GiB ({rows} steps of {size} cells), more than "
                f"memory_limit, {self._limit / GIB:.1f} GiB; plan fewer robots, a smaller area, or with fcost"
            )
        self.reserved = _grown(self.reserved, rows * size)
        self.passed = _grown(self.passed, rows * size * self._forbids)
        self.entries = _grown(self.entries, rows * ends)
        self._rules[3] = rows

    def find_way(
        self, start: int, is_shut: NDArray[np.bool_], limit: int = 1 << 62, most_looks: int = 1 << 62
    ) -> NDArray[np.uint8] | None:
        """Return the actions of the cheapest way from a site, or None if none costs less than `limit`.

        ``is_shut[site]`` bars sites, none if it is empty. None as well if that is not known after `most_looks` nodes.
        """
        from trihex.planners.kernels import astar as kernels

        offset, vertex, cost, back = self._moves
        earliest = kernels.find_first_entry(
            int(self.distance[start]) // int(cost.max()),
            self._gates,
            self._rules,
            offset,
            vertex,
            back,
            self.distance,
            self._number,
            self.reserved,
            self.passed,
            self.entries,
        )
        kernels.begin(start, self.distance, self._nodes, *self._lists, self._state)
        self._state[kernels.LOOKS] = 0
        status = kernels.BUDGET_SPENT
        while status in (kernels.BUDGET_SPENT, kernels.LIST_FULL):
            if self._state[kernels.LOOKS] >= most_looks:
                return None
            if status == kernels.LIST_FULL:
                self._make_lists(2 * self._nodes.shape[1])
                kernels.begin(start, self.distance, self._nodes, *self._lists, self._state)
            status = kernels.search(
                *(self._rules, *self._moves, self.distance, self.scenario.moves, self._number, is_shut),
                *(self.reserved, self.passed, self.entries, limit, earliest),
                *(self._nodes, *self._lists, self._state, min(_BUDGET, most_looks)),
            )
        if status == kernels.NOTHING:
            return None
        actions = np.empty(int(self._nodes[kernels.STEP, self._state[kernels.GOAL]]), dtype=np.uint8)
        kernels.write_way(self._nodes, self._state, self._moves[0].shape[1], actions)
        return actions

    def reserve(self, start: int, actions: NDArray[np.uint8], is_on: bool = True) -> None:
        """Reserve a way, or free it again."""
        from trihex.planners.kernels import astar as kernels

        self.make_room(actions.size + 1)
        offset, vertex = self._moves[:2]
        tables = (self.reserved, self.passed, self.entries)
        kernels.reserve(start, actions, is_on, self._rules, offset, vertex, self.distance, self._number, *tables)


def _grown(array: NDArray[Any], size: int) -> NDArray[Any]:
    """Return a copy with room for `size` entries; the new ones are 0."""
    grown = np.zeros(size, dtype=array.dtype)
    grown[: array.size] = array
    return grown
