"""Escape: whether actions that came from a file stay inside their area."""

from numba import njit, types

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, TABLE_I32


@njit(
    types.int64(IN_I32, IN_U8, IN_I64, TABLE_I32, IN_I64, IN_I32, types.int64, types.int64, types.int64, types.int64),
    cache=True,
    nogil=True,
)
def find_escape(start, actions, first_action, offset, jump_at, jump_to, origin, pitch, height, width):
    """Return the index of the first action that leads out of the area, -1 if none does."""
    jump = 0
    for r in range(len(start)):
        at = types.int64(start[r])
        for i in range(first_action[r], first_action[r + 1]):
            action = actions[i]
            if action == JUMP:
                while jump_at[jump] < i:
                    jump += 1
                at = types.int64(jump_to[jump])
            elif action != WAIT:
                at += offset[at & 1, action]
                place = at - origin
                if place < 0 or place >= height * pitch or place % pitch >= width:
                    return i
    return -1
