"""Replay of actions: where they lead and what they cost."""

from numba import njit, types

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, OUT_I32, OUT_I64, TABLE_I32


@njit(
    types.void(IN_I32, IN_U8, IN_I64, TABLE_I32, IN_I32, IN_I64, IN_I32, OUT_I32, OUT_I64, OUT_I64),
    cache=True,
    nogil=True,
)
def replay(start, actions, first_action, offset, cost, jump_at, jump_to, site, distance, waits):
    """Follow each robot to its last action: its site, the cost of its moves (a jump costs 0), its number of waits.

    Robot r has the actions ``actions[first_action[r] : first_action[r + 1]]``; `jump_at` (ascending, with a last
    entry beyond all actions) and `jump_to` tell where jumps lead.
    """
    jump = 0
    for r in range(len(start)):
        at = start[r]
        d = 0
        w = 0
        for i in range(first_action[r], first_action[r + 1]):
            action = actions[i]
            if action == WAIT:
                w += 1
            elif action == JUMP:
                while jump_at[jump] < i:
                    jump += 1
                at = jump_to[jump]
            else:
                d += cost[action]
                at += offset[at & 1, action]
        site[r] = at
        distance[r] = d
        waits[r] = w


@njit(
    types.void(IN_U8, IN_I64, types.int64, TABLE_I32, IN_I64, IN_I32, OUT_I32),
    cache=True,
    nogil=True,
)
def advance(actions, first_action, step, offset, jump_at, jump_to, site):
    """Move `site` of every robot from `step` to ``step + 1``; robots without further actions stay."""
    for r in range(len(site)):
        i = first_action[r] + step
        if i >= first_action[r + 1]:
            continue
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
            site[r] = jump_to[low]
        else:
            site[r] += offset[site[r] & 1, action]
