"""Meetings: robots that come to one place, or pass one.

Robots act in the order of their numbers. ``place[s]`` names the robot that holds site s; the name counts only if that
robot stands there now, i.e. it is parked there or has a smaller number than the robot that asks (which has acted
already). So nothing needs to be cleared from step to step: ``vertex_holder`` with `passed` and, on destinations,
`place` with `rank` work alike.
"""

from typing import NamedTuple

import numpy as np

from trihex.judging.kernels.doors import enters_in_vain, is_shut
from trihex.judging.kernels.findings import CAPACITY, CELL, CROSSING, EXCHANGE, NONE, SHUT, note
from trihex.judging.kernels.law import BARRIER
from trihex.kernels.signatures import HELPER, OUT_I32, declared

# In place of the site that a robot came from, once it acts no more.
PARKED, ARRIVED, LOST = -2, -3, -4
NOWHERE = -(2**31)


class JudgedRobots(NamedTuple):
    """The robots of a plan, as the judge follows them."""

    site: OUT_I32  # where each is; ~site in the step in which it enters a destination; then, or when lost, `NOWHERE`
    came_from: OUT_I32  # where it was a step ago; `PARKED`, `ARRIVED` or `LOST` once it acts no more
    passed: OUT_I32  # the lattice vertex that it has passed in this step, -1: none
    rank: OUT_I32  # as how many-eth it has entered its destination in that step
    active: OUT_I32  # those that act, ascending
    ended: OUT_I32  # room for those that have done their last action in this step


class Places(NamedTuple):
    """Who came where last."""

    place: OUT_I32  # what lies at each site, and who came there last: see `law`
    vertex_holder: OUT_I32  # who passed each lattice vertex last, if crossing is forbidden


_U = np.uint64
JUDGED_ROBOTS, PLACES = declared(JudgedRobots), declared(Places)


@HELPER
def robot_in(what):
    """Return who came last, by an entry of `place`, to a site that is no destination."""
    return np.int64(what & (BARRIER - 1))


@HELPER
def judge_crossing(deed, robots, places, findings):
    """Judge whether a robot passes a lattice vertex that another has passed in this step."""
    other = np.int64(places.vertex_holder[deed.vertex])
    if other < deed.robot and robots.passed[other] == deed.vertex:
        to = np.int64(robots.site[other])
        to = to if to >= 0 else ~to
        sites = (np.int64(robots.came_from[other]), to, deed.here, deed.target)
        note(findings, deed.step, CROSSING, (other, deed.robot), sites)
    else:
        places.vertex_holder[deed.vertex] = deed.robot


@HELPER
def judge_exchange(deed, robots, places, findings):
    """Judge whether the robot that now stands where this one came from has come from where this one goes."""
    other = robot_in(places.place[_U(deed.here)])
    if other < deed.robot and robots.site[_U(other)] == deed.here and robots.came_from[_U(other)] == deed.target:
        note(findings, deed.step, EXCHANGE, (other, deed.robot), (deed.target, deed.here, NONE, NONE))


@HELPER
def enter(deed, law, robots, places, findings):
    """Let a robot enter a destination, and judge whether there was room for it."""
    robot = deed.robot
    other = ~deed.onto
    robots.site[robot] = ~deed.target
    is_after_other = other < robot and robots.site[other] == ~deed.target
    robots.rank[robot] = robots.rank[other] + 1 if is_after_other else 1
    places.place[deed.target] = ~robot
    is_too_many = enters_in_vain(deed.target, deed.step, law.doors)
    if is_too_many or (law.capacity > 0 and robots.rank[robot] > law.capacity):
        note(findings, deed.step, CAPACITY, (robot, NONE), (deed.target, NONE, NONE, NONE))


@HELPER
def judge_door(deed, law, findings):
    """Judge whether a robot comes into a cell that lets nobody in then."""
    if deed.target != deed.here and is_shut(deed.target, deed.step, law.doors):
        note(findings, deed.step, SHUT, (deed.robot, NONE), (deed.target, NONE, NONE, NONE))


@HELPER
def stand(deed, robots, places, findings):
    """Let a robot come to its cell, or stay, and judge whether another is there."""
    robot = deed.robot
    other = robot_in(deed.onto)
    robots.site[_U(robot)] = deed.target
    is_there = other != robot and robots.site[_U(other)] == deed.target
    if is_there and (other < robot or robots.came_from[other] == PARKED):
        both = min(other, robot), max(other, robot)
        note(findings, deed.step, CELL, both, (deed.target, NONE, NONE, NONE))
    else:
        places.place[_U(deed.target)] = robot | (deed.onto & BARRIER)


@HELPER
def retire(robot, robots, places):
    """Let a robot that acts no more rest where it is, or vanish if it has entered a destination."""
    robots.passed[robot] = -1
    site = robots.site[robot]
    if site == NOWHERE:
        return
    if site < 0:
        robots.site[robot] = NOWHERE
        robots.came_from[robot] = ARRIVED
        return
    robots.came_from[robot] = PARKED
    what = places.place[site]
    other = robot_in(what)
    if robots.site[other] != site or robots.came_from[other] != PARKED:
        places.place[site] = robot | (what & BARRIER)
