"""Frame: the places around the start of a window, and what ways between them cost where there is no barrier.

A place is a number as small as the window is, so that tables of places stay in the cache.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_U16, declared
from trihex.planners.kernels.ways import ROW

_U = np.uint64


class Frame(NamedTuple):
    """Places; tables by (steps that are left, orientation, the end less the place) of ways of just so many steps."""

    offset: IN_I32  # what a direction adds to a place, as in `Ways`
    least: IN_I32  # what they cost at least
    # What one can do first so that a way costs less than one quantum beyond that, bit 0 to wait, and then the moves;
    # and in a second table so that it costs less than two.
    first: IN_U16
    quantum: types.int64  # the least that any action costs beyond the best one, wherever it leads
    bits: types.int64  # of a place
    centre: types.int64  # the place of the start, and the difference of equal places


FRAME = declared(Frame)


@HELPER
def place_after(place, site, k, frame):
    """Return the place to which direction `k` leads from a site that has a place."""
    return place + frame.offset[_U((site & 1) << ROW | k)]


@HELPER
def entry_of(left, site, place, end, frame):
    """Return where the tables know of ways of so many steps from a site and its place to another place."""
    return ((left << 1 | site & 1) << frame.bits) + end - place + frame.centre


@HELPER
def first_actions(actions, entry, slack, frame):
    """Return those of some actions with which a way may cost less than `slack` beyond the least of its entry."""
    if slack <= frame.quantum:
        return actions & np.int64(frame.first[_U(entry)])
    if slack <= 2 * frame.quantum:
        return actions & np.int64(frame.first[_U(entry + len(frame.least))])
    return actions
