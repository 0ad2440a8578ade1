"""Slots: who will be in whose way, by look-up.

Following the first of the best directions from every cell makes a forest; the cells whose ways enter a destination by
the same last move form a *branch*. On a forest two robots meet on their shortest ways if and only if they are in one
branch and equally many steps from its end. So each (branch, steps) is a *slot* with a number, slots of a branch in
order of steps, and what the paper counts over n - 1 paths is one look-up in a table of robots by slot. (The slot bound
and the optimum have slots as well: there they are steps in which somebody can arrive.)

Slots are found when they are first asked for: a cell where nobody ever comes costs nothing. A branch has slots up to
some depth; what is deeper is in its last.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, IN_U16, OUT_I32, OUT_I64, declared, kernel
from trihex.planners.kernels.ways import WAYS, first_of, neighbour

# Flag of a line: the first robot of its branch stands here.
LEAD = 1 << 30


class Sites(NamedTuple):
    """What is known of each site."""

    distance: IN_I32  # V, to the nearest destination, or along lanes
    moves: IN_U16  # the directions that are open, a bit each
    best: IN_U16  # the best of them, a bit each; the first makes the forest
    slot: OUT_I32  # 0 while unknown; -1 - (number of the destination) at destinations


class Slots(NamedTuple):
    """Branches, region by region; their slots, from 1, branch by branch; and the robots in them."""

    branch_of_end: IN_I32  # the branch of each (number of a destination * directions + last direction)
    first_slot: IN_I64  # branch b has the slots first_slot[b] .. first_slot[b + 1] - 1
    branch_of_slot: IN_I32  # the branch to which a slot belongs
    count: OUT_I32  # how many robots are in a slot
    line: OUT_I32  # how many robots one finds there, see `line_up` and `count_meetings`
    highest: OUT_I64  # the last slot of a branch that held a robot when the block began, 0: none
    lined_end: OUT_I64  # where in a branch lines end: from there on they are 0
    first_branch_of_region: IN_I64  # region r has the branches from this one to that of r + 1
    first_end_of_region: IN_I64  # and its destinations have the numbers from this one on


SITES, SLOTS = declared(Sites), declared(Slots)


@kernel(types.void(IN_I32, IN_U16, WAYS, IN_I32, OUT_I32, OUT_I32))
def find_branches(starts, best, ways, number_of_destination, label, branch):
    """Fill the branch of each start: number of its destination * directions + last direction.

    ``number_of_destination[site]`` is -1 elsewhere; ``label`` is 0 at first, and branch + 1 on the ways afterwards.
    """
    for i in range(len(starts)):
        at = np.int64(starts[i])
        k = np.int64(0)
        while label[at] == 0 and number_of_destination[at] < 0:
            k = first_of(best[at])
            at = neighbour(at, k, ways)
        found = label[at] if label[at] > 0 else number_of_destination[at] * ways.count + k + 1
        branch[i] = found - 1
        at = np.int64(starts[i])
        while label[at] == 0 and number_of_destination[at] < 0:
            label[at] = found
            at = neighbour(at, first_of(best[at]), ways)


@HELPER
def find_slot(site, ways, sites, slots):
    """Fill and return the slot of a site."""
    best, slot = sites.best, sites.slot
    at = site
    k = np.int64(0)
    steps = 0
    while slot[at] == 0:
        k = first_of(best[at])
        at = neighbour(at, k, ways)
        steps += 1
    if steps == 0:
        return slot[at]
    if slot[at] < 0:
        branch = slots.branch_of_end[(-1 - slot[at]) * ways.count + k]
        deepest = slots.first_slot[branch] - 1 + steps
    else:
        branch = slots.branch_of_slot[slot[at]]
        deepest = slot[at] + steps
    last = slots.first_slot[branch + 1] - 1
    at = site
    while slot[at] == 0:
        slot[at] = min(deepest, last)
        deepest -= 1
        at = neighbour(at, first_of(best[at]), ways)
    return slot[site]


@kernel(types.void(IN_I32, WAYS, SITES, SLOTS))
def find_slots(starts, ways, sites, slots):
    """Fill the slots of some sites."""
    for i in range(len(starts)):
        find_slot(np.int64(starts[i]), ways, sites, slots)


@HELPER
def line_up(first, last, places, slots):
    """Fill how long the line is that a robot finds in its slot: in each step it is one shorter, those of the slot join.

    Each takes up so many `places` in the line.
    """
    waiting = np.int32(0)
    for slot in range(first, last):
        waiting = max(np.int32(0), waiting - np.int32(1)) + slots.count[slot] * np.int32(places)
        slots.line[slot] = waiting
    return waiting


@HELPER
def measure_lines(branch, steps, places, slots):
    """Find how far the line of a branch may reach in the next `steps` steps, and clear what lies beyond."""
    end = slots.first_slot[branch]
    if slots.highest[branch] > 0:
        waiting = line_up(end, slots.highest[branch] + 1, places, slots)
        end = min(slots.first_slot[branch + 1], slots.highest[branch] + 1 + max(waiting, steps))
    for slot in range(end, slots.lined_end[branch]):
        slots.line[slot] = 0
    slots.lined_end[branch] = end


@HELPER
def count_meetings(first, last, slots):
    """Fill how many robots are in each slot, and mark the first slot that is not empty."""
    is_first = True
    for slot in range(first, last):
        slots.line[slot] = slots.count[slot]
        if is_first and slots.count[slot] > 0:
            slots.line[slot] |= LEAD
            is_first = False
