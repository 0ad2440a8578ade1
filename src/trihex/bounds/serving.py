"""Serving: how soon the robots can arrive at best, if they hinder each other at a few chosen nodes only.

Two robots pass a gate at least ``gap`` ticks apart, so there is at most one in each window of so many ticks, wherever
the windows begin. They begin where it pays: those of a gate from which it takes t ticks to a destination are t ticks
before windows of arrivals, so that whoever is led from gate to gate on a shortest way stays in one window.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

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
    shift: int = 0,
) -> tuple[NDArray[np.int64], int]:
    """Return (the ticks in which robots arrive, ascending; the last one looked at): the most that can arrive that soon.

    Robots without a gate on their way are among them. All are served if `horizon` and `most_looks` allow. The windows
    of arrivals begin `shift` ticks before the start: whatever it is, the i-th robot to arrive arrives no sooner.
    """
    from trihex.bounds.kernels import serving as kernels

    gates = _gates_of(demand, network, horizon + shift, shift)
    slots = _make_slots(network, gates.width, demand.sites.size)
    search, state = _make_search(network, gates.width), np.zeros(6, dtype=np.int64)
    if demand.scenario.has_flows and demand.scenario.is_stepwise:
        _shut_doors(demand, network, gates.width, search.seen)
    state[kernels.STEP], looks = -1, 0
    while state[kernels.SERVED] < gates.robots and state[kernels.STEP] < gates.horizon and looks < most_looks:
        kernels.serve_robots(gates, slots, search, state, min(_BUDGET, most_looks - looks))
        looks = int(state[kernels.LOOKS])
        if progress is not None:
            progress(int(state[kernels.SERVED]), gates.robots)
    arrival = slots.arrival[: state[kernels.SERVED]].astype(np.int64) - shift
    return np.sort(np.concatenate([arrival, network.free_steps])), int(state[kernels.STEP]) - shift


def _ticks_from_gates(network: GateNetwork) -> NDArray[np.int64]:
    """Return how many ticks it takes at least from being in each gate to arriving, through whichever gates."""
    ticks = np.where(network.steps_out < 0, 2**30, network.steps_out).astype(np.int64)
    to = np.repeat(np.arange(ticks.size), np.diff(network.first_arc))
    before = np.empty(0, dtype=np.int64)
    while not np.array_equal(before, ticks):
        before = ticks.copy()
        np.minimum.at(ticks, network.arc_gate, before[to] + network.arc_steps)
    return ticks


def _gates_of(demand: Demand, network: GateNetwork, horizon: int, shift: int) -> Gates:
    """Return the network for kernels."""
    from trihex.bounds.kernels.serving import Gates
    from trihex.kernels.signatures import given

    # Where all windows are steps it makes no difference when they begin.
    ticks = _ticks_from_gates(network) * (not demand.scenario.is_stepwise)
    every = np.arange(ticks.size)
    to, robot_to = (np.repeat(every, np.diff(first)) for first in (network.first_arc, network.first_robot))
    gates: Gates = given(
        Gates,
        gap=network.gap,
        steps_out=np.where(network.steps_out < 0, -1, network.steps_out - ticks).astype(np.int32),
        first_arc=network.first_arc,
        arc_gate=network.arc_gate,
        arc_steps=(network.arc_steps + ticks[to] - ticks[network.arc_gate]).astype(np.int32),
        first_robot=network.first_robot,
        robot=network.robot,
        robot_window=((network.robot_steps + ticks[robot_to] + shift) // network.gap[robot_to]).astype(np.int32),
        robots=network.robot_count,
        width=(horizon + int(network.gap.max(initial=1))) // int(network.gap.min(initial=2**30)) + 1,
        horizon=horizon,
    )
    return gates


def _shut_doors(demand: Demand, network: GateNetwork, width: int, seen: NDArray[np.int32]) -> None:
    """Let searches pass by the slots of doors in steps in which these let nobody in.

    Not where a robot starts: it passes its door without coming in.
    """
    from trihex.bounds.kernels.serving import DEAD

    schedule, layout = demand.scenario.schedule, demand.scenario.area.layout
    door_of_site = np.full(layout.size, -1, dtype=np.int64)
    door_of_site[layout.cell_to_site(schedule.cells)] = np.arange(schedule.cells.size)
    door_of_site[demand.sites] = -1
    gates = np.flatnonzero((network.site >= 0) & (door_of_site[network.site] >= 0))
    steps = np.arange(1, width)
    openings = schedule.openings_at(door_of_site[network.site[gates]], steps[:, None])
    step, gate = np.nonzero(openings <= network.copy[gates])
    slots = gates[gate] * width + steps[step]
    seen[slots] = seen[slots + seen.size // 2] = DEAD


def _make_slots(network: GateNetwork, width: int, robots: int) -> GateSlots:
    """Return slots that nobody passes yet."""
    from trihex.bounds.kernels.serving import GateSlots

    count = network.steps_out.size * width
    return GateSlots(
        is_used=np.zeros(count, dtype=bool),
        onward=np.full(count, -1, dtype=np.int32),
        first_slot=np.full(robots, -1, dtype=np.int32),
        next_unserved=network.first_robot[:-1].copy(),
        arrival=np.empty(robots, dtype=np.int32),
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
