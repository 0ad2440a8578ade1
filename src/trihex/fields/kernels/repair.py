"""Repair of distances after a few cells have changed: first the wave that raises, then the wave that lowers.

A cell's distance is *supported* by a neighbour that is nearer by the cost of the move between them. The first wave
visits, in the order of the old distances, the cells that may have lost their last support, and raises those that have
to "not reached". The second starts at the rim of what was raised and wherever a change made a way shorter, and settles
cells in the order of the new distances. Both wake only the neighbours of cells that change. Like the kernels of
`trihex.fields.kernels.buckets` they work through buckets as wide as the least cost of a move, so that a bucket is final
when its turn comes; what to begin with comes in a sorted list, because it may lie anywhere.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.fields.kernels.front import DONE, FARTHEST, GO_ON, LISTS_FULL, TOO_FAR
from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.signatures import (
    HELPER,
    IN_I32,
    IN_I64,
    IN_U16,
    OUT_I32,
    OUT_I64,
    OUT_U16,
    TABLE_I32,
    declared,
    kernel,
)

RAISE, LOWER = 0, 1
LOG_FULL = 4  # why a wave may return, beside those of `front`
# What `state` holds: which list is read, at which entry, how many entries the three lists have in the order of their
# turns, the value at which the bucket being read ends, how much of the beginnings and of the log is used, and why the
# kernel returned.
LIST, AT, COUNT, NEAR_COUNT, FAR_COUNT, BUCKET_END, BEGUN, LOGGED, REASON, STATE_SIZE = range(10)
_U = np.uint64  # unsigned indices are not looked at whether they count from the end
_SITE = (1 << 32) - 1  # the low half of a beginning; the high half is its value


class WaveField(NamedTuple):
    """The field that a wave passes over, and the moves that carry it."""

    distance: OUT_I32
    moves: IN_U16  # open moves of each site
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    cost: IN_I32  # of each direction, ascending


class WaveFront(NamedTuple):
    """The sites to look at, and how far the wave has come."""

    state: OUT_I64  # see above
    beginnings: IN_I64  # value << 32 | site of the sites to look at first, ascending; values are the old distances when
    # the wave raises, the new ones when it lowers
    lists: OUT_I32  # one array, cut into three lists of equal length, which take turns
    log: OUT_I32  # the sites that were raised, or those that were lowered (now and then twice)


_FIELD = declared(WaveField)


@kernel(types.void(IN_I32, _FIELD, OUT_I32))
def find_best(sites, field, best):
    """Fill the least distance that each of `sites` can have by one move to a neighbour as it is now."""
    for i in range(len(sites)):
        site = sites[i]
        least = NOT_REACHED
        bits = field.moves[site]
        for k in range(len(field.cost)):
            if bits >> k & 1:
                there = field.distance[site + field.offset[site & 1, k]]
                if there != NOT_REACHED:
                    least = min(least, there + field.cost[k])
        best[i] = least


@HELPER
def _next_site(front):
    """Return the next site of the bucket being read, or -1 if there is none."""
    state = front.state
    if state[AT] < state[COUNT]:
        site = types.int64(front.lists[state[LIST] * (len(front.lists) // 3) + state[AT]])
        state[AT] += 1
        return site
    if state[BEGUN] < len(front.beginnings) and front.beginnings[state[BEGUN]] >> 32 < state[BUCKET_END]:
        site = front.beginnings[state[BEGUN]] & _SITE
        state[BEGUN] += 1
        return site
    return -1


@HELPER
def _turn_to_next(front, width):
    """Go on to the next bucket, or, if nothing waits, to that of the next beginning."""
    state = front.state
    state[LIST] = (state[LIST] + 1) % 3
    state[AT] = 0
    state[COUNT], state[NEAR_COUNT], state[FAR_COUNT] = state[NEAR_COUNT], state[FAR_COUNT], 0
    state[BUCKET_END] += width
    if state[COUNT] == 0 and state[NEAR_COUNT] == 0:
        if state[BEGUN] == len(front.beginnings):
            state[REASON] = DONE
        else:
            state[BUCKET_END] = max(state[BUCKET_END], (front.beginnings[state[BEGUN]] >> 32) + width)
    if state[BUCKET_END] > FARTHEST:
        state[REASON] = TOO_FAR


@HELPER
def _is_supported(site, value, field):
    """Tell whether a site is a destination or a neighbour is nearer by the cost of the move to it."""
    bits = field.moves[site]
    for k in range(len(field.cost)):
        if bits >> k & 1 and field.distance[_U(site + field.offset[site & 1, k])] == value - field.cost[k]:
            return True
    return value == 0


@HELPER
def _wake_neighbours(wave, site, value, front, field):
    """List the neighbours that a site may have supported, or that come nearer by way of it, which are lowered."""
    state, lists, distance = front.state, front.lists, field.distance
    length = len(lists) // 3
    near, far = (state[LIST] + 1) % 3 * length, (state[LIST] + 2) % 3 * length
    near_tail, far_tail = near + state[NEAR_COUNT], far + state[FAR_COUNT]
    far_from = state[BUCKET_END] + field.cost[0]
    bits = field.moves[site]
    for k in range(len(field.cost)):
        if not bits >> k & 1:
            continue
        target = site + field.offset[site & 1, k]
        there = value + field.cost[k]
        if wave == RAISE:
            if distance[_U(target)] != there:
                continue
        elif distance[_U(target)] > there:
            distance[_U(target)] = there
        else:
            continue
        if there < far_from:
            lists[_U(near_tail)] = target
            near_tail += 1
        else:
            lists[_U(far_tail)] = target
            far_tail += 1
    state[NEAR_COUNT], state[FAR_COUNT] = near_tail - near, far_tail - far


@kernel(types.void(types.int64, declared(WaveFront), _FIELD, types.int64))
def run_wave(wave, front, field, budget):
    """Go on with a wave for up to `budget` entries, and tell in ``state[REASON]`` why it stopped."""
    state, width = front.state, field.cost[0]
    state[REASON] = GO_ON
    while budget > 0:
        if max(state[NEAR_COUNT], state[FAR_COUNT]) + len(field.cost) > len(front.lists) // 3:
            state[REASON] = LISTS_FULL
        elif state[LOGGED] == len(front.log):
            state[REASON] = LOG_FULL
        if state[REASON] != GO_ON:
            break
        site = _next_site(front)
        if site < 0:
            _turn_to_next(front, width)
            continue
        budget -= 1
        value = types.int64(field.distance[site])
        if value == NOT_REACHED or value < state[BUCKET_END] - width:  # raised already, or settled in an earlier bucket
            continue
        if wave == RAISE:
            if _is_supported(site, value, field):
                continue
            field.distance[site] = NOT_REACHED
        front.log[state[LOGGED]] = site
        state[LOGGED] += 1
        _wake_neighbours(wave, site, value, front, field)


@kernel(types.void(IN_I32, _FIELD, TABLE_I32, OUT_U16))
def renew_directions(sites, field, back, directions):
    """Find the best directions of `sites` anew, and of their neighbours the one that leads here.

    ``back[parity, k]`` is the direction that leads back from the neighbour in direction k.
    """
    for i in range(len(sites)):
        site = sites[i]
        value = types.int64(field.distance[site])
        bits = field.moves[site]
        best = 0
        for k in range(len(field.cost)):
            if not bits >> k & 1:
                continue
            target = site + field.offset[site & 1, k]
            there = types.int64(field.distance[target])
            bit_back = 1 << back[site & 1, k]
            if there != NOT_REACHED and there - value == field.cost[k]:
                directions[target] |= bit_back
            else:
                directions[target] &= ~bit_back
            if value != NOT_REACHED and value - there == field.cost[k]:
                best |= 1 << k
        directions[site] = best
