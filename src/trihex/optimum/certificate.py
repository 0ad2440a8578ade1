"""Certificate: tolls that prove a plan to be the best."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, check_as_fast
from trihex.errors import PlanError, check_type
from trihex.fields import NScheme, make_n_scheme
from trihex.kernels.codes import NOT_REACHED
from trihex.memory import limit_or_default
from trihex.optimum.earliest import lay_words, make_slot_graph
from trihex.optimum.fair import FairPricing
from trihex.optimum.network import Network, make_network
from trihex.optimum.workspace import check_memory, start_nodes
from trihex.plans import Plan
from trihex.record import Record, read_only

# Bytes for each node of a layer: a word; and for each action: node and toll.
_BYTES_PER_NODE = _BYTES_PER_ACTION = 8
# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the stack at first.
_STACK = 1 << 16


@dataclass(frozen=True, eq=False)
class Certificate(Record):
    """What robots would have to pay for cells and steps; it proves that no plan has a smaller sum of t_r.

    Parameters
    ----------
    plan : Plan
        The plan that is proven.
    cell, step : ndarray of int64, shape (tolls,)
        Where and when there is a toll, in order of step: on a robot that is in the cell after the step, or enters the
        destination in it.
    toll : ndarray of int64, shape (tolls,)
        In the unit of the costs, at least 1.
    vertex, vertex_step, vertex_toll : ndarray of int64, optional
        The same of lattice vertices, on a robot that moves through the vertex in the step. Vertices bear the numbers
        that `Layout` gives them.
    """

    plan: Plan
    cell: NDArray[np.int64]
    step: NDArray[np.int64]
    toll: NDArray[np.int64]
    vertex: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    vertex_step: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    vertex_toll: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))

    def __post_init__(self) -> None:
        check_type("plan", self.plan, Plan)
        for name in ("cell", "step", "toll", "vertex", "vertex_step", "vertex_toll"):
            self._set(name, read_only(np.asarray(getattr(self, name), dtype=np.int64)))

    def in_words(self) -> str:
        """Return how many tolls prove which plan."""
        return f"{self.toll.size + self.vertex_toll.size} tolls for {self.plan.in_words()}"


def check_certifiable(scenario: Scenario) -> None:
    """Raise PlanError unless a plan is a flow that can be proven: time in steps alone, all begin at once, no doors."""
    check_as_fast(scenario, "a certificate")
    if not scenario.is_stepwise:
        raise PlanError(
            "a certificate needs time in steps alone: clock='steps' and following='allow', "
            f"not {scenario.clock!r}, {scenario.following!r}"
        )
    if scenario.has_start_times:
        raise PlanError("a certificate needs robots that may all begin at once, without start_times")
    if scenario.has_flows:
        raise PlanError("a certificate needs destinations that let in as many in each step, not doors of a flow")


def check_equal_steps(scenario: Scenario) -> None:
    """Raise PlanError unless every step costs the same, nobody passes a lattice vertex and a plan can be proven."""
    check_certifiable(scenario)
    tessellation = scenario.area.tessellation
    rule = "all steps must cost the same:"
    if tessellation.edge_count < tessellation.direction_count:
        raise PlanError(f"{rule} hexagonal cells or neighbourhood='edge', not {tessellation.name}")
    if scenario.waiting_cost != tessellation.edge_cost:
        raise PlanError(
            f"{rule} waiting_cost must be that of a move, {tessellation.edge_cost}, not {scenario.waiting_cost}"
        )


def make_certificate(
    plan: Plan,
    *,
    n_scheme: NScheme | None = None,
    progress: Callable[[int, int], None] | None = None,
    memory_limit: int | None = None,
) -> Certificate:
    """Find tolls that prove a plan to be the best, whoever made it; docs/optimum.md says why they do.

    Parameters
    ----------
    plan : Plan
        In which all arrive who can, and without conflicts.
    n_scheme : NScheme, optional
        That of its scenario, if it is at hand.
    progress : callable, optional
        Called with (steps looked at, steps of the plan).
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Raises
    ------
    PlanError
        If moves last or doors have a flow, some robot does not arrive, or the plan is not the best, or is but cannot be
        proven, as the flow leaves something out (docs/optimum.md).
    TooLargeError
        If the time-expanded graph would take more than `memory_limit`.

    Examples
    --------
    >>> import trihex as th
    >>> area = th.Area("hexagonal", [[0, 0, 0], [0, 1, 0]])
    >>> scenario = th.Scenario(area, destinations=[(0, 0)], robots=[(2, 0), (2, 1)], destination_capacity=1)
    >>> certificate = th.make_certificate(th.make_plan(scenario, "optimal"))
    >>> certificate.step, certificate.toll
    (array([2]), array([10]))
    """
    check_type("plan", plan, Plan)
    scenario = plan.scenario
    check_certifiable(scenario)
    n_scheme = n_scheme if n_scheme is not None else make_n_scheme(scenario)
    sites = scenario.area.layout.cell_to_site(scenario.robots)
    distance = n_scheme.distance_of_site[sites]
    robots = np.flatnonzero((distance != NOT_REACHED) & (distance != 0))
    late = robots[~plan.arrived[robots]]
    if late.size:
        raise PlanError(f"a certificate needs a plan in which all arrive who can, unlike robot {late[0]}")
    if plan.jumps.size or np.diff(plan.first_action).sum() != np.diff(plan.first_action)[robots].sum():
        raise PlanError("a certificate needs a plan in which nobody jumps, and nobody moves who cannot arrive")
    network = make_network(n_scheme)
    if network.has_equal_steps:
        return _Proof(network, plan, robots, memory_limit).make(progress)
    return _by_fair_prices(FairPricing(network, plan, robots, memory_limit), progress)


def _by_fair_prices(pricing: FairPricing, progress: Callable[[int, int], None] | None) -> Certificate:
    """Return the certificate; raise PlanError if the tolls do not prove the plan."""
    plan, network = pricing.plan, pricing.network
    if not pricing.make(progress):
        raise PlanError(f"a certificate needs the best plan; one of less than {plan.total_time} is possible")
    node, step, toll = pricing.tolls()
    proven = pricing.proven(toll, np.where(node >= network.first_destination, plan.scenario.entry_limit, 1))
    if proven != plan.total_time:
        raise PlanError(f"a certificate needs the best plan: its total is {plan.total_time}, proven is {proven}")
    place = network.site_of_node[node].astype(np.int64)
    columns = []
    for chosen in (~network.is_vertex[node], network.is_vertex[node]):
        order = np.flatnonzero(chosen)[np.lexsort((place[chosen], step[chosen]))]
        columns += [place[order], step[order], toll[order]]
    columns[0] = plan.scenario.area.layout.site_to_cell(columns[0].astype(np.int32)).astype(np.int64)
    return Certificate(plan, *columns)


class _Proof:
    """The words of all nodes under a plan, in which labels and tolls are found."""

    def __init__(self, network: Network, plan: Plan, robots: NDArray[np.int64], memory_limit: int | None) -> None:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import tolls as kernels
        from trihex.optimum.kernels.words import FLOW

        self.network, self.plan, self.robots = network, plan, robots
        sites = plan.scenario.area.layout.cell_to_site(plan.scenario.robots[robots])
        cells = network.node_of_site[sites].astype(np.int64)
        self.last = int(plan.arrival_step_of_robot[robots].max(initial=0))
        need = (self.last + 1) * network.node_count * _BYTES_PER_NODE + plan.actions.size * _BYTES_PER_ACTION
        check_memory(network, cells, self.last + 1, need, limit_or_default(memory_limit))
        self.start, self.graph = start_nodes(network, cells), make_slot_graph(network)
        words = lay_words(network, self.graph, plan, self.start, robots, self.last + 1)
        words &= np.uint32(FLOW)
        self._check_flow(words.reshape(self.last + 1, -1))
        state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        state[kernels.LAST] = self.last
        self.labelling = given(
            kernels.Labelling,
            hops=network.hops,
            capacity=plan.scenario.entry_limit,
            words=words,
            stack=np.empty(_STACK, dtype=np.int64),
            state=state,
        )

    def _check_flow(self, flow: NDArray[np.uint32]) -> None:
        """Raise PlanError where robots share a cell or a slot; else kernels would follow one in place of the other."""
        first, limit = self.network.first_destination, self.plan.scenario.entry_limit
        shared = np.count_nonzero(flow[:, :first]) != self.plan.actions.size
        if shared or (limit and flow[:, first:].max(initial=0) > limit):
            raise PlanError("a certificate needs a plan without conflicts; audit_plan tells which it has")

    def make(self, progress: Callable[[int, int], None] | None) -> Certificate:
        """Return the certificate; raise PlanError if the tolls do not prove the plan."""
        from trihex.optimum.kernels.residual import DONE, LIST_FULL
        from trihex.optimum.kernels.tolls import ARRIVAL, label_nodes

        status = None
        while status != DONE:
            status = label_nodes(self.graph, self.labelling, _BUDGET)
            if status == LIST_FULL:
                stack = self.labelling.stack
                self.labelling = self.labelling._replace(stack=np.concatenate([stack, np.empty_like(stack)]))
            if progress:
                progress(int(self.labelling.state[ARRIVAL]), self.last)
        proven, cell, step, toll = self._tolls()
        steps = int(self.plan.arrival_step_of_robot[self.robots].sum())
        if proven != steps:
            raise PlanError(
                f"a certificate needs the best plan: its robots take {steps} steps together, proven are {proven}"
            )
        order, toll = np.lexsort((cell, step)), toll * self.plan.scenario.waiting_cost
        return Certificate(self.plan, *(read_only(column[order]) for column in (cell, step, toll)))

    def _tolls(self) -> tuple[int, NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Return how many steps the tolls prove, and cell, step and toll of each."""
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import tolls as kernels

        plan, layout = self.plan, self.plan.scenario.area.layout
        out: Any = given(
            kernels.TollsOut,
            first=plan.first_action[self.robots],
            label=np.empty(self.robots.size, dtype=np.int64),
            node=np.zeros(plan.actions.size, dtype=np.int32),
            toll=np.zeros(plan.actions.size, dtype=np.int32),
        )
        kernels.write_tolls(self.graph, self.labelling, self.start, out)
        at = np.flatnonzero(out.toll)
        node, toll = out.node[at].astype(np.int64), out.toll[at].astype(np.int64)
        step = at + 1 - plan.first_action[np.searchsorted(plan.first_action, at, "right") - 1]
        goal, goal_step, goal_toll = self._tolls_of_destinations()
        paid = int(toll.sum()) + int(goal_toll.sum()) * plan.scenario.entry_limit
        cell = layout.site_to_cell(self.network.site_of_node[np.concatenate([node, goal])])
        columns = (cell.astype(np.int64), np.concatenate([step, goal_step]), np.concatenate([toll, goal_toll]))
        return int(out.label.sum()) - paid, *columns

    def _tolls_of_destinations(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Return node, step and toll of the slots whose label is later than their step: they are full."""
        from trihex.optimum.kernels.tolls import WHEN

        words = self.labelling.words.reshape(self.last + 1, -1)[:, self.network.first_destination :].astype(np.int64)
        label = np.where(words < WHEN, self.last, words // WHEN - 1)
        toll = label - np.arange(self.last + 1)[:, None]
        toll[0] = 0  # nobody arrives there then who has to go
        step, goal = np.nonzero(toll > 0)
        return goal + self.network.first_destination, step, toll[step, goal]
