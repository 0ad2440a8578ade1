"""Slots: who will be in whose way, by look-up.

Following the first of the best directions from every cell makes a forest; the cells whose ways enter a destination by
the same last move form a *branch*. On a forest two robots meet on their shortest ways if and only if they are in one
branch and equally many steps from its end. So each (branch, steps) is a *slot* with a number, slots of a branch in
order of steps, and what the paper counts over n - 1 paths is one look-up in a table of robots by slot.

Slots are found when they are first asked for: a cell where nobody ever comes costs nothing. ``slot[site]`` is 0 while
unknown, and -1 - (number of the destination) at destinations. A branch has slots up to some depth; what is deeper is in
its last.
"""

import numpy as np
from numba import njit, types
from numba.cpython.unsafe.numbers import trailing_zeros

from trihex.kernels.signatures import IN_I32, IN_I64, IN_U16, OUT_I32, TABLE_I32

# Flag of a line: the first robot of its branch stands here.
LEAD = 1 << 30


@njit(types.void(IN_I32, IN_U16, TABLE_I32, IN_I32, OUT_I32, OUT_I32), cache=True, nogil=True)
def find_branches(starts, best, offset, number_of_destination, label, branch):
    """Fill the branch of each start: number of its destination * directions + last direction.

    ``number_of_destination[site]`` is -1 elsewhere; ``label`` is 0 at first, and branch + 1 on the ways afterwards.
    """
    directions = offset.shape[1]
    for i in range(len(starts)):
        at = starts[i]
        k = np.int64(0)
        while label[at] == 0 and number_of_destination[at] < 0:
            k = np.int64(trailing_zeros(best[at]))
            at += offset[at & 1, k]
        found = label[at] if label[at] > 0 else number_of_destination[at] * directions + k + 1
        branch[i] = found - 1
        at = starts[i]
        while label[at] == 0 and number_of_destination[at] < 0:
            label[at] = found
            at += offset[at & 1, trailing_zeros(best[at])]


@njit(nogil=True)
def find_slot(site, best, offset, branch_of_end, first_slot, branch_of_slot, slot):
    """Fill and return the slot of a site."""
    at = site
    k = np.int64(0)
    steps = 0
    while slot[at] == 0:
        k = np.int64(trailing_zeros(best[at]))
        at += offset[at & 1, k]
        steps += 1
    if steps == 0:
        return slot[at]
    if slot[at] < 0:
        branch = branch_of_end[(-1 - slot[at]) * offset.shape[1] + k]
        deepest = first_slot[branch] - 1 + steps
    else:
        branch = branch_of_slot[slot[at]]
        deepest = slot[at] + steps
    last = first_slot[branch + 1] - 1
    at = site
    while slot[at] == 0:
        slot[at] = min(deepest, last)
        deepest -= 1
        at += offset[at & 1, trailing_zeros(best[at])]
    return slot[site]


@njit(types.void(IN_I32, IN_U16, TABLE_I32, IN_I32, IN_I64, IN_I32, OUT_I32), cache=True, nogil=True)
def find_slots(sites, best, offset, branch_of_end, first_slot, branch_of_slot, slot):
    """Fill the slots of `sites`."""
    for i in range(len(sites)):
        find_slot(sites[i], best, offset, branch_of_end, first_slot, branch_of_slot, slot)


@njit(nogil=True)
def line_up(first, last, count, line):
    """Fill how long the line is that a robot finds in its slot: one leaves in each step, those of the slot join."""
    waiting = np.int32(0)
    for slot in range(first, last):
        waiting = max(np.int32(0), waiting - np.int32(1)) + count[slot]
        line[slot] = waiting
    return waiting


@njit(nogil=True)
def count_meetings(first, last, count, line):
    """Fill how many robots are in each slot, and mark the first slot that is not empty."""
    is_first = True
    for slot in range(first, last):
        line[slot] = count[slot]
        if is_first and count[slot] > 0:
            line[slot] |= LEAD
            is_first = False
