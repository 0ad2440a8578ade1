"""Reservations: the ways of robots in space and time, and the search for one more."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED, WAIT
from trihex.memory import GIB, limit_or_default
from trihex.planners.estimates import Estimates

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
        from trihex.kernels.signatures import given
        from trihex.planners.kernels import astar, reservations

        scenario = n_scheme.scenario
        self.distance = n_scheme.distance_of_site
        layout, tessellation = scenario.area.layout, scenario.area.tessellation
        self._limit = limit_or_default(memory_limit)
        self._forbids = scenario.forbids_crossing
        cost, duration = tessellation.cost_of_direction, tessellation.duration_of_direction
        sites = layout.cell_to_site(scenario.destinations).astype(np.int64)
        around = np.unique(sites[:, None] + layout.offset_of_direction[sites & 1])
        self._terrain = given(
            reservations.Terrain,
            offset=layout.offset_of_direction,
            vertex=layout.vertex_of_direction,
            back=layout.back_of_direction,
            cost=cost,
            duration=duration,
            moves=scenario.moves,
            distance=self.distance,
            gates=around[(self.distance[around] > 0) & (self.distance[around] != NOT_REACHED)].astype(np.int32),
            first_vertex_move=scenario.first_vertex_move,
            waiting_cost=scenario.waiting_cost,
            least_cost=min(scenario.waiting_cost, int((cost // duration).min())),
            most_cost=(cost // duration).max(),
        )
        self._has_doors = scenario.has_flows
        ends = sites.size if scenario.entry_limit or self._has_doors else 0
        number = np.zeros(layout.size if ends else 0, dtype=np.int32)
        if ends:
            number[sites] = np.arange(ends)
        self._reserved = given(
            reservations.Reserved,
            rows=0,
            per_tick=0 if scenario.is_stepwise else 2 if scenario.following == "allow" else 1,
            site=np.zeros(0, dtype=np.uint8),
            vertex=np.zeros(0, dtype=np.uint8),
            entries=np.zeros(0, dtype=np.int32),
            number=number,
            ends=ends,
            capacity=scenario.entry_limit,
            let_in=np.zeros(0, dtype=np.int32),
            doors=scenario.schedule.for_kernels(layout),
        )
        self._estimates = Estimates(self._terrain)
        self._state = np.zeros(astar.STATE_SIZE, dtype=np.int64)
        self._make_lists(1 << 12)

    def _make_lists(self, size: int) -> None:
        """Make empty lists for searches, of `size` nodes."""
        from trihex.kernels.signatures import given
        from trihex.planners.kernels import astar
        from trihex.planners.kernels.heap import Heap

        self._nodes = given(
            astar.SpaceTime,
            site=np.empty(size, dtype=np.int32),
            step=np.empty(size, dtype=np.int32),
            parent=np.empty(size, dtype=np.int32),
            action=np.empty(size, dtype=np.uint8),
            cost=np.empty(size, dtype=np.int64),
            place=np.empty(size, dtype=np.int32),
            table=np.full(4 * size, -1, dtype=np.int32),
        )
        self._heap = given(
            Heap,
            key=np.empty(2 * size, dtype=np.int64),
            tie=np.empty(2 * size, dtype=np.int32),
            item=np.empty(2 * size, dtype=np.int32),
        )
        self._state[:] = 0

    def least_steps(self, distance: int) -> int:
        """Return how many steps a way that costs so much takes at least."""
        return distance // int(self._terrain.most_cost)

    def make_room(self, steps: int) -> None:
        """Let the tables have rows for at least so many steps.

        Raises
        ------
        TooLargeError
            If they would take more than the limit.
        """
        size, ends, have = self.distance.size, self._reserved.ends, self._steps
        if steps <= have:
            return
        steps = max(steps, have + have // 2)
        rows, need = steps * max(1, self._reserved.per_tick), self._bytes_of(steps)
        if need > self._limit:
            raise TooLargeError(
                f"reservations would take {need / GIB:.1f} GiB ({steps} steps of {size} cells), more than "
                f"memory_limit, {self._limit / GIB:.1f} GiB; plan fewer robots, a smaller area, or with fcost"
            )
        self._reserved = self._reserved._replace(
            rows=rows,
            site=_grown(self._reserved.site, rows * size),
            vertex=_grown(self._reserved.vertex, steps * size * self._forbids),
            entries=_grown(self._reserved.entries, rows * ends),
            let_in=_grown(self._reserved.let_in, steps * ends * self._has_doors),
        )

    @property
    def _steps(self) -> int:
        """How many steps the tables have rows for."""
        return int(self._reserved.rows // max(1, self._reserved.per_tick))

    def _bytes_of(self, steps: int) -> int:
        """Return what tables for so many steps take."""
        size, ends = self.distance.size, self._reserved.ends
        rows = steps * max(1, self._reserved.per_tick)
        return int(rows * (size + 4 * ends) + steps * (size * self._forbids + 4 * ends * self._has_doors))

    def hold(self, start: int, start_time: int) -> None:
        """Reserve the site of a robot that stands there until it may begin to move."""
        from trihex.planners.kernels import reservations

        self.make_room(start_time + 1)
        # Where moves last it may begin to go in the first half tick that is no more reserved.
        last = start_time * self._reserved.per_tick - 1 if self._reserved.per_tick else start_time
        reservations.hold(start, last, self._reserved, self.distance.size)

    def find_way(self, start: int, start_time: int, is_shut: NDArray[np.bool_]) -> NDArray[np.uint8] | None:
        """Return the actions of the cheapest way from a site, all that is waited first, or None if there is none.

        ``is_shut[site]`` bars sites, none if it is empty.
        """
        from trihex.planners.kernels import astar

        self._estimates.make_room(self._steps, self._limit - self._bytes_of(self._steps))
        status = astar.BUDGET_SPENT
        while status in (astar.BUDGET_SPENT, astar.LIST_FULL):
            if status == astar.LIST_FULL:
                self._make_lists(2 * self._nodes.site.size)
            space = (self._estimates.tables, self._nodes, self._heap, self._state)
            status = astar.search(start, start_time, self._terrain, self._reserved, is_shut, *space, _BUDGET)
        if status == astar.NOTHING:
            return None
        self._estimates.learn(self._nodes, self._state, for_good=is_shut.size == 0)
        actions = np.full(int(self._nodes.step[self._state[astar.GOAL]]), WAIT, dtype=np.uint8)
        return actions[actions.size - astar.write_way(self._nodes, self._state, actions) - start_time :].copy()

    def reserve(self, start: int, actions: NDArray[np.uint8]) -> None:
        """Reserve a way; where moves last or nobody follows at once, the one that was found last."""
        from trihex.planners.kernels import astar, reservations

        steps = int(self._nodes.step[self._state[astar.GOAL]]) if self._reserved.per_tick else actions.size
        self.make_room(steps + 1)
        reserve = reservations.reserve_ticks if self._reserved.per_tick else reservations.reserve
        reserve(start, actions, self._terrain, self._reserved)

    def unreserve(self, start: int, actions: NDArray[np.uint8]) -> None:
        """Free a way that was reserved."""
        from trihex.planners.kernels import reservations

        if self._estimates.tables.rows:
            self._estimates.forget()
        reservations.unreserve(start, actions, self._terrain, self._reserved)

    def straighten_way(
        self, start: int, start_time: int, most: int, turn: NDArray[np.int32], layers: Any, actions: NDArray[np.uint8]
    ) -> int:
        """Fill `actions` with the straightest of the cheapest ways of as many; see the kernel."""
        from trihex.planners.kernels import straight

        space = (self._terrain, self._reserved, turn, layers)
        return int(straight.straighten_way(start, start_time, most, *space, actions))


def _grown(array: NDArray[Any], size: int) -> NDArray[Any]:
    """Return a copy with room for `size` entries; the new ones are 0."""
    grown = np.zeros(size, dtype=array.dtype)
    grown[: array.size] = array
    return grown
