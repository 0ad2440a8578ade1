"""The judge's walk through a plan, step by step, and its own idea of which moves the corner rule allows.

Nothing here is shared with the kernels that planners use: a fault in theirs must show.
"""

from numba import njit, types

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, OUT_I32, OUT_I64, OUT_U8, TABLE_I32

# `place` tells in one number for each site what lies there, and which robot came there last: the robot on a free cell,
# robot + BARRIER on a barrier, ~robot (negative) on a destination; OUTSIDE in the padding.
BARRIER = 1 << 30
OUTSIDE = -(2**31)
ALLOW, NO_SQUEEZE, NO_CUT = 0, 1, 2
# What was found. STOPS is for the caller, who knows what robots can reach.
CELL, EXCHANGE, CROSSING, JUMPS, OUT_OF_AREA, ONTO_BARRIER, CORNER, CAPACITY, ACTS_ON, STOPS = range(10)
# In place of the site that a robot came from, once it acts no more.
PARKED, ARRIVED, LOST = -2, -3, -4
NOWHERE = -(2**31)
AHEAD = 16  # robots between asking for a robot's places and using them
# Entries of `state`.
STEP, ACTIVE, COUNT = 0, 1, 2
# Marks and entries of the state of `flood`.
UNKNOWN, CLOSED, OPEN = 0, 1, 2
NEXT, FIRST, HEAD, TAIL, IS_OPEN = range(5)
FOUND = types.Array(types.int32, 2, "C")


@njit(nogil=True)
def _is_blocked(what):
    return what >= BARRIER or what == OUTSIDE


@njit(nogil=True)
def _is_corner_closed(place, site, target, vertex, ring, rule):
    """Tell whether barriers around `vertex` forbid the move from `site` to `target` under `rule`."""
    around = len(ring)
    here = there = 0
    for i in range(around):
        if vertex + ring[i] == site:
            here = i
        elif vertex + ring[i] == target:
            there = i
    one_way = other_way = 0
    i = (here + 1) % around
    while i != there:
        one_way += _is_blocked(place[vertex + ring[i]])
        i = (i + 1) % around
    i = (there + 1) % around
    while i != here:
        other_way += _is_blocked(place[vertex + ring[i]])
        i = (i + 1) % around
    if rule == NO_CUT:
        return one_way + other_way > 0
    return one_way > 0 and other_way > 0


@njit(nogil=True)
def _note(state, found, code, robot, other, a, b, c, d):
    """Count a conflict, and keep it while there is room."""
    if state[COUNT] < found.shape[0]:
        row = found[state[COUNT]]
        row[0] = code
        row[1] = state[STEP]
        row[2] = robot
        row[3] = other
        row[4] = a
        row[5] = b
        row[6] = c
        row[7] = d
    state[COUNT] += 1


@njit(
    types.void(IN_I32, IN_I64, OUT_I32, OUT_I32, OUT_I32, OUT_I32, OUT_I64, FOUND),
    cache=True,
    nogil=True,
)
def begin(start, first_action, place, site, came_from, active, state, found):
    """Set all robots on their starts; those without actions are parked, or have arrived."""
    count = 0
    for r in range(len(start)):
        site[r] = start[r]
        came_from[r] = start[r]
        acts = first_action[r + 1] > first_action[r]
        if place[start[r]] < 0:
            site[r] = NOWHERE
            came_from[r] = ARRIVED
            if acts:
                _note(state, found, ACTS_ON, r, -1, start[r], -1, -1, -1)
        elif acts:
            active[count] = r
            count += 1
        else:
            came_from[r] = PARKED
            place[start[r]] = r
    state[ACTIVE] = count


