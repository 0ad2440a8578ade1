"""Repair of distances after a few cells have changed: first the wave that raises, then the wave that lowers.

A cell's distance is *supported* by a neighbour that is nearer by the cost of the move between them. The first wave
visits, in the order of the old distances, the cells that may have lost their last support, and raises those that have
to "not reached". The second starts at the rim of what was raised and wherever a change made a way shorter, and settles
cells in the order of the new distances. Both wake only the neighbours of cells that change. Like the kernels of
`fields` they work through buckets as wide as the least cost of a move, so that a bucket is final when its turn comes;
what to begin with comes in a sorted list, because it may lie anywhere.
"""

from numba import njit, types

from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, IN_U16, OUT_I32, OUT_I64, OUT_U16, TABLE_I32

FARTHEST = 2_000_000_000
ALLOW, NO_SQUEEZE, NO_CUT = 0, 1, 2
RAISE, LOWER = 0, 1
# What `state` holds: which list is read, at which entry, the lengths of the three lists in the order of their turns,
# the value at which the bucket being read ends, how much of the beginnings and of the log is used, why it returned.
LIST, AT, COUNT, BUCKET_END, BEGUN, LOGGED, REASON, STATE_SIZE = 0, 1, 2, 5, 6, 7, 8, 9
GO_ON, DONE, LISTS_FULL, LOG_FULL, TOO_FAR = 0, 1, 2, 3, 4
SITE = (1 << 32) - 1  # the low half of a beginning; the high half is its value


@njit(types.boolean(IN_BOOL, *[types.int64] * 3, IN_I32, types.int64), cache=True, nogil=True)
def _is_corner_open(blocked, site, target, vertex, ring, rule):
    """Tell whether `rule` lets a move from `site` to `target` pass `vertex`, whose sites are ``vertex + ring``."""
    here = 0
    there = 0
    for i in range(len(ring)):
        if vertex + ring[i] == site:
            here = i
        elif vertex + ring[i] == target:
            there = i
    barriers = 0
    one_way = 0
    for j in range(1, len(ring)):
        i = (here + j) % len(ring)
        if i != there and blocked[vertex + ring[i]]:
            barriers += 1
            one_way += j < (there - here) % len(ring)
    if rule == NO_CUT:
        return barriers == 0
    return one_way == 0 or one_way == barriers


@njit(
    types.void(IN_I32, IN_BOOL, TABLE_I32, TABLE_I32, IN_I32, types.int64, types.int64, OUT_U16, OUT_I32),
    cache=True,
    nogil=True,
)
def renew_moves(changed, blocked, offset, vertex, ring, edge_count, rule, moves, around):
    """Find the open moves of the `changed` sites and their neighbours anew, and fill `around` with those sites.

    All sites around a lattice vertex are neighbours, so no farther site can gain or lose a move.
    """
    directions = offset.shape[1]
    for i in range(len(changed)):
        for j in range(directions + 1):
            site = changed[i]
            if j > 0:
                site += offset[site & 1, j - 1]
            around[i * (directions + 1) + j] = site
            bits = 0
            if not blocked[site]:
                for k in range(directions):
                    target = site + offset[site & 1, k]
                    is_open = not blocked[target]
                    if is_open and k >= edge_count and rule != ALLOW:
                        is_open = _is_corner_open(blocked, site, target, site + vertex[site & 1, k], ring, rule)
                    bits |= is_open << k
            moves[site] = bits


@njit(types.void(IN_I32, IN_U16, TABLE_I32, IN_I32, IN_I32, OUT_I32), cache=True, nogil=True)
def find_best(sites, moves, offset, cost, distance, best):
    """Fill the least distance that each of `sites` can have by one move to a neighbour as it is now."""
    for i in range(len(sites)):
        site = sites[i]
        least = NOT_REACHED
        bits = moves[site]
        for k in range(len(cost)):
            if bits >> k & 1:
                there = distance[site + offset[site & 1, k]]
                if there != NOT_REACHED:
                    least = min(least, there + cost[k])
        best[i] = least


