"""Rows of actions: what the robots of a simulation do in a block of steps, one row for each robot."""

import numpy as np
from numba import njit, types

from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, OUT_I64, OUT_U8

# So many steps nearly every row has; a loop of known length is one instruction.
USUAL = 32
# Rows ahead of which a place in the plan is fetched.
AHEAD = 12


@njit(types.void(IN_I32, IN_I32, IN_U8, types.int64, types.int64, IN_I64, OUT_U8), cache=True, nogil=True)
def write_rows(number, robot_of_row, action_of_row, steps, first_step, first_action, actions):
    """Write rows of `steps` actions, the first of step `first_step` (from 0), to where they belong in a plan.

    ``number[robot]`` is the number that a robot has in the plan. Fetching ahead and the loop of known length make it
    three times as fast.
    """
    rows = len(robot_of_row)
    for row in range(rows):
        ahead = number[robot_of_row[np.uint64(min(row + AHEAD, rows - 1))]]
        prefetch(actions, first_action[ahead] + first_step)
        robot = number[robot_of_row[np.uint64(row)]]
        at = first_action[robot] + first_step
        count = min(steps, first_action[robot + 1] - at)
        if count == USUAL:
            for s in range(USUAL):
                actions[np.uint64(at + s)] = action_of_row[np.uint64(row * steps + s)]
        else:
            for s in range(count):
                actions[np.uint64(at + s)] = action_of_row[np.uint64(row * steps + s)]


@njit(types.void(IN_I32, IN_U8, types.int64, types.int64, IN_I64, IN_I64, OUT_I64), cache=True, nogil=True)
def add_times(robot_of_row, action_of_row, steps, first_step, arrival, cost_of_action, time):
    """Add to the time of each robot what its row of actions costs, up to the step in which it arrives (0: not yet)."""
    for row in range(len(robot_of_row)):
        robot = robot_of_row[row]
        end = arrival[robot] - first_step if arrival[robot] > 0 else steps
        for s in range(min(steps, end)):
            time[robot] += cost_of_action[action_of_row[row * steps + s]]
