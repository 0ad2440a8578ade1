"""Which moves the barriers and the corner rule leave open at each site."""

import numpy as np
from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, MASK, OUT_BOOL, OUT_U16, TABLE_I32, _array

IN_TABLE_ROW = _array(types.int32, True)
ALLOW, NO_SQUEEZE, NO_CUT = 0, 1, 2
BLOCK = 8192  # even


@njit(types.void(MASK, types.int64, types.int64, OUT_BOOL), cache=True, nogil=True)
def fill_blocked(barriers, origin, pitch, blocked):
    """Copy `barriers` (height, width) into the padded `blocked`, where the padding is blocked."""
    blocked[:] = True
    height, width = barriers.shape
    for y in range(height):
        site = origin + y * pitch
        for x in range(width):
            blocked[site + x] = barriers[y, x]


@njit(nogil=True)
def _fill_way(blocked, start, stop, site, ring, at, end, shut):
    """Set ``shut[i]`` where a barrier stands on the way round a vertex from place `at` of its ring to place `end`.

    `site` is the place on the ring of the site that moves.
    """
    shut[:] = 0
    while True:
        at = (at + 1) % len(ring)
        if at == end:
            return
        step = ring[at] - ring[site]
        there = blocked[start + step : stop + step]
        for i in range(len(shut)):
            shut[i] |= there[i]


@njit(nogil=True)
def _add_direction(blocked, start, stop, offset, vertex, ring, rule, orientation, bit, one_way, other_way, moves):
    """Set `bit` of ``moves[site]`` where a direction is open, for sites of an orientation, or of both if it is 2."""
    one_way[:] = 0
    if rule != ALLOW:
        site, target = 0, 0
        while vertex + ring[site] != 0:
            site += 1
        while vertex + ring[target] != offset:
            target += 1
        _fill_way(blocked, start, stop, site, ring, site, target, one_way)
        _fill_way(blocked, start, stop, site, ring, target, site, other_way)
        if rule == NO_CUT:
            one_way |= other_way
        else:
            one_way &= other_way
    here = blocked[start:stop]
    there = blocked[start + offset : stop + offset]
    for i in range(len(moves)):
        is_open = (here[i] | there[i] | one_way[i]) == 0
        is_open &= (orientation == 2) | (i & 1 == orientation)
        moves[i] |= bit if is_open else np.uint16(0)


@njit(
    types.void(
        IN_BOOL,
        types.int64,
        types.int64,
        TABLE_I32,
        TABLE_I32,
        IN_TABLE_ROW,
        types.int64,
        types.int64,
        OUT_U16,
    ),
    cache=True,
    nogil=True,
)
def fill_moves(blocked, first, last, offset, vertex, ring, edge_count, rule, moves):
    """Set bit k of ``moves[site]`` where direction k may be taken, for the sites first..last-1.

    `first` is even, `moves` all 0 before. Direction by direction over a block of sites, so that the compiler makes
    vector instructions of every loop; site by site, "no-cut" took twenty times as long.
    """
    barriers = blocked.view(np.uint8)
    one_way = np.zeros(BLOCK, dtype=np.uint8)
    other_way = np.zeros(BLOCK, dtype=np.uint8)
    for start in range(first, last, BLOCK):
        stop = min(start + BLOCK, last)
        block = moves[start:stop]
        one, other = one_way[: stop - start], other_way[: stop - start]
        for k in range(offset.shape[1]):
            corner_rule = rule if k >= edge_count else ALLOW
            bit = np.uint16(1 << k)
            is_same = offset[0, k] == offset[1, k] and vertex[0, k] == vertex[1, k]
            for side in range(1 if is_same else 2):
                orientation = 2 if is_same else side
                _add_direction(
                    barriers, start, stop, offset[side, k], vertex[side, k], ring, corner_rule, orientation, bit,
                    one, other, block,
                )  # fmt: skip
