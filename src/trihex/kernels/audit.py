"""The judge's walk through a plan, step by step, and its own idea of which moves the corner rule allows.

Nothing here is shared with the kernels that planners use: a fault in theirs must show.
"""

from numba import njit, types

from trihex.kernels.signatures import IN_I32, IN_I64, IN_U8, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32

WAIT, JUMP = 255, 254
FREE, DESTINATION, BARRIER, OUTSIDE = 0, 1, 2, 3  # what lies at a site
ALLOW, NO_SQUEEZE, NO_CUT = 0, 1, 2
# What was found. STOPS is for the caller, who knows what robots can reach.
CELL, EXCHANGE, CROSSING, JUMPS, OUT_OF_AREA, ONTO_BARRIER, CORNER, CAPACITY, ACTS_ON, STOPS = range(10)
# In place of the site that a robot came from, once it acts no more.
PARKED, ARRIVED, LOST = -2, -3, -4
NOWHERE = -(2**31)
# Entries of `state`.
STEP, ACTIVE, COUNT = 0, 1, 2
FOUND = types.Array(types.int32, 2, "C")


@njit(types.boolean(IN_U8, types.int64, types.int64, types.int64, IN_I32, types.int64), cache=True, nogil=True)
def _is_corner_closed(ground, site, target, vertex, ring, rule):
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
        one_way += ground[vertex + ring[i]] >= BARRIER
        i = (i + 1) % around
    i = (there + 1) % around
    while i != here:
        other_way += ground[vertex + ring[i]] >= BARRIER
        i = (i + 1) % around
    if rule == NO_CUT:
        return one_way + other_way > 0
    return one_way > 0 and other_way > 0


@njit(
    types.void(OUT_I64, FOUND, *[types.int64] * 7),
    cache=True,
    nogil=True,
)
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
    types.void(IN_I32, IN_I64, IN_U8, OUT_I32, OUT_I32, OUT_I32, OUT_I64, FOUND),
    cache=True,
    nogil=True,
)
def begin(start, first_action, ground, site, came_from, active, state, found):
    """Set all robots on their starts; those without actions are parked, or have arrived."""
    count = 0
    for r in range(len(start)):
        site[r] = start[r]
        came_from[r] = start[r]
        acts = first_action[r + 1] > first_action[r]
        if ground[start[r]] == DESTINATION:
            site[r] = NOWHERE
            came_from[r] = ARRIVED
            if acts:
                _note(state, found, ACTS_ON, r, -1, start[r], -1, -1, -1)
        elif acts:
            active[count] = r
            count += 1
        else:
            came_from[r] = PARKED
    state[ACTIVE] = count


@njit(
    types.void(
        IN_U8,
        IN_I64,
        IN_U8,
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
    ground,
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
    holder,
    vertex_holder,
    active,
    ended,
    budget,
    state,
    found,
):
    """Judge whole steps, until about `budget` robot-steps are done or nobody acts any more.

    Robots act in the order of their numbers. ``holder[s]`` names the robot that holds site s; the entry counts only if
    that robot stands there now, i.e. it is parked there or has a smaller number than the robot that asks (which has
    acted already). So nothing needs to be cleared from step to step: ``vertex_holder`` with `passed` and, on
    destinations, ``holder`` with `rank` work alike.
    """
    while state[ACTIVE] > 0 and budget > 0:
        state[STEP] += 1
        step = state[STEP]
        budget -= state[ACTIVE]
        kept = 0
        over = 0
        for j in range(state[ACTIVE]):
            r = active[j]
            i = first_action[r] + step - 1
            action = actions[i]
            here = site[r]
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
            onto = ground[target]

            if onto == OUTSIDE:  # not followed any further
                _note(state, found, OUT_OF_AREA, r, -1, here, -1, -1, -1)
                site[r] = NOWHERE
                came_from[r] = LOST
                passed[r] = -1
                ended[over] = r
                over += 1
                continue
            if onto == BARRIER and action != WAIT:
                _note(state, found, ONTO_BARRIER, r, -1, here, target, -1, -1)
            if crossed >= 0:
                if corner_rule != ALLOW and onto != BARRIER:
                    if _is_corner_closed(ground, here, target, crossed, ring, corner_rule):
                        _note(state, found, CORNER, r, -1, here, target, -1, -1)
                if forbid_crossing:
                    h = vertex_holder[crossed]
                    if h < r and passed[h] == crossed:
                        to = site[h] if site[h] >= 0 else ~site[h]
                        _note(state, found, CROSSING, h, r, came_from[h], to, here, target)
                    else:
                        vertex_holder[crossed] = r
            if target != here:  # has the robot that stands where this one came from come from where this one goes?
                h = holder[here]
                if h < r and site[h] == here and came_from[h] == target:
                    _note(state, found, EXCHANGE, h, r, target, here, -1, -1)

            h = holder[target]
            if onto == DESTINATION:
                site[r] = ~target
                rank[r] = rank[h] + 1 if h < r and site[h] == ~target else 1
                holder[target] = r
                if capacity > 0 and rank[r] > capacity:
                    _note(state, found, CAPACITY, r, -1, target, -1, -1, -1)
                if i + 1 < first_action[r + 1]:
                    _note(state, found, ACTS_ON, r, -1, target, -1, -1, -1)
                ended[over] = r
                over += 1
                continue
            site[r] = target
            if h != r and site[h] == target and (h < r or came_from[h] == PARKED):
                _note(state, found, CELL, min(h, r), max(h, r), target, -1, -1, -1)
            else:
                holder[target] = r
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
                h = holder[site[r]]
                if site[h] != site[r] or came_from[h] != PARKED:
                    holder[site[r]] = r


@njit(
    types.int64(
        IN_U8,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        types.int64,
        types.int64,
        OUT_BOOL,
        OUT_I32,
        types.int64,
        types.int64,
        types.int64,
    ),
    cache=True,
    nogil=True,
)
def flood(ground, offset, vertex, ring, edge_count, corner_rule, reached, queue, head, tail, budget):
    """Reach on from ``queue[head:tail]``, at most `budget` sites; return the new tail. A move is open both ways."""
    for at in range(head, min(tail, head + budget)):
        site = queue[at]
        for k in range(offset.shape[1]):
            target = site + offset[site & 1, k]
            if ground[target] >= BARRIER or reached[target]:
                continue
            if k >= edge_count and corner_rule != ALLOW:
                if _is_corner_closed(ground, site, target, site + vertex[site & 1, k], ring, corner_rule):
                    continue
            reached[target] = True
            queue[tail] = target
            tail += 1
    return tail
