"""Robots that weigh a longer way against waiting, by the paper's Fcost, see `choice`.

They are simulated region by region, a block of steps in each, as in `greedy`.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, IN_I64, OUT_I32, declared, kernel
from trihex.planners.kernels.choice import MEETINGS, NOBODY, QUEUE, RULE, Choice, Turn, stays, weigh_best, weigh_others
from trihex.planners.kernels.robots import ROBOTS
from trihex.planners.kernels.rows import ROWS
from trihex.planners.kernels.slots import LEAD, SITES, SLOTS, count_meetings, line_up, measure_lines
from trihex.planners.kernels.traffic import TRAFFIC, Now, note_entry, note_passing
from trihex.planners.kernels.ways import WAYS, first_of, neighbour

_U = np.uint64
_ONE = np.int64(1)  # how many places in a line a robot takes up


class Asking(NamedTuple):
    """Who has been asked, by robot; and who is to be asked."""

    row: OUT_I32  # of a robot
    asked: OUT_I32  # the step in which it was asked last
    came_from: OUT_I32  # the site where it was before it moved last
    captain_of_region: OUT_I32  # who is asked first, 0: not known
    waiting: OUT_I32  # a stack of those that are asked after others who stand in their way


ASKING = declared(Asking)


@HELPER
def _move(robot, site, choice, turn, ways, sites, slots, traffic, robots, asking):
    """Let a robot take its choice; return what it loses: the cost beyond what it comes nearer."""
    to = choice.to
    note_passing(choice.via, traffic, turn.now)
    asking.came_from[_U(robot)] = site
    traffic.robot_at[_U(site)] = 0
    slots.count[_U(sites.slot[_U(site)])] -= 1
    if sites.slot[_U(to)] < 0:
        robots.arrival[_U(robot)] = turn.now.step
        robots.site[_U(robot)] = 0
        note_entry(to, ways.entry_limit, traffic, turn.now)
    else:
        traffic.robot_at[_U(to)] = robot
        robots.site[_U(robot)] = to
        slots.count[_U(sites.slot[_U(to)])] += 1
    return np.int64(ways.cost[_U(choice.direction)]) + sites.distance[_U(to)] - sites.distance[_U(site)]


@HELPER
def _ask(own, turn, rule, ways, sites, slots, traffic, robots, asking, rows):
    """Ask a robot what it does, after those who stand in its way; return what they lose.

    The captain asks nobody, and nobody listed before `own` is asked again.
    """
    loss = np.int64(0)
    robot, depth = own, 0
    while asking.asked[_U(own)] != turn.now.step:
        site = np.int64(robots.site[_U(robot)])
        slot = sites.slot[_U(site)]
        descends = robot == turn.captain or (rule.counts == MEETINGS and slots.line[_U(slot)] & LEAD != 0)
        choice, other = weigh_best(site, own, descends, turn, rule, ways, sites, slots, traffic, asking)
        if other != NOBODY and own != turn.captain:
            asking.waiting[_U(depth)] = robot
            depth += 1
            robot = other
            continue
        if descends and choice.direction != WAIT:
            slots.line[_U(slot)] &= LEAD - 1
        elif choice.fcost > sites.distance[_U(site)] and (
            rule.counts == MEETINGS or choice.direction == WAIT or (turn.now.step + robot) % rule.period == 0
        ):
            choice = weigh_others(site, choice, turn, rule, ways, sites, slots, traffic)
            if stays(robot, site, choice, rule, ways, sites, asking):
                choice = Choice(np.int64(WAIT), site, np.int64(0), choice.fcost, choice.best)
        asking.asked[_U(robot)] = turn.now.step
        rows.action[_U(asking.row[_U(robot)] * rows.steps + turn.now.s)] = choice.direction
        if choice.direction == WAIT:
            loss += ways.waiting_cost
        else:
            loss += _move(robot, site, choice, turn, ways, sites, slots, traffic, robots, asking)
        if depth > 0:
            depth -= 1
            robot = np.int64(asking.waiting[_U(depth)])
    return loss


@HELPER
def _begin(region, first_row, rule, sites, slots, robots, asking, rows):
    """Give each robot of a region a row, and find how far its lines may reach."""
    first_branch, last_branch = slots.first_branch_of_region[region], slots.first_branch_of_region[region + 1]
    for branch in range(first_branch, last_branch):
        slots.highest[branch] = 0
    first, row = robots.first_of_region[region], first_row
    for j in range(first, first + robots.count_of_region[region]):
        robot = robots.listed[j]
        asking.row[robot] = row
        rows.robot[row] = robot
        row += 1
        slot = sites.slot[robots.site[robot]]
        branch = slots.branch_of_slot[slot]
        slots.highest[branch] = max(slots.highest[branch], slot)
    if rule.counts == QUEUE:
        for branch in range(first_branch, last_branch):
            measure_lines(branch, rows.steps, _ONE, slots)


@HELPER
def _count(region, s, rule, slots):
    """Count anew, where it is due, who is in each slot of a region."""
    for branch in range(slots.first_branch_of_region[region], slots.first_branch_of_region[region + 1]):
        if rule.counts == MEETINGS:
            count_meetings(slots.first_slot[branch], slots.first_slot[branch + 1], slots)
        elif s % rule.period == 0:
            line_up(slots.first_slot[branch], slots.lined_end[branch], _ONE, slots)


@HELPER
def _find_captain(region, ways, sites, traffic, robots, asking):
    """Return who is at the head of the way of the captain: the cell its first best direction leads to is free."""
    captain = np.int64(asking.captain_of_region[region])
    if captain == 0 or robots.site[captain] == 0:
        captain = np.int64(robots.listed[robots.first_of_region[region]])
    while True:
        site = np.int64(robots.site[captain])
        ahead = np.int64(traffic.robot_at[neighbour(site, first_of(sites.best[site]), ways)])
        if ahead == 0:
            asking.captain_of_region[region] = captain
            return captain
        captain = ahead


@HELPER
def _turn_of(region, captain, slots, now):
    """Return the turn of a region."""
    first, last = slots.first_branch_of_region[region], slots.first_branch_of_region[region + 1]
    ends = slots.first_end_of_region
    return Turn(captain, slots.first_slot[first], slots.first_slot[last], -ends[region + 1], -1 - ends[region], now)


@HELPER
def _step(region, now, rule, ways, sites, slots, traffic, robots, asking, rows):
    """Let the robots of a region act in one step, the captain first; return what they lose."""
    _count(region, now.s, rule, slots)
    captain = _find_captain(region, ways, sites, traffic, robots, asking)
    turn = _turn_of(region, captain, slots, now)
    loss = np.int64(0)
    first = kept = robots.first_of_region[region]
    for j in range(first - 1, first + robots.count_of_region[region]):
        own = np.int64(robots.listed[j]) if j >= first else captain
        loss += _ask(own, turn, rule, ways, sites, slots, traffic, robots, asking, rows)
        if j >= first:
            robots.listed[_U(kept)] = own
            kept += robots.site[_U(own)] > 0
    robots.count_of_region[region] = kept - first
    return loss


@kernel(types.int64(RULE, WAYS, SITES, SLOTS, ASKING, IN_I64, TRAFFIC, ROBOTS, ROWS))
def weigh(rule, ways, sites, slots, asking, regions, traffic, robots, rows):
    """Let the robots of some regions act for a block of steps; fill `rows` and return what they lose.

    Each robot takes the free direction of least Fcost, unless waiting for the best direction promises less. In each
    region one robot, the captain, or who stands at the head of its way, is asked first and descends; so a captain
    arrives in bounded time, and then there is another. Robots lose the cost of waits, and of moves beyond what they
    come nearer.
    """
    first_row = np.int64(0)  # no literal, for which numba would compile all helpers anew
    loss = np.int64(0)
    for region in regions:
        _begin(region, first_row, rule, sites, slots, robots, asking, rows)
        first_row += robots.count_of_region[region]
        for s in range(rows.steps):
            if robots.count_of_region[region] == 0:
                break
            now = Now(rows.block, s, rows.first_step + s + 1)
            loss += _step(region, now, rule, ways, sites, slots, traffic, robots, asking, rows)
    return loss
