"""Fronts: entries that wait to be expanded, and the moves worth trying from each.

What both ways of settling a field, by buckets and by a queue, have in common. One array of int32 holds barriers and
the padding (-1), what is settled and what is not yet reached (`NOT_REACHED`), so that one comparison tells whether a
move is open and brings anything.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import HELPER, IN_I32, IN_U16, MASK, OUT_I32, _array, declared, kernel

FARTHEST = 2_000_000_000  # distances of open cells stay below it, so that sums of a few moves never overflow
IN_U64, OUT_U64 = _array(types.uint64, True), _array(types.uint64, False)
# Why a kernel returned: it may be called to go on, it is done, its lists are full, or it came too far.
GO_ON, DONE, LISTS_FULL, TOO_FAR = 0, 1, 2, 3
_U = np.uint64
_SITE, _ROW = np.uint64(2**32 - 1), np.uint64(32)  # an entry: its site in the low half, the start of its row above


class FrontMoves(NamedTuple):
    """The moves worth trying, as in `trihex.fields.front.FrontTable`."""

    table: IN_U64  # rows of moves, each to be added to a site
    direction: IN_U64  # of each move of `table`
    cost: IN_I32  # of each group of moves, ascending
    pitch: types.int64  # sites from one row of cells to the next


class FrontCells(NamedTuple):
    """The cells that the front passes over."""

    distance: OUT_I32  # -1 where nobody can stand
    moves: IN_U16  # open moves of each site; empty if all that lead to a free cell are open


class Expanded(NamedTuple):
    """The entry that is being expanded."""

    site: types.uint64
    row: types.uint64  # where its moves begin in the table
    distance: types.int32
    open_moves: types.uint64


FRONT_MOVES, FRONT_CELLS = declared(FrontMoves), declared(FrontCells)


def ends_of(slots):
    """Return the first column of a row that is not in group 0, not in groups 0 and 1, and in none, of a front table.

    With `is_masked`, whether a move must be open in `FrontCells.moves`, they are the *shape* that a kernel is compiled
    for: a plain tuple, because numba hands constants on in it, but not in one with names. So no loop over moves is
    left; the loops made fields 1.1 to 1.3 times as slow.
    """
    return sum(slots[:1]), sum(slots[:2]), sum(slots)


@kernel(types.void(MASK, types.int64, types.int64, OUT_I32))
def prepare(barriers, first, pitch, distance):
    """Fill the rows of `barriers` from site `first` on: `NOT_REACHED` at free cells, -1 at barriers and the margin."""
    height, width = barriers.shape
    for y in range(height):
        row = _U(first + y * pitch)  # unsigned, or else numba looks whether it counts from the end: ten times slower
        for x in range(width):
            distance[row + _U(x)] = -1 if barriers[y, x] else NOT_REACHED
        for x in range(width, pitch):
            distance[row + _U(x)] = -1


@kernel(types.void(OUT_I32, types.int64))
def finish(distance, horizon):
    """Put `NOT_REACHED` at barriers, in the padding, and where the distance is not yet known to be below `horizon`."""
    for site in range(len(distance)):
        value = distance[site]
        distance[site] = NOT_REACHED if value < 0 or value >= horizon else value


@HELPER
def site_of(entry):
    """Return the site of an entry."""
    return entry & _SITE


@HELPER
def costs_of(moves, shape):
    """Return the cost of the moves of each group, 0 of those that there are not."""
    end0, end1, columns, _ = shape
    cost = moves.cost
    return cost[0], cost[1] if end0 < columns else np.int32(0), cost[2] if end1 < columns else np.int32(0)


@HELPER
def expand(entry, cells, is_masked):
    """Return what is to be known of an entry before its moves are tried."""
    site = entry & _SITE
    return Expanded(site, entry >> _ROW, cells.distance[site], _U(cells.moves[site]) if is_masked else _U(0))


@HELPER
def prefetch_around(here, farther, rows, columns, moves, distance):
    """Begin to load what lies ahead, 4 << `farther` moves on, and so many `rows` to the north and the south."""
    ahead = moves.table[here.row + _U(columns)]
    prefetch(distance, here.site + (ahead << _U(farther)))
    prefetch(distance, here.site + _U(rows * moves.pitch))
    prefetch(distance, here.site - _U(rows * moves.pitch))


@HELPER
def try_moves(here, value, first, last, moves, distance, is_masked, lists, tail):
    """Give `value` to the sites where columns first..last-1 lead, if that is better; append them; return the tail.

    Every move is written to the list and every distance stored, and the tail moves on or not: without a branch to
    guess wrong this is twice as fast.
    """
    for column in range(first, last):
        place = here.row + _U(column)
        moved = here.site + moves.table[place]
        target = moved & _SITE
        old = distance[target]
        is_better = old > value
        if is_masked:
            is_better &= (here.open_moves >> moves.direction[place]) & _U(1) != 0
        lists[tail] = moved
        tail += _U(is_better)
        distance[target] = value if is_better else old
    return tail
