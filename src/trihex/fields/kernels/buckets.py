"""Fields of distances: least cost from every site to the nearest destination, settled front by front.

The cells are settled in *buckets*, each as wide as the least cost of a move: a move leads from one bucket to the next
or the one after it, so what a bucket holds when its turn comes is final, and three lists that take turns are all the
queue there is. Each cell is expanded once (1.0 to 1.1 times: who is improved while it waits stands in the queue
twice). What a field spreads from, the *seeds*, may have any values: each is put into its bucket when that bucket's turn
comes.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import types

from trihex.fields.kernels.front import (
    DONE,
    FARTHEST,
    FRONT_CELLS,
    FRONT_MOVES,
    GO_ON,
    IN_U64,
    LISTS_FULL,
    OUT_U64,
    TOO_FAR,
    ends_of,
    expand,
    prefetch_around,
    site_of,
    try_moves,
)
from trihex.kernels.signatures import HELPER, IN_I32, OUT_I64, declared, kernel

# What `state` holds: which list is read, at which entry, the lengths of the three lists in the order of their turns,
# how many seeds are in, the value at which the bucket being read ends, and why the kernel returned.
LIST, AT, COUNT, NEAR_COUNT, FAR_COUNT, SEED, BUCKET_END, REASON, STATE_SIZE = 0, 1, 2, 3, 4, 5, 6, 7, 8
_U = np.uint64


class Buckets(NamedTuple):
    """The entries that wait, and how far the settling has come."""

    state: OUT_I64  # see above
    lists: OUT_U64  # one array, cut into three lists of equal length
    seeds: IN_U64  # entries to begin with
    value_of_seed: IN_I32  # their values, ascending; one not below the distance there still spreads if it is equal


class Tails(NamedTuple):
    """Where the next entries go in the lists of the next bucket and of the one after it."""

    near: types.uint64
    far: types.uint64


_SIGNATURE = types.void(declared(Buckets), FRONT_MOVES, FRONT_CELLS, types.int64)


@lru_cache
def make_settle(slots, is_masked):
    """Return the kernel for a front table with these `slots`, compiled for them.

    Its arguments: `Buckets`, `FrontMoves`, `FrontCells` and the number of entries to expand at most. It tells in
    ``state[REASON]`` whether it may `GO_ON`, is `DONE`, needs longer lists, or came too far.
    """
    end0, end1, columns = ends_of(slots)

    @kernel(_SIGNATURE)
    def settle(buckets, moves, cells, budget):
        _settle(buckets, moves, cells, (end0, end1, columns, is_masked), budget)

    return settle


@HELPER
def _settle(buckets, moves, cells, shape, budget):
    """Expand up to `budget` entries, bucket by bucket."""
    state = buckets.state
    columns, width = shape[2], moves.cost[0]
    length = len(buckets.lists) // 3
    state[REASON] = GO_ON
    while state[REASON] == GO_ON and budget > 0:
        _add_seeds(buckets, length, cells.distance)
        fit = (length - max(state[NEAR_COUNT], state[FAR_COUNT])) // columns - 1
        count = max(0, min(state[COUNT] - state[AT], fit, budget))
        _expand_some(count, buckets, moves, cells, shape)
        budget -= count
        if state[AT] == state[COUNT] and not _is_seed_due(buckets):
            _turn_to_next(buckets, width)
        elif fit <= 0 or state[COUNT] == length:
            state[REASON] = LISTS_FULL


@HELPER
def _is_seed_due(buckets):
    """Tell whether the next seed belongs to the bucket being read."""
    seed = buckets.state[SEED]
    return seed < len(buckets.seeds) and buckets.value_of_seed[seed] < buckets.state[BUCKET_END]


@HELPER
def _add_seeds(buckets, length, distance):
    """Append the seeds of the bucket being read to its list."""
    state = buckets.state
    while state[COUNT] < length and _is_seed_due(buckets):
        entry, value = buckets.seeds[state[SEED]], buckets.value_of_seed[state[SEED]]
        if value <= distance[site_of(entry)]:
            distance[site_of(entry)] = value
            buckets.lists[state[LIST] * length + state[COUNT]] = entry
            state[COUNT] += 1
        state[SEED] += 1


@HELPER
def _expand_some(count, buckets, moves, cells, shape):
    """Expand the next `count` entries of the list that is read."""
    state, lists, cost, distance = buckets.state, buckets.lists, moves.cost, cells.distance
    end0, end1, columns, is_masked = shape
    length = len(lists) // 3
    near, far = (state[LIST] + 1) % 3 * length, (state[LIST] + 2) % 3 * length
    at = _U(state[LIST] * length + state[AT])
    tails = Tails(_U(near + state[NEAR_COUNT]), _U(far + state[FAR_COUNT]))
    far_from = np.int32(state[BUCKET_END] + cost[0])
    for i in range(count):
        here = expand(lists[at + _U(i)], cells, is_masked)
        prefetch_around(here, 0, 3, columns, moves, distance)
        value = np.int32(here.distance + cost[0])
        near_tail = try_moves(here, value, 0, end0, moves, distance, is_masked, lists, tails.near)
        tails = Tails(near_tail, tails.far)
        if end0 < columns:
            value = np.int32(here.distance + cost[1])
            tails = _try_group(here, value, end0, end1, far_from, moves, distance, is_masked, lists, tails)
        if end1 < columns:
            value = np.int32(here.distance + cost[2])
            tails = _try_group(here, value, end1, columns, far_from, moves, distance, is_masked, lists, tails)
    state[AT] += count
    state[NEAR_COUNT] = np.int64(tails.near) - near
    state[FAR_COUNT] = np.int64(tails.far) - far


@HELPER
def _try_group(here, value, first, last, far_from, moves, distance, is_masked, lists, tails):
    """Try moves that may lead to the next bucket or to the one after it; return the tails of both."""
    is_far = value >= far_from
    tail = tails.far if is_far else tails.near
    tail = try_moves(here, value, first, last, moves, distance, is_masked, lists, tail)
    return Tails(tails.near if is_far else tail, tail if is_far else tails.far)


@HELPER
def _turn_to_next(buckets, width):
    """Go on to the next bucket, or, if nothing waits, to that of the next seed."""
    state = buckets.state
    state[LIST] = (state[LIST] + 1) % 3
    state[AT] = 0
    state[COUNT], state[NEAR_COUNT], state[FAR_COUNT] = state[NEAR_COUNT], state[FAR_COUNT], 0
    state[BUCKET_END] += width
    if state[COUNT] == 0 and state[NEAR_COUNT] == 0:
        if state[SEED] == len(buckets.seeds):
            state[REASON] = DONE
        elif not _is_seed_due(buckets):
            missing = buckets.value_of_seed[state[SEED]] - state[BUCKET_END]
            state[BUCKET_END] += (missing // width + 1) * width
    if state[REASON] == GO_ON and state[BUCKET_END] > FARTHEST:
        state[REASON] = TOO_FAR
