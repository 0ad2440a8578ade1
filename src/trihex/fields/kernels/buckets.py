"""Fields of distances: least cost from every site to the nearest destination, settled front by front.

The cells are settled in *buckets*, each as wide as the least cost of a move: a move leads from one bucket to the next
or the one after it, so what a bucket holds when its turn comes is final, and three lists that take turns are all the
queue there is. Each cell is expanded once (1.0 to 1.1 times: who is improved while it waits stands in the queue
twice). One array of int32 holds barriers and the padding (-1), what is settled and what is not yet reached
(`NOT_REACHED`), so that one comparison tells whether a move is open and brings anything. What a field spreads from,
the *seeds*, may have any values: each is put into its bucket when that bucket's turn comes.
"""

from functools import lru_cache

import numpy as np
from numba import njit, types

from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import IN_I32, IN_U16, MASK, OUT_I32, OUT_I64, _array

FARTHEST = 2_000_000_000  # distances of open cells stay below it, so that sums of a few moves never overflow
IN_U64, OUT_U64 = _array(types.uint64, True), _array(types.uint64, False)
# What `state` holds: which list is read, at which entry, the lengths of the three lists in the order of their turns,
# how many seeds are in, the value at which the bucket being read ends, and why the kernel returned.
LIST, AT, COUNT, SEED, BUCKET_END, REASON, STATE_SIZE = 0, 1, 2, 5, 6, 7, 8
GO_ON, DONE, LISTS_FULL, TOO_FAR = 0, 1, 2, 3


@njit(types.void(MASK, types.int64, types.int64, OUT_I32), cache=True, nogil=True)
def prepare(barriers, first, pitch, distance):
    """Fill the rows of `barriers` from site `first` on: `NOT_REACHED` at free cells, -1 at barriers and the margin."""
    height, width = barriers.shape
    for y in range(height):
        row = distance[first + y * pitch : first + (y + 1) * pitch]
        for x in range(width):
            row[x] = -1 if barriers[y, x] else NOT_REACHED
        row[width:] = -1


@njit(types.void(OUT_I32, types.int64), cache=True, nogil=True)
def finish(distance, horizon):
    """Put `NOT_REACHED` at barriers, in the padding, and where the distance is not yet known to be below `horizon`."""
    for site in range(len(distance)):
        value = distance[site]
        distance[site] = NOT_REACHED if value < 0 or value >= horizon else value


@njit(nogil=True)
def try_moves(entry, first, last, value, table, direction, bits, is_masked, distance, lists, tail):
    """Give `value` to the sites where columns first..last-1 lead, if that is better; append them; return the tail.

    Every move is written to the list and every distance stored, and the tail moves on or not: without a branch to
    guess wrong this is twice as fast.
    """
    site = entry & np.uint64(2**32 - 1)
    row = entry >> np.uint64(32)
    for column in range(first, last):
        moved = site + table[row + np.uint64(column)]
        target = moved & np.uint64(2**32 - 1)
        old = distance[target]
        is_better = old > value
        if is_masked:
            is_better &= (bits >> direction[row + np.uint64(column)]) & np.uint64(1) != 0
        lists[tail] = moved
        tail += np.uint64(is_better)
        distance[target] = value if is_better else old
    return tail


