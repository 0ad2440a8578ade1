"""Planner `optimal`: the least sum of times, proven."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError, check_choice
from trihex.plan import Plan
from trihex.planners.earliest import make_earliest_flow
from trihex.planners.fcost import plan_fcost
from trihex.planners.flow import Flow, make_flow_by_levels, make_flow_singly
from trihex.planners.greedy import plan_greedy
from trihex.planners.network import OBJECTIVES, Network, make_network
from trihex.schemes import NOT_REACHED, NScheme


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
        move and robots had to wait in place of an exchange of cells.

    Raises
    ------
    PlanError
        If there is no such objective.
    TooLargeError
        If the time-expanded graph would take more than `memory_limit`.
    """
    check_choice("objective", objective, OBJECTIVES, PlanError)
    scenario = n_scheme.scenario
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
    return _make_plan(flow, going[order], proves=objective == "time")


def _find_flow(
    n_scheme: NScheme, network: Network, cells: NDArray[np.int64], robots: NDArray[np.int64], **options: Any
) -> Flow:
    """Find the flow of least cost by the way that is quickest as robots crowd or not."""
    flow = make_flow_singly(network, cells, **options)
    if flow is not None:
        return flow
    if network.has_equal_steps:
        return make_earliest_flow(network, cells, robots, plan_fcost(n_scheme), **options)
    return make_flow_by_levels(network, cells, **options)


def _make_plan(flow: Flow, robots: NDArray[np.int64], proves: bool) -> Plan:
    """Let the robots follow the flow."""
    from trihex.kernels import flow_paths as kernels

    network = flow.network
    scenario = network.scenario
    layout = scenario.area.layout
    arrival = np.zeros(robots.size, dtype=np.int64)
    shape = network.cell_count, network.first_destination, network.out_arcs
    while kernels.part_exchanges(flow.start_of_robot, *shape, flow.flow, arrival):
        pass
    length = np.zeros(scenario.robot_count, dtype=np.int64)
    length[robots] = arrival
    first_action = np.concatenate([[0], np.cumsum(length)])
    actions = np.empty(first_action[-1], dtype=np.uint8)
    kernels.write_actions(
        flow.start_of_robot,
        *shape,
        flow.flow,
        network.site_of_node,
        layout.offset_of_direction,
        first_action[robots],
        actions,
    )
    plan = Plan(scenario, actions, first_action, planner="optimal")
    return replace(plan, optimal=proves and plan.total_time == flow.total)
