"""Taken: which sites and lattice vertices robots take in the steps that a window looks at.

A byte for each of 16 steps, of a site and then of its lattice vertex, so that what a window looks at lies together: it
stays in the cache whatever the area. Step 16 takes the byte of step 0, which must be free by then.
"""

from typing import NamedTuple

import numpy as np

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, OUT_U8, declared
from trihex.planners.kernels.ways import back_of, neighbour, vertex_of

_U = np.uint64
STEPS, BITS = 16, 5  # of steps, and of the number of a byte of a site


class Taken(NamedTuple):
    """Who is where after a step, and what is passed in it."""

    # Of a site: 1 + the direction by which a robot comes there, `WAIT`, or of a destination how many robots enter it.
    # Of a vertex: 1 if it is passed.
    byte: OUT_U8


TAKEN = declared(Taken)


@HELPER
def of_site(site, step):
    """Return the number of the byte of a site in a step."""
    return _U(site << BITS | step & (STEPS - 1))


@HELPER
def _of_vertex(vertex, step):
    """Return the number of the byte of a lattice vertex in a step; nobody ever passes vertex 0."""
    return _U(vertex << BITS | STEPS | step & (STEPS - 1))


@HELPER
def take(site, k, step, distance, ways, taken):
    """Take what an action needs that is begun at a site, for a step, and return where it leads."""
    if k == WAIT:
        taken.byte[of_site(site, step)] = WAIT
        return site
    vertex, target = vertex_of(site, k, ways), neighbour(site, k, ways)
    taken.byte[_of_vertex(vertex, step)] = vertex != 0
    place = of_site(target, step)
    taken.byte[place] = 1 + k if distance[_U(target)] > 0 else taken.byte[place] + 1
    return target


@HELPER
def release(site, k, step, distance, ways, taken):
    """Free what `take` took, and return where the action leads."""
    if k == WAIT:
        taken.byte[of_site(site, step)] = 0
        return site
    vertex, target = vertex_of(site, k, ways), neighbour(site, k, ways)
    taken.byte[_of_vertex(vertex, step)] = 0
    place = of_site(target, step)
    taken.byte[place] = 0 if distance[_U(target)] > 0 else taken.byte[place] - 1
    return target


@HELPER
def may_wait(site, step, taken):
    """Tell whether nobody comes to a site in a step."""
    return taken.byte[of_site(site, step)] == 0


@HELPER
def may_move(site, k, step, is_end, ways, taken):
    """Tell whether a robot may leave a site by direction `k` in a step; `is_end`: for a destination."""
    if taken.byte[_of_vertex(vertex_of(site, k, ways), step)]:
        return False
    there = np.int64(taken.byte[of_site(neighbour(site, k, ways), step)])
    if is_end:
        return ways.entry_limit == 0 or there < ways.entry_limit
    return there == 0 and taken.byte[of_site(site, step)] != 1 + back_of(site, k, ways)  # nobody comes the other way
