"""Robots that act when it is time: each is asked when it has come to a centre, or when what it waits for becomes free.

They weigh a longer way against waiting as in `fcost`, or descend as in `greedy`, where moves last several ticks or a
cell is owned until a robot has left it (`claims`). Nobody is asked in between: waiting costs nothing. Robots are
simulated region by region, a block of ticks in each; within a tick they are asked in the order of their rank in the
region, from 0, and asked once more if a cell becomes free meanwhile.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import APART, HELPER, IN_I64, OUT_I32, OUT_I64, declared, kernel
from trihex.planners.kernels.choice import ALWAYS, NOTHING, RULE, STAY, Turn, is_of_region, slot_of
from trihex.planners.kernels.claims import (
    AWAITED,
    NEVER,
    STAGE,
    claim,
    duration_of,
    owner_of,
    tick_of_leave,
    tick_of_opening,
)
from trihex.planners.kernels.robots import ROBOTS
from trihex.planners.kernels.slots import line_up, measure_lines
from trihex.planners.kernels.tick_rows import TICK_ROWS
from trihex.planners.kernels.traffic import Now
from trihex.planners.kernels.ways import back_of, first_of, neighbour, without_first

_FAR = np.int64(1 << 60)
_WAIT = np.int64(WAIT)
_U = np.uint64


class Agenda(NamedTuple):
    """Whom to ask when; by robot but for the last two."""

    due: OUT_I32  # the tick at which it is asked next, `NEVER` if it sleeps
    done: OUT_I32  # the tick at which the last of its actions so far ends
    row: OUT_I32  # its row
    came_from: OUT_I32  # the site where it was before it moved last
    captain_of_region: OUT_I32  # who descends whatever that costs, 0: not known
    asked: OUT_I64  # for each tick of the block a bit for each rank: who is asked
    waiting: OUT_I32  # a stack of those that are asked after others who stand in their way


class Ledger(NamedTuple):
    """What robots have done and are to do."""

    first_row: types.int64  # of the region under way
    words: types.int64  # of `asked`, for each tick
    robots: ROBOTS
    rows: TICK_ROWS
    agenda: declared(Agenda)


class Aim(NamedTuple):
    """What a robot would do."""

    direction: types.int64  # that it would take now, or `WAIT`
    slot: types.int64  # of the cell to which that leads
    to: types.int64  # that cell
    fcost: types.int64  # of that direction
    best: types.int64  # the least Fcost of all that was weighed, open or not
    ready: types.int64  # the first tick after this one at which a best direction opens, `NEVER` if nobody knows


AGENDA = declared(Agenda)


@HELPER
def _put(robot, tick, ledger):
    """Let a robot be asked at a tick, or later than in this block."""
    agenda, rows = ledger.agenda, ledger.rows
    agenda.due[_U(robot)] = tick
    s = tick - rows.first_step
    if s < rows.steps:
        rank = np.int64(agenda.row[_U(robot)]) - ledger.first_row
        agenda.asked[_U(s * ledger.words + (rank >> 6))] |= np.int64(1) << (rank & 63)


@HELPER
def _line_before(slot, own_slot, rule, stage):
    """Return what it costs to stand in the line that one finds on the way from a slot."""
    return rule.price * (stage.slots.line[_U(slot + 1)] - stage.clock.headway * (slot + 1 == own_slot))


@HELPER
def _aim_best(robot, site, descends, turn, rule, stage, agenda):
    """Weigh the best directions; return the aim, and who stands in the way and has still to be asked at this tick."""
    sites, tick = stage.sites, turn.now.step
    own_slot = np.int64(sites.slot[_U(site)])
    direction, aimed, goal, least, best, ready, other = _WAIT, own_slot, site, _FAR, _FAR, NEVER, np.int64(0)
    untried = np.int64(sites.best[_U(site)])
    while untried:
        k = first_of(untried)
        untried = without_first(untried)
        to = neighbour(site, k, stage.ways)
        slot = slot_of(to, stage.ways, sites, stage.slots)
        if not is_of_region(slot, turn):
            continue
        fcost = np.int64(sites.distance[_U(site)])
        if rule.counts != NOTHING and slot > 0:
            fcost += _line_before(slot, own_slot, rule, stage)
        best = min(best, fcost)
        opens = tick_of_opening(robot, site, k, to, slot, tick, stage)
        if opens == NEVER:
            blocking = owner_of(to, stage.claims)
            if agenda.due[_U(blocking)] == tick:
                other = blocking
            stage.claims.owner[_U(to)] |= AWAITED
        elif opens > tick:
            ready = min(ready, opens)
        elif fcost < least:
            direction, aimed, goal, least = k, slot, to, fcost
            if descends:
                break
    return Aim(direction, aimed, goal, least, best, ready), other


@HELPER
def _aim_elsewhere(robot, site, aim, turn, rule, stage):
    """Weigh all other directions; return the aim, which may be another one."""
    sites, tick = stage.sites, turn.now.step
    own_slot = np.int64(sites.slot[_U(site)])
    direction, aimed, goal, least, best, ready = aim
    untried = np.int64(sites.moves[_U(site)] & ~sites.best[_U(site)])
    while untried:
        k = first_of(untried)
        untried = without_first(untried)
        to = neighbour(site, k, stage.ways)
        fcost = np.int64(stage.ways.cost[_U(k)]) + sites.distance[_U(to)]
        if fcost >= least:
            continue
        slot = slot_of(to, stage.ways, sites, stage.slots)
        if slot < turn.first_slot or slot >= turn.end_slot:
            continue
        fcost += _line_before(slot, own_slot, rule, stage)
        best = min(best, fcost)
        if fcost < least and tick_of_opening(robot, site, k, to, slot, tick, stage) == tick:
            direction, aimed, goal, least = k, slot, to, fcost
    return Aim(direction, aimed, goal, least, best, ready)


@HELPER
def _stays(robot, site, aim, patience, rule, sites, agenda):
    """Tell whether a robot had better wait than take its aim."""
    worth = aim.best + patience
    if aim.direction == WAIT or aim.fcost == aim.best or aim.fcost < worth:
        return False
    here, there = sites.distance[_U(site)], sites.distance[_U(aim.to)]
    if rule.aside == STAY or there > here:
        return True
    if rule.aside != ALWAYS:
        return aim.fcost > worth
    return there == here and aim.to == agenda.came_from[_U(robot)]


@HELPER
def _note(robot, action, count, ledger):
    """Add some actions of one kind to the row of a robot."""
    rows = ledger.rows
    row = np.int64(ledger.agenda.row[_U(robot)])
    used = np.int64(rows.used[_U(row)])
    for i in range(used, used + count):
        rows.action[_U(row * rows.steps + i)] = action
    rows.used[_U(row)] = used + count


@HELPER
def _wait_until(robot, tick, ledger):
    """Note that a robot has waited from the end of its last action to a tick; return for how many ticks."""
    waits = tick - ledger.agenda.done[_U(robot)]
    _note(robot, _WAIT, waits, ledger)
    ledger.agenda.done[_U(robot)] = tick
    return waits


@APART
def _call(hole, turn, stage, ledger):
    """Let those who wait around a cell that is being left be asked as soon as each can enter it."""
    for j in range(stage.ways.count):
        beside = neighbour(hole, j, stage.ways)
        robot = owner_of(beside, stage.claims)
        if robot == 0 or not is_of_region(np.int64(stage.sites.slot[_U(beside)]), turn):
            continue
        k = back_of(hole, j, stage.ways)
        if stage.sites.best[_U(beside)] >> k & 1:
            tick = tick_of_leave(robot, hole, k, turn.now.step, stage)
            if ledger.agenda.done[_U(robot)] <= tick and tick < ledger.agenda.due[_U(robot)]:
                _put(robot, tick, ledger)


@HELPER
def _go(robot, site, aim, turn, stage, ledger):
    """Let a robot take its aim; return what it loses: the cost beyond what it comes nearer."""
    agenda, tick = ledger.agenda, turn.now.step
    _note(robot, aim.direction, 1, ledger)
    end = tick + duration_of(robot, aim.direction, stage.clock)
    agenda.done[_U(robot)] = end
    agenda.came_from[_U(robot)] = site
    stage.slots.count[_U(stage.sites.slot[_U(site)])] -= 1
    is_awaited = claim(robot, site, aim.direction, aim.slot, tick, stage)
    if aim.slot > 0:
        ledger.robots.site[_U(robot)] = aim.to
        stage.slots.count[_U(aim.slot)] += 1
        _put(robot, end, ledger)
    else:
        ledger.robots.arrival[_U(robot)] = end
        ledger.robots.site[_U(robot)] = 0
    if is_awaited:
        _call(site, turn, stage, ledger)
    nearer = np.int64(stage.sites.distance[_U(site)]) - stage.sites.distance[_U(aim.to)]
    return (stage.ways.cost[_U(aim.direction)] - nearer) * stage.clock.slowness[_U(robot)]


@HELPER
def _aim_of(robot, site, aim, turn, rule, stage, agenda):
    """Return what a robot does whose best directions have been weighed: perhaps it goes elsewhere, or waits."""
    is_due = aim.direction == WAIT or (turn.now.step + robot) % rule.period == 0
    if rule.counts == NOTHING or robot == turn.captain or aim.fcost <= stage.sites.distance[_U(site)] or not is_due:
        return aim
    aim = _aim_elsewhere(robot, site, aim, turn, rule, stage)
    patience = stage.ways.waiting_cost * min(aim.ready - turn.now.step, stage.clock.headway * stage.clock.shortest)
    patience //= stage.clock.slowness[_U(robot)]  # a longer way costs the slow more
    if not _stays(robot, site, aim, patience, rule, stage.sites, agenda):
        return aim
    ready = min(aim.ready, turn.now.step + stage.clock.shortest)
    return Aim(_WAIT, aim.slot, site, aim.fcost, aim.best, ready)


@HELPER
def _ask(own, turn, rule, stage, ledger):
    """Ask a robot what it does, after those who stand in its way; return what they lose. The captain asks nobody."""
    agenda = ledger.agenda
    loss = np.int64(0)
    robot, depth = own, 0
    agenda.due[_U(robot)] = NEVER
    while True:
        site = np.int64(ledger.robots.site[_U(robot)])
        aim, other = _aim_best(robot, site, robot == turn.captain, turn, rule, stage, agenda)
        if other and own != turn.captain:
            agenda.waiting[_U(depth)] = robot
            depth += 1
            robot = other
            agenda.due[_U(robot)] = NEVER
            continue
        aim = _aim_of(robot, site, aim, turn, rule, stage, agenda)
        if aim.direction != WAIT:
            loss += _wait_until(robot, turn.now.step, ledger) * stage.ways.waiting_cost
            loss += _go(robot, site, aim, turn, stage, ledger)
        elif aim.ready != NEVER:
            _put(robot, aim.ready, ledger)
        if depth == 0:
            return loss
        depth -= 1
        robot = np.int64(agenda.waiting[_U(depth)])


@HELPER
def _begin(region, rule, stage, ledger):
    """Give each robot of a region a row, and find how far its lines may reach; put those who are due into the block."""
    robots, rows, agenda, slots = ledger.robots, ledger.rows, ledger.agenda, stage.slots
    first_branch, last_branch = slots.first_branch_of_region[region], slots.first_branch_of_region[region + 1]
    for branch in range(first_branch, last_branch):
        slots.highest[branch] = 0
    for i in range(ledger.words * rows.steps):
        agenda.asked[i] = 0
    first, row = robots.first_of_region[region], ledger.first_row
    for j in range(first, first + robots.count_of_region[region]):
        robot = np.int64(robots.listed[j])
        agenda.row[robot] = row
        rows.robot[row] = robot
        rows.used[row] = 0
        row += 1
        if agenda.due[robot] != NEVER:
            _put(robot, np.int64(agenda.due[robot]), ledger)
        slot = stage.sites.slot[robots.site[robot]]
        branch = slots.branch_of_slot[slot]
        slots.highest[branch] = max(slots.highest[branch], slot)
    if rule.counts != NOTHING:
        for branch in range(first_branch, last_branch):
            measure_lines(branch, rows.steps, stage.clock.headway, slots)


@HELPER
def _end(region, stage, ledger):
    """Let robots wait until the block is over, list who has not arrived, and return what they lose by that."""
    robots, rows = ledger.robots, ledger.rows
    first = kept = robots.first_of_region[region]
    end = rows.first_step + rows.steps
    waits = np.int64(0)
    for j in range(first, first + robots.count_of_region[region]):
        robot = np.int64(robots.listed[j])
        if robots.site[robot] == 0:
            continue
        if ledger.agenda.done[robot] < end:
            waits += _wait_until(robot, end, ledger)
        robots.listed[kept] = robot
        kept += 1
    robots.count_of_region[region] = kept - first
    return waits * stage.ways.waiting_cost


@HELPER
def _find_captain(region, tick, stage, ledger):
    """Return who is at the head of the captain's way; if it stands, it is asked at this tick."""
    robots, agenda, sites = ledger.robots, ledger.agenda, stage.sites
    captain = np.int64(agenda.captain_of_region[region])
    if captain == 0 or robots.site[captain] == 0:
        captain = np.int64(0)
        first = robots.first_of_region[region]
        for j in range(first, first + robots.count_of_region[region]):
            if robots.site[robots.listed[j]]:
                captain = np.int64(robots.listed[j])
                break
        if captain == 0:
            return captain
    ahead = captain
    while ahead:
        captain = ahead
        site = np.int64(robots.site[captain])
        ahead = owner_of(neighbour(site, first_of(sites.best[site]), stage.ways), stage.claims)
    agenda.captain_of_region[region] = captain
    if agenda.done[captain] <= tick and agenda.due[captain] != tick:
        _put(captain, tick, ledger)
    return captain


