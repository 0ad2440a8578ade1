"""Lines: where robots stand on the shortest ways, and how many wait there for those before them.

As the slots of the planners, but nothing is kept that a change of the world would spoil: the branch of a cell of the
forest of shortest ways, and its steps to the end, are found when first asked for and stamped with the version of the
field.

A *slot* is a place in line in one number: ``branch << 32 | steps``, the last site before the destination and the steps
to the end of the way. Sorted, the slots of a branch stand together, the nearest first.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import (
    APART,
    HELPER,
    IN_I32,
    IN_I64,
    IN_U16,
    OUT_I32,
    OUT_I64,
    TABLE_I32,
    declared,
    kernel,
)

_NONE = np.int64(-1)


class LivingWays(NamedTuple):
    """The field, and the ways from site to site."""

    distance: IN_I32  # of each site
    moves: IN_U16  # of each site, bit k: direction k is open
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    vertex: TABLE_I32  # the same for the lattice vertex passed
    cost: IN_I32  # of each direction


class Forest(NamedTuple):
    """Shortest ways by the first best direction, as far as they have been asked for."""

    version: types.int64  # of the field
    seen: OUT_I32  # the version in which branch and steps of a site were found
    branch: OUT_I32  # the last site before the destination on the way from each site
    steps: OUT_I32  # on the way from each site


class WaitingLines(NamedTuple):
    """How long the lines are, see `line_up`."""

    slot: OUT_I64  # that is taken, ascending
    length: OUT_I64  # of the line in each of them
    count: types.int64  # how many there are


@HELPER
def _next_on_way(site, ways):
    """Return where the first best direction leads from a site that is reached and no destination."""
    distance, offset = ways.distance, ways.offset
    for k in range(len(ways.cost)):
        if ways.moves[site] >> k & 1:
            target = np.int64(site + offset[site & 1, k])
            if distance[target] == distance[site] - ways.cost[k]:
                return target
    return _NONE


@APART
def _walk(site, ways, forest):
    """Find branch and steps of a site and of all on its way."""
    at = site
    walked = np.int64(0)
    while forest.seen[at] != forest.version:
        parent = _next_on_way(at, ways)
        if ways.distance[parent] == 0:
            forest.seen[at] = forest.version
            forest.branch[at] = at
            forest.steps[at] = 1
            break
        at = parent
        walked += 1
    branch = forest.branch[at]
    steps = forest.steps[at] + walked
    at = site
    while forest.seen[at] != forest.version:
        forest.seen[at] = forest.version
        forest.branch[at] = branch
        forest.steps[at] = steps
        steps -= 1
        at = _next_on_way(at, ways)


@HELPER
def slot_of(site, ways, forest):
    """Return the slot of a site that is reached and no destination."""
    if forest.seen[site] != forest.version:
        _walk(site, ways, forest)
    return np.int64(forest.branch[site]) << 32 | np.int64(forest.steps[site])


@kernel(types.void(IN_I32, declared(LivingWays), declared(Forest), OUT_I64))
def find_slots(sites, ways, forest, slots):
    """Fill the slots of `sites`."""
    for i in range(len(sites)):
        slots[i] = slot_of(np.int64(sites[i]), ways, forest)


@kernel(types.int64(IN_I64, types.int64, OUT_I64, OUT_I64))
def line_up(slots, headway, slot_of_line, line):
    """Fill how long the line is in each slot that is taken, given the sorted slots of all robots; return how many.

    With each step towards the end of the branch it becomes one place shorter; each of those that stand in the slot adds
    `headway` places, the number of the shortest moves that lie between two robots that go through one cell.
    """
    count = 0
    for i in range(len(slots)):
        if count > 0 and slots[i] == slot_of_line[count - 1]:
            line[count - 1] += headway
            continue
        line[count] = headway
        if count > 0 and slots[i] >> 32 == slot_of_line[count - 1] >> 32:
            line[count] += max(0, line[count - 1] - (slots[i] - slot_of_line[count - 1]))
        slot_of_line[count] = slots[i]
        count += 1
    return count


@HELPER
def line_at(slot, lines):
    """Return how long the line is that a robot finds in a slot."""
    low, high = np.int64(0), lines.count
    while low < high:
        middle = (low + high) // 2
        if lines.slot[middle] <= slot:
            low = middle + 1
        else:
            high = middle
    if low == 0 or lines.slot[low - 1] >> 32 != slot >> 32:
        return np.int64(0)
    return max(np.int64(0), lines.length[low - 1] - (slot - lines.slot[low - 1]))
