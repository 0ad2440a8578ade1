"""Catchments: prices of exits at which robots that each go for the cheapest arrive soonest, all together.

An exit passes a robot every so often, its `gap`. Robots arrive there in order of their steps, each one gap after the
other at the soonest. Times are in parts of a step, `PARTS`, so that all sums are exact.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, IN_U16, OUT_I32, OUT_I64, declared, kernel
from trihex.planners.kernels.ways import WAYS, first_of, neighbour

PARTS = 256
_FAR = np.int64(-(1 << 60))


class Offers(NamedTuple):
    """Which exits each robot may go to: the entries of a robot follow each other."""

    first: IN_I64  # robot r has the entries first[r] .. first[r + 1] - 1
    exit: IN_I32
    distance: IN_I64
    steps: IN_I32
    robot: IN_I32
    first_of_exit: IN_I64  # exit d has the entries of_exit[first_of_exit[d]] .. of_exit[first_of_exit[d + 1] - 1]
    of_exit: IN_I64  # of robots that have several, exit by exit


class Shares(NamedTuple):
    """Who goes where, at which prices."""

    price: OUT_I64  # of an exit
    gap: OUT_I64  # between two robots that an exit lets pass, in parts of a step
    time: OUT_I64  # when the robots of an exit arrive, all together, in parts of a step
    chosen: OUT_I64  # the entry that a robot has chosen
    count: types.Array(types.int32, 2, "C")  # robots by exit and steps
    moved: OUT_I64  # stack of entries that are tried; as many as there are robots
    touched: OUT_I64  # stack of exits, and
    is_touched: OUT_I32  # whether an exit is there
    waiting_cost: types.int64  # of a step


OFFERS, SHARES = declared(Offers), declared(Shares)


@kernel(types.void(IN_I32, IN_U16, WAYS, OUT_I32))
def fill_catchments(sites, best, ways, catchment):
    """Fill of each site in which catchment it lies, that of the destination where its first best directions lead.

    ``catchment[site]`` is known of destinations, and -1 elsewhere.
    """
    for i in range(len(sites)):
        at = np.int64(sites[i])
        while catchment[at] < 0:
            at = neighbour(at, first_of(np.int64(best[at])), ways)
        found = catchment[at]
        at = np.int64(sites[i])
        while catchment[at] < 0:
            catchment[at] = found
            at = neighbour(at, first_of(np.int64(best[at])), ways)


@HELPER
def _time_of(exit, gap, shares):
    """Return when the robots of an exit arrive, all together, if it lets one pass every so often."""
    total, last = np.int64(0), _FAR
    for steps in range(shares.count.shape[1]):
        count = np.int64(shares.count[exit, steps])
        if count > 0:
            begin = max(np.int64(steps * PARTS), last + gap)
            total += count * begin + gap * (count * (count - 1) // 2)
            last = begin + (count - 1) * gap
    return total


@kernel(types.void(IN_I64, IN_I64, types.int64, SHARES))
def find_gaps(wanted, least, most, shares):
    """Find the gap of each exit so that its robots arrive as late, all together, as they have done."""
    for exit in range(len(wanted)):
        low, high = least[exit], most
        while low < high:
            gap = (low + high) // 2
            if _time_of(exit, gap, shares) < wanted[exit]:
                low = gap + 1
            else:
                high = gap
        shares.gap[exit] = low
        shares.time[exit] = _time_of(exit, low, shares)


@HELPER
def _cheapest(robot, exit, price, offers, shares):
    """Return the cheapest entry of a robot if an exit has another price; of equal ones that chosen already."""
    chosen = shares.chosen[robot]
    best = chosen
    least = offers.distance[chosen] + (price if offers.exit[chosen] == exit else shares.price[offers.exit[chosen]])
    for entry in range(offers.first[robot], offers.first[robot + 1]):
        other = np.int64(offers.exit[entry])
        cost = offers.distance[entry] + (price if other == exit else shares.price[other])
        if cost < least:
            least, best = cost, entry
    return best


@HELPER
def _touch(exit, touched, shares):
    """Put an exit on the stack of those that change, unless it is there; return how many there are."""
    if shares.is_touched[exit]:
        return touched
    shares.is_touched[exit] = 1
    shares.touched[touched] = exit
    return touched + 1


@HELPER
def _rest_of(entry, offers, shares):
    """Return what a robot pays beside its waits from the start until it arrives, in parts."""
    return PARTS * (offers.distance[entry] - shares.waiting_cost * np.int64(offers.steps[entry]))


@HELPER
def _choose(entry, offers, shares):
    """Let a robot choose an entry; return the one it had chosen, and what it pays more beside waits."""
    robot = np.int64(offers.robot[entry])
    before = shares.chosen[robot]
    shares.count[offers.exit[before], offers.steps[before]] -= 1
    shares.count[offers.exit[entry], offers.steps[entry]] += 1
    shares.chosen[robot] = entry
    return before, _rest_of(entry, offers, shares) - _rest_of(before, offers, shares)


@HELPER
def _is_better(exit, price, offers, shares):
    """Give an exit a price if all robots together pay less by that; tell whether they do."""
    moved, touched, change = 0, 0, np.int64(0)
    for i in range(offers.first_of_exit[exit], offers.first_of_exit[exit + 1]):
        robot = np.int64(offers.robot[offers.of_exit[i]])
        if price > shares.price[exit] and offers.exit[shares.chosen[robot]] != exit:
            continue
        entry = _cheapest(robot, exit, price, offers, shares)
        if entry != shares.chosen[robot]:
            before, more = _choose(entry, offers, shares)
            change += more
            shares.moved[moved] = before
            moved += 1
            touched = _touch(np.int64(offers.exit[before]), touched, shares)
            touched = _touch(np.int64(offers.exit[entry]), touched, shares)
    for i in range(touched):
        other = shares.touched[i]
        shares.is_touched[other] = 0
        change += shares.waiting_cost * (_time_of(other, shares.gap[other], shares) - shares.time[other])
    if change >= 0:
        for i in range(moved):
            _choose(shares.moved[i], offers, shares)
        return False
    for i in range(touched):
        other = shares.touched[i]
        shares.time[other] = _time_of(other, shares.gap[other], shares)
    shares.price[exit] = price
    return True


@kernel(types.boolean(types.int64, OFFERS, SHARES))
def change_prices(step, offers, shares):
    """Raise and lower the price of each exit in turn by a step, as long as that is better; tell whether it ever was."""
    has_changed = False
    for exit in range(len(shares.price)):
        for change in (step, -step):
            while _is_better(exit, shares.price[exit] + change, offers, shares):
                has_changed = True
    return has_changed
