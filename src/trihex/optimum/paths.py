"""Paths: what each robot does if it goes with the flow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trihex.optimum.flow import Flow
from trihex.plans import Plan


def make_plan_of_flow(flow: Flow, robots: NDArray[np.int64], proves: bool) -> Plan:
    """Let the robots follow the flow."""
    from trihex.optimum.kernels import paths as kernels

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
