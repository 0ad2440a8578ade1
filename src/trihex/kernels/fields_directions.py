"""Fields of directions: which moves attain the distance of each site, and how many moves the longest way takes."""

import numpy as np
from numba import njit, types

from trihex.kernels.signatures import IN_I32, OUT_U16, TABLE_I32

BLOCK = 4096  # even; a block of sites and its neighbours stay in the cache while all directions are tried


@njit(types.void(IN_I32, TABLE_I32, IN_I32, types.int64, types.int64, OUT_U16), cache=True, nogil=True)
def fill_directions(distance, offset, cost, first, last, directions):
    """Set bit k of ``directions[site]`` where direction k attains the distance of the site; first..last-1, first even.

    Where nothing was reached, `distance` is so large that no neighbour can be a move nearer.
    """
    for start in range(first, last, BLOCK):
        stop = min(start + BLOCK, last)
        here = distance[start:stop]
        bits = directions[start:stop]
        bits[:] = 0
        for k in range(len(cost)):
            step = cost[k]
            bit = np.uint16(1 << k)
            if offset[0, k] == offset[1, k]:
                there = distance[start + offset[0, k] : stop + offset[0, k]]
                for i in range(len(bits)):
                    bits[i] |= bit if np.int32(here[i] - there[i]) == step else np.uint16(0)
            else:
                for orientation in range(2):
                    there = distance[start + offset[orientation, k] : stop + offset[orientation, k]]
                    for i in range(len(bits)):
                        is_best = (np.int32(here[i] - there[i]) == step) & (i & 1 == orientation)
                        bits[i] |= bit if is_best else np.uint16(0)
