"""Ways: which moves lead from a site, where they lead to, past what, at what cost."""

from typing import NamedTuple

import numpy as np
from numba import types
from numba.cpython.unsafe.numbers import trailing_zeros

from trihex.kernels.signatures import HELPER, IN_I32, declared

# Tables have a row of 16 directions for each parity of sites.
ROW = 4


class Ways(NamedTuple):
    """The moves there are, and the rules for them."""

    offset: IN_I32  # what a move adds to the site
    vertex: IN_I32  # what makes, added to the site, the number of the lattice vertex that a move passes
    back: IN_I32  # the direction that leads back
    cost: IN_I32  # of a direction
    waiting_cost: types.int64  # w_t
    count: types.int64  # how many directions there are
    first_vertex_move: types.int64  # the first direction past a vertex that others may not pass in the same step
    entry_limit: types.int64  # how many robots may enter a destination in one step, 0: any number


WAYS = declared(Ways)


# Sites are made unsigned before they index an array, or numba would test each for being negative: a fifth of a step.
@HELPER
def neighbour(site, k, ways):
    """Return the site to which direction `k` leads."""
    return site + ways.offset[np.uint64((site & 1) << ROW | k)]


@HELPER
def back_of(site, k, ways):
    """Return the direction that leads back where direction `k` leads from a site."""
    return np.int64(ways.back[np.uint64((site & 1) << ROW | k)])


@HELPER
def vertex_of(site, k, ways):
    """Return the vertex that direction `k` passes, 0 if it passes none or nobody minds."""
    return (site + ways.vertex[np.uint64((site & 1) << ROW | k)]) * (k >= ways.first_vertex_move)


@HELPER
def first_of(directions):
    """Return the first of some directions, given as bits; there must be one."""
    return np.int64(trailing_zeros(directions))


@HELPER
def without_first(directions):
    """Return directions, given as bits, without the first of them."""
    return directions & (directions - 1)
