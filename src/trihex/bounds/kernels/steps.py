"""Numbers of steps, and queues at the destinations."""

from numba import types

from trihex.kernels.signatures import IN_I32, IN_I64, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32, kernel


@kernel(types.void(OUT_I64, IN_I64, IN_I64))
def queue_up(slots, places, apart):
    """Delay sorted `slots` until each is ``apart[j]`` later than the one ``places[j]`` places before it, for all j."""
    for i in range(len(slots)):
        for j in range(len(places)):
            if i >= places[j]:
                slots[i] = max(slots[i], slots[i - places[j]] + apart[j])


@kernel(types.void(IN_U16, TABLE_I32, IN_I32, OUT_I32, OUT_I32, OUT_BOOL, OUT_I64, types.int64))
def spread_costs(moves, offset, cost, least, queue, is_queued, state, budget):
    """Go on with the least sums of `cost` (0 is allowed) by correcting labels, at most `budget` sites.

    The ring buffer `queue` holds ``state[1]`` sites from ``state[0]`` on.
    """
    size = len(queue)
    head, count = state[0], state[1]
    while count > 0 and budget > 0:
        budget -= 1
        site = queue[head]
        head = head + 1 if head + 1 < size else 0
        count -= 1
        is_queued[site] = False
        bits = moves[site]
        for k in range(len(cost)):
            if bits >> k & 1:
                target = site + offset[site & 1, k]
                if least[site] + cost[k] < least[target]:
                    least[target] = least[site] + cost[k]
                    if not is_queued[target]:
                        is_queued[target] = True
                        queue[(head + count) % size] = target
                        count += 1
    state[0], state[1] = head, count
