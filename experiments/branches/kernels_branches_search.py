"""Search: the cheapest way to lead a part of a branch to a gate that has steps to spare, pushing others aside."""

import numpy as np
from numba import njit, types

from trihex.kernels.branches import (
    BRANCH,
    COST,
    DISTANCE,
    GRID,
    IS_DESTINATION,
    LOAD,
    MOVES,
    OFFSET,
    PARENT,
    PASSING,
    REVERSE,
    STEPS,
    TABLE,
    VERTEX,
    VERTEX_GATE,
    WAY,
    gate_of_move,
)
from trihex.kernels.signatures import IN_I32, OUT_I64

# A site is visited in two states: COMING from outside; LEAVING, pushed out by one that comes into the site below.
# Columns of `mark` for COMING, those for LEAVING stand SECOND further on: which search wrote the next three; the least
# cost and steps so far; the state before (2 * site + state, -1 for none); the least cost from here, as learned in the
# epoch that stands behind the two states.
COMING, LEAVING = 0, 1
SEARCH, SPENT, MADE, BEFORE, LEAST = range(5)
SECOND = 5
EPOCH = 10
MARK_COLUMNS = 11
# States wait in buckets of about equal cost, last in, first out: a search that goes ahead where it can loses little to
# one in strict order, and a heap took half of the time. Columns of `waiting`: state, cost spent, next of the bucket.
_STATE, _COST, _NEXT = range(3)
_END = 1 << 33
BUCKETS = 1 << 12
MOST_COST = (1 << 29) - 1
# What a search is told.
NUMBER, AGE, OWN, BEST, LIGHT, WAITING_COST, MOST_VISITS, FIRST_VERTEX_MOVE, ONLY_FREE_GATES, VISITS = range(10)
FROM, WIDTH, AT, LAST, SIZE = range(10, 15)
TOLD = 15

WIDE = types.Array(types.int64, 2, "C")


