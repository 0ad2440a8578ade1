"""Mending: the robots of a plan go along their ways, and look ahead for a cheaper one every few steps.

What all of them take in the steps that they look ahead is kept; it goes along with them, from step to step.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, IN_I64, OUT_I32, OUT_I64, OUT_U8, declared, kernel
from trihex.planners.kernels.frame import FRAME, place_after
from trihex.planners.kernels.taken import TAKEN, release, take
from trihex.planners.kernels.ways import WAYS, neighbour
from trihex.planners.kernels.windows import GROUND, NODES, NOTHING, Window, find_way, least_left

_U = np.uint64


class Pace(NamedTuple):
    """How robots look ahead."""

    ahead: types.int64  # how many steps, `taken.STEPS` at most
    every: types.int64  # after so many
    is_lazy: types.int64  # 1: whoever will lose something yet exchanges its way for one as cheap, too, that goes later


class Troop(NamedTuple):
    """The robots of a plan, on their ways."""

    action: OUT_U8  # what they do, one after the other
    first: IN_I64  # the first action of each
    length: OUT_I64  # how many actions each has, which may become fewer
    time: OUT_I64  # what its way costs, which may become less
    paid: OUT_I64  # and how much of that it has paid
    site: OUT_I32  # where each is
    ahead: OUT_I32  # and where it will be after the last step for which it has taken what it needs
    listed: OUT_I32  # who is still on the way


PACE, TROOP = declared(Pace), declared(Troop)


@HELPER
def _take_step(step, count, distance, ways, taken, troop):
    """Take what the robots that are listed need in a step."""
    for i in range(count):
        robot = _U(troop.listed[_U(i)])
        if troop.length[robot] >= step:
            k = np.int64(troop.action[_U(troop.first[robot] + step - 1)])
            troop.ahead[robot] = take(np.int64(troop.ahead[robot]), k, step, distance, ways, taken)


@HELPER
def _go(step, count, distance, ways, taken, troop):
    """Let the robots that are listed do what they do in a step; return how many are still on the way."""
    kept = np.int64(0)
    for i in range(count):
        robot = _U(troop.listed[_U(i)])
        k = np.int64(troop.action[_U(troop.first[robot] + step - 1)])
        troop.site[robot] = release(np.int64(troop.site[robot]), k, step, distance, ways, taken)
        troop.paid[robot] += ways.waiting_cost if k == WAIT else ways.cost[_U(k)]
        troop.listed[_U(kept)] = robot
        kept += troop.length[robot] > step
    return kept


@HELPER
def _look(robot, begin, pace, frame, ground, ways, troop):
    """Return the window of a robot after a step, what the way through it costs, and the site at which that ends."""
    steps = min(pace.ahead, troop.length[_U(robot)] - begin)
    start = site = np.int64(troop.site[_U(robot)])
    place, cost = frame.centre, np.int64(0)
    first = troop.first[_U(robot)] + begin
    for i in range(first, first + steps):
        k = np.int64(troop.action[_U(i)])
        if k == WAIT:
            cost += ways.waiting_cost
        else:
            cost += ways.cost[_U(k)]
            place = place_after(place, site, k, frame)
            site = neighbour(site, k, ways)
    is_last = np.int64(troop.length[_U(robot)] == begin + steps)
    loses = troop.time[_U(robot)] - troop.paid[_U(robot)] > ground.distance[_U(start)]
    return Window(begin, steps, start, place, is_last, cost + (pace.is_lazy & loses)), cost, site


@HELPER
def _replace(robot, window, end, frame, nodes, troop):
    """Give a robot the way that ends in a node; it may arrive earlier by it."""
    step, node = np.int64(nodes.place[_U(end)]) >> frame.bits, end
    if window.is_last:
        troop.length[_U(robot)] = window.begin + step
    first = troop.first[_U(robot)] + window.begin
    while step > 0:
        step -= 1
        troop.action[_U(first + step)] = nodes.action[_U(node)]
        node = np.int64(nodes.parent[_U(node)])


@HELPER
def _mend(robot, begin, pace, frame, ground, ways, taken, nodes, troop):
    """Give a robot a cheaper way through its window, if there is one."""
    window, cost, site = _look(robot, begin, pace, frame, ground, ways, troop)
    least = least_left(window.start, frame.centre, window.steps, window, frame, ground)
    if max(least, np.int64(ground.distance[_U(window.start)]) - ground.distance[_U(site)]) >= window.most:
        return
    at, first = window.start, troop.first[_U(robot)]
    for i in range(begin, begin + window.steps):
        at = release(at, np.int64(troop.action[_U(first + i)]), i + 1, ground.distance, ways, taken)
    end = find_way(window, least, frame, ground, ways, taken, nodes)
    if end != NOTHING:
        troop.time[_U(robot)] -= cost - nodes.cost[_U(end)]
        _replace(robot, window, end, frame, nodes, troop)
    at = window.start
    for i in range(begin, min(begin + window.steps, troop.length[_U(robot)])):
        at = take(at, np.int64(troop.action[_U(first + i)]), i + 1, ground.distance, ways, taken)


@kernel(types.int64(types.int64, types.int64, types.int64, PACE, FRAME, GROUND, WAYS, TAKEN, NODES, TROOP))
def mend(begin, end, count, pace, frame, ground, ways, taken, nodes, troop):
    """Lead robots, of which `count` are listed, from after step `begin` to after step `end`; return how many are left.

    From step 1 - `pace.ahead` to 0 they stand and take what they need later.
    """
    for step in range(begin, end):
        _take_step(step + pace.ahead, count, ground.distance, ways, taken, troop)
        if step < 0:
            continue
        for i in range(count):
            robot = np.int64(troop.listed[_U(i)])
            if (step + robot) % pace.every == 0:
                _mend(robot, step, pace, frame, ground, ways, taken, nodes, troop)
        count = _go(step + 1, count, ground.distance, ways, taken, troop)
    return count
