"""Actions: what robots do in a plan, and the one step along it that all kernels share but the judge's."""

from typing import NamedTuple

from numba import types

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import APART, HELPER, IN_I32, IN_I64, IN_U8, TABLE_I32, declared


class Actions(NamedTuple):
    """What robots do, one after the other, as in `Plan`."""

    action: IN_U8  # a direction, `WAIT` or `JUMP`
    first: IN_I64  # robot r has the actions first[r] .. first[r + 1] - 1
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    jump_at: IN_I64  # which of the actions are jumps, ascending
    jump_to: IN_I32  # the sites to which they lead
    slowness: IN_I32  # of each robot: how many times as long its moves last


ACTIONS = declared(Actions)


@HELPER
def times_of(robot, action, actions):
    """Return how many times as much as one of the fastest an action of a robot takes: waits and jumps are alike."""
    return 1 if action >= JUMP else types.int64(actions.slowness[robot])


@HELPER
def site_after(site, i, actions):
    """Return where a robot is that does action `i` at `site`."""
    action = actions.action[i]
    if action == WAIT:
        return site
    if action == JUMP:
        return _end_of_jump(i, actions.jump_at, actions.jump_to)
    return site + actions.offset[site & 1, action]


@APART
def _end_of_jump(i, jump_at, jump_to):
    """Return the site to which action `i` jumps, by bisection."""
    low, high = 0, len(jump_at)
    while low < high:
        middle = (low + high) // 2
        if jump_at[middle] < i:
            low = middle + 1
        else:
            high = middle
    return jump_to[low]
