"""Law: which moves the scenario allows, found anew from what lies at each site.

Nothing in this folder is shared with the kernels that planners use: a fault in theirs must show.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.judging.kernels.doors import GUARDED_CELLS
from trihex.kernels.signatures import APART, HELPER, IN_I32, TABLE_I32, declared

# `place` tells in one number for each site what lies there, and which robot came there last: the robot on a free cell,
# robot + BARRIER on a barrier, ~robot (negative) on a destination; OUTSIDE in the padding.
BARRIER = 1 << 30
OUTSIDE = -(2**31)
# Corner rules, by their places in `trihex.areas.CORNERS`.
ALLOW, NO_SQUEEZE, NO_CUT = 0, 1, 2


class Law(NamedTuple):
    """The lattice and the rules of the scenario."""

    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    vertex: TABLE_I32  # likewise the lattice vertex that it passes, if it passes one
    ring: IN_I32  # what to add to a vertex for the sites around it, in their order
    edge_count: types.int64  # directions from this one on pass a vertex
    corner_rule: types.int64  # `ALLOW`, `NO_SQUEEZE` or `NO_CUT`
    forbids_crossing: types.boolean  # whether but one robot may pass a vertex in a step
    capacity: types.int64  # how many robots may enter a destination in a step, 0 for any number
    duration: IN_I32  # how many ticks a move of the fastest in each direction lasts
    slowness: IN_I32  # of each robot: how many times as long its moves last
    forbids_following: types.boolean  # whether a robot owns both cells for the whole move
    doors: GUARDED_CELLS  # the cells that let robots in by a schedule


LAW = declared(Law)


@HELPER
def is_blocked(what):
    """Tell by an entry of `place` whether nobody may stand there."""
    return what >= BARRIER or what == OUTSIDE


@HELPER
def _count_barriers(first, last, vertex, place, ring):
    """Count barriers around `vertex` between two places of its ring."""
    count = 0
    i = (first + 1) % len(ring)
    while i != last:
        count += is_blocked(place[vertex + ring[i]])
        i = (i + 1) % len(ring)
    return count


@APART
def is_corner_closed(site, target, vertex, place, law):
    """Tell whether barriers around `vertex` forbid the move from `site` to `target`."""
    here = there = np.int64(0)
    for i in range(len(law.ring)):
        if vertex + law.ring[i] == site:
            here = np.int64(i)
        elif vertex + law.ring[i] == target:
            there = np.int64(i)
    one_way = _count_barriers(here, there, vertex, place, law.ring)
    other_way = _count_barriers(there, here, vertex, place, law.ring)
    if law.corner_rule == NO_CUT:
        return one_way + other_way > 0
    return one_way > 0 and other_way > 0