@njit(
    types.void(
        IN_U8,
        IN_I64,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        types.int64,
        types.int64,
        types.boolean,
        types.int64,
        IN_I64,
        IN_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        types.int64,
        OUT_I64,
        FOUND,
    ),
    cache=True,
    nogil=True,
)
def judge(
    actions,
    first_action,
    offset,
    vertex,
    ring,
    edge_count,
    corner_rule,
    forbid_crossing,
    capacity,
    jump_at,
    jump_to,
    site,
    came_from,
    passed,
    rank,
    place,
    vertex_holder,
    active,
    ended,
    budget,
    state,
    found,
):
    """Judge whole steps, until about `budget` robot-steps are done or nobody acts any more.

    Robots act in the order of their numbers. ``place[s]`` names the robot that holds site s; the name counts only if
    that robot stands there now, i.e. it is parked there or has a smaller number than the robot that asks (which has
    acted already). So nothing needs to be cleared from step to step: ``vertex_holder`` with `passed` and, on
    destinations, `place` with `rank` work alike.
    """
    while state[ACTIVE] > 0 and budget > 0:
        state[STEP] += 1
        step = state[STEP]
        budget -= state[ACTIVE]
        kept = 0
        over = 0
        last = state[ACTIVE] - 1
        for j in range(last + 1):
            r = active[min(j + 2 * AHEAD, last)]
            prefetch(actions, first_action[r] + step - 1)
            r = active[min(j + AHEAD, last)]
            action = actions[first_action[r] + step - 1]
            if action < JUMP:
                here = site[r]
                prefetch(place, here + offset[here & 1, action])
                if forbid_crossing and action >= edge_count:
                    prefetch(vertex_holder, here + vertex[here & 1, action])
            r = active[j]
            i = first_action[r] + step - 1
            action = actions[i]
            here = site[r]
            if action == WAIT and place[here] == r and i + 1 < first_action[r + 1]:  # most of all, in crowds
                came_from[r] = here
                passed[r] = -1
                active[kept] = r
                kept += 1
                continue
            target = here
            crossed = -1
            if action == JUMP:
                low, high = 0, len(jump_at)
                while low < high:
                    middle = (low + high) // 2
                    if jump_at[middle] < i:
                        low = middle + 1
                    else:
                        high = middle
                target = jump_to[low]
                _note(state, found, JUMPS, r, -1, here, target, -1, -1)
            elif action != WAIT:
                target = here + offset[here & 1, action]
                if action >= edge_count:
                    crossed = here + vertex[here & 1, action]
            came_from[r] = here
            passed[r] = crossed
            onto = place[target]
            is_barrier = onto >= BARRIER

            if onto == OUTSIDE:  # not followed any further
                _note(state, found, OUT_OF_AREA, r, -1, here, -1, -1, -1)
                site[r] = NOWHERE
                came_from[r] = LOST
                passed[r] = -1
                ended[over] = r
                over += 1
                continue
            if is_barrier and action != WAIT:
                _note(state, found, ONTO_BARRIER, r, -1, here, target, -1, -1)
            if crossed >= 0:
                if corner_rule != ALLOW and not is_barrier:
                    if _is_corner_closed(place, here, target, crossed, ring, corner_rule):
                        _note(state, found, CORNER, r, -1, here, target, -1, -1)
                if forbid_crossing:
                    h = vertex_holder[crossed]
                    if h < r and passed[h] == crossed:
                        to = site[h] if site[h] >= 0 else ~site[h]
                        _note(state, found, CROSSING, h, r, came_from[h], to, here, target)
                    else:
                        vertex_holder[crossed] = r
            if target != here:  # has the robot that stands where this one came from come from where this one goes?
                h = place[here] & (BARRIER - 1)
                if h < r and site[h] == here and came_from[h] == target:
                    _note(state, found, EXCHANGE, h, r, target, here, -1, -1)

            if onto < 0:
                h = ~onto
                site[r] = ~target
                rank[r] = rank[h] + 1 if h < r and site[h] == ~target else 1
                place[target] = ~r
                if capacity > 0 and rank[r] > capacity:
                    _note(state, found, CAPACITY, r, -1, target, -1, -1, -1)
                if i + 1 < first_action[r + 1]:
                    _note(state, found, ACTS_ON, r, -1, target, -1, -1, -1)
                ended[over] = r
                over += 1
                continue
            h = onto & (BARRIER - 1)
            site[r] = target
            if h != r and site[h] == target and (h < r or came_from[h] == PARKED):
                _note(state, found, CELL, min(h, r), max(h, r), target, -1, -1, -1)
            else:
                place[target] = r | (onto & BARRIER)
            if i + 1 < first_action[r + 1]:
                active[kept] = r
                kept += 1
            else:
                ended[over] = r
                over += 1
        state[ACTIVE] = kept
        for j in range(over):
            r = ended[j]
            passed[r] = -1
            if site[r] == NOWHERE:
                continue
            if site[r] < 0:
                site[r] = NOWHERE
                came_from[r] = ARRIVED
            else:
                came_from[r] = PARKED
                h = place[site[r]] & (BARRIER - 1)
                if site[h] != site[r] or came_from[h] != PARKED:
                    place[site[r]] = r | (place[site[r]] & BARRIER)


@njit(
    types.void(
        IN_I32,
        IN_I32,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        types.int64,
        types.int64,
        OUT_U8,
        OUT_I32,
        OUT_I64,
        types.int64,
    ),
    cache=True,
    nogil=True,
)
def flood(start, place, offset, vertex, ring, edge_count, corner_rule, mark, queue, state, budget):
    """Mark all that is connected with each site of `start`: `CLOSED`, or `OPEN` if a destination is among it.

    Goes on where the last call left off, for at most `budget` sites. A move is open both ways or not at all.
    """
    while state[NEXT] < len(start) and budget > 0:
        if state[HEAD] == state[TAIL]:
            site = start[state[NEXT]]
            if mark[site] != UNKNOWN:
                state[NEXT] += 1
                continue
            mark[site] = CLOSED
            queue[state[TAIL]] = site
            state[FIRST] = state[TAIL]
            state[TAIL] += 1
            state[IS_OPEN] = 0
        site = queue[state[HEAD]]
        state[HEAD] += 1
        budget -= 1
        state[IS_OPEN] |= place[site] < 0
        for k in range(offset.shape[1]):
            target = site + offset[site & 1, k]
            if _is_blocked(place[target]) or mark[target] != UNKNOWN:
                continue
            if k >= edge_count and corner_rule != ALLOW:
                if _is_corner_closed(place, site, target, site + vertex[site & 1, k], ring, corner_rule):
                    continue
            mark[target] = CLOSED
            queue[state[TAIL]] = target
            state[TAIL] += 1
        if state[HEAD] == state[TAIL] and state[IS_OPEN]:
            for i in range(state[FIRST], state[TAIL]):
                mark[queue[i]] = OPEN
