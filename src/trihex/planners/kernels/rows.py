"""Rows of actions: what the robots of a simulation do in a block of steps, one row for each robot."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import IN_I32, IN_I64, OUT_I32, OUT_I64, OUT_U8, declared, kernel

# So many steps nearly every row has; a loop of known length is one instruction.
USUAL = 32
# Rows ahead of which a place in the plan is fetched.
AHEAD = 12


class Rows(NamedTuple):
    """The actions of some robots in a block of steps."""

    robot: OUT_I32  # of each row
    action: OUT_U8  # row after row, `steps` of each
    block: types.int64  # number of the block, from 1
    first_step: types.int64  # how many steps were before the block
    steps: types.int64  # of the block, 32 at most


ROWS = declared(Rows)


@kernel(types.void(ROWS, IN_I32, IN_I64, OUT_U8))
def write_rows(rows, number, first_action, actions):
    """Write rows to where they belong in a plan.

    ``number[robot]`` is the number that a robot has in the plan. Fetching ahead and the loop of known length make it
    three times as fast.
    """
    steps = rows.steps
    count = len(rows.robot)
    for row in range(count):
        ahead = number[rows.robot[np.uint64(min(row + AHEAD, count - 1))]]
        prefetch(actions, first_action[ahead] + rows.first_step)
        robot = number[rows.robot[np.uint64(row)]]
        at = first_action[robot] + rows.first_step
        length = min(steps, first_action[robot + 1] - at)
        if length == USUAL:
            for s in range(USUAL):
                actions[np.uint64(at + s)] = rows.action[np.uint64(row * steps + s)]
        else:
            for s in range(length):
                actions[np.uint64(at + s)] = rows.action[np.uint64(row * steps + s)]


@kernel(types.void(ROWS, IN_I64, IN_I64, OUT_I64))
def add_times(rows, arrival, cost_of_action, time):
    """Add to the time of each robot what its row of actions costs, up to the step in which it arrives (0: not yet)."""
    for row in range(len(rows.robot)):
        robot = rows.robot[row]
        end = arrival[robot] - rows.first_step if arrival[robot] > 0 else rows.steps
        for s in range(min(rows.steps, end)):
            time[robot] += cost_of_action[rows.action[row * rows.steps + s]]
