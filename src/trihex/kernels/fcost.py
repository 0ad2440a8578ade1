"""Robots that weigh a longer way against waiting: the paper's Fcost = v + V + w_t * c, with c by look-up.

Following the first of the best directions from every cell makes a forest; the cells whose ways enter a destination by
the same last move form a *branch*. On a forest two robots meet on their shortest ways if and only if they are in one
branch and equally many steps from its end. So each (branch, steps) is a *slot* with a number, slots of a branch in
order of steps, and what the paper counts over n - 1 paths is one look-up in a table of robots by slot.
"""

import numpy as np
from numba import njit, types

from trihex.kernels.signatures import IN_I32, IN_I64, IN_U16, OUT_I32, OUT_I64, OUT_U8, TABLE_I32

# What c counts: robots that will be in my slot, or the line that they have formed in it by the time I am there.
MEETINGS, QUEUE = 0, 1
# When a blocked robot steps aside: never; to a place no farther than its own, if that is worth a wait; whenever there
# is one that it has not just left.
STAY, WORTH, ALWAYS = 0, 1, 2
_DIGIT_BITS = 10
_DIGITS = 1 << _DIGIT_BITS


@njit(types.void(IN_I32, IN_I32, IN_U16, TABLE_I32, OUT_I32, OUT_I32), cache=True, nogil=True)
def grow_branches(order, distance, directions, offset, branch, steps):
    """Fill the last site of each branch, and the steps to its end, for the sites in `order` of distance."""
    for i in range(len(order)):
        site = order[i]
        k = 0
        while not directions[site] >> k & 1:
            k += 1
        parent = site + offset[site & 1, k]
        if distance[parent] == 0:
            branch[site] = site
            steps[site] = 1
        else:
            branch[site] = branch[parent]
            steps[site] = steps[parent] + 1


@njit(types.void(IN_I64, IN_I64, OUT_I64), cache=True, nogil=True)
def line_up(first_slot, count, line):
    """Fill how long the line is that a robot finds in its slot: one leaves in each step, those of the slot join."""
    for branch in range(len(first_slot) - 1):
        waiting = 0
        for slot in range(first_slot[branch], first_slot[branch + 1]):
            waiting = max(0, waiting - 1) + count[slot]
            line[slot] = waiting


@njit(types.void(IN_I32, IN_I32, types.int64, OUT_I32, OUT_I32), cache=True, nogil=True)
def sort_by_distance(distance, site, active, listed, spare):
    """Sort the first `active` robots of `listed` by the distance of their sites, keeping the order of ties.

    By digits, as many as are in use: a third of the time of a merge sort, and an eighth of its time to compile.
    """
    least = 2**31 - 1
    most = 0
    for i in range(active):
        least = min(least, distance[site[listed[i]]])
        most = max(most, distance[site[listed[i]]])
    count = np.empty(_DIGITS, dtype=np.int64)
    shift = 0
    while (most - least) >> shift > 0:
        count[:] = 0
        for i in range(active):
            count[((distance[site[listed[i]]] - least) >> shift) % _DIGITS] += 1
        before = 0
        for digit in range(_DIGITS):
            before += count[digit]
            count[digit] = before - count[digit]
        for i in range(active):
            digit = ((distance[site[listed[i]]] - least) >> shift) % _DIGITS
            spare[count[digit]] = listed[i]
            count[digit] += 1
        for i in range(active):
            listed[i] = spare[i]
        shift += _DIGIT_BITS


