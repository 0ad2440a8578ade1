"""Choice: what a robot would do, the least Fcost of what it can do.

Fcost is v + V + w_t * c, the cost of a move, the distance from there, and what c others on the way cost (section IV of
the paper).
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, declared
from trihex.planners.kernels.slots import LEAD, find_slot
from trihex.planners.kernels.traffic import Now, is_full, is_passed
from trihex.planners.kernels.ways import first_of, neighbour, vertex_of, without_first

# What c counts: robots that will be in my slot, or the line that they have formed in it by the time I am there.
# Nothing at all: robots descend.
MEETINGS, QUEUE, NOTHING = 0, 1, 2
# When a blocked robot steps aside: never; to a place no farther than its own, if that is worth a wait; whenever there
# is one that it has not just left.
STAY, WORTH, ALWAYS = 0, 1, 2
_FAR = np.int64(1 << 60)
_WAIT = np.int64(WAIT)
NOBODY = np.int64(0)
_U = np.uint64


class Rule(NamedTuple):
    """How robots weigh."""

    counts: types.int64  # what c counts
    aside: types.int64  # when to step aside
    period: types.int64  # every how many steps lines are counted anew, and a robot whose way is free looks for a better
    price: types.int64  # of a collision, w_t in the paper


class Turn(NamedTuple):
    """The region under way, and the step."""

    captain: types.int64  # the robot that is asked first, and descends
    first_slot: types.int64  # the region has the slots from this one on
    end_slot: types.int64  # to the one before this
    first_end: types.int64  # what its destinations have in place of a slot: from this number on
    last_end: types.int64  # to this one
    now: Now  # the step


class Choice(NamedTuple):
    """What a robot would do."""

    direction: types.int64  # that it would take, or `WAIT`
    to: types.int64  # the site to which that leads
    via: types.int64  # the vertex that it passes, 0: none
    fcost: types.int64  # of that direction
    best: types.int64  # the least Fcost of all that was weighed, free or not


RULE = declared(Rule)


@HELPER
def is_of_region(slot, turn):
    """Tell whether a slot, or a destination, belongs to the region under way."""
    if slot > 0:
        return turn.first_slot <= slot < turn.end_slot
    return turn.first_end <= slot <= turn.last_end


@HELPER
def slot_of(site, ways, sites, slots):
    """Return the slot of a site, found now if nobody has asked for it before."""
    slot = np.int64(sites.slot[_U(site)])
    return slot if slot != 0 else np.int64(find_slot(site, ways, sites, slots))


@HELPER
def _collisions(slot, own_slot, slots):
    """Return how many others a robot meets, or finds in line, if it goes on from a slot."""
    return np.int64(slots.line[_U(slot + 1)] & (LEAD - 1)) - (slot + 1 == own_slot)


@HELPER
def weigh_best(site, own, descends, turn, rule, ways, sites, slots, traffic, asking):
    """Weigh the best directions; return the choice and who stands in the way and is to be asked first.

    Who was listed before `own` has been asked in this step, or stands in the way of one that is being asked.
    """
    own_slot, own_distance = np.int64(sites.slot[_U(site)]), np.int64(sites.distance[_U(site)])
    direction, to, via, least, best = _WAIT, site, np.int64(0), _FAR, _FAR
    untried = np.int64(sites.best[_U(site)])
    while untried:
        k = first_of(untried)
        untried = without_first(untried)
        target = neighbour(site, k, ways)
        slot = slot_of(target, ways, sites, slots)
        if not is_of_region(slot, turn):
            continue
        fcost = own_distance
        if slot > 0:
            fcost += rule.price * _collisions(slot, own_slot, slots)
        best = min(best, fcost)
        other = np.int64(traffic.robot_at[_U(target)])
        if other:
            if other > own and asking.asked[_U(other)] != turn.now.step:
                return Choice(direction, to, via, least, best), other
            continue
        vertex = vertex_of(site, k, ways)
        if is_passed(vertex, traffic, turn.now) or is_full(target, ways.entry_limit, traffic, turn.now):
            continue
        if fcost < least:
            direction, to, via, least = k, target, vertex, fcost
            if descends:
                break
    return Choice(direction, to, via, least, best), NOBODY


@HELPER
def weigh_others(site, choice, turn, rule, ways, sites, slots, traffic):
    """Weigh all other directions; return the choice, which may be another one."""
    own_slot = np.int64(sites.slot[_U(site)])
    direction, to, via, least, best = choice
    untried = np.int64(sites.moves[_U(site)] & ~sites.best[_U(site)])
    while untried:
        k = first_of(untried)
        untried = without_first(untried)
        target = neighbour(site, k, ways)
        fcost = np.int64(ways.cost[_U(k)]) + sites.distance[_U(target)]
        if fcost >= least:
            continue
        slot = slot_of(target, ways, sites, slots)
        if slot < turn.first_slot or slot >= turn.end_slot:
            continue
        fcost += rule.price * _collisions(slot, own_slot, slots)
        best = min(best, fcost)
        if fcost >= least or traffic.robot_at[_U(target)]:
            continue
        vertex = vertex_of(site, k, ways)
        if not is_passed(vertex, traffic, turn.now):
            direction, to, via, least = k, target, vertex, fcost
    return Choice(direction, to, via, least, best)


@HELPER
def stays(robot, site, choice, rule, ways, sites, asking):
    """Tell whether a robot had better wait than take its choice."""
    worth = choice.best + ways.waiting_cost
    if choice.direction == WAIT or choice.fcost == choice.best or choice.fcost < worth:
        return False
    here, there = sites.distance[_U(site)], sites.distance[_U(choice.to)]
    if rule.aside == STAY or there > here:
        return True
    if rule.aside == WORTH:
        return choice.fcost > worth
    return there == here and choice.to == asking.came_from[_U(robot)]
