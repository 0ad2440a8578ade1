"""Numbers of steps to the nearest destination."""

from numba import types

from trihex.kernels.signatures import IN_U16, OUT_I32, TABLE_I32, kernel


@kernel(types.int64(IN_U16, TABLE_I32, OUT_I32, OUT_I32, types.int64, types.int64, types.int64))
def count_steps(moves, offset, steps, queue, head, tail, budget):
    """Go on with a search in breadth from ``queue[head:tail]``, at most `budget` sites; return the new tail."""
    for at in range(head, min(tail, head + budget)):
        site = queue[at]
        bits = moves[site]
        for k in range(offset.shape[1]):
            if bits >> k & 1:
                target = site + offset[site & 1, k]
                if steps[target] < 0:
                    steps[target] = steps[site] + 1
                    queue[tail] = target
                    tail += 1
    return tail
