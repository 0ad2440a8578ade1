"""Mazes carved cell by cell."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import (
    HELPER,
    IN_BOOL,
    IN_U16,
    OUT_BOOL,
    OUT_I32,
    OUT_I64,
    OUT_U8,
    TABLE_I32,
    declared,
    kernel,
)

TABLE_U8 = types.Array(types.uint8, 2, "C", readonly=True)


class MazeGround(NamedTuple):
    """Where a maze may be, and how it is to be carved."""

    inside: IN_BOOL  # whether a site is a cell of the area
    offset: TABLE_I32  # what an edge neighbour adds to a site, by parity of the site
    front: TABLE_I32  # by parity * edge neighbours + k: what else touches the neighbour k, but not at the edge crossed
    turns: TABLE_U8  # orders in which a site tries its neighbours
    turn_of_site: IN_U16  # which of them is that of a site


class MazeWalk(NamedTuple):
    """What has been carved, and the way to the present site."""

    free: OUT_BOOL
    taken: OUT_U8  # how many neighbours a site has tried
    trail: OUT_I32  # sites from the first to the present one
    length: OUT_I64  # of the trail, one number; 0 at the end


@HELPER
def _is_clear(site, k, ground, walk):
    """Tell whether neighbour k of a site is a barrier of the area that touches no free site but at the edge crossed."""
    target = site + ground.offset[site & 1, k]
    if walk.free[target] or not ground.inside[target]:
        return False
    row = (site & 1) * ground.offset.shape[1] + k
    for j in range(ground.front.shape[1]):  # noqa: SIM110
        if walk.free[site + ground.front[row, j]]:
            return False
    return True


@kernel(types.void(declared(MazeGround), declared(MazeWalk), types.int64))
def carve_maze(ground, walk, budget):
    """Walk on at random, freeing cells, and back where no way is open; at most `budget` tries in one call.

    A cell is freed only if it is clear of what is free, so nothing ever closes a ring, through edges or vertices.
    """
    edges = ground.offset.shape[1]
    trail, taken = walk.trail, walk.taken
    n = walk.length[0]
    while n > 0 and budget > 0:
        budget -= 1
        site = trail[n - 1]
        turn = taken[site]
        if turn == edges:
            n -= 1
            continue
        taken[site] = turn + 1
        k = ground.turns[ground.turn_of_site[site], turn]
        if _is_clear(site, k, ground, walk):
            target = site + ground.offset[site & 1, k]
            walk.free[target] = True
            trail[n] = target
            n += 1
    walk.length[0] = n
