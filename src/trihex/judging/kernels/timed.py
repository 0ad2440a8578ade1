"""The judge's walk through a plan whose moves last, tick by tick.

A robot is looked at when it begins a move, when it comes to own the cell where that leads, and when it has entered a
destination. Waits are only counted. In each half tick first those vanish that have entered, then the others leave,
then they come; each in the order of their numbers.
"""

import numpy as np
from numba import types

from trihex.judging.kernels.deeds import DEEDS, NO_VERTEX, deed_at
from trihex.judging.kernels.doors import enters_in_vain, is_shut
from trihex.judging.kernels.findings import ACTS_ON, CAPACITY, FINDINGS, JUMPS, NONE, OUT_OF_AREA, SHUT, note
from trihex.judging.kernels.ground import judge_ground
from trihex.judging.kernels.law import LAW, OUTSIDE
from trihex.judging.kernels.owners import (
    MOVERS,
    NEVER,
    OWNERS,
    enter,
    hold,
    judge_exchange,
    judge_owner,
    own_vertex,
)
from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import HELPER, IN_I32, OUT_I64, kernel

# Entries of `clock`: the tick that is next, and how many robots act.
TICK, ACTIVE = 0, 1
# What a robot does when it is due.
VANISHES, LEAVES, COMES = range(3)
# In place of when it is due: it is no longer there; one that stays for good has ~h,
# where its last action ends at half tick h.
GONE = -(2**31)
_U = np.uint64


@HELPER
def _duration(robot, action, law):
    """Return how many ticks a move of a robot lasts; a jump, of which no rule tells, takes one."""
    return np.int64(1) if action == JUMP else np.int64(law.duration[_U(action)]) * law.slowness[_U(robot)]


@HELPER
def _rest(robot, half_tick, i, law, deeds, movers):
    """Let a robot at the centre of a cell wait from action `i` on; return until when it owns the cell."""
    first, last = deeds.first[_U(robot)], deeds.first[_U(robot + 1)]
    waits = np.int64(0)
    while i + waits < last and deeds.action[_U(i + waits)] == WAIT:
        waits += 1
    movers.coming[_U(robot)] = i + waits - first
    if i + waits == last:
        movers.due[_U(robot)] = ~(half_tick + 2 * waits)
        return np.int64(NEVER)
    leaves = half_tick + 2 * waits
    movers.due[_U(robot)], movers.phase[_U(robot)] = leaves, LEAVES
    return leaves + _duration(robot, deeds.action[_U(i + waits)], law) * (2 if law.forbids_following else 1)


