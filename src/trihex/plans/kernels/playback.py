"""Playback: what all robots together do in each step of a plan."""

from numba import njit, types

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, IN_U8, OUT_I64, TABLE_I32


@njit(
    types.void(
        IN_I32,
        IN_U8,
        IN_I64,
        TABLE_I32,
        IN_I32,
        IN_I64,
        IN_I32,
        IN_BOOL,
        IN_I32,
        types.int64,
        types.int64,
        OUT_I64,
        OUT_I64,
        OUT_I64,
        OUT_I64,
        OUT_I64,
    ),
    cache=True,
    nogil=True,
)
def count_steps(
    start,
    actions,
    first_action,
    offset,
    cost,
    jump_at,
    jump_to,
    arrived,
    distance,
    not_reached,
    waiting_cost,
    moving,
    waiting,
    arriving,
    spent,
    lost,
):
    """Add up for each step: robots that move, wait, arrive; the time spent, and how much of it was no way forward.

    The counts are of all robots, the times of those that arrive only. `distance` is the N-scheme; an action loses
    what it costs less what it brings its robot nearer.
    """
    jump = 0
    for r in range(len(start)):
        at = start[r]
        first = first_action[r]
        for i in range(first, first_action[r + 1]):
            step = i - first + 1
            action = actions[i]
            c = waiting_cost
            to = at
            if action == WAIT:
                waiting[step] += 1
            else:
                moving[step] += 1
                if action == JUMP:
                    while jump_at[jump] < i:
                        jump += 1
                    to = jump_to[jump]
                    c = 0
                else:
                    to = at + offset[at & 1, action]
                    c = cost[action]
            if arrived[r]:
                spent[step] += c
                lost[step] += c
                if distance[at] != not_reached and distance[to] != not_reached:
                    lost[step] += distance[to] - distance[at]
            at = to
        if arrived[r]:
            arriving[first_action[r + 1] - first] += 1
