"""Starts: what is wrong with where and when the robots of a plan start."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.judging.conflict import AIMS_AT_BARRIER, SHARES_CELL, STARTS_EARLY, STARTS_ON_BARRIER
from trihex.kernels.codes import WAIT
from trihex.plans import Plan


def conflicts_of_starts(scenario: Scenario) -> NDArray[np.int32]:
    """Return conflicts at step 0 as rows: code, step, two robots, four sites; -1 for none.

    Where several robots start in one cell, each is charged with the one of the smallest number.
    """
    area, robots = scenario.area, scenario.robots
    blocked = np.flatnonzero(area.is_barrier(robots))
    aims = scenario.destinations[area.is_barrier(scenario.destinations)]
    _, first, group = np.unique(robots, return_index=True, return_inverse=True)
    other = first[group]
    late = np.flatnonzero(other != np.arange(robots.size))
    rows = np.full((aims.size + blocked.size + late.size, 8), -1, dtype=np.int32)
    rows[:, 1] = 0
    at_aim, at_start, at_share = np.split(rows, [aims.size, aims.size + blocked.size])
    at_aim[:, 0], at_aim[:, 4] = AIMS_AT_BARRIER, area.layout.cell_to_site(aims)
    at_start[:, 0], at_start[:, 2] = STARTS_ON_BARRIER, blocked
    at_start[:, 4] = area.layout.cell_to_site(robots[blocked])
    at_share[:, 0], at_share[:, 2], at_share[:, 3] = SHARES_CELL, other[late], late
    at_share[:, 4] = area.layout.cell_to_site(robots[late])
    return rows


def conflicts_of_start_times(plan: Plan) -> NDArray[np.int32]:
    """Return who moves before its start time, as rows like those of `conflicts_of_starts`: its first move alone.

    Until then a robot only waits, which takes one step (tick) whatever the clock.
    """
    scenario = plan.scenario
    if not scenario.has_start_times:
        return np.empty((0, 8), dtype=np.int32)
    moves = np.append(np.flatnonzero(plan.actions != WAIT), plan.actions.size)
    begin, end = plan.first_action[:-1], plan.first_action[1:]
    first = moves[np.searchsorted(moves, begin)]
    is_there = np.isin(scenario.robots, scenario.destinations)  # whatever they do is wrong, which is told elsewhere
    early = np.flatnonzero((first < end) & (first - begin < scenario.start_times) & ~is_there)
    rows = np.full((early.size, 8), -1, dtype=np.int32)
    rows[:, 0], rows[:, 1], rows[:, 2] = STARTS_EARLY, (first - begin)[early] + 1, early
    rows[:, 4] = scenario.area.layout.cell_to_site(scenario.robots[early])
    return rows
