"""Columns: what each robot did in each step, of a plan or of a run, as the columns of a table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Tessellation
from trihex.kernels.codes import JUMP, LATE, UNDERWAY, WAIT
from trihex.plans import Motion, Plan, rows_of_actions, rows_of_motion

Ints = NDArray[np.int64]


def words_of_actions(tessellation: Tessellation) -> list[str]:
    """Return the words of the column `action`; a table holds their indexes."""
    north, south = tessellation.direction_names
    return [*north, *south, "start", "wait", "jump"]


class Columns(NamedTuple):
    """A row for each robot and step, or action of a plan, robot by robot, in the order of `PLAN_HEADER`."""

    robot: Ints
    step: Ints
    x: Ints
    y: Ints
    word: Ints  # place in `words`
    time: Ints
    words: list[str]


def columns_of(motion: Motion) -> Columns:
    """Return the rows of a plan or of a run.

    Robots of a plan have rows up to their last action, those of a run up to the last step in which they are there.
    """
    area, tessellation = motion.scenario.area, motion.scenario.area.tessellation
    first_row, step, cell = rows_of_actions(motion) if isinstance(motion, Plan) else rows_of_motion(motion)
    length, first = np.diff(first_row), first_row[:-1]
    robot = np.repeat(np.arange(length.size), length)
    action = np.full(cell.size, WAIT, dtype=np.uint8)
    if isinstance(motion, Plan):
        is_action = np.ones(cell.size, dtype=bool)
        is_action[first] = False
        action[is_action] = motion.actions
    else:
        for number, ending in enumerate(_actions_that_end(motion), 1):
            there = (motion.joined < number) & (motion.joined + length > number)
            action[(first - motion.joined)[there] + number] = ending[there]
        has_ended = action != UNDERWAY
        robot, step, cell, action = (column[has_ended] for column in (robot, step, cell, action))
        first = np.searchsorted(robot, np.arange(length.size))
    words = words_of_actions(tessellation) + ["late"] * (not isinstance(motion, Plan))
    start, wait, jump, late = (count + len(words_of_actions(tessellation)) for count in (-3, -2, -1, 0))
    word_of_action = np.arange(WAIT + 1)
    word_of_action[[WAIT, JUMP, LATE]] = wait, jump, late
    cost_of_action = np.zeros(WAIT + 1, dtype=np.int64)
    cost_of_action[: tessellation.direction_count] = tessellation.cost_of_direction
    cost_of_action[[WAIT, LATE]] = motion.scenario.waiting_cost
    word, cost = word_of_action[action], cost_of_action[action]
    if motion.scenario.has_slowness:
        cost *= np.where(action < JUMP, motion.scenario.slowness[robot], 1)
    orientation = tessellation.orientation_of_cell(*area.cell_to_xy(np.append(cell[:1], cell[:-1])))
    is_move = word < tessellation.direction_count
    word[is_move] += orientation[is_move] * tessellation.direction_count
    word[first], cost[first] = start, 0
    total = np.cumsum(cost)
    x, y = area.cell_to_xy(cell)
    return Columns(robot, step, x, y, word, total - total[first][robot], words)


def _actions_that_end(motion: Motion) -> Iterator[NDArray[np.uint8]]:
    """Yield for step 1, 2, ... the action of each robot that ends in it, `UNDERWAY` where a move goes on."""
    duration = motion.scenario.duration_of_direction
    heading, due = np.full(motion.joined.size, WAIT, dtype=np.uint8), np.zeros(motion.joined.size, dtype=np.int64)
    for step in range(1, motion.steps + 1):
        action = motion.actions_in(step).copy()
        begins = np.flatnonzero(action < UNDERWAY)
        heading[begins], due[begins] = action[begins], step - 1 + duration[action[begins]]
        np.copyto(action, UNDERWAY, where=due > step)
        np.copyto(action, heading, where=due == step)
        yield action
