"""Mending: cheaper ways through short windows of a plan, past what all others do."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import TooLargeError
from trihex.fields import NScheme
from trihex.memory import GIB, available_memory
from trihex.planners.crowd import make_ways
from trihex.planners.frame import make_frame
from trihex.planners.recording import Progress
from trihex.plans import Plan

# How many steps robots look ahead, after how many. (8 and 4, 8 and 2, 12 and 4, 16 and 4 steps: docs/laboratory.)
_AHEAD, _EVERY = 10, 3
# Nodes of a search, as many as are ever needed; who would need more keeps its way.
_NODES = 1 << 12
# Robot-steps between two looks at the keyboard: a few hundredths of a second.
_BUDGET = 200_000
# Costs are sums of 32 bits.
_MOST_COST = 1 << 25


def may_mend(scenario: Scenario) -> bool:
    """Tell whether windows know all rules of a scenario."""
    return scenario.moves_by_steps and scenario.waiting_cost <= _MOST_COST


def mend(plan: Plan, n_scheme: NScheme, rounds: int, progress: Progress | None = None) -> Plan:
    """Return a plan in which no robot arrives later or pays more, and some pay less or arrive earlier.

    Every few steps each robot looks some steps ahead. If what it does there costs more than it need cost were nobody in
    its way, it looks for the cheapest way of as many steps to where it will be then, past the ways of all others; near
    its end, to a destination in no more steps. In all rounds but the last a robot that will lose something yet takes
    ways, too, that cost as much and go later: what it hurries for and what it waits for come together round by round.

    Parameters
    ----------
    plan : Plan
        By a planner, of a scenario that `may_mend` tells of.
    n_scheme : NScheme
        The N-scheme of its scenario.
    rounds : int
        At most; when a round saves nothing, it was the last.
    progress : callable, optional
        Called with (robots that have arrived, robots that arrive) of one round after the other.
    """
    if plan.actions.size == 0:
        return plan
    actions, length, time = plan.actions.copy(), np.diff(plan.first_action), plan.time_of_robot.copy()
    nouns = _make_nouns(n_scheme)
    for done in range(rounds):
        before = time.sum()
        _run_round(nouns, plan, done < rounds - 1, (actions, length, time), progress)
        if time.sum() == before:
            break
    firsts = plan.first_action[:-1].tolist()
    kept = [actions[first : first + own] for first, own in zip(firsts, length.tolist(), strict=True)]
    return replace(plan, actions=np.concatenate(kept), first_action=np.append(0, np.cumsum(length)))


def _make_nouns(n_scheme: NScheme) -> tuple[Any, ...]:
    """Return frame, ground, ways, what is taken and nodes as kernels know them."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels.taken import BITS, Taken
    from trihex.planners.kernels.windows import Ground, Nodes

    scenario = n_scheme.scenario
    tessellation, size = scenario.area.tessellation, scenario.area.layout.size << BITS
    if size > available_memory():
        raise TooLargeError(f"to look ahead would take {size / GIB:.1f} GiB, more than is free; choose rounds=0")
    shape = (tessellation.name, tessellation.neighbourhood, tessellation.costs)
    frame = make_frame(*shape, scenario.waiting_cost, _AHEAD)
    ground = given(
        Ground,
        distance=n_scheme.distance_of_site,
        moves=scenario.moves,
        most_cost=tessellation.cost_of_direction.max(),
    )
    lists = ("site", "place", "cost", "level", "parent", "now", "later")
    nodes = given(
        Nodes,
        **{name: np.empty(_NODES, dtype=np.int32) for name in lists},
        action=np.empty(_NODES, dtype=np.uint8),
        node_of_place=np.zeros((_AHEAD + 1) << frame.bits, dtype=np.int32),
    )
    return frame, ground, make_ways(scenario), given(Taken, byte=np.zeros(size, dtype=np.uint8)), nodes


def _run_round(
    nouns: tuple[Any, ...],
    plan: Plan,
    is_lazy: bool,
    ways: tuple[NDArray[np.uint8], NDArray[np.int64], NDArray[np.int64]],
    progress: Progress | None,
) -> None:
    """Let all robots look ahead, step by step; `ways`: their actions, how many each has, and what they cost."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels import mending as kernels

    actions, length, time = ways
    start = plan.scenario.area.layout.cell_to_site(plan.scenario.robots)
    listed = np.flatnonzero(length).astype(np.int32)
    listed = listed[np.argsort(start[listed])]  # neighbours look at the same cells
    troop = given(
        kernels.Troop,
        action=actions,
        first=plan.first_action,
        length=length,
        time=time,
        paid=np.zeros_like(time),
        site=start.copy(),
        ahead=start.copy(),
        listed=listed,
    )
    pace = given(kernels.Pace, ahead=_AHEAD, every=_EVERY, is_lazy=is_lazy)
    left, step = listed.size, 1 - _AHEAD
    while left:
        end = step + max(1, _BUDGET // left)
        left, step = int(kernels.mend(step, end, left, pace, *nouns, troop)), end
        if progress is not None:
            progress(listed.size - left, listed.size)
