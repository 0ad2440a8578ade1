"""One step of robots in a world that may change before the next: greedy descent, or the least Fcost.

Robots are asked in the order of their distance; so the nearest of those that can act always comes nearer. Where moves
last several ticks, or a cell is owned until a robot has left it, a step is a tick, and only robots at a centre are
asked: a robot `occupies` the cell where it stands or which it enters, and `Held` has what it owns beside.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.doors import DOORS, has_doors, is_door_full
from trihex.kernels.signatures import HELPER, IN_I32, OUT_BOOL, OUT_I32, OUT_U8, declared, kernel
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
    patience: types.int64  # what a robot pays at most rather than wait; w_t where moves last a step
    price: types.int64  # of each place in a line
    headway: types.int64  # how many places in a line a robot takes, see `line_up`
    first_vertex_move: types.int64  # the first direction that passes a vertex which others may not
    entry_limit: types.int64  # how many may enter a destination at a time, 0 for any number
    is_timed: types.int64  # whether moves last several ticks, or nobody follows before a cell is left
    follows: types.int64  # 1 if a robot owns but the half of its move, 0 if nobody may follow before it is over
    tick: types.int64  # at which the step begins
    captain: types.int64  # who waits until it can come nearer, -1 where the first can always


class Walkers(NamedTuple):
    """Robots and where they are."""

    site: OUT_I32  # of each robot
    came_from: OUT_I32  # where each robot was before its last move, -1 if it has made none
    action: OUT_U8  # of each robot in this step: filled where it moves
    occupied: OUT_U8  # of each site: whether a robot is there, or enters
    due: OUT_I32  # the tick at which the last move of each robot ends; only where `is_timed`, as the next two
    heading: OUT_U8  # the direction of that move
    enters: OUT_BOOL  # whether each robot is on its way into a destination


class Held(NamedTuple):
    """What robots own, as in `trihex.running.claims.Claims`, and which branches are led."""

    duration: IN_I32  # ticks of a move in each direction
    left_until: OUT_I32  # of a site: the half tick until which somebody owns it who leaves it; only where `is_timed`
    passed_until: OUT_I32  # of a vertex: the tick until which somebody passes it
    entered_until: OUT_I32  # of each place of a destination: the half tick until which somebody enters it
    let_in: OUT_I32  # of each door, where there are some: how many come in at each of the next ticks
    let_in_at: OUT_I32  # and at which
    doors: DOORS
    led: OUT_I32  # of the last site of each branch: the tick after that at which somebody led it


class StepChoice(NamedTuple):
    """What a robot can do now, and what it would do if all were empty; directions are -1 if there is none."""

    direction: types.int64  # the one of least Fcost that it can take, of several the one that leads nearest
    fcost: types.int64  # of that
    distance: types.int64  # of the site it leads to
    descent: types.int64  # the first best direction that it can take
    best: types.int64  # the least Fcost of all moves, whoever stands there


@HELPER
def _delay_at(target, own_slot, rules, ways, forest, lines):
    """Return how long the line is ahead of a robot of a slot that moves to `target`, itself left out."""
    slot = slot_of(target, ways, forest) + 1
    return max(np.int64(0), line_at(slot, lines) - rules.headway * (slot == own_slot))


@HELPER
def _place_at(target, rules, held):
    """Return which place of a destination is free first."""
    first = target * rules.entry_limit
    for i in range(first + 1, (target + 1) * rules.entry_limit):
        if held.entered_until[i] < held.entered_until[first]:
            first = i
    return first


@HELPER
def _owns_from(k, rules, held):
    """Return the half tick from which a robot owns the cell that it enters by a move that begins now."""
    return 2 * rules.tick + rules.follows * held.duration[k]


@HELPER
def _count_of(target, end, held):
    """Return where it is kept how many come in by a door at tick `end`."""
    ahead = len(held.let_in) // len(held.doors.rate)
    return (np.int64(held.doors.number[target]) - 1) * ahead + end % ahead


@HELPER
def _is_shut(target, end, held):
    """Tell whether a door lets nobody in at tick `end`, or as many as it does are coming."""
    if not has_doors(held.doors) or held.doors.number[target] == 0:
        return False
    at = _count_of(target, end, held)
    return is_door_full(target, end, np.int64(held.let_in[at]) * (held.let_in_at[at] == end), held.doors)


@HELPER
def _is_barred(here, k, target, rules, ways, walkers, held):
    """Tell whether a robot is there or still leaves, one passes the same vertex, or enough enter the destination."""
    if walkers.occupied[target] or _is_shut(target, rules.tick + held.duration[k], held):
        return True
    if k >= rules.first_vertex_move and held.passed_until[here + ways.vertex[here & 1, k]] > rules.tick:
        return True
    if rules.is_timed and held.left_until[target] > _owns_from(k, rules, held):
        return True
    if rules.entry_limit == 0 or ways.distance[target] > 0:
        return False
    return held.entered_until[_place_at(target, rules, held)] > _owns_from(k, rules, held)


@HELPER
def _descend(here, rules, ways, walkers, held):
    """Return the first best direction that a robot can take, -1 if there is none."""
    for k in range(len(ways.cost)):
        if ways.moves[here] >> k & 1:
            target = here + ways.offset[here & 1, k]
            is_best = np.int64(ways.distance[target]) + ways.cost[k] == ways.distance[here]
            if is_best and not _is_barred(here, k, target, rules, ways, walkers, held):
                return np.int64(k)
    return _NONE


@HELPER
def _weigh(here, own_slot, rules, ways, forest, lines, walkers, held):
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
            fcost += rules.price * _delay_at(target, own_slot, rules, ways, forest, lines)
        best = min(best, fcost)
        if _is_barred(here, k, target, rules, ways, walkers, held):
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
        return choice.fcost <= choice.best + rules.patience
    target = here + ways.offset[here & 1, choice.direction]
    return choice.distance < ways.distance[here] or target != came_from


@HELPER
def _leads(own_slot, rules, held):
    """Tell whether no robot nearer than this one leads its branch in this step; it does now.

    A branch is named by its last site.
    """
    branch = own_slot >> 32
    is_first = held.led[branch] != rules.tick + 1
    held.led[branch] = rules.tick + 1
    return is_first


@HELPER
def _decide(robot, here, rules, ways, forest, lines, walkers, held):
    """Return the direction that a robot takes, -1 if it waits."""
    if rules.mode == GREEDY:
        return _descend(here, rules, ways, walkers, held)
    own_slot = slot_of(here, ways, forest)
    is_first = _leads(own_slot, rules, held)
    choice = _weigh(here, own_slot, rules, ways, forest, lines, walkers, held)
    if choice.descent >= 0 and (is_first or robot == rules.captain):
        return choice.descent
    if robot == rules.captain:
        return _NONE
    had_better_wait = choice.fcost != choice.best and choice.fcost >= choice.best + rules.patience
    if (
        choice.direction >= 0
        and had_better_wait
        and not _steps_aside(here, walkers.came_from[robot], choice, rules, ways)
    ):
        return _NONE
    return choice.direction


@HELPER
def _move(robot, here, taken, rules, ways, walkers, held):
    """Let a robot go, and stamp what it passes and enters."""
    target = here + ways.offset[here & 1, taken]
    walkers.action[robot] = taken
    walkers.occupied[here] = 0
    walkers.came_from[robot] = here
    walkers.site[robot] = target
    enters, end = ways.distance[target] == 0, rules.tick + held.duration[taken]
    if has_doors(held.doors) and held.doors.number[target]:
        at = _count_of(target, end, held)
        held.let_in[at] = held.let_in[at] * (held.let_in_at[at] == end) + 1
        held.let_in_at[at] = end
    if taken >= rules.first_vertex_move:
        held.passed_until[here + ways.vertex[here & 1, taken]] = end
    if rules.is_timed:
        held.left_until[here] = 2 * end - rules.follows * held.duration[taken]
        walkers.due[robot] = end
        walkers.heading[robot] = taken
        walkers.enters[robot] = enters
    if not enters:
        walkers.occupied[target] = 1
    elif rules.entry_limit:
        held.entered_until[_place_at(target, rules, held)] = 2 * end


@kernel(
    types.void(
        IN_I32,
        declared(StepRules),
        declared(LivingWays),
        declared(Forest),
        declared(WaitingLines),
        declared(Walkers),
        declared(Held),
    )
)
def act(order, rules, ways, forest, lines, walkers, held):
    """Let each robot of `order` move or wait; `walkers` follow.

    A robot only ever enters a cell that nobody is in or enters at that moment, so no two exchange cells; who is asked
    later may follow into a cell that was left in the same step.
    """
    for i in range(len(order)):
        robot = order[i]
        here = np.int64(walkers.site[robot])
        taken = _decide(robot, here, rules, ways, forest, lines, walkers, held)
        if taken >= 0:
            _move(robot, here, taken, rules, ways, walkers, held)
