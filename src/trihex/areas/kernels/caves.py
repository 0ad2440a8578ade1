"""Caves smoothed."""

import numpy as np
from numba import types

from trihex.kernels.signatures import IN_BOOL, OUT_BOOL, TABLE_I32, kernel


@kernel(types.void(IN_BOOL, types.int64, types.int64, TABLE_I32, OUT_BOOL))
def smooth(blocked, first, last, offset, smoothed):
    """Let each of the sites first..last-1 become what most of itself and its neighbours are."""
    directions = offset.shape[1]
    for site in range(first, last):
        parity = site & 1
        count = 2 * blocked[site] - 1
        for k in range(directions):
            count += 2 * blocked[np.uint64(site + offset[parity, k])] - 1  # unsigned: it never counts from the end
        smoothed[site] = count > 0