@HELPER
def _vanish(robot, half_tick, law, deeds, movers, owners, findings):
    """Take a robot that has entered a destination out of the area."""
    site = np.int64(movers.target[robot])
    owners.until[site] -= 1
    movers.due[robot] = GONE
    if enters_in_vain(site, half_tick // 2, law.doors):
        note(findings, half_tick // 2, CAPACITY, (robot, NONE), (site, NONE, NONE, NONE))
    if deeds.first[robot] + movers.coming[robot] + 1 < deeds.first[robot + 1]:
        note(findings, half_tick // 2, ACTS_ON, (robot, NONE), (site, NONE, NONE, NONE))


@HELPER
def _come(robot, half_tick, law, deeds, movers, owners, findings):
    """Let a robot own the cell that it goes to, and judge whether it may."""
    site = np.int64(movers.target[_U(robot)])
    if owners.place[_U(site)] < 0:
        movers.due[robot], movers.phase[robot] = movers.ends[robot], VANISHES
        enter(robot, site, half_tick, law.capacity, owners, findings)
        return
    judge_owner(robot, site, half_tick, owners, findings)
    i = deeds.first[_U(robot)] + movers.coming[_U(robot)] + 1
    hold(robot, site, _rest(robot, np.int64(movers.ends[_U(robot)]), i, law, deeds, movers), owners)


@HELPER
def _leave(robot, half_tick, law, deeds, movers, owners, findings):
    """Let a robot begin a move, and judge the way that it takes."""
    i = deeds.first[_U(robot)] + movers.coming[_U(robot)]
    deed = deed_at(i, robot, half_tick // 2 + 1, np.int64(movers.target[_U(robot)]), owners.place, law, deeds)
    duration = _duration(robot, deed.action, law)
    movers.here[_U(robot)], movers.target[_U(robot)] = deed.here, deed.target
    movers.ends[_U(robot)] = half_tick + 2 * duration
    if deed.action == JUMP:
        note(findings, deed.step, JUMPS, (robot, NONE), (deed.here, deed.target, NONE, NONE))
    if deed.onto == OUTSIDE:  # not followed any further
        note(findings, deed.step, OUT_OF_AREA, (robot, NONE), (deed.here, NONE, NONE, NONE))
        movers.due[robot], movers.ends[robot] = GONE, half_tick
        return
    judge_ground(deed, law, owners.place, findings)
    if deed.vertex != NO_VERTEX and law.forbids_crossing:
        own_vertex(deed, half_tick, half_tick + 2 * duration, movers, owners, findings)
    if deed.onto >= 0 and deed.target != deed.here and is_shut(deed.target, half_tick // 2 + duration, law.doors):
        note(findings, half_tick // 2 + duration, SHUT, (robot, NONE), (deed.target, NONE, NONE, NONE))
    if deed.target != deed.here:
        judge_exchange(deed, half_tick, movers, owners, findings)
    if law.forbids_following:
        _come(robot, half_tick, law, deeds, movers, owners, findings)
    else:
        movers.due[_U(robot)], movers.phase[_U(robot)] = half_tick + duration, COMES


@HELPER
def _judge_half_tick(half_tick, turns, law, deeds, movers, owners, findings):
    """Let all whose turn it is do what they are due to do in this half tick."""
    for phase in range(COMES if half_tick % 2 else VANISHES, COMES + 1):
        for j in range(turns):
            robot = np.int64(movers.turn[_U(j)])
            if movers.due[_U(robot)] != half_tick or movers.phase[_U(robot)] != phase:
                continue
            if phase == VANISHES:
                _vanish(robot, half_tick, law, deeds, movers, owners, findings)
            elif phase == LEAVES:
                _leave(robot, half_tick, law, deeds, movers, owners, findings)
            else:
                _come(robot, half_tick, law, deeds, movers, owners, findings)


@HELPER
def _take_turns(tick, acting, movers):
    """Strike off who acts no more, list whose turn comes in this tick; return how many there are of both."""
    kept = turns = 0
    for j in range(acting):
        robot = movers.active[_U(j)]
        due = movers.due[_U(robot)]
        movers.active[_U(kept)] = movers.turn[_U(turns)] = robot
        kept += due >= 0
        turns += due >= 0 and due <= 2 * tick + 1
    return kept, turns


@kernel(types.void(IN_I32, LAW, DEEDS, MOVERS, OWNERS, FINDINGS, OUT_I64))
def begin(start, law, deeds, movers, owners, findings, clock):
    """Set all robots on their starts, whose they are; who starts there together is judged elsewhere."""
    for r in range(len(start)):
        robot, site = np.int64(r), np.int64(start[r])
        movers.here[robot] = movers.target[robot] = site
        movers.active[robot] = robot
        if owners.place[site] >= 0:
            hold(robot, site, _rest(robot, np.int64(0), deeds.first[robot], law, deeds, movers), owners)
            continue
        movers.due[robot] = GONE
        if deeds.first[robot + 1] > deeds.first[robot]:
            note(findings, np.int64(0), ACTS_ON, (robot, NONE), (site, NONE, NONE, NONE))
    clock[ACTIVE] = len(start)


@kernel(types.void(LAW, DEEDS, MOVERS, OWNERS, FINDINGS, OUT_I64, types.int64))
def judge(law, deeds, movers, owners, findings, clock, budget):
    """Judge whole ticks, until about `budget` looks at robots are done or nobody acts any more."""
    while clock[ACTIVE] > 0 and budget > 0:
        tick = clock[TICK]
        clock[ACTIVE], turns = _take_turns(tick, clock[ACTIVE], movers)
        budget -= clock[ACTIVE] // 4 + 4 * turns + 1
        for half_tick in range(2 * tick, 2 * tick + 2):
            _judge_half_tick(half_tick, turns, law, deeds, movers, owners, findings)
        clock[TICK] += 1
