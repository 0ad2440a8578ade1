"""Serving: how soon the robots can arrive at best, if they hinder each other at a few chosen nodes only."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from trihex.bounds.demand import Demand
from trihex.bounds.gates import GateNetwork

if TYPE_CHECKING:
    from trihex.bounds.kernels.serving import Gates, GateSearch, GateSlots

_BUDGET = 10_000_000


def least_arrivals(
    demand: Demand,
    network: GateNetwork,
    horizon: int,
    most_looks: int,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[int, int, int]:
    """Return (steps of all robots served, number of them, last step looked at): the most that can arrive that soon.

    Robots without a gate on their way are among them. All are served if `horizon` and `most_looks` allow.
    """
    from trihex.bounds.kernels import serving as kernels

    gates = _gates_of(network, horizon + 1)
    slots = _make_slots(network, gates.width, demand.sites.size)
    search, state = _make_search(network, gates.width), np.zeros(7, dtype=np.int64)
    while state[kernels.SERVED] < gates.robots and state[kernels.STEP] < horizon and state[kernels.LOOKS] < most_looks:
        budget = min(_BUDGET, most_looks - int(state[kernels.LOOKS]))
        kernels.serve_robots(gates, slots, search, state, budget)
        if progress is not None:
            progress(int(state[kernels.SERVED]), gates.robots)
    served, total = int(state[kernels.SERVED]), int(state[kernels.TOTAL])
    return total + int(network.free_steps.sum()), served + network.free_steps.size, int(state[kernels.STEP])


def _gates_of(network: GateNetwork, width: int) -> Gates:
    """Return the network for kernels."""
    from trihex.bounds.kernels.serving import Gates
    from trihex.kernels.signatures import given

    gates: Gates = given(
        Gates,
        steps_out=network.steps_out,
        first_arc=network.first_arc,
        arc_gate=network.arc_gate,
        arc_steps=network.arc_steps,
        first_robot=network.first_robot,
        robot=network.robot,
        robot_steps=network.robot_steps,
        robots=network.robot_count,
        width=width,
    )
    return gates


def _make_slots(network: GateNetwork, width: int, robots: int) -> GateSlots:
    """Return slots that nobody passes yet."""
    from trihex.bounds.kernels.serving import GateSlots

    count = network.steps_out.size * width
    return GateSlots(
        is_used=np.zeros(count, dtype=bool),
        onward=np.full(count, -1, dtype=np.int32),
        first_slot=np.full(robots, -1, dtype=np.int32),
        next_unserved=network.first_robot[:-1].copy(),
    )


def _make_search(network: GateNetwork, width: int) -> GateSearch:
    """Return room for searches, none of which has been made yet."""
    from trihex.bounds.kernels.serving import GateSearch

    gates = network.steps_out.size
    halves = 2 * gates * width
    half, parent, changed, stack = np.empty((4, halves), dtype=np.int32)
    reach, dead_reach = np.full((2, gates), -1, dtype=np.int32)
    next_robot, dead_robot = (network.first_robot[:-1].copy() for _ in range(2))
    return GateSearch(
        seen=np.zeros(halves, dtype=np.int32),
        half=half,
        parent=parent,
        changed=changed,
        stack=stack,
        reach=reach,
        next_robot=next_robot,
        dead_reach=dead_reach,
        dead_robot=dead_robot,
    )
