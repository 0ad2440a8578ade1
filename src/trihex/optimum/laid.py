"""Laid plan: the flow of a plan that is the best, with the labels that tell what else could be."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError, TooLargeError
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.memory import GIB
from trihex.optimum.open_graph import OpenGraph
from trihex.plans import Plan

# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the stacks at first.
_STACK = 1 << 16
# Bytes for each node of each step: flow with early labels, late labels, dues; where nobody is to be sought, twice; what
# is raised, and what it was; words of the variation under way.
_BYTES_PER_NODE = 36


class LaidPlan:
    """A plan in the words of the nodes of an open graph, which must be the best for that area.

    Parameters
    ----------
    plan : Plan
        In which all arrive who can.
    n_scheme : NScheme
    memory_limit : int
        In bytes.

    Attributes
    ----------
    start : ndarray of int64
        Node of each robot that has to go.
    arrivals : ndarray of int64
        Steps in which they arrive, ascending.
    words : ndarray of uint32
        Flow of all nodes of all steps, and early labels.
    due, late : ndarray of int32
        When the robot arrives that passes each node, or never, and late labels.
    dead_early, dead_late : ndarray of int32
        From which slots on no search is to come to each node: see `trihex.optimum.kernels.variation`.
    """

    def __init__(self, plan: Plan, n_scheme: NScheme, memory_limit: int) -> None:
        distance = n_scheme.distance_of_cell(plan.scenario.robots)
        robots = np.flatnonzero((distance != NOT_REACHED) & (distance != 0))
        _check_arrivals(plan, robots)
        self.arrivals = np.sort(plan.arrival_step_of_robot[robots]).astype(np.int64)
        self.last = int(self.arrivals.max(initial=1))
        need = (self.last + 1) * (plan.scenario.area.cell_count + 1) * _BYTES_PER_NODE
        if need > memory_limit:
            raise TooLargeError(
                f"prices of {plan.scenario.area.cell_count} cells over {self.last} steps need {need / GIB:.1f} GiB, "
                f"more than memory_limit, {memory_limit / GIB:.1f} GiB; take a smaller area or fewer robots"
            )
        nearness = n_scheme.distance.reshape(-1).astype(np.int64)
        self.graph = OpenGraph(plan.scenario, nearness)
        self.start = self.graph.node_of_cell[plan.scenario.robots[robots]]
        self.words = self._lay(plan, robots)
        self.due = self._dues()
        self._label_early()
        self.late = self._label_late()
        self.dead_early, self.dead_late = self._deaths()

    def _lay(self, plan: Plan, robots: NDArray[np.int64]) -> NDArray[np.uint32]:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import laid as kernels

        layout, graph = plan.scenario.area.layout, self.graph
        site = layout.cell_to_site(graph.cell_of_node).astype(np.int32)
        node_of_site = np.full(layout.size, -1, dtype=np.int32)
        node_of_site[site] = np.arange(site.size)
        words = np.zeros((self.last + 1) * graph.node_count, dtype=np.uint32)
        laid = given(
            kernels.LaidPlan,
            start=self.start,
            first_action=plan.first_action[robots],
            action=plan.actions,
            site_of_node=site,
            node_of_site=node_of_site,
            offset=layout.offset_of_direction,
        )
        rows = words.reshape(-1, graph.node_count)
        is_laid = kernels.lay_plan(laid, graph.for_kernels, words)
        if not is_laid or rows[:, graph.is_barrier].any():
            raise PlanError("prices need a plan without moves that are not open; audit_plan tells which it has")
        limit = plan.scenario.entry_limit
        shared = np.count_nonzero(rows[:, : graph.first_goal]) != plan.actions.size
        if shared or (limit and rows[:, graph.first_goal :].max(initial=0) > limit):
            raise PlanError("prices need a plan without conflicts; audit_plan tells which it has")
        return words

    def _dues(self) -> NDArray[np.int32]:
        from trihex.optimum.kernels.variation import write_dues

        due = np.empty(self.words.size, dtype=np.int32)
        write_dues(self.graph.for_kernels, self.start, self.words, due)
        return due

    def _deaths(self) -> NDArray[np.int32]:
        from trihex.optimum.kernels.variation import write_deaths

        deaths = np.empty((2, self.words.size), dtype=np.int32)
        write_deaths(self.graph.for_kernels, self.graph.is_barrier, self.words, self.late, *deaths)
        return deaths

    @property
    def is_best(self) -> bool:
        """Whether no robot could arrive sooner."""
        from trihex.optimum.kernels.variation import is_best

        return bool(is_best(self.words, self.late, self.last))

    def _label_early(self) -> None:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import tolls as kernels
        from trihex.optimum.kernels.residual import DONE, LIST_FULL

        graph = self.graph
        # Barriers are labelled beforehand, so that nobody goes through.
        self.words.reshape(-1, graph.node_count)[:, graph.is_barrier] |= np.uint32((self.last + 1) * kernels.WHEN)
        state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        state[kernels.LAST] = self.last
        labelling = given(
            kernels.Labelling,
            hops=np.zeros(graph.node_count, dtype=np.int32),
            capacity=graph.scenario.entry_limit,
            words=self.words,
            stack=np.empty(max(_STACK, 16 * graph.node_count), dtype=np.int64),
            state=state,
        )
        status = None
        while status != DONE:
            status = kernels.label_nodes(graph.for_kernels, labelling, _BUDGET)
            if status == LIST_FULL:
                labelling = labelling._replace(stack=_longer(labelling.stack))

    def _label_late(self) -> NDArray[np.int32]:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import late as kernels
        from trihex.optimum.kernels.residual import DONE, LIST_FULL

        state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        state[kernels.ARRIVAL] = self.last + 1
        search: Any = given(
            kernels.LateSearch,
            barrier=self.graph.is_barrier,
            words=self.words,
            late=np.zeros(self.words.size, dtype=np.int32),
            stack=np.empty(_STACK, dtype=np.int64),
            state=state,
        )
        status = None
        while status != DONE:
            status = kernels.label_late(self.graph.for_kernels, search, _BUDGET)
            if status == LIST_FULL:
                search = search._replace(stack=_longer(search.stack))
        late: NDArray[np.int32] = search.late
        return late


def _check_arrivals(plan: Plan, robots: NDArray[np.int64]) -> None:
    """Raise PlanError unless all robots arrive, and no others do anything."""
    late = robots[~plan.arrived[robots]]
    if late.size:
        raise PlanError(f"prices need a plan in which all arrive who can, unlike robot {late[0]}")
    if plan.jumps.size or np.diff(plan.first_action)[robots].sum() != plan.actions.size:
        raise PlanError("prices need a plan in which nobody jumps, and nobody moves who cannot arrive")


def _longer(array: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.concatenate([array, np.empty_like(array)])
