"""Rows: where robots were, a row for each of their steps or actions, robot by robot."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from trihex.plans.motion import Ints, Motion
from trihex.plans.plan import Plan, actions_of

# Actions that kernels look at in one call, some 10 ms: Ctrl-C works in between.
BUDGET = 10_000_000


def rows_of_motion(motion: Motion) -> tuple[Ints, Ints, Ints]:
    """Return one row for each robot and each step in which it was there, robot by robot.

    Where moves last several steps (ticks) there is one where the robot starts, where each action ends and, if it stays
    to the end, at the last step.

    Returns
    -------
    first_row : int64 array, shape (robots + 1,)
        Robot r has the rows ``first_row[r]`` to ``first_row[r + 1] - 1``.
    step, cell : int64 arrays, shape (rows,)
        The cell after each step; the last one of a robot that arrives is its destination.
    """
    if not isinstance(motion, Plan):
        return _rows_of_steps(motion)
    length = np.diff(motion.first_action) + 1
    if motion.has_steps:
        length = np.where(motion.arrived, length, motion.steps + 1)
    else:
        length += ~motion.arrived & (motion.last_step_of_robot < motion.steps)
    first_row = np.concatenate([[0], np.cumsum(length)])
    return first_row, _steps_of_rows(motion, first_row), cells_of_rows(motion, first_row)


def rows_of_actions(plan: Plan) -> tuple[Ints, Ints, Ints]:
    """Return one row for the start and for each action of each robot, as `rows_of_motion` does."""
    first_row = plan.first_action + np.arange(plan.first_action.size)
    return first_row, _steps_of_rows(plan, first_row), cells_of_rows(plan, first_row)


def _steps_of_rows(plan: Plan, first_row: Ints) -> Ints:
    """Return the step (tick) of each row; in those beyond the last action of a robot time goes on to the end."""
    length = np.diff(first_row)
    number = np.arange(first_row[-1]) - np.repeat(first_row[:-1], length)
    if plan.has_steps:
        return np.asarray(number)
    is_action = (number > 0) & (number <= np.repeat(np.diff(plan.first_action), length))
    step = np.where(number > 0, plan.steps, 0)
    step[is_action] = steps_of_actions(plan)
    return np.asarray(step)


def _rows_of_steps(motion: Motion) -> tuple[Ints, Ints, Ints]:
    length = motion.last_seen_of_robot - motion.joined + 1
    first_row = np.concatenate([[0], np.cumsum(length)])
    first, joined = first_row[:-1], motion.joined
    step = np.arange(first_row[-1]) - np.repeat(first - joined, length)
    cell = np.empty(first_row[-1], dtype=np.int64)
    for number, here in enumerate(motion.cells_by_step()):
        there = (joined <= number) & (motion.last_seen_of_robot >= number)
        cell[(first - joined)[there] + number] = here[there]
    cell[first_row[1:] - 1] = motion.last_cell_of_robot  # cells_by_step has -1 for those that have gone
    return first_row, step, cell


def cells_of_rows(plan: Plan, first_row: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the cell number of each robot at its start and after each action, robot by robot.

    Robot r has the rows from ``first_row[r]`` on, at least one more than actions; in those beyond it stays.
    """
    from trihex.plans.kernels.rows import fill_rows

    layout = plan.scenario.area.layout
    start, site = layout.cell_to_site(plan.scenario.robots), np.empty(first_row[-1], dtype=np.int32)
    for robot, last in blocks_of(plan):
        fill_rows(start, actions_of(plan), robot, last, first_row, site)
    return layout.site_to_cell(site)


def steps_of_actions(plan: Plan, robot: int = 0, last: int | None = None) -> NDArray[np.int64]:
    """Return the step (tick) in which each action of a plan, or of some of its robots, ends, shape (actions,)."""
    first = plan.first_action[robot : None if last is None else last + 1]
    action = plan.actions[first[0] : first[-1]]
    lasts: NDArray[np.signedinteger] = plan.duration_of_action[action]
    if plan.scenario.has_slowness:
        lasts = plan.durations(action, np.repeat(plan.scenario.slowness[robot:last], np.diff(first)))
    end = np.cumsum(lasts, dtype=np.int64)
    return np.asarray(end - np.repeat(np.append(0, end)[first[:-1] - first[0]], np.diff(first)))


def blocks_of(plan: Plan) -> Iterator[tuple[int, int]]:
    """Yield robots from, and up to, that have about so many actions together as one call of a kernel takes."""
    first, robot, robots = plan.first_action, 0, plan.scenario.robot_count
    while robot < robots:
        last = max(robot + 1, int(np.searchsorted(first, first[robot] + BUDGET)) - 1)
        last = min(robots, last, robot + 1_000_000)
        yield robot, last
        robot = last
