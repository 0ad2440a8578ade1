"""Which moves the barriers and the corner rule leave open at each site."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import ALLOW, NO_CUT
from trihex.kernels.corners import CORNER_RULE
from trihex.kernels.signatures import HELPER, IN_U8, MASK, OUT_BOOL, OUT_U8, OUT_U16, kernel

BLOCK = 8192  # even
BOTH = 2  # orientations
_U = np.uint64  # unsigned indices are not looked at whether they count from the end, which would forbid vectors


class Way(NamedTuple):
    """A direction, for the sites of one orientation or of both."""

    offset: types.int32
    vertex: types.int32
    bit: types.uint16
    orientation: types.int64


@kernel(types.void(MASK, types.int64, types.int64, OUT_BOOL))
def fill_blocked(barriers, origin, pitch, blocked):
    """Copy `barriers` (height, width) into the padded `blocked`, where the padding is blocked."""
    blocked[:] = True
    height, width = barriers.shape
    for y in range(height):
        site = _U(origin + y * pitch)
        for x in range(width):
            blocked[site + _U(x)] = barriers[y, x]


@HELPER
def _fill_shut(blocked, start, size, ring, places, shut):
    """Set ``shut[i]`` where a barrier stands on the way round the vertex of site ``start + i``.

    `places` on the ring of the vertex are that of the site, and those between which the way leads, clockwise.
    """
    site, at, end = places
    for i in range(size):
        shut[_U(i)] = 0
    at = (at + 1) % len(ring)
    while at != end:
        there = _U(start + ring[at] - ring[site])
        for i in range(size):
            shut[_U(i)] |= blocked[there + _U(i)]
        at = (at + 1) % len(ring)


@HELPER
def _fill_corners(blocked, start, size, way, corners, one_way, other_way):
    """Set ``one_way[i]`` where the rule closes the vertex that a direction passes."""
    ring = corners.ring
    site, target = 0, 0
    while way.vertex + ring[site] != 0:
        site += 1
    while way.vertex + ring[target] != way.offset:
        target += 1
    _fill_shut(blocked, start, size, ring, (site, site, target), one_way)
    _fill_shut(blocked, start, size, ring, (site, target, site), other_way)
    if corners.rule == NO_CUT:
        for i in range(size):
            one_way[_U(i)] |= other_way[_U(i)]
    else:
        for i in range(size):
            one_way[_U(i)] &= other_way[_U(i)]


@HELPER
def _add_direction(blocked, start, size, way, shut, moves):
    """Set the bit of a direction where it is open: neither cell nor neighbour is a barrier, nor is the vertex shut."""
    here, there = _U(start), _U(start + way.offset)
    for i in range(size):
        at = _U(i)
        is_open = (blocked[here + at] | blocked[there + at] | shut[at]) == 0
        is_open &= (way.orientation == BOTH) | (i & 1 == way.orientation)
        moves[here + at] |= way.bit if is_open else np.uint16(0)


@kernel(types.void(IN_U8, types.int64, types.int64, CORNER_RULE, OUT_U8, OUT_U8, OUT_U16))
def fill_moves(blocked, first, last, corners, one_way, other_way, moves):
    """Set bit k of ``moves[site]`` where direction k may be taken, for the sites first..last-1.

    `first` is even, `moves` all 0 before; `one_way` and `other_way` are room for `BLOCK` sites each. Direction by
    direction over a block of sites, so that the compiler makes vector instructions of every loop; site by site,
    "no-cut" took twenty times as long.
    """
    offset, vertex = corners.offset, corners.vertex
    for start in range(first, last, BLOCK):
        size = min(BLOCK, last - start)
        for k in range(offset.shape[1]):
            is_same = offset[0, k] == offset[1, k] and vertex[0, k] == vertex[1, k]
            for side in range(1 if is_same else 2):
                way = Way(offset[side, k], vertex[side, k], np.uint16(1 << k), BOTH if is_same else side)
                if k >= corners.edge_count and corners.rule != ALLOW:
                    _fill_corners(blocked, start, size, way, corners, one_way, other_way)
                else:
                    for i in range(size):
                        one_way[_U(i)] = 0
                _add_direction(blocked, start, size, way, one_way, moves)
