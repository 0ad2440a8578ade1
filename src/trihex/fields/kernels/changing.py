"""Moves of an area whose barriers change."""

from numba import types

from trihex.kernels.codes import ALLOW, NO_CUT
from trihex.kernels.corners import CORNER_RULE
from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, OUT_I32, OUT_U16, kernel


@HELPER
def _is_corner_open(site, target, vertex, blocked, corners):
    """Tell whether the rule lets a move from `site` to `target` pass `vertex`."""
    ring = corners.ring
    here, there = 0, 0
    for i in range(len(ring)):
        if vertex + ring[i] == site:
            here = i
        elif vertex + ring[i] == target:
            there = i
    barriers, one_way = 0, 0
    for j in range(1, len(ring)):
        i = (here + j) % len(ring)
        if i != there and blocked[vertex + ring[i]]:
            barriers += 1
            one_way += j < (there - here) % len(ring)
    if corners.rule == NO_CUT:
        return barriers == 0
    return one_way == 0 or one_way == barriers


@HELPER
def _open_moves(site, blocked, corners):
    """Return the bits of the directions that may be taken from a site."""
    bits = 0
    if not blocked[site]:
        for k in range(corners.offset.shape[1]):
            target = site + corners.offset[site & 1, k]
            is_open = not blocked[target]
            if is_open and k >= corners.edge_count and corners.rule != ALLOW:
                is_open = _is_corner_open(site, target, site + corners.vertex[site & 1, k], blocked, corners)
            bits |= is_open << k
    return bits


@kernel(types.void(IN_I32, IN_BOOL, CORNER_RULE, OUT_U16, OUT_I32))
def renew_moves(changed, blocked, corners, moves, around):
    """Find the open moves of the `changed` sites and their neighbours anew, and fill `around` with those sites.

    All sites around a lattice vertex are neighbours, so no farther site can gain or lose a move.
    """
    directions = corners.offset.shape[1]
    for i in range(len(changed)):
        for j in range(directions + 1):
            site = types.int64(changed[i])
            if j > 0:
                site += corners.offset[site & 1, j - 1]
            around[i * (directions + 1) + j] = site
            moves[site] = _open_moves(site, blocked, corners)
