"""Cells: which ways lead on from a cell, to which region it belongs, whether somebody stands there.

A *region* is what leads to the same few destinations. A robot keeps to its region: of the best directions of a cell
those that lead elsewhere are taken away when the first robot comes there (`CHECKED`).
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, HELPER, IN_I32, OUT_I32, OUT_U16, declared, kernel
from trihex.planners.kernels.ways import WAYS, first_of, neighbour, without_first

# Flags of a cell above its direction bits.
DIRECTIONS = (1 << 12) - 1
OCCUPIED = 1 << 12
WATCHED = 1 << 13  # somebody may wait for it
CHECKED = 1 << 14  # its directions lead to its own region only
DESTINATION = 1 << 15
_U = np.uint64


class Cells(NamedTuple):
    """What is known of each site."""

    flags: OUT_U16  # bits of the best directions, and flags
    region: OUT_I32  # 1 + the number of its region, 0 while unknown


CELLS = declared(Cells)


@HELPER
def may_go(flags, k):
    """Tell, by the flags of a cell, whether a robot stands there to whom direction `k` is one of the best; as 1 or 0.

    Not before the cell is checked: until then the direction may lead to another region.
    """
    return (flags >> k) & (flags >> 12) & (flags >> 14) & 1


@HELPER
def _find_region(site, cells, ways):
    """Fill and return the region of a site: that of the destination at the end of its first best directions."""
    at = site
    while cells.region[_U(at)] == 0:
        at = neighbour(at, first_of(cells.flags[_U(at)]), ways)
    found = cells.region[_U(at)]
    at = site
    while cells.region[_U(at)] == 0:
        cells.region[_U(at)] = found
        at = neighbour(at, first_of(cells.flags[_U(at)]), ways)
    return found


@kernel(types.void(IN_I32, CELLS, WAYS, OUT_I32))
def find_regions(starts, cells, ways, region_of_robot):
    """Fill the region of each start; that of destinations is known."""
    for robot in range(len(starts)):
        region_of_robot[robot] = _find_region(np.int64(starts[robot]), cells, ways)


@APART
def check(site, own, cells, ways):
    """Leave of the best directions of a site those that lead to its own region, as the first does; return its flags."""
    here = cells.flags[_U(site)]
    cells.region[_U(site)] = own
    untried = without_first(np.int64(here & DIRECTIONS))
    while untried:
        k = first_of(untried)
        untried = without_first(untried)
        if _find_region(neighbour(site, k, ways), cells, ways) != own:
            here &= ~np.uint16(1 << k)
    here |= CHECKED
    cells.flags[_U(site)] = here
    return here
