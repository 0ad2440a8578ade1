"""Escape: whether actions that came from a file stay inside their area."""

from numba import types

from trihex.kernels.actions import ACTIONS, site_after
from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import IN_I32, kernel


@kernel(types.int64(IN_I32, ACTIONS, types.int64, types.int64, types.int64, types.int64))
def find_escape(start, actions, origin, pitch, height, width):
    """Return the index of the first action that leads out of the area, -1 if none does."""
    for robot in range(len(start)):
        site = types.int64(start[robot])
        for i in range(actions.first[robot], actions.first[robot + 1]):
            if actions.action[i] == WAIT:
                continue
            site = site_after(site, i, actions)
            place = site - origin
            if place < 0 or place >= height * pitch or place % pitch >= width:
                return i
    return -1
