"""Fields of distances: least cost from every site to the nearest destination."""

from numba import njit, types

from trihex.kernels.signatures import IN_I32, IN_U16, OUT_I32, OUT_U16, TABLE_I32

NOT_REACHED = 2**31 - 1


@njit(
    types.int64(IN_I32, TABLE_I32, IN_I32, IN_U16, OUT_I32, OUT_I32, OUT_U16),
    cache=True,
    nogil=True,
)
def spread(sources, offset, cost, moves, distance, queue, queued):
    """Fill `distance` from `sources` by correcting labels along open moves, first in first out."""
    size = len(queue)
    head = 0
    tail = 0
    count = 0
    for i in range(len(sources)):
        distance[sources[i]] = 0
        queued[sources[i]] = 1
        queue[tail] = sources[i]
        tail = tail + 1 if tail + 1 < size else 0
        count += 1
    while count > 0:
        site = queue[head]
        head = head + 1 if head + 1 < size else 0
        count -= 1
        queued[site] = 0
        bits = moves[site]
        for k in range(len(cost)):
            if bits >> k & 1:
                target = site + offset[site & 1, k]
                value = distance[site] + cost[k]
                if value < distance[target]:
                    distance[target] = value
                    if not queued[target]:
                        queued[target] = 1
                        queue[tail] = target
                        tail = tail + 1 if tail + 1 < size else 0
                        count += 1
    return count


@njit(
    types.void(IN_I32, IN_U16, TABLE_I32, IN_I32, types.int64, types.int64, OUT_U16),
    cache=True,
    nogil=True,
)
def fill_directions(distance, moves, offset, cost, first, last, directions):
    """Set bit k of ``directions[site]`` where the open direction k attains the distance of the site."""
    for site in range(first, last):
        here = distance[site]
        bits = 0
        if here != NOT_REACHED and here != 0:
            open_moves = moves[site]
            for k in range(len(cost)):
                if open_moves >> k & 1 and distance[site + offset[site & 1, k]] + cost[k] == here:
                    bits |= 1 << k
        directions[site] = bits
