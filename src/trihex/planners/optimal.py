"""Planner `optimal`: the least sum of times, proven."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, check_as_fast
from trihex.errors import PlanError, check_choice
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.preparing import prepare
from trihex.optimum import (
    OBJECTIVES,
    Flow,
    Network,
    make_earliest_flow,
    make_flow_at_prices,
    make_flow_singly,
    make_network,
    make_plan_of_flow,
)
from trihex.planners.fcost import plan_fcost
from trihex.planners.greedy import plan_greedy
from trihex.plans import Plan


def plan_optimal(
    n_scheme: NScheme,
    *,
    progress: Callable[[int, int], None] | None = None,
    objective: str = "time",
    memory_limit: int | None = None,
) -> Plan:
    """Plan with the least sum of t_r, or the fewest steps, proven by a flow in the time-expanded graph.

    Robots that share a goal are interchangeable, so a plan is an integral flow: one robot for each cell and step, and
    for each lattice vertex and step where crossing is forbidden. The flow of least cost is found by successive
    shortest paths (docs/optimum.md); the robots then follow it, and two that would exchange cells both wait instead.

    Parameters
    ----------
    n_scheme : NScheme
    progress : callable, optional
        Called with (robots served, robots that can arrive).
    objective : {"time", "steps"}
        "time": the least sum of t_r; "steps": the least sum of arrival steps, which also has the earliest last arrival.
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Returns
    -------
    Plan
        `optimal` is True if its sum of t_r is proven to be the least: under "time", unless waiting costs more than a
        move and robots had to wait in place of an exchange of cells; then it is the cheaper one of that plan and
        that of `fcost`.

    Raises
    ------
    PlanError
        If there is no such objective, or the rules are no pure flow: moves of different durations (clock "costs" on
        triangles with 12 neighbours and squares with 8), or following "forbid".
    TooLargeError
        If the time-expanded graph would take more than `memory_limit`.
    """
    check_choice("objective", objective, OBJECTIVES, PlanError)
    scenario = n_scheme.scenario
    check_is_flow(scenario)
    if objective == "time" and scenario.waiting_cost == 0:
        # Nobody needs a detour where waiting is free: greedy descent pays the distances, which no plan can beat. (The
        # flow would see the same, but among endlessly many layers of equal cost.)
        return replace(plan_greedy(n_scheme, progress=progress), planner="optimal", optimal=True)
    sites = scenario.area.layout.cell_to_site(scenario.robots)
    distance = n_scheme.distance_of_site[sites]
    going = np.flatnonzero((distance != NOT_REACHED) & (distance != 0))
    network = make_network(n_scheme, objective)
    cells = network.node_of_site[sites[going]].astype(np.int64)
    order = np.argsort(network.value[cells], kind="stable")
    flow = _find_flow(n_scheme, network, cells[order], going[order], progress=progress, memory_limit=memory_limit)
    plan = make_plan_of_flow(flow, going[order], proves=objective == "time")
    if objective == "steps" or plan.optimal:
        return plan
    least = flow.total + scenario.waiting_cost * int(scenario.start_times[going].sum())
    return _cheaper(plan, plan_fcost(n_scheme), least)


def _cheaper(plan: Plan, other: Plan, least: int) -> Plan:
    """Return the plan of less total time; where robots had to wait in place of exchanging cells `fcost` may be that."""
    best = min(plan, other, key=lambda one: one.total_time)
    return replace(best, planner="optimal", optimal=best.total_time == least)


def check_is_flow(scenario: Scenario) -> None:
    """Raise PlanError where it is more than the flow through a node of each step that robots must not do."""
    check_as_fast(scenario, "planner 'optimal'")
    if scenario.is_stepwise:
        return
    rule = "following='allow', not 'forbid'"
    if scenario.following == "allow":
        *some, last = map(str, np.unique(scenario.duration_of_direction))
        rule = f"moves that last equally long, not {', '.join(some)} and {last} ticks as by clock='costs' here"
    raise PlanError(
        f"planner 'optimal' needs {rule}, which is no pure flow; the lower bound in the report of another planner "
        "tells how far its plan is from the optimum at most"
    )


def _find_flow(
    n_scheme: NScheme, network: Network, cells: NDArray[np.int64], robots: NDArray[np.int64], **options: Any
) -> Flow:
    """Find the flow of least cost by the way that is quickest as robots crowd or not."""
    flow = make_flow_singly(network, cells, **options)
    if flow is not None:
        return flow
    prepare("optimal_earliest" if network.has_equal_steps else "optimal_crowd")
    if network.has_equal_steps:
        return make_earliest_flow(network, cells, robots, plan_fcost(n_scheme, rounds=0), **options)
    return make_flow_at_prices(network, cells, **options)
