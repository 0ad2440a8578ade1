"""Ticks: robots along actions that last longer than a step, each at its own pace."""

from numba import types

from trihex.kernels.actions import ACTIONS, site_after, times_of
from trihex.kernels.signatures import IN_I32, OUT_I32, OUT_I64, kernel


@kernel(types.void(ACTIONS, IN_I32, types.int64, types.int64, types.int64, OUT_I64, OUT_I64, OUT_I32))
def follow_ticks(actions, duration, first_robot, last_robot, tick, index, begun, site):
    """Move `site` of robots first_robot..last_robot-1 on to `tick`; one of the fastest lasts ``duration[its byte]``.

    `index` is the action that each does, or would do next, and `begun` when it began: where durations differ, that is
    all that tells what a robot does at a tick.
    """
    for robot in range(first_robot, last_robot):
        i, now, at = index[robot], begun[robot], site[robot]
        while i < actions.first[robot + 1]:
            action = actions.action[i]
            end = now + duration[action] * times_of(robot, action, actions)
            if end > tick:
                break
            now = end
            at = site_after(at, i, actions)
            i += 1
        index[robot], begun[robot], site[robot] = i, now, at
