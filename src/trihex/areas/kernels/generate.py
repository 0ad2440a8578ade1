"""Generation of areas: mazes carved cell by cell, caves smoothed and reduced to one."""

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, OUT_U8, TABLE_I32

TABLE_U8 = types.Array(types.uint8, 2, "C", readonly=True)


@njit(
    types.void(OUT_BOOL, IN_BOOL, TABLE_I32, TABLE_I32, TABLE_U8, IN_U16, OUT_U8, OUT_I32, OUT_I64, types.int64),
    cache=True,
    nogil=True,
)
def carve_maze(free, inside, offset, front, turns, turn_of_site, taken, trail, length, budget):
    """Walk on at random, freeing cells, and back where no way is open; at most `budget` tries in one call.

    ``offset[parity, k]`` are the edge neighbours. One may be freed if all sites ``front[parity * edges + k]`` around it
    are barriers, which are those that touch it but not at the edge it is entered by. So nothing ever closes a ring,
    through edges or through vertices. Each site tries its neighbours in the order ``turns[turn_of_site[site]]``, of
    which ``taken[site]`` are done. ``trail[:length[0]]`` is the way to the present site, empty at the end.
    """
    edges = offset.shape[1]
    n = length[0]
    while n > 0 and budget > 0:
        budget -= 1
        site = trail[n - 1]
        turn = taken[site]
        if turn == edges:
            n -= 1
            continue
        taken[site] = turn + 1
        parity = site & 1
        k = turns[turn_of_site[site], turn]
        target = site + offset[parity, k]
        if free[target] or not inside[target]:
            continue
        is_clear = True
        for j in range(front.shape[1]):
            if free[site + front[parity * edges + k, j]]:
                is_clear = False
                break
        if is_clear:
            free[target] = True
            trail[n] = target
            n += 1
    length[0] = n


@njit(types.void(IN_BOOL, types.int64, types.int64, TABLE_I32, OUT_BOOL), cache=True, nogil=True)
def smooth(blocked, first, last, offset, smoothed):
    """Let each of the sites first..last-1 become what most of itself and its neighbours are."""
    directions = offset.shape[1]
    for site in range(first, last):
        parity = site & 1
        count = 2 * blocked[site] - 1
        for k in range(directions):
            count += 2 * blocked[site + offset[parity, k]] - 1
        smoothed[site] = count > 0


@njit(types.void(OUT_I32, TABLE_I32, OUT_I32, OUT_I64, types.int64), cache=True, nogil=True)
def label_regions(region, offset, queue, state, budget):
    """Give the sites of each connected region of free ones (`region` 0) a number from 1.

    `state` is (next site to look at, next place of the queue to read, to write, regions so far, the largest region, its
    size); the work is done when the first has passed all sites. At most `budget` sites are looked at in one call.
    """
    directions = offset.shape[1]
    start, head, tail, regions = state[0], state[1], state[2], state[3]
    while budget > 0 and start < len(region):
        budget -= 1
        if head < tail:
            site = queue[head]
            head += 1
            for k in range(directions):
                target = site + offset[site & 1, k]
                if region[target] == 0:
                    region[target] = regions
                    queue[tail] = target
                    tail += 1
            if head == tail and tail > state[5]:
                state[4], state[5] = regions, tail
        elif region[start] == 0:
            regions += 1
            region[start] = regions
            queue[0] = start
            head, tail = 0, 1
        else:
            start += 1
    state[0], state[1], state[2], state[3] = start, head, tail, regions
