"""Walk: the cells through which the robots of a plan go."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from trihex.plans.motion import Motion, rows_of_motion
from trihex.plans.plan import Plan, actions_of

# Actions that kernels look at in one call, some 10 ms: Ctrl-C works in between.
_BUDGET = 10_000_000


def follow(plan: Plan, step: int, next_step: int, site: NDArray[np.int32]) -> None:
    """Move `site` of all robots from one step to another; robots without further actions stay."""
    from trihex.plans.kernels import replay as kernels

    actions, some = actions_of(plan), max(1, _BUDGET // (next_step - step))
    for first in range(0, site.size, some):
        kernels.follow(actions, first, min(site.size, first + some), step, next_step, site)


def visits_of(plan: Motion) -> NDArray[np.int64]:
    """Return how many robots start in or enter each cell, shape (height, width)."""
    from trihex.plans.kernels import replay as kernels

    if not isinstance(plan, Plan):
        return _visits_of_rows(plan)
    layout = plan.scenario.area.layout
    visits = np.zeros(layout.size, dtype=np.int64)
    start, actions = layout.cell_to_site(plan.scenario.robots), actions_of(plan)
    for robot, last in blocks_of(plan):
        kernels.count_visits(start, actions, robot, last, visits)
    return layout.cells_of(visits)  # type: ignore[return-value]


def _visits_of_rows(motion: Motion) -> NDArray[np.int64]:
    first_row, _, cell = rows_of_motion(motion)
    enters = np.append(True, cell[1:] != cell[:-1])[: cell.size]
    enters[first_row[:-1]] = True
    area = motion.scenario.area
    return np.bincount(cell[enters], minlength=area.cell_count).reshape(area.height, area.width)


def count_marked_moves(plan: Plan, marked: NDArray[np.uint16]) -> int:
    """Return how many moves of a plan are marked: bit k of each site, as in `Scenario.moves`, for direction k."""
    from trihex.plans.kernels import replay as kernels

    start, actions = plan.scenario.area.layout.cell_to_site(plan.scenario.robots), actions_of(plan)
    return sum(int(kernels.count_marked(start, actions, robot, last, marked)) for robot, last in blocks_of(plan))


def blocks_of(plan: Plan) -> Iterator[tuple[int, int]]:
    """Yield robots from, and up to, that have about so many actions together as one call of a kernel takes."""
    first, robot, robots = plan.first_action, 0, plan.scenario.robot_count
    while robot < robots:
        last = max(robot + 1, int(np.searchsorted(first, first[robot] + _BUDGET)) - 1)
        last = min(robots, last, robot + 1_000_000)
        yield robot, last
        robot = last


def cells_of_rows(plan: Plan, first_row: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the cell number of each robot at each step, robot by robot; robot r from row ``first_row[r]`` on."""
    cells = np.empty(first_row[-1], dtype=np.int64)
    length = np.diff(first_row) - 1
    for step, cell_of_robot in enumerate(plan.cells_by_step()):
        acts = length >= step
        cells[first_row[:-1][acts] + step] = cell_of_robot[acts]
    cells[first_row[1:] - 1] = plan.last_cell_of_robot  # cells_by_step has -1 for those that have arrived
    return cells