@njit(
    types.void(types.int64, OUT_I64, IN_I64, OUT_I32, OUT_I32, IN_U16, TABLE_I32, IN_I32, OUT_I32, types.int64),
    cache=True,
    nogil=True,
)
def run_wave(wave, state, beginnings, lists, log, moves, offset, cost, distance, budget):
    """Go on with a wave for up to `budget` entries, and tell in ``state[REASON]`` why it stopped.

    `beginnings` are the value << 32 | site of the sites to look at first, ascending; values are the old distances when
    the wave raises, the new ones when it lowers. `lists` is one array, cut into three of equal length. `log` gets the
    sites that were raised, or those that were lowered (now and then twice).
    """
    directions = len(cost)
    width = cost[0]
    length = len(lists) // 3
    here = state[LIST] * length
    near = (state[LIST] + 1) % 3 * length
    far = (state[LIST] + 2) % 3 * length
    at = state[AT]
    count, near_count, far_count = state[COUNT], state[COUNT + 1], state[COUNT + 2]
    bucket_end = state[BUCKET_END]
    begun = state[BEGUN]
    logged = state[LOGGED]
    reason = GO_ON
    while reason == GO_ON and budget > 0:
        if max(near_count, far_count) + directions > length:
            reason = LISTS_FULL
            break
        if logged == len(log):
            reason = LOG_FULL
            break
        if at < count:
            site = types.int64(lists[here + at])
            at += 1
        elif begun < len(beginnings) and beginnings[begun] >> 32 < bucket_end:
            site = beginnings[begun] & SITE
            begun += 1
        else:  # the next bucket, or, if nothing waits, that of the next beginning
            here, near, far = near, far, here
            at, count, near_count, far_count = 0, near_count, far_count, 0
            bucket_end += width
            if count == 0 and near_count == 0:
                if begun == len(beginnings):
                    reason = DONE
                else:
                    bucket_end = max(bucket_end, (beginnings[begun] >> 32) + width)
            if bucket_end > FARTHEST:
                reason = TOO_FAR
            continue
        budget -= 1
        value = types.int64(distance[site])
        if value == NOT_REACHED or value < bucket_end - width:  # raised already, or settled in an earlier bucket
            continue
        bits = moves[site]
        if wave == RAISE:
            is_supported = value == 0
            for k in range(directions):
                if bits >> k & 1 and distance[site + offset[site & 1, k]] == value - cost[k]:
                    is_supported = True
                    break
            if is_supported:
                continue
            distance[site] = NOT_REACHED
        log[logged] = site
        logged += 1
        for k in range(directions):
            if not bits >> k & 1:
                continue
            target = site + offset[site & 1, k]
            there = value + cost[k]
            if wave == RAISE:
                if distance[target] != there:
                    continue
            elif distance[target] > there:
                distance[target] = there
            else:
                continue
            if there < bucket_end + width:
                lists[near + near_count] = target
                near_count += 1
            else:
                lists[far + far_count] = target
                far_count += 1
    state[LIST] = here // length
    state[AT] = at
    state[COUNT], state[COUNT + 1], state[COUNT + 2] = count, near_count, far_count
    state[BUCKET_END] = bucket_end
    state[BEGUN] = begun
    state[LOGGED] = logged
    state[REASON] = reason


@njit(
    types.void(IN_I32, IN_U16, TABLE_I32, TABLE_I32, IN_I32, IN_I32, OUT_U16),
    cache=True,
    nogil=True,
)
def renew_directions(sites, moves, offset, reverse, cost, distance, directions):
    """Find the best directions of `sites` anew, and of their neighbours the one that leads here."""
    for i in range(len(sites)):
        site = sites[i]
        value = types.int64(distance[site])
        bits = moves[site]
        best = 0
        for k in range(len(cost)):
            if not bits >> k & 1:
                continue
            target = site + offset[site & 1, k]
            there = types.int64(distance[target])
            back = reverse[site & 1, k]
            if there != NOT_REACHED and there - value == cost[k]:
                directions[target] |= 1 << back
            else:
                directions[target] &= ~(1 << back)
            if value != NOT_REACHED and value - there == cost[k]:
                best |= 1 << k
        directions[site] = best
