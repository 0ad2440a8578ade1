"""Robots taken from one frame of a movie to the next."""

from numba import njit, types

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, OUT_I32, TABLE_I32


@njit(
    types.void(IN_U8, IN_I64, types.int64, types.int64, types.int64, types.int64, TABLE_I32, IN_I64, IN_I32, OUT_I32),
    cache=True,
    nogil=True,
)
def follow(actions, first_action, first_robot, last_robot, step, next_step, offset, jump_at, jump_to, site):
    """Move `site` of robots first_robot..last_robot-1 from `step` to `next_step`, robot by robot.

    One robot's actions lie side by side: with 10^5 robots this takes half the time of going step by step if frames
    are 20 steps apart, and a quarter if they are 200 apart.
    """
    for r in range(first_robot, last_robot):
        at = site[r]
        for i in range(first_action[r] + step, min(first_action[r] + next_step, first_action[r + 1])):
            action = actions[i]
            if action == WAIT:
                continue
            if action == JUMP:
                low, high = 0, len(jump_at)
                while low < high:
                    middle = (low + high) // 2
                    if jump_at[middle] < i:
                        low = middle + 1
                    else:
                        high = middle
                at = jump_to[low]
            else:
                at += offset[at & 1, action]
        site[r] = at
