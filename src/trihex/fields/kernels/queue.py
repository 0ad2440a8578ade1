"""Fields spread through one queue, first in, first out: faster than buckets where fronts are a few cells long."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import types

from trihex.fields.kernels.front import (
    DONE,
    FRONT_CELLS,
    FRONT_MOVES,
    GO_ON,
    LISTS_FULL,
    OUT_U64,
    costs_of,
    ends_of,
    expand,
    prefetch_around,
    try_moves,
)
from trihex.kernels.signatures import HELPER, OUT_I64, declared, kernel

# What `state` holds: at which entry of the queue, where it ends, and why the kernel returned.
AT, TAIL, REASON, STATE_SIZE = 0, 1, 2, 3
LONGEST = 256  # entries that may wait; what ends up in a longer queue is better off in buckets
QUEUE_SIZE = 2048  # so small that it stays in the cache
_U = np.uint64


class FrontQueue(NamedTuple):
    """The entries that wait, and how far the spreading has come."""

    state: OUT_I64  # see above
    queue: OUT_U64


_SIGNATURE = types.void(declared(FrontQueue), FRONT_MOVES, FRONT_CELLS, types.int64)


@lru_cache
def make_spread(slots, is_masked):
    """Return the kernel for a front table with these `slots`, see `trihex.fields.kernels.buckets.make_settle`.

    A cell may be expanded again when a way of more moves and less cost reaches it, so nothing is final before the
    queue is empty or all that waits in it lies farther. In return there are no buckets, whose ends the processor
    cannot foresee where each holds but a few cells. It expands up to `budget` entries, a few more if need be, and
    tells in ``state[REASON]`` whether it may `GO_ON`, is `DONE`, or has more than `LONGEST` entries waiting.
    """
    end0, end1, columns = ends_of(slots)

    @kernel(_SIGNATURE)
    def spread(waiting, moves, cells, budget):
        _spread(waiting, moves, cells, (end0, end1, columns, is_masked), budget)

    return spread


@HELPER
def _spread(waiting, moves, cells, shape, budget):
    """Expand entries until the queue is empty or too long, or `budget` of them are."""
    state, queue = waiting.state, waiting.queue
    _, _, columns, is_masked = shape
    at, tail = _U(state[AT]), _U(state[TAIL])
    last = _U(len(queue) - columns)
    costs = costs_of(moves, shape)
    reason = GO_ON
    while reason == GO_ON and budget > 0:
        tail = _move_to_front(queue, at, tail)
        at = _U(0)
        while at != tail and tail <= last:
            here = expand(queue[at], cells, is_masked)
            at += _U(1)
            prefetch_around(here, 2, 4, columns, moves, cells.distance)
            tail = _try_all(here, costs, moves, cells.distance, shape, queue, tail)
        budget -= np.int64(at)
        if at == tail:
            reason = DONE
        elif tail - at > _U(LONGEST):
            reason = LISTS_FULL
    state[AT] = at
    state[TAIL] = tail
    state[REASON] = reason


@HELPER
def _move_to_front(queue, at, tail):
    """Move the entries at..tail-1 to the beginning of the queue; return where they end."""
    for i in range(tail - at):
        queue[_U(i)] = queue[at + _U(i)]
    return tail - at


@HELPER
def _try_all(here, costs, moves, distance, shape, queue, tail):
    """Try the moves of all groups; return the tail."""
    end0, end1, columns, is_masked = shape
    value = np.int32(here.distance + costs[0])
    tail = try_moves(here, value, 0, end0, moves, distance, is_masked, queue, tail)
    if end0 < columns:
        value = np.int32(here.distance + costs[1])
        tail = try_moves(here, value, end0, end1, moves, distance, is_masked, queue, tail)
    if end1 < columns:
        value = np.int32(here.distance + costs[2])
        tail = try_moves(here, value, end1, columns, moves, distance, is_masked, queue, tail)
    return tail
