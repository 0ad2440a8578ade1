"""Fields spread through one queue, first in, first out: faster than buckets where fronts are a few cells long."""

from functools import lru_cache

import numpy as np
from numba import njit, types

from trihex.fields.kernels.buckets import DONE, GO_ON, IN_U64, OUT_U64, try_moves
from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import IN_I32, IN_U16, OUT_I32, OUT_I64

# What `state` holds: at which entry of the queue, where it ends, and why the kernel returned.
AT, TAIL, REASON, STATE_SIZE = 0, 1, 2, 3
QUEUE_FULL = 2
LONGEST = 256  # entries that may wait; what ends up in a longer queue is better off in buckets
QUEUE_SIZE = 2048  # so small that it stays in the cache


@lru_cache
def make_spread(slots, is_masked):
    """Return the kernel for a front table with these `slots`, see `trihex.fields.kernels.buckets.make_settle`.

    A cell may be expanded again when a way of more moves and less cost reaches it, so nothing is final before the
    queue is empty or all that waits in it lies farther. In return there are no buckets, whose ends the processor
    cannot foresee where each holds but a few cells. It expands up to `budget` entries, a few more if need be, and
    tells in ``state[REASON]`` whether it may `GO_ON`, is `DONE`, or has more than `LONGEST` entries waiting.
    """
    groups, columns = len(slots), sum(slots)
    end0, end1 = slots[0], sum(slots[:2])

    @njit(
        types.void(OUT_I64, OUT_U64, IN_U64, IN_U64, IN_I32, IN_U16, OUT_I32, types.int64, types.int64),
        cache=True,
        nogil=True,
    )
    def spread(state, queue, table, direction, cost, moves, distance, pitch, budget):
        at, tail = np.uint64(state[AT]), np.uint64(state[TAIL])
        last = np.uint64(len(queue) - columns)
        rows = np.uint64(4 * pitch)
        left = budget
        bits = np.uint64(0)
        reason = GO_ON
        while reason == GO_ON and left > 0:
            for i in range(tail - at):
                queue[np.uint64(i)] = queue[at + np.uint64(i)]
            tail -= at
            at = np.uint64(0)
            while at != tail and tail <= last:
                entry = queue[at]
                at += np.uint64(1)
                site = entry & np.uint64(2**32 - 1)
                row = entry >> np.uint64(32)
                base = distance[site]
                prefetch(distance, site + (table[row + np.uint64(columns)] << np.uint64(2)))
                prefetch(distance, site + rows)
                prefetch(distance, site - rows)
                if is_masked:
                    bits = np.uint64(moves[site])
                value = np.int32(base + cost[0])
                tail = try_moves(entry, 0, end0, value, table, direction, bits, is_masked, distance, queue, tail)
                if groups > 1:
                    value = np.int32(base + cost[1])
                    tail = try_moves(entry, end0, end1, value, table, direction, bits, is_masked, distance, queue, tail)
                if groups > 2:
                    value = np.int32(base + cost[2])
                    tail = try_moves(
                        entry, end1, columns, value, table, direction, bits, is_masked, distance, queue, tail
                    )
            left -= np.int64(at)
            if at == tail:
                reason = DONE
            elif tail - at > np.uint64(LONGEST):
                reason = QUEUE_FULL
        state[AT] = at
        state[TAIL] = tail
        state[REASON] = reason

    return spread
