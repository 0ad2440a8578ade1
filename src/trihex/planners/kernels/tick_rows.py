"""Rows of actions that last: what robots do in a block of ticks, as many actions as each has begun in it."""

from typing import NamedTuple

from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, OUT_I32, OUT_I64, OUT_U8, declared, kernel


class TickRows(NamedTuple):
    """The actions of some robots in a block of ticks, a row for each robot."""

    robot: OUT_I32  # of each row
    action: OUT_U8  # row after row, room for `steps` in each
    used: OUT_U8  # how many actions a row holds
    block: types.int64  # number of the block, from 1
    first_step: types.int64  # how many ticks were before the block
    steps: types.int64  # ticks of the block


TICK_ROWS = declared(TickRows)


@kernel(types.int64(TICK_ROWS, IN_I64, IN_I32, OUT_I64, OUT_U8))
def pack(rows, cost_of_action, slowness, time, packed):
    """Write all actions one after the other, add what they cost to the time of each robot, and return how many."""
    count = 0
    for row in range(len(rows.robot)):
        for i in range(row * rows.steps, row * rows.steps + rows.used[row]):
            packed[count] = rows.action[i]
            count += 1
            times = 1 if rows.action[i] == WAIT else slowness[rows.robot[row]]
            time[rows.robot[row]] += cost_of_action[rows.action[i]] * times
    return count


@kernel(types.void(IN_I32, IN_U8, IN_U8, OUT_I64, OUT_U8))
def write_back(robot, used, packed, end, actions):
    """Write packed rows to where they belong in a plan: ``end[robot]`` is where its later ones begin, and goes down."""
    at = len(packed)
    for row in range(len(robot) - 1, -1, -1):
        at -= used[row]
        first = end[robot[row]] - used[row]
        for i in range(used[row]):
            actions[first + i] = packed[at + i]
        end[robot[row]] = first
