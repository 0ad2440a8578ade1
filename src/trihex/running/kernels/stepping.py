"""One step of robots in a world that may change before the next: greedy descent, or the least Fcost.

Robots are asked in the order of their distance; so the nearest of those that can act always comes nearer.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, OUT_I32, OUT_U8, declared, kernel
from trihex.running.kernels.lines import Forest, LivingWays, WaitingLines, line_at, slot_of

GREEDY, FCOST = 0, 1
# When a robot that had better wait steps to a place no farther than its own: never, if that costs no more, or always
# unless it has just left that place.
STAY, WORTH, ALWAYS = 0, 1, 2
_FAR = np.int64(1 << 60)
_NONE = np.int64(-1)


class StepRules(NamedTuple):
    """How robots decide, and what they must not do."""

    mode: types.int64  # `GREEDY` or `FCOST`
    aside: types.int64  # `STAY`, `WORTH` or `ALWAYS`
    waiting_cost: types.int64  # w_t
    first_vertex_move: types.int64  # the first direction that passes a vertex which others may not
    entry_limit: types.int64  # how many may enter a destination in a step, 0 for any number
    step: types.int64  # number of the step


class Walkers(NamedTuple):
    """Robots and where they are."""

    site: OUT_I32  # of each robot
    came_from: OUT_I32  # where each robot was before its last move, -1 if it has made none
    action: OUT_U8  # of each robot in this step: filled where it moves
    occupied: OUT_U8  # of each site: whether a robot is there


class StepTraffic(NamedTuple):
    """Stamps: what has happened in which step."""

    passed: OUT_I32  # the last step in which a robot passed each vertex
    entered_step: OUT_I32  # the last step in which a robot entered each destination, or led the branch of each site
    entered_count: OUT_I32  # how many entered each destination in that step


class StepChoice(NamedTuple):
    """What a robot can do now, and what it would do if all were empty; directions are -1 if there is none."""

    direction: types.int64  # the one of least Fcost that it can take, of several the one that leads nearest
    fcost: types.int64  # of that
    distance: types.int64  # of the site it leads to
    descent: types.int64  # the first best direction that it can take
    best: types.int64  # the least Fcost of all moves, whoever stands there


@HELPER
def _delay_at(target, own_slot, ways, forest, lines):
    """Return how many steps the line ahead costs a robot of a slot that moves to `target`, itself left out."""
    slot = slot_of(target, ways, forest) + 1
    return max(np.int64(0), line_at(slot, lines) - (slot == own_slot))


@HELPER
def _is_barred(here, k, target, rules, ways, walkers, traffic):
    """Tell whether a robot is there, one has passed the same vertex, or enough have entered the destination."""
    if walkers.occupied[target]:
        return True
    if k >= rules.first_vertex_move and traffic.passed[here + ways.vertex[here & 1, k]] == rules.step:
        return True
    if rules.entry_limit == 0 or ways.distance[target] > 0:
        return False
    return traffic.entered_step[target] == rules.step and traffic.entered_count[target] >= rules.entry_limit


@HELPER
def _descend(here, rules, ways, walkers, traffic):
    """Return the first best direction that a robot can take, -1 if there is none."""
    for k in range(len(ways.cost)):
        if ways.moves[here] >> k & 1:
            target = here + ways.offset[here & 1, k]
            is_best = np.int64(ways.distance[target]) + ways.cost[k] == ways.distance[here]
            if is_best and not _is_barred(here, k, target, rules, ways, walkers, traffic):
                return np.int64(k)
    return _NONE


@HELPER
def _weigh(here, own_slot, rules, ways, forest, lines, walkers, traffic):
    """Return what a robot that stands `here` can do, and what it would do if all were empty."""
    best, least, nearest = _FAR, _FAR, _FAR
    taken, descent = _NONE, _NONE
    for k in range(len(ways.cost)):
        if not ways.moves[here] >> k & 1:
            continue
        target = here + ways.offset[here & 1, k]
        there = np.int64(ways.distance[target])
        fcost = there + ways.cost[k]
        is_descent = fcost == ways.distance[here]
        if there > 0:
            fcost += rules.waiting_cost * _delay_at(target, own_slot, ways, forest, lines)
        best = min(best, fcost)
        if _is_barred(here, k, target, rules, ways, walkers, traffic):
            continue
        if is_descent and descent < 0:
            descent = np.int64(k)
        if fcost < least or (fcost == least and there < nearest):
            taken, least, nearest = np.int64(k), fcost, there
    return StepChoice(taken, least, nearest, descent, best)


@HELPER
def _steps_aside(here, came_from, choice, rules, ways):
    """Tell whether a robot that had better wait makes its move all the same."""
    if rules.aside == STAY or choice.distance > ways.distance[here]:
        return False
    if rules.aside == WORTH:
        return choice.fcost <= choice.best + rules.waiting_cost
    target = here + ways.offset[here & 1, choice.direction]
    return choice.distance < ways.distance[here] or target != came_from


@HELPER
def _leads(own_slot, rules, traffic):
    """Tell whether no robot nearer than this one leads its branch in this step; it does now.

    A branch is named by its last site, where no destination is: there the stamp of entries is free for that.
    """
    branch = own_slot >> 32
    is_first = traffic.entered_step[branch] != rules.step
    traffic.entered_step[branch] = rules.step
    return is_first


@HELPER
def _decide(here, came_from, rules, ways, forest, lines, walkers, traffic):
    """Return the direction that a robot takes, -1 if it waits."""
    if rules.mode == GREEDY:
        return _descend(here, rules, ways, walkers, traffic)
    own_slot = slot_of(here, ways, forest)
    is_first = _leads(own_slot, rules, traffic)
    choice = _weigh(here, own_slot, rules, ways, forest, lines, walkers, traffic)
    if is_first and choice.descent >= 0:
        return choice.descent
    had_better_wait = choice.fcost != choice.best and choice.fcost >= choice.best + rules.waiting_cost
    if choice.direction >= 0 and had_better_wait and not _steps_aside(here, came_from, choice, rules, ways):
        return _NONE
    return choice.direction


@HELPER
def _move(robot, here, taken, rules, ways, walkers, traffic):
    """Let a robot go, and stamp what it passes and enters."""
    target = here + ways.offset[here & 1, taken]
    walkers.action[robot] = taken
    walkers.occupied[here] = 0
    walkers.came_from[robot] = here
    walkers.site[robot] = target
    if taken >= rules.first_vertex_move:
        traffic.passed[here + ways.vertex[here & 1, taken]] = rules.step
    if ways.distance[target] > 0:
        walkers.occupied[target] = 1
        return
    entered = traffic.entered_count[target] * (traffic.entered_step[target] == rules.step)
    traffic.entered_count[target] = entered + 1
    traffic.entered_step[target] = rules.step


@kernel(
    types.void(
        IN_I32,
        declared(StepRules),
        declared(LivingWays),
        declared(Forest),
        declared(WaitingLines),
        declared(Walkers),
        declared(StepTraffic),
    )
)
def act(order, rules, ways, forest, lines, walkers, traffic):
    """Let each robot of `order` move or wait; `walkers` follow.

    A robot only ever enters a cell that is empty at that moment, so no two exchange cells; who is asked later may enter
    a cell that was left in the same step.
    """
    for i in range(len(order)):
        robot = order[i]
        here = np.int64(walkers.site[robot])
        taken = _decide(here, walkers.came_from[robot], rules, ways, forest, lines, walkers, traffic)
        if taken >= 0:
            _move(robot, here, taken, rules, ways, walkers, traffic)
