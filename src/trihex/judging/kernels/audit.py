"""The judge's walk through a plan, step by step."""

import numpy as np
from numba import types

from trihex.judging.kernels.deeds import DEEDS, NO_VERTEX, deed_of, prefetch_deed
from trihex.judging.kernels.findings import ACTS_ON, FINDINGS, JUMPS, NONE, OUT_OF_AREA, note
from trihex.judging.kernels.ground import judge_ground
from trihex.judging.kernels.law import BARRIER, LAW, OUTSIDE
from trihex.judging.kernels.meetings import (
    ARRIVED,
    JUDGED_ROBOTS,
    LOST,
    NOWHERE,
    PARKED,
    PLACES,
    enter,
    judge_crossing,
    judge_door,
    judge_exchange,
    retire,
    stand,
)
from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import HELPER, IN_I32, OUT_I64, kernel

# Entries of `clock`: the step under way, and how many robots act.
STEP, ACTIVE = 0, 1
AHEAD = 16  # robots between asking for a robot's places and using them
_U = np.uint64


@HELPER
def _judge_way(deed, law, robots, places, findings):
    """Judge how a robot gets where it goes, whoever may be there."""
    judge_ground(deed, law, places.place, findings)
    if deed.vertex != NO_VERTEX and law.forbids_crossing:
        judge_crossing(deed, robots, places, findings)
    if deed.target != deed.here:
        judge_exchange(deed, robots, places, findings)


@HELPER
def _judge_deed(robot, step, law, deeds, robots, places, findings):
    """Let a robot act, and judge what it does; return whether it goes on to the next step."""
    here = np.int64(robots.site[robot])
    goes_on = deeds.first[_U(robot)] + step < deeds.first[_U(robot + 1)]
    deed = deed_of(robot, step, here, places.place, law, deeds)
    robots.came_from[_U(robot)] = here
    robots.passed[_U(robot)] = deed.vertex
    if deed.action == WAIT and deed.onto == robot and goes_on:  # most of all, in crowds
        return True
    if deed.action == JUMP:
        note(findings, step, JUMPS, (robot, NONE), (here, deed.target, NONE, NONE))
    if deed.onto == OUTSIDE:  # not followed any further
        note(findings, step, OUT_OF_AREA, (robot, NONE), (here, NONE, NONE, NONE))
        robots.site[robot] = NOWHERE
        robots.came_from[robot] = LOST
        robots.passed[robot] = NO_VERTEX
        return False
    _judge_way(deed, law, robots, places, findings)
    if deed.onto >= 0:
        judge_door(deed, law, findings)
        stand(deed, robots, places, findings)
        return goes_on
    enter(deed, law, robots, places, findings)
    if goes_on:
        note(findings, step, ACTS_ON, (robot, NONE), (deed.target, NONE, NONE, NONE))
    return False


@HELPER
def _judge_step(step, acting, law, deeds, robots, places, findings):
    """Let all that act do so; return how many go on, and how many have ended."""
    kept = ended = 0
    for j in range(acting):
        robot = robots.active[_U(min(j + 2 * AHEAD, acting - 1))]
        prefetch(deeds.action, deeds.first[_U(robot)] + step - 1)
        prefetch_deed(robots.active[_U(min(j + AHEAD, acting - 1))], step, robots, places, law, deeds)
        robot = np.int64(robots.active[_U(j)])
        if _judge_deed(robot, step, law, deeds, robots, places, findings):
            robots.active[kept] = robot
            kept += 1
        else:
            robots.ended[ended] = robot
            ended += 1
    return kept, ended


@kernel(types.void(IN_I32, DEEDS, JUDGED_ROBOTS, PLACES, FINDINGS, OUT_I64))
def begin(start, deeds, robots, places, findings, clock):
    """Set all robots on their starts; those without actions are parked, or have arrived."""
    count = 0
    for r in range(len(start)):
        robot, site = np.int64(r), np.int64(start[r])
        robots.site[robot] = site
        robots.came_from[robot] = site
        acts = deeds.first[robot + 1] > deeds.first[robot]
        if places.place[site] < 0:
            robots.site[robot] = NOWHERE
            robots.came_from[robot] = ARRIVED
            if acts:
                note(findings, clock[STEP], ACTS_ON, (robot, NONE), (site, NONE, NONE, NONE))
        elif acts:
            robots.active[count] = robot
            count += 1
        else:
            robots.came_from[robot] = PARKED
            places.place[site] = robot | (places.place[site] & BARRIER)
    clock[ACTIVE] = count


@kernel(types.void(LAW, DEEDS, JUDGED_ROBOTS, PLACES, FINDINGS, OUT_I64, types.int64))
def judge(law, deeds, robots, places, findings, clock, budget):
    """Judge whole steps, until about `budget` robot-steps are done or nobody acts any more."""
    while clock[ACTIVE] > 0 and budget > 0:
        budget -= clock[ACTIVE]
        clock[STEP] += 1
        clock[ACTIVE], ended = _judge_step(clock[STEP], clock[ACTIVE], law, deeds, robots, places, findings)
        for j in range(ended):
            retire(robots.ended[j], robots, places)
