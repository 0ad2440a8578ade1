"""Starts: what is wrong with a plan before its first step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.judging.conflict import AIMS_AT_BARRIER, SHARES_CELL, STARTS_ON_BARRIER


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
