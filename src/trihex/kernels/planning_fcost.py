"""Robots that weigh every open direction by its cost and by who else is on the way, step by step."""

import numpy as np
from numba import njit, types

from trihex.kernels.planning import DESTINATION, OCCUPIED
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, OUT_U8, OUT_U16, TABLE_I32

PAPER, QUEUE = 0, 1
DISTANCE, STEPS, BRANCH, SLOT = range(4)
NOT_REACHED = 2**31 - 1

_GRID = types.Array(types.int32, 2, "C")
_DIGIT = 11
_STEP = 1 << 32
_FAR = 1 << 62


@njit(types.int64(IN_I32, IN_U16, IN_U16, IN_I64, TABLE_I32, OUT_I32, _GRID), cache=True, nogil=True)
def fill_tree(destinations, moves, best, first_of_bits, offset, queue, info):
    """Fill steps, branch and slot of each site's row of `info`, whose distances are given; return the number of slots.

    Every site follows its first best direction. Its branch is the site from which that path enters the destination; a
    branch owns as many slots as its longest path has steps, and two more: ``slot = first slot + steps``.
    """
    tail = 0
    for destination in destinations:
        info[destination, STEPS] = 0
        info[destination, BRANCH] = -1
        info[destination, SLOT] = 0
        queue[tail] = destination
        tail += 1
    head = 0
    while head < tail:
        site = queue[head]
        head += 1
        for k in range(offset.shape[1]):
            child = site + offset[site & 1, k]
            if not moves[site] >> k & 1 or best[child] == 0:
                continue
            if child + offset[child & 1, first_of_bits[best[child]]] != site:
                continue
            branch = child if info[site, DISTANCE] == 0 else info[site, BRANCH]
            info[child, STEPS] = info[site, STEPS] + 1
            info[child, BRANCH] = branch
            info[branch, SLOT] = info[child, STEPS]  # in the end its longest path: steps only grow in this order
            queue[tail] = child
            tail += 1
    slots = 0
    for i in range(tail):
        site = queue[i]
        if info[site, BRANCH] == site:
            longest = info[site, SLOT]
            info[site, SLOT] = slots + 1
            slots += longest + 2
        elif info[site, DISTANCE] > 0:
            info[site, SLOT] = info[info[site, BRANCH], SLOT] - 1 + info[site, STEPS]
    return slots


@njit(types.void(IN_I32, types.int64, _GRID, OUT_I32, OUT_I32, OUT_I64), cache=True, nogil=True)
def sort_by_distance(site, active, info, robots, spare, count):
    """Sort the first `active` of `robots` by distance, stable, digit by digit, as many digits as are in use."""
    least = NOT_REACHED
    most = 0
    for i in range(active):
        distance = info[site[robots[i]], DISTANCE]
        least = min(least, distance)
        most = max(most, distance)
    shift = 0
    while (most - least) >> shift > 0:
        count[:] = 0
        for i in range(active):
            count[((info[site[robots[i]], DISTANCE] - least) >> shift & len(count) - 1)] += 1
        total = 0
        for digit in range(len(count)):
            total += count[digit]
            count[digit] = total - count[digit]
        for i in range(active):
            digit = (info[site[robots[i]], DISTANCE] - least) >> shift & len(count) - 1
            spare[count[digit]] = robots[i]
            count[digit] += 1
        robots[:active] = spare[:active]
        shift += _DIGIT


@njit(
    types.UniTuple(types.int64, 3)(
        OUT_U16,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        _GRID,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        OUT_I32,
        OUT_I64,
        OUT_I64,
        types.int64,
        types.boolean,
    ),
    cache=True,
    nogil=True,
)
def _choose(
    cells,
    offset,
    vertex,
    cost,
    info,
    rule,
    waiting_cost,
    first_vertex_move,
    capacity,
    step,
    passed,
    entered,
    many,
    here,
    must_descend,
):
    """Return what to note in ``many`` of a branch, where (-1: nothing), and the direction to take (-1: wait)."""
    least = _FAR
    chosen = _FAR
    best = -1
    wanted = 0
    booked = -1
    own = info[here, SLOT]
    for k in range(offset.shape[1]):
        if not cells[here] >> k & 1:
            continue
        target = here + offset[here & 1, k]
        if info[target, DISTANCE] > info[here, DISTANCE]:
            continue
        late = 0
        at = 0
        end = -1
        if info[target, DISTANCE] > 0:
            if rule == PAPER:
                late = many[info[target, SLOT] + 1] - (info[target, SLOT] + 1 == own)
            else:
                end = info[info[target, BRANCH], SLOT]
                at = info[target, STEPS] + 1
                if many[end] > step * _STEP:
                    late = max(0, many[end] - step * _STEP - at)
        fcost = cost[k] + info[target, DISTANCE] + waiting_cost * late
        if fcost < least:
            least = fcost
            booked = end
            wanted = step * _STEP + at + late + 1
        if fcost >= chosen or cells[target] & OCCUPIED:
            continue
        if must_descend and info[target, DISTANCE] + cost[k] > info[here, DISTANCE]:
            continue
        if k >= first_vertex_move and passed[here + vertex[here & 1, k]] == step:
            continue
        if capacity > 0 and cells[target] & DESTINATION and entered[target] >= step * _STEP + capacity:
            continue
        chosen = fcost
        best = k
    if chosen > least and chosen >= least + waiting_cost and not must_descend:
        best = -1
    return wanted, booked, best


