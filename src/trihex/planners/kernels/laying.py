"""Laying: lanes become distances and directions of their cells."""

from typing import NamedTuple

import numpy as np
from numba import types
from numba.cpython.unsafe.numbers import trailing_zeros

from trihex.kernels.signatures import HELPER, OUT_I32, OUT_U16, declared, kernel
from trihex.planners.kernels.lanes import DEMAND
from trihex.planners.kernels.residual import AFTER, BEFORE, BEGIN, NETWORK, STREETS


class Laid(NamedTuple):
    """What lanes make of an area."""

    moves: OUT_U16  # bits of the moves that a wave from the lanes may take: none leads into a lane or a destination
    distance: OUT_I32  # along the lane, of its sites; known of destinations beforehand
    direction: OUT_U16  # the bit of the one direction of a site of a lane
    sites: OUT_I32  # the sites of all lanes, one lane after the other


LAID = declared(Laid)


@HELPER
def _lay_lane(start, first, streets, network, laid):
    """Fill the sites of a lane from place `first` on, with directions and distances; return the place behind it."""
    size = len(streets.moves)
    filled, site = first, start
    while network.ends[site] < 0:
        following = np.int64(network.node[site, AFTER]) - 1
        if following >= size:
            following = np.int64(network.node[following, AFTER]) - 1
        for k in range(len(streets.cost) - 1, -1, -1):  # of two moves to one place the first is the cheaper
            if streets.moves[site] >> k & 1 and site + streets.offset[site & 1, k] == following:
                laid.direction[site] = 1 << k
        laid.sites[filled] = site
        filled += 1
        site = following
    for i in range(filled - 1, first - 1, -1):
        here = np.int64(laid.sites[i])
        taken = np.int64(trailing_zeros(laid.direction[here]))
        laid.distance[here] = streets.cost[taken] + laid.distance[here + streets.offset[here & 1, taken]]
    return filled


@HELPER
def _shut(site, streets, laid):
    """Take away the moves that lead into a site."""
    for k in range(len(streets.cost)):
        beside = site + streets.offset[site & 1, k]
        for back in range(len(streets.cost)):
            if beside + streets.offset[beside & 1, back] == site:
                laid.moves[beside] &= ~np.uint16(1 << back)


@kernel(types.int64(DEMAND, STREETS, NETWORK, LAID))
def lay(demand, streets, network, laid):
    """Lay all lanes; return how many sites they have."""
    filled = np.int64(0)
    for i in range(len(demand.starts)):
        start = np.int64(demand.starts[i])
        if network.node[start, BEFORE] == BEGIN:
            filled = _lay_lane(start, filled, streets, network, laid)
    for i in range(filled):
        _shut(np.int64(laid.sites[i]), streets, laid)
    for site in range(len(network.ends)):
        if network.ends[site] >= 0:
            _shut(np.int64(site), streets, laid)
    return filled
