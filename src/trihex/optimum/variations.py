"""Variations: the optimum if one cell were another than it is, exchanged anew from a plan that is the best."""

from __future__ import annotations

from collections.abc import Iterator
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
        self._graph = laid.graph
        self._steps = int(laid.arrivals.sum())
        self._words = np.empty(laid.words.size, dtype=np.uint32)
        self._log = np.empty((_LOG, LOG_COLUMNS), dtype=np.uint32)
        self._optimum = given(Optimum, laid.words, laid.due, laid.dead_early, laid.dead_late)
        self._opened, self._doors = self._make_openings(), self._make_doors(n_scheme)
        if not laid.is_best:
            least = self._varied(-1, 1)
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

    def robots_if_opened(self, cells: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return how many robots that have to go could arrive if a barrier were opened, for each of them."""
        from trihex.optimum.kernels.variation import count_let_in

        graph = self._graph
        scratch, let_in = np.empty((3, graph.node_count), dtype=np.int64), np.empty(cells.size, dtype=np.int64)
        nodes = read_only(graph.node_of_cell[cells])
        count_let_in(graph.for_kernels, graph.is_barrier, nodes, self._starts(), *scratch, let_in)
        return let_in + self.robot_count

    def robots_if_closed(self, cell: int) -> int:
        """Return how many robots that have to go could arrive if a free cell were closed."""
        from trihex.optimum.kernels.variation import count_reached

        graph = self._graph
        queue = np.empty(2 * graph.node_count, dtype=np.int64)
        node = int(graph.node_of_cell[cell])
        return int(count_reached(graph.for_kernels, graph.is_barrier, node, self._starts(), queue))

    def _starts(self) -> NDArray[np.int64]:
        """Return the nodes of all robots that have to go, whether they can or not."""
        start = self._graph.node_of_cell[self._graph.scenario.robots]
        return read_only(start[start < self._graph.first_goal])

    def openings(self, cells: NDArray[np.int64]) -> Iterator[tuple[int, int, int]]:
        """Yield the place of each barrier that it helps to open, and how many steps that saves at least and at most.

        All others save nothing. To ask `saved_if_open` before the next is quicker than to ask later.

        Parameters
        ----------
        cells : ndarray of int64
        """
        from trihex.optimum.kernels.opening import bound_steps_gained

        nodes = read_only(self._graph.node_of_cell[cells])
        ways, bounds = np.empty(self._laid.last + 1, dtype=np.int32), np.empty(2, dtype=np.int64)
        place = self._next_opening(nodes, 0)
        while place is not None:
            bound_steps_gained(self._graph.for_kernels, self._opened, self._doors.arrived, ways, bounds)
            yield place, int(bounds[0]), int(bounds[1])
            place = self._next_opening(nodes, place + 1)

    def saved_if_open(self, cell: int) -> int:
        """Return how many steps opening a barrier saves."""
        from trihex.optimum.kernels import opening as kernels

        node, state = int(self._graph.node_of_cell[cell]), self._opened.state
        if self._open != node and self._next_opening(read_only(np.array([node])), 0) is None:
            return 0
        return self._steps - self._varied(node, int(state[kernels.FIRST]), int(state[kernels.END]))

    def lost_if_closed(self, cell: int) -> int:
        """Return how many steps more robots need if a free cell is closed; all must still be able to arrive."""
        from trihex.optimum.kernels.variation import NEVER

        laid, size, node = self._laid, self._graph.node_count, int(self._graph.node_of_cell[cell])
        first = int(laid.due[node::size].min())
        if first == NEVER:  # nobody passes
            return 0
        layers = laid.last + 1 + max(8, laid.last // 8)
        while True:
            if self._words.size < layers * size:
                self._words = np.empty(layers * size, dtype=np.uint32)
            steps = self._varied(-1, first, closed=node)
            if steps >= 0:
                return steps - self._steps
            layers *= 2

    def most_saved_by_door(self, cells: NDArray[np.int64]) -> int:
        """Return how many steps are saved at most if one of the barriers becomes a destination, whichever it is."""
        from trihex.optimum.kernels.doors import bound_door

        return int(bound_door(self._graph.for_kernels, self._doors, read_only(self._graph.node_of_cell[cells])))

    def saved_by_door(self, cell: int) -> int:
        """Return how many steps are saved if a barrier becomes a destination."""
        from trihex.optimum.kernels import doors as kernels
        from trihex.optimum.kernels.opening import restore_labels

        graph, self._open = self._graph, -1
        restore_labels(self._opened)
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
        self._open = -1  # node whose late labels are raised
        return given(
            kernels.Openings,
            node=np.empty(0, dtype=np.int64),
            barrier=self._graph.is_barrier,
            words=laid.words,
            last=laid.last,
            late=laid.late,
            early=np.zeros(laid.last + 1, dtype=np.int32),
            raised=np.empty(laid.words.size, dtype=np.uint32),
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

    def _next_opening(self, nodes: NDArray[np.int64], place: int) -> int | None:
        """Return the next place among barriers, from one on, of one that saves steps; None if there is none."""
        from trihex.optimum.kernels import opening as kernels

        openings = self._opened._replace(node=nodes)
        self._opened, state, self._open = openings, openings.state, -1
        state[kernels.CELL] = place
        while state[kernels.CELL] < nodes.size:
            if kernels.find_opening(self._graph.for_kernels, openings, max(1, _ROWS // self._laid.last)):
                place = int(state[kernels.CELL]) - 1
                self._open = int(nodes[place])
                return place
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
        from trihex.optimum.kernels.words import DEAD, LABEL

        laid, graph, words = self._laid, self._graph, self._words
        dead = self._optimum.dead_late if opened >= 0 else self._optimum.dead_early
        kernels.begin_at_step(self._optimum, dead, first, words)
        if opened >= 0:
            kernels.open_node(graph.for_kernels, opened, words)
            kernels.revive_raised(graph.for_kernels, self._opened, first, words)
        if closed is not None:
            words[laid.words.size :].reshape(-1, graph.node_count)[:] = graph.is_barrier * np.uint32(DEAD * LABEL)
            kernels.close_node(graph.for_kernels, closed, words)
        before = int(np.searchsorted(laid.arrivals, first))
        # Where a cell is closed no more arrive by any step than did before, so no slot is sought when they have.
        most = self._doors.arrived[slice(0 if closed is None else None)]
        served, total = self._fill(before, int(laid.arrivals[:before].sum()), first, end, most)
        if served < laid.arrivals.size and end is None:
            return -1
        return total + int(np.maximum(laid.arrivals[served:], end or 0).sum())

    def _fill(self, served: int, total: int, first: int, end: int | None, most: NDArray[np.int64]) -> tuple[int, int]:
        """Fill the slots from a step on, with what was served before; return robots served and the sum of steps.

        No more than `most` arrive by each step.
        """
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
            search = given(kernels.SlotSearch, words=self._words, log=self._log, heads=heads, state=state, most=most)
            status = fill_slots(graph.for_kernels, search, self._laid.arrivals.size, _BUDGET)
            if status == residual.LIST_FULL:
                self._log = np.concatenate([self._log, np.empty_like(self._log)])
        return int(state[kernels.SERVED]), int(state[kernels.TOTAL])
