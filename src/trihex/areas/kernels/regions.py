"""Connected parts of an area."""

from numba import types

from trihex.kernels.signatures import IN_BOOL, OUT_I32, OUT_I64, TABLE_I32, kernel


@kernel(types.void(IN_BOOL, TABLE_I32, types.int64, OUT_I64, OUT_I32, OUT_I32))
def label_regions(blocked, offset, budget, state, stack, region):
    """Fill `region` with the number of the region of each free site, counted from 0 by first site; -1 elsewhere.

    `state` holds the next site to look at, the height of the stack and the number of regions: zeros before the first
    call, and `region` all -1. Some `budget` sites are worked off in one call; the work is done when ``state[0]`` is the
    number of sites and ``state[1]`` is 0.
    """
    site, height, count = state[0], state[1], state[2]
    directions = offset.shape[1]
    while budget > 0 and (height > 0 or site < blocked.size):
        budget -= 1
        if height == 0:
            if not blocked[site] and region[site] < 0:
                region[site] = count
                stack[0] = site
                height = 1
                count += 1
            site += 1
            continue
        height -= 1
        at = stack[height]
        for k in range(directions):
            target = at + offset[at & 1, k]
            if not blocked[target] and region[target] < 0:
                region[target] = count - 1
                stack[height] = target
                height += 1
    state[0], state[1], state[2] = site, height, count
