"""Paths: what each robot does if it goes with the flow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trihex.kernels.codes import WAIT
from trihex.optimum.flow import Flow
from trihex.plans import Plan


def make_plan_of_flow(flow: Flow, robots: NDArray[np.int64], proves: bool) -> Plan:
    """Let the robots follow the flow."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import paths as kernels

    network = flow.network
    scenario = network.scenario
    paths = given(
        kernels.FlowPaths,
        start=flow.start_of_robot,
        flow=flow.flow,
        out=network.out_arcs,
        cell_count=network.cell_count,
        first_goal=network.first_destination,
    )
    arrival = np.zeros(robots.size, dtype=np.int64)
    while kernels.part_exchanges(paths, arrival):
        pass
    length = np.zeros(scenario.robot_count, dtype=np.int64)
    length[robots] = arrival
    first_action = np.concatenate([[0], np.cumsum(length)])
    actions = np.full(first_action[-1], WAIT, dtype=np.uint8)
    start_times = scenario.start_times[robots]
    out = given(
        kernels.ActionsOut,
        first=first_action[robots] + start_times,
        action=actions,
        site_of_node=network.site_of_node,
        offset=scenario.area.layout.offset_of_direction,
    )
    kernels.write_actions(paths, out)
    plan = Plan(scenario, actions, first_action, planner="optimal")
    least = flow.total + scenario.waiting_cost * int(start_times.sum())
    return replace(plan, optimal=proves and plan.total_time == least)