@HELPER
def _tick(region, now, rule, stage, ledger):
    """Ask all robots of a region who are due at a tick, or for whom a cell is left; return what they lose."""
    agenda, rows, slots = ledger.agenda, ledger.rows, stage.slots
    first, last = slots.first_branch_of_region[region], slots.first_branch_of_region[region + 1]
    ends = slots.first_end_of_region
    loss, captain = np.int64(0), np.int64(0)
    if rule.counts != NOTHING:
        if now.s % (stage.clock.shortest * rule.period) == 0:
            for branch in range(first, last):
                line_up(slots.first_slot[branch], slots.lined_end[branch], stage.clock.headway, slots)
        captain = _find_captain(region, now.step, stage, ledger)
    turn = Turn(captain, slots.first_slot[first], slots.first_slot[last], -ends[region + 1], -1 - ends[region], now)
    if captain and agenda.due[captain] == now.step:
        loss += _ask(captain, turn, rule, stage, ledger)
    is_anybody_due = True
    while is_anybody_due:
        is_anybody_due = False
        for word in range(ledger.words):
            at = now.s * ledger.words + word
            while agenda.asked[_U(at)]:
                is_anybody_due = True
                bits = agenda.asked[_U(at)]
                agenda.asked[_U(at)] = bits & (bits - 1)
                robot = np.int64(rows.robot[_U(ledger.first_row + (word << 6 | first_of(bits)))])
                if agenda.due[_U(robot)] == now.step:
                    loss += _ask(robot, turn, rule, stage, ledger)
    return loss


@kernel(types.int64(RULE, STAGE, AGENDA, IN_I64, ROBOTS, TICK_ROWS))
def act(rule, stage, agenda, regions, robots, rows):
    """Let the robots of some regions act for a block of ticks; fill `rows` and return what they lose.

    A robot that finds all its best cells owned sleeps until one of them is left; one that a robot under way holds up is
    asked again when that is over. The nearest robot of all can be held up only by one that is under way, for less than
    one move; where robots may go elsewhere, too, one of each region, the captain, or who stands at the head of its way,
    is asked first and descends. So somebody arrives in bounded time, and then the next. Robots lose the cost of waits,
    and of moves beyond what they come nearer.
    """
    first_row = np.int64(0)  # no literal, for which numba would compile all helpers anew
    loss = np.int64(0)
    for region in regions:
        ledger = Ledger(first_row, (robots.count_of_region[region] + 63) >> 6, robots, rows, agenda)
        _begin(region, rule, stage, ledger)
        first_row += robots.count_of_region[region]
        for s in range(rows.steps):
            now = Now(rows.block, s, rows.first_step + s)
            loss += _tick(region, now, rule, stage, ledger)
        loss += _end(region, stage, ledger)
    return loss