@njit(types.void(types.int64, types.int64, types.int64, OUT_I64, OUT_I64, WIDE), cache=True, nogil=True, _nrt=False)
def _push(state, spent, key, told, bucket, waiting):
    """Put a state into the bucket of its `key`, or into the one at hand if that is over."""
    if told[SIZE] >= len(waiting):
        return
    b = max((key - told[FROM]) // told[WIDTH], told[AT])
    if b >= BUCKETS:
        return
    told[LAST] = max(told[LAST], b)
    entry = told[SIZE]
    told[SIZE] += 1
    waiting[entry, _STATE] = state
    waiting[entry, _COST] = spent
    waiting[entry, _NEXT] = bucket[b]
    bucket[b] = entry


@njit(types.int64(types.int64, types.int64, types.int64, GRID, GRID), cache=True, nogil=True, _nrt=False)
def _least(site, state, epoch, node, mark):
    """Return what it will cost at least from a site in a state."""
    if mark[site, EPOCH] != epoch:
        return node[site, DISTANCE]
    return max(node[site, DISTANCE], mark[site, state * SECOND + LEAST])


@njit(
    types.void(
        types.int64, types.int64, types.int64, types.int64, types.int64, OUT_I64, GRID, GRID, OUT_I64, WIDE
    ),
    cache=True,
    nogil=True,
    _nrt=False,
)
def _visit(site, state, spent, made, before, told, node, mark, bucket, waiting):
    """Note a cheaper way to a site in a state, if it is one and not too dear."""
    at = state * SECOND
    if mark[site, at + SEARCH] == told[NUMBER] and mark[site, at + SPENT] <= spent:
        return
    key = spent + _least(site, state, told[AGE], node, mark)
    if key >= told[BEST]:
        return
    mark[site, at + SEARCH] = told[NUMBER]
    mark[site, at + SPENT] = spent
    mark[site, at + MADE] = made
    mark[site, at + BEFORE] = before
    _push(2 * site + state, spent, key, told, bucket, waiting)


@njit(
    types.void(types.int64, types.int64, types.int64, types.int64, OUT_I64, GRID, OUT_I64, WIDE),
    cache=True,
    nogil=True,
    _nrt=False,
)
def _offer(state, spent, steps, gate, told, slot, bucket, waiting):
    """Offer to end in a branch, after `steps` moves in all and the wait for its next free step."""
    steps = min(steps, slot.shape[1] - 1)
    key = spent + told[WAITING_COST] * (slot[gate, steps] - steps)
    if key < told[BEST]:
        _push(_END | state, key, key, told, bucket, waiting)


@njit(types.boolean(types.int64, types.int64, types.int64, OUT_I64, TABLE, GRID), cache=True, nogil=True, _nrt=False)
def _is_vertex_free(site, k, state, told, table, node):
    """Tell whether few enough robots pass the vertex of a move, not counting those that go where it leads."""
    parity = site & 1
    vertex = site + table[VERTEX + parity, k]
    busy = node[vertex, PASSING]
    if busy <= told[LIGHT]:
        return True
    own = node[site, PARENT]
    if state == LEAVING and own >= told[FIRST_VERTEX_MOVE] and site + table[VERTEX + parity, own] == vertex:
        busy -= node[site, LOAD]
    target = site + table[OFFSET + parity, k]
    if node[target, MOVES] & IS_DESTINATION:
        gate = node[vertex, VERTEX_GATE]
        return busy <= told[LIGHT] or (gate != told[OWN] and not told[ONLY_FREE_GATES])
    for j in range(told[FIRST_VERTEX_MOVE], table.shape[1]):
        if node[target, MOVES] >> j & 1 and target + table[VERTEX + (target & 1), j] == vertex:
            other = target + table[OFFSET + (target & 1), j]
            if other != site and node[other, LOAD] > 0 and node[other, PARENT] == table[REVERSE + (target & 1), j]:
                busy -= node[other, LOAD]
    return busy <= told[LIGHT]


@njit(
    types.void(types.int64, types.int64, OUT_I64, TABLE, GRID, GRID, GRID, OUT_I64, WIDE),
    cache=True,
    nogil=True,
    _nrt=False,
)
def _expand(site, state, told, table, node, mark, slot, bucket, waiting):
    """Visit all that can follow a site in a state."""
    spent = np.int64(mark[site, state * SECOND + SPENT])
    made = np.int64(mark[site, state * SECOND + MADE])
    parity = site & 1
    load = node[site, LOAD]
    me = 2 * site + state
    light = told[LIGHT]
    is_crowded = load > light
    if state == COMING and load > 0 and node[site, BRANCH] != told[OWN] and not told[ONLY_FREE_GATES]:
        _offer(me, spent + node[site, WAY], made + node[site, STEPS], node[site, BRANCH], told, slot, bucket, waiting)
    may_push = is_crowded and (state == COMING or mark[site, SECOND + BEFORE] >= 0)
    may_go = state == LEAVING or not is_crowded
    for k in range(table.shape[1]):
        if not node[site, MOVES] >> k & 1:
            continue
        target = site + table[OFFSET + parity, k]
        is_child = node[target, LOAD] > light and node[target, PARENT] == table[REVERSE + parity, k]
        if is_child:
            if may_push:
                _visit(target, LEAVING, spent, made, me, told, node, mark, bucket, waiting)
            continue
        if not may_go or (state == LEAVING and k == node[site, PARENT]):
            continue
        if k >= told[FIRST_VERTEX_MOVE] and not _is_vertex_free(site, k, state, told, table, node):
            continue
        if node[target, MOVES] & IS_DESTINATION:
            gate = gate_of_move(site, k, table, told[FIRST_VERTEX_MOVE], node)
            if gate != told[OWN] and not (is_crowded and k < told[FIRST_VERTEX_MOVE]):
                _offer(me, spent + table[COST, k], made + 1, gate, told, slot, bucket, waiting)
        else:
            _visit(target, COMING, spent + table[COST, k], made + 1, me, told, node, mark, bucket, waiting)


@njit(
    types.int64(IN_I32, types.int64, OUT_I64, TABLE, GRID, GRID, GRID, OUT_I64, WIDE, OUT_I64, OUT_I64),
    cache=True,
    nogil=True,
    _nrt=False,
)
def search(sources, count, told, table, node, mark, slot, bucket, waiting, closed, path):
    """Look for a way out for one of `sources`; return the number of states of `path`, the last first, 0 for none.

    `sources` are sites of one branch, each the parent of the one before it, that carry nearly the same load: any may
    leave its parent. Costs count from the first of them. It is an A* search with the distance as estimate; what a
    search learns about the cost from where it has been serves those that follow it in the same epoch, in which nothing
    changes for the better.
    """
    top = sources[0]
    told[SIZE] = 0
    told[AT] = 0
    told[LAST] = -1
    told[FROM] = told[BEST]
    for i in range(count):
        key = node[top, WAY] - node[sources[i], WAY] + _least(sources[i], LEAVING, told[AGE], node, mark)
        told[FROM] = min(told[FROM], key)
    for i in range(count):
        spent = node[top, WAY] - node[sources[i], WAY]
        made = node[top, STEPS] - node[sources[i], STEPS]
        _visit(sources[i], LEAVING, spent, made, -1, told, node, mark, bucket, waiting)
    seen = 0
    end = -1
    reached = told[BEST]
    while told[AT] <= told[LAST]:
        entry = bucket[told[AT]]
        if entry < 0:
            told[AT] += 1
            continue
        if seen >= told[MOST_VISITS] or told[SIZE] >= len(waiting):
            reached = told[FROM] + told[AT] * told[WIDTH]
            break
        bucket[told[AT]] = waiting[entry, _NEXT]
        state = waiting[entry, _STATE]
        if state & _END:
            end = state ^ _END
            reached = waiting[entry, _COST]
            break
        site = state >> 1
        if waiting[entry, _COST] != mark[site, (state & 1) * SECOND + SPENT]:
            continue
        closed[seen] = state
        seen += 1
        _expand(site, state & 1, told, table, node, mark, slot, bucket, waiting)
    bucket[: told[LAST] + 1] = -1
    told[VISITS] += seen
    for i in range(seen):
        site = closed[i] >> 1
        at = (closed[i] & 1) * SECOND
        if mark[site, EPOCH] != told[AGE]:
            mark[site, EPOCH] = told[AGE]
            mark[site, LEAST] = 0
            mark[site, SECOND + LEAST] = 0
        mark[site, at + LEAST] = max(mark[site, at + LEAST], reached - mark[site, at + SPENT])
    length = 0
    while end >= 0:
        path[length] = end
        length += 1
        end = mark[end >> 1, (end & 1) * SECOND + BEFORE]
    return length
