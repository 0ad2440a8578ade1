"""Variations: the optimum if one cell were another than it is, exchanged anew from a plan that is the best."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError, check_type
from trihex.fields import NScheme, make_n_scheme
from trihex.memory import limit_or_default
from trihex.optimum.certificate import check_equal_steps
from trihex.optimum.laid import LaidPlan
from trihex.plans import Plan
from trihex.record import read_only

# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the log of a search at first.
_LOG = 1 << 16
# Rows of nodes that are looked at between two looks at the keyboard, for each cell two or three.
_ROWS = 50_000
# So many nodes, cells times steps, are many. (10^6 on room-64-64-8 with 500 robots: 0.2 s to exchange, 0.01 to bound.)
_MANY = 200_000


class Variations:
    """Optima of areas that differ in one cell from that of a plan, which is the best where all steps cost the same.

    What is saved and lost is in steps, all robots together.

    Parameters
    ----------
    plan : Plan
        In which all arrive who can.
    n_scheme : NScheme, optional
        That of its scenario, if it is at hand.
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Raises
    ------
    PlanError
        If steps cost differently, some robot does not arrive, or the plan is not the best.
    TooLargeError
        If the nodes of all steps would take more than `memory_limit`.
    """

    def __init__(self, plan: Plan, *, n_scheme: NScheme | None = None, memory_limit: int | None = None) -> None:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels.slots import LOG_COLUMNS
        from trihex.optimum.kernels.variation import Optimum

        check_type("plan", plan, Plan)
        check_equal_steps(plan.scenario)
        n_scheme = n_scheme if n_scheme is not None else make_n_scheme(plan.scenario)
        self._laid = laid = LaidPlan(plan, n_scheme, limit_or_default(memory_limit))
        self._graph = graph = laid.graph
        self._steps = int(laid.arrivals.sum())
        self._words = np.empty(laid.words.size, dtype=np.uint32)
        self._log = np.empty((_LOG, LOG_COLUMNS), dtype=np.uint32)
        self._optimum = given(Optimum, graph.is_barrier, laid.words, laid.due, laid.late)
        self._opened, self._doors = self._make_openings(), self._make_doors(n_scheme)
        least = self._varied(-1, 1)
        if least < self._steps:
            raise PlanError(f"prices need the best plan: its robots take {self._steps} steps together, {least} will do")

    @property
    def robot_count(self) -> int:
        """Robots that have to go and can arrive."""
        return int(self._laid.start.size)

    @property
    def is_quick(self) -> bool:
        """Whether to exchange slots for a door takes no longer than to bound what it saves."""
        return int(self._laid.words.size) < _MANY

    @property
    def all_arrive(self) -> bool:
        """Whether no robot is cut off."""
        scenario = self._graph.scenario
        return self.robot_count == int((~np.isin(scenario.robots, scenario.destinations)).sum())

    @property
    def unit(self) -> int:
        """What a step costs."""
        return int(self._graph.scenario.waiting_cost)

    def robots_if_changed(self, cell: int) -> int:
        """Return how many robots that have to go could arrive if a cell were opened or closed."""
        from trihex.optimum.kernels.variation import count_reached

        graph, scenario = self._graph, self._graph.scenario
        start = graph.node_of_cell[scenario.robots]
        start = start[start < graph.first_goal]
        queue = np.empty(2 * graph.node_count, dtype=np.int64)
        node = int(graph.node_of_cell[cell])
        return int(count_reached(graph.for_kernels, graph.is_barrier, node, start, queue))

    def saved_bounds(
        self, cells: NDArray[np.int64], tell: Callable[[int], None] | None = None
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return how many steps opening each barrier saves at least and at most; nearly all save nothing.

        Parameters
        ----------
        cells : ndarray of int64
        tell : callable, optional
            Called with the number of cells looked at.
        """
        from trihex.optimum.kernels.opening import count_steps_gained

        least = np.zeros(cells.size, dtype=np.int64)
        place = self._next_opening(cells, 0, tell)
        while place is not None:
            least[place] = count_steps_gained(self._graph.for_kernels, self._opened, self._gained)
            place = self._next_opening(cells, place + 1, tell)
        return least, np.where(least > 0, self._steps, 0)

    def saved_if_open(self, cell: int) -> int:
        """Return how many steps opening a barrier saves."""
        from trihex.optimum.kernels import opening as kernels

        if self._next_opening(np.array([cell]), 0) is None:
            return 0
        state = self._opened.state
        node, first, end = int(self._graph.node_of_cell[cell]), int(state[kernels.FIRST]), int(state[kernels.END])
        steps = self._varied(node, first, end)
        kernels.restore_labels(self._opened)
        return self._steps - steps

    def lost_if_closed(self, cell: int) -> int:
        """Return how many steps more robots need if a free cell is closed; all must still be able to arrive."""
        laid, size, node = self._laid, self._graph.node_count, int(self._graph.node_of_cell[cell])
        due = laid.due[node::size]
        if not due.any():
            return 0
        first = int(due[due > 0].min())
        layers = laid.last + 1 + max(8, laid.last // 8)
        while True:
            self._words = np.empty(layers * size, dtype=np.uint32)
            steps = self._varied(-1, first, closed=node)
            if steps >= 0:
                self._words = np.empty(laid.words.size, dtype=np.uint32)
                return steps - self._steps
            layers *= 2

    def most_saved_by_doors(
        self, cells: NDArray[np.int64], tell: Callable[[int], None] | None = None
    ) -> NDArray[np.int64]:
        """Return how many steps are saved at most if each barrier becomes a destination; `tell`: see `saved_bounds`."""
        from trihex.optimum.kernels.doors import bound_doors

        saved = np.zeros(cells.size, dtype=np.int64)
        search = self._doors._replace(node=read_only(self._graph.node_of_cell[cells]))
        share = max(1, _BUDGET * 4 // self._graph.node_count)
        for first in range(0, cells.size, share):
            bound_doors(self._graph.for_kernels, search, saved, first, min(first + share, cells.size))
            if tell:
                tell(min(first + share, cells.size))
        return saved

    def saved_by_door(self, cell: int) -> int:
        """Return how many steps are saved if a barrier becomes a destination."""
        from trihex.optimum.kernels import doors as kernels

        graph = self._graph
        graph.set_door(int(graph.node_of_cell[cell]))
        found = np.zeros(2, dtype=np.int64)
        kernels.find_door_steps(graph.for_kernels, self._doors, self._laid.late, graph.door, found)
        first, end = found.tolist()
        steps = self._varied(graph.door, first, end) if end else self._steps
        graph.set_door(None)
        return self._steps - steps

    def _make_openings(self) -> Any:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import opening as kernels

        laid = self._laid
        self._gained = np.empty(laid.last + 1, dtype=bool)
        return given(
            kernels.Openings,
            node=np.empty(0, dtype=np.int64),
            barrier=self._graph.is_barrier,
            words=laid.words,
            last=laid.last,
            late=laid.late,
            early=np.zeros(laid.last + 1, dtype=np.int32),
            raised=np.empty(laid.words.size, dtype=np.int64),
            before=np.empty(laid.words.size, dtype=np.int32),
            state=np.zeros(kernels.STATE_SIZE, dtype=np.int64),
        )

    def _make_doors(self, n_scheme: NScheme) -> Any:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels.doors import DoorSearch

        laid, graph, scenario = self._laid, self._graph, self._graph.scenario
        distance = n_scheme.distance_of_cell(graph.cell_of_node[laid.start])
        arrived = np.searchsorted(laid.arrivals, np.arange(laid.last + 1), side="right")
        return given(
            DoorSearch,
            node=np.empty(0, dtype=np.int64),
            barrier=graph.is_barrier,
            start=laid.start,
            steps=distance.astype(np.int64) // scenario.waiting_cost,
            arrived=arrived.astype(np.int64),
            capacity=scenario.entry_limit,
            away=np.empty(graph.node_count, dtype=np.int64),
            queue=np.empty(graph.node_count, dtype=np.int64),
            near=np.empty(laid.last + 1, dtype=np.int64),
            near_door=np.empty(laid.last + 1, dtype=np.int64),
        )

    def _next_opening(
        self, cells: NDArray[np.int64], place: int, tell: Callable[[int], None] | None = None
    ) -> int | None:
        """Return the next place among the cells, from one on, of one that saves steps; None if there is none."""
        from trihex.optimum.kernels import opening as kernels

        openings = self._opened._replace(node=read_only(self._graph.node_of_cell[cells]))
        self._opened, state = openings, openings.state
        state[kernels.CELL] = place
        while state[kernels.CELL] < cells.size:
            found = kernels.find_opening(self._graph.for_kernels, openings, max(1, _ROWS // self._laid.last))
            if tell:
                tell(int(state[kernels.CELL]))
            if found:
                return int(state[kernels.CELL]) - 1
        return None

    def _varied(self, opened: int, first: int, end: int | None = None, closed: int | None = None) -> int:
        """Return the steps of all robots in a variation.

        Parameters
        ----------
        opened, closed : int
            Node that is opened, -1: none; and closed, which may need more layers of words than there are: then -1.
        first, end : int
            Just as many arrive by each step before the first, or from `end` on, as they do.
        """
        from trihex.optimum.kernels import variation as kernels

        laid, graph = self._laid, self._graph
        kernels.begin_at_step(graph.for_kernels, self._optimum, opened, first, self._words)
        if closed is not None:
            kernels.close_node(graph.for_kernels, closed, self._words)
        before = int(np.searchsorted(laid.arrivals, first))
        served, total = self._fill(before, int(laid.arrivals[:before].sum()), first, end)
        if served < laid.arrivals.size and end is None:
            return -1
        return total + int(np.maximum(laid.arrivals[served:], end or 0).sum())

    def _fill(self, served: int, total: int, first: int, end: int | None) -> tuple[int, int]:
        """Fill the slots from a step on, with what was served before; return robots served and the sum of steps."""
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import residual, slots as kernels
        from trihex.optimum.kernels.earliest import fill_slots
        from trihex.optimum.kernels.words import DEAD

        graph, state = self._graph, np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        state[kernels.STEP], state[kernels.GOAL] = first - 1, graph.node_count
        state[kernels.LAST] = (end or self._words.size // graph.node_count) - 1
        state[kernels.SERVED], state[kernels.TOTAL] = served, total
        state[kernels.PATIENCE] = kernels.TIRELESS  # where most is dead from the beginning
        heads = np.empty(DEAD, dtype=np.int64)
        status = None
        while status not in (residual.DONE, residual.LAYERS_FULL):
            search = given(kernels.SlotSearch, words=self._words, log=self._log, heads=heads, state=state)
            status = fill_slots(graph.for_kernels, search, self._laid.arrivals.size, _BUDGET)
            if status == residual.LIST_FULL:
                self._log = np.concatenate([self._log, np.empty_like(self._log)])
        return int(state[kernels.SERVED]), int(state[kernels.TOTAL])