@njit(
    types.UniTuple(types.int64, 3)(
        OUT_U16,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        _GRID,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        OUT_I32,
        OUT_I64,
        OUT_I32,
        OUT_I64,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_BOOL,
        OUT_I32,
        OUT_U8,
        OUT_I64,
        OUT_I64,
    ),
    cache=True,
    nogil=True,
)
def weigh(
    cells,
    offset,
    vertex,
    cost,
    info,
    rule,
    waiting_cost,
    first_vertex_move,
    capacity,
    step,
    active,
    budget,
    passed,
    entered,
    asked,
    many,
    site,
    robots,
    spare,
    aside,
    log_robot,
    log_action,
    log_end,
    arrival,
):
    """Let robots move by least Fcost until `budget` robot-steps are done; return step, active robots, steps done.

    ``Fcost = v + V + waiting_cost * c`` of each open direction of a site, ``cells[site]`` (with flags beside). By the
    rule PAPER, c counts the other robots whose shortest path meets the one that starts with the direction: those of
    the same branch that are as many steps away, ``many[slot]``. By the rule QUEUE, c is how many steps such a robot
    would wait at the end of its branch, which one robot leaves in each step, for the nearer ones that have been asked
    before it; ``many`` of the branch is its next free step.

    Robots are asked in order of distance. Each takes the free direction of least Fcost that leads no farther away,
    unless another is so much better that waiting for it costs no more. But one that is the first of its branch, or has
    just stepped `aside`, only descends: without this, crowds dodge for ever (docs/planners.md). A move from
    `first_vertex_move` on passes a lattice vertex; a destination takes `capacity` robots a step (0: any number).
    """
    done = 0
    logged = 0
    count = np.empty(1 << _DIGIT, dtype=np.int64)
    while active > 0 and budget > 0 and done < len(log_end) and logged + active <= len(log_robot):
        step += 1
        budget -= active
        sort_by_distance(site, active, info, robots, spare, count)
        before = logged
        left = 0
        for i in range(active):
            robot = robots[i]
            here = site[robot]
            branch = info[info[here, BRANCH], SLOT]
            must_descend = asked[branch] != step or aside[robot]
            asked[branch] = step
            wanted, booked, best = _choose(
                cells,
                offset,
                vertex,
                cost,
                info,
                rule,
                waiting_cost,
                first_vertex_move,
                capacity,
                step,
                passed,
                entered,
                many,
                here,
                must_descend,
            )
            if booked >= 0:
                many[booked] = wanted
            aside[robot] = False
            if best < 0:
                robots[left] = robot
                left += 1
                continue
            target = here + offset[here & 1, best]
            aside[robot] = info[target, DISTANCE] + cost[best] > info[here, DISTANCE]
            cells[here] &= ~OCCUPIED
            if best >= first_vertex_move:
                passed[here + vertex[here & 1, best]] = step
            spare[logged - before] = info[here, SLOT]
            log_robot[logged] = robot
            log_action[logged] = best
            logged += 1
            site[robot] = target
            if cells[target] & DESTINATION:
                arrival[robot] = step
                if capacity > 0:
                    entered[target] = max(entered[target], step * _STEP) + 1
            else:
                cells[target] |= OCCUPIED
                robots[left] = robot
                left += 1
        if rule == PAPER:
            for i in range(before, logged):
                many[spare[i - before]] -= 1
                many[info[site[log_robot[i]], SLOT]] += 1
        active = left
        log_end[done] = logged
        done += 1
    return step, active, done
