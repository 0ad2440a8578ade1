"""Estimates: what the way from a site in a step to a destination costs at least, as far as it is known.

A site costs its distance, and more: by what earlier searches have learned, and by ways of so many steps, because no
destination can be entered before a certain one. Entries are what comes to the distance, 2 bytes each.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.signatures import HELPER, OUT_U16, declared, kernel
from trihex.planners.kernels.reservations import TERRAIN

MOST_MORE = 65535  # what is more is estimated too low


class Estimates(NamedTuple):
    """Tables of rows of all sites."""

    rows: types.int64  # how many `learned` has, one for each step
    learned: OUT_U16  # what is more from a site in a step
    longer_rows: types.int64  # how many `longer` has
    longer: OUT_U16  # row n: what is more from a site in n steps or more, whatever is reserved


ESTIMATES = declared(Estimates)


@HELPER
def least_left(site, step, earliest, terrain, estimates):
    """Return what it costs at least to get from a site in a step to a destination, not before the step `earliest`."""
    size, distance = len(terrain.distance), np.int64(terrain.distance[site])
    left, steps = distance, earliest - step
    if step < estimates.rows:
        left += estimates.learned[step * size + site]
    if steps <= 0:
        return left
    if steps < estimates.longer_rows:
        return max(left, distance + estimates.longer[steps * size + site])
    return max(left, steps * terrain.least_cost)


@HELPER
def _least_in(steps, site, terrain, longer):
    """Return what a way from a site costs that takes so many steps or more, from the rows of fewer steps."""
    size, distance = len(terrain.distance), np.int64(terrain.distance[site])
    least = distance + MOST_MORE
    if distance == 0:
        return least  # nobody stays at a destination
    least = min(least, terrain.waiting_cost + distance + longer[(steps - 1) * size + site])
    for k in range(len(terrain.cost)):
        if terrain.moves[site] >> k & 1:
            target, before = site + terrain.offset[site & 1, k], max(0, steps - np.int64(terrain.duration[k]))
            beyond = np.int64(terrain.distance[target]) + longer[before * size + target]
            least = min(least, terrain.cost[k] + beyond)
    return least


@kernel(types.void(types.int64, types.int64, TERRAIN, ESTIMATES))
def fill_longer(first, last, terrain, estimates):
    """Fill the rows `first` to the one before `last` of `longer`; those before are filled, and row 0 is all 0."""
    size = len(terrain.distance)
    for steps in range(first, last):
        for site in range(size):
            if terrain.distance[site] != NOT_REACHED:
                more = _least_in(steps, site, terrain, estimates.longer) - terrain.distance[site]
                estimates.longer[steps * size + site] = more