@njit(
    types.UniTuple(types.int64, 3)(
        *[IN_I64, IN_I32, IN_I32, IN_I32, IN_U16, IN_U16, TABLE_I32, TABLE_I32, IN_I32, IN_I64],
        *[types.int64, types.int64, types.int64],
        *[OUT_I32, OUT_I32, OUT_I32, OUT_I32, OUT_U8, OUT_I64, OUT_I64, OUT_I32, OUT_I32, OUT_I32, OUT_I32],
        *[OUT_I32, OUT_U8, OUT_I64, OUT_I64],
    ),
    cache=True,
    nogil=True,
)
def weigh(
    rules,
    distance,
    slot_of_site,
    branch_of_site,
    directions,
    moves,
    offset,
    vertex,
    cost,
    first_slot,
    step,
    active,
    budget,
    listed,
    spare,
    site,
    came_from,
    occupied,
    count,
    line,
    passed,
    entered_step,
    entered_count,
    led_step,
    log_robot,
    log_action,
    log_end,
    arrival,
):
    """Let robots act until `budget` robot-steps are done or the log is full; return step, active robots, steps done.

    `rules` are: what c counts, when to step aside, w_t, what a collision costs, the first vertex move that may not be
    crossed, the capacity of a destination (0: any). The first robot of each branch descends, if it can; the nearest of
    all always can, so every robot arrives. Any other takes the free direction of least Fcost, unless waiting for the
    best direction promises less.
    """
    counts, aside, waiting_cost, collision_cost, first_vertex_move, capacity = rules
    done = 0
    logged = 0
    while active > 0 and budget > 0 and done < len(log_end) and logged + active <= len(log_robot):
        step += 1
        budget -= active
        if counts == QUEUE:
            line_up(first_slot, count, line)
        else:
            for slot in range(len(count)):
                line[slot] = count[slot]
        sort_by_distance(distance, site, active, listed, spare)
        kept = 0
        for i in range(active):
            robot = listed[i]
            here = site[robot]
            parity = here & 1
            own_slot = slot_of_site[here]
            is_first = led_step[branch_of_site[here]] != step
            led_step[branch_of_site[here]] = step
            best = 1 << 60
            least = 1 << 60  # Fcost of the best free direction, and of the cell it leads to the distance
            nearest = 1 << 60
            taken = -1
            descent = -1
            for k in range(offset.shape[1]):
                if not moves[here] >> k & 1:
                    continue
                target = here + offset[parity, k]
                collisions = 0
                if distance[target] > 0:
                    slot = slot_of_site[target] + 1
                    collisions = line[slot] - (slot == own_slot)
                fcost = cost[k] + distance[target] + collision_cost * collisions
                best = min(best, fcost)
                if occupied[target]:
                    continue
                if k >= first_vertex_move and passed[here + vertex[parity, k]] == step:
                    continue
                if capacity > 0 and entered_step[target] == step and entered_count[target] >= capacity:
                    continue
                if descent < 0 and directions[here] >> k & 1:
                    descent = k
                if fcost < least or (fcost == least and distance[target] < nearest):
                    least = fcost
                    nearest = distance[target]
                    taken = k
            if is_first and descent >= 0:
                taken = descent
            elif taken >= 0 and least != best and least >= best + waiting_cost:
                steps_aside = aside != STAY and nearest <= distance[here]
                if aside == WORTH and least > best + waiting_cost:
                    steps_aside = False
                if aside == ALWAYS and nearest == distance[here] and here + offset[parity, taken] == came_from[robot]:
                    steps_aside = False
                if not steps_aside:
                    taken = -1
            if taken >= 0:
                target = here + offset[parity, taken]
                log_robot[logged] = robot
                log_action[logged] = taken
                logged += 1
                occupied[here] = 0
                came_from[robot] = here
                site[robot] = target
                count[own_slot] -= 1
                if taken >= first_vertex_move:
                    passed[here + vertex[parity, taken]] = step
                if distance[target] == 0:
                    arrival[robot] = step
                    if capacity > 0:
                        entered_count[target] = 1 + entered_count[target] * (entered_step[target] == step)
                        entered_step[target] = step
                    continue
                occupied[target] = 1
                count[slot_of_site[target]] += 1
            listed[kept] = robot
            kept += 1
        active = kept
        log_end[done] = logged
        done += 1
    return step, active, done