@lru_cache
def make_settle(slots, is_masked):
    """Return the kernel for a front table with these `slots`, compiled for them, so that no loop over moves is left.

    Its arguments: state, lists, seeds, value_of_seed, table, direction, cost, moves, distance, pitch, budget. `lists`
    is one array, cut into three of equal length. `seeds` are entries with their values, ascending; a seed that is not
    below what `distance` holds there still spreads if it is equal. ``cost[g]`` is the cost of the moves of group g. If
    `is_masked`, a move must be open in ``moves[site]``; if not, nothing is read there. It expands up to `budget`
    entries and tells in ``state[REASON]`` whether it may `GO_ON`, is `DONE`, needs longer lists, or came too far.
    """
    groups, columns = len(slots), sum(slots)
    end0, end1 = slots[0], sum(slots[:2])

    @njit(
        types.void(OUT_I64, OUT_U64, IN_U64, IN_I32, IN_U64, IN_U64, IN_I32, IN_U16, OUT_I32, types.int64, types.int64),
        cache=True,
        nogil=True,
    )
    def settle(state, lists, seeds, value_of_seed, table, direction, cost, moves, distance, pitch, budget):
        length = np.uint64(len(lists) // 3)
        room = length - np.uint64(columns)
        here = np.uint64(state[LIST]) * length
        near = np.uint64((state[LIST] + 1) % 3) * length
        far = np.uint64((state[LIST] + 2) % 3) * length
        at = here + np.uint64(state[AT])
        end = here + np.uint64(state[COUNT])
        tail = near + np.uint64(state[COUNT + 1])
        far_tail = far + np.uint64(state[COUNT + 2])
        seed = state[SEED]
        bucket_end = state[BUCKET_END]
        three_rows = np.uint64(3 * pitch)
        left = np.uint64(budget)
        bits = np.uint64(0)
        reason = GO_ON
        while reason == GO_ON and left > 0:
            while seed < len(seeds) and value_of_seed[seed] < bucket_end and end - here < length:
                site = seeds[seed] & np.uint64(2**32 - 1)
                if value_of_seed[seed] <= distance[site]:
                    distance[site] = value_of_seed[seed]
                    lists[end] = seeds[seed]
                    end += np.uint64(1)
                seed += 1
            longest = max(tail - near, far_tail - far)
            fit = (room - longest) // np.uint64(columns) if longest < room else np.uint64(0)
            count = min(end - at, fit, left)
            left -= count
            stop = at + count
            far_from = bucket_end + cost[0]
            while at < stop:
                entry = lists[at]
                at += np.uint64(1)
                site = entry & np.uint64(2**32 - 1)
                base = distance[site]
                prefetch(distance, site + table[(entry >> np.uint64(32)) + np.uint64(columns)])
                prefetch(distance, site + three_rows)
                prefetch(distance, site - three_rows)
                if is_masked:
                    bits = np.uint64(moves[site])
                value = np.int32(base + cost[0])
                tail = try_moves(entry, 0, end0, value, table, direction, bits, is_masked, distance, lists, tail)
                if groups > 1:
                    value = np.int32(base + cost[1])
                    is_far = value >= far_from
                    t = far_tail if is_far else tail
                    t = try_moves(entry, end0, end1, value, table, direction, bits, is_masked, distance, lists, t)
                    tail, far_tail = tail if is_far else t, t if is_far else far_tail
                if groups > 2:
                    value = np.int32(base + cost[2])
                    is_far = value >= far_from
                    t = far_tail if is_far else tail
                    t = try_moves(entry, end1, columns, value, table, direction, bits, is_masked, distance, lists, t)
                    tail, far_tail = tail if is_far else t, t if is_far else far_tail
            if at == end and (seed == len(seeds) or value_of_seed[seed] >= bucket_end):
                here, near, far = near, far, here
                at, end, tail, far_tail = here, tail, far_tail, far
                bucket_end += cost[0]
                if end == here and tail == near:
                    if seed == len(seeds):
                        reason = DONE
                    elif value_of_seed[seed] >= bucket_end:
                        bucket_end += ((value_of_seed[seed] - bucket_end) // cost[0] + 1) * cost[0]
                if reason == GO_ON and bucket_end > FARTHEST:
                    reason = TOO_FAR
            elif fit == 0 or end - here == length:
                reason = LISTS_FULL
        state[LIST] = here // length
        state[AT] = at - here
        state[COUNT] = end - here
        state[COUNT + 1] = tail - near
        state[COUNT + 2] = far_tail - far
        state[SEED] = seed
        state[BUCKET_END] = bucket_end
        state[REASON] = reason

    return settle
