"""Robots that weigh a longer way against waiting: the paper's Fcost = v + V + w_t * c, with c by look-up.

Regions, blocks, rows and the tables of moves are those of `greedy`, as is why indices are made unsigned (it saves a
sixth); branches and slots are those of `slots`.
"""

import numpy as np
from numba import njit, types
from numba.cpython.unsafe.numbers import trailing_zeros

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import IN_I32, IN_I64, IN_U16, OUT_I32, OUT_I64, OUT_U8, TABLE_I32
from trihex.planners.kernels.greedy import ROW
from trihex.planners.kernels.slots import LEAD, count_meetings, find_slot, line_up

# What c counts: robots that will be in my slot, or the line that they have formed in it by the time I am there.
MEETINGS, QUEUE = 0, 1
# When a blocked robot steps aside: never; to a place no farther than its own, if that is worth a wait; whenever there
# is one that it has not just left.
STAY, WORTH, ALWAYS = 0, 1, 2
_FAR = 1 << 60
_U = np.uint64


@njit(nogil=True)
def _measure_lines(regions_branches, steps, count, line, first_slot, highest, lined_end):
    """Find how far the lines of some branches may reach in the next `steps` steps, and clear what lies beyond."""
    first_branch, last_branch = regions_branches
    for branch in range(first_branch, last_branch):
        end = first_slot[branch]
        if highest[branch] > 0:
            waiting = line_up(end, highest[branch] + 1, count, line)
            end = min(first_slot[branch + 1], highest[branch] + 1 + max(waiting, steps))
        for slot in range(end, lined_end[branch]):
            line[slot] = 0
        lined_end[branch] = end


@njit(nogil=True)
def _find_captain(captain, site_of_robot, robot_at, best, offset):
    """Return who is at the head of the way of `captain`: the cell to which its first best direction leads is free."""
    while True:
        site = site_of_robot[captain]
        ahead = robot_at[site + offset[site & 1, trailing_zeros(best[site])]]
        if ahead == 0:
            return captain
        captain = ahead


@njit(
    types.void(
        *[IN_I64, TABLE_I32, IN_I32, IN_I32, IN_I32, types.int64, types.int64, types.int64],
        *[IN_I32, IN_U16, IN_U16, OUT_I32, OUT_I64, OUT_I32, OUT_I32],
        *[IN_I32, IN_I64, IN_I32, OUT_I32, OUT_I32, OUT_I32, OUT_I64, OUT_I64],
        *[IN_I64, IN_I64, IN_I64, IN_I64, OUT_I64, OUT_I32, OUT_I32],
        *[OUT_I32, OUT_I32, OUT_I32, OUT_I32],
        *[OUT_I32, OUT_U8, OUT_I64, OUT_I64],
    ),
    cache=True,
    nogil=True,
)
def weigh(
    rules,
    table,
    offset,
    vertex,
    cost,
    block,
    first_step,
    steps,
    distance,
    best_moves,
    moves,
    robot_at,
    passed,
    entered_step,
    entered_count,
    branch_of_end,
    first_slot,
    branch_of_slot,
    slot,
    count,
    line,
    highest,
    lined_end,
    first_branch_of_region,
    first_end_of_region,
    regions,
    first_of_region,
    count_of_region,
    captain_of_region,
    listed,
    site_of_robot,
    row_of_robot,
    asked,
    came_from,
    robot_of_row,
    action_of_row,
    arrival,
    lost,
):
    """Let the robots of `regions` act for `steps` steps after `first_step`; fill a row of actions for each.

    `rules` are: what c counts, when to step aside, every how many steps lines are counted anew and a robot whose way
    is free looks for a better one, what a collision costs, w_t, the first vertex move that may not be crossed, the
    capacity of a destination (0: any). Each robot takes the free direction of least Fcost, unless waiting for the best
    direction promises less. In each region one robot, the captain, or who stands at the head of its way, is asked
    first and descends; so a captain arrives in bounded time, and then there is another. `lost` counts what all robots
    lose: the cost of waits, and of moves beyond what they come nearer.
    """
    counts, aside, period, price, waiting_cost, first_vertex_move, capacity = rules
    filled = 0
    loss = 0
    waiting_for_other = np.empty(len(listed), np.int32)
    for i in range(len(regions)):
        region = regions[i]
        first = first_of_region[region]
        first_branch, last_branch = first_branch_of_region[region], first_branch_of_region[region + 1]
        low, high = first_slot[first_branch], first_slot[last_branch]
        low_end, high_end = -first_end_of_region[region + 1], -1 - first_end_of_region[region]
        for branch in range(first_branch, last_branch):
            highest[branch] = 0
        for j in range(first, first + count_of_region[region]):
            robot = listed[j]
            row_of_robot[robot] = filled
            robot_of_row[filled] = robot
            filled += 1
            own_slot = slot[site_of_robot[robot]]
            branch = branch_of_slot[own_slot]
            highest[branch] = max(highest[branch], own_slot)
        if counts == QUEUE:
            _measure_lines((first_branch, last_branch), steps, count, line, first_slot, highest, lined_end)
        for s in range(steps):
            if count_of_region[region] == 0:
                break
            step = first_step + s + 1
            for branch in range(first_branch, last_branch):
                if counts == MEETINGS:
                    count_meetings(first_slot[branch], first_slot[branch + 1], count, line)
                elif s % period == 0:
                    line_up(first_slot[branch], lined_end[branch], count, line)
            captain = captain_of_region[region]
            if captain == 0 or site_of_robot[captain] == 0:
                captain = listed[first]
            captain = _find_captain(captain, site_of_robot, robot_at, best_moves, table)
            captain_of_region[region] = captain
            kept = first
            for j in range(first - 1, first + count_of_region[region]):
                own = listed[j] if j >= first else captain
                robot = own
                depth = 0
                while asked[_U(own)] != step:
                    site = np.int64(site_of_robot[_U(robot)])
                    parity = (site & 1) << ROW
                    own_distance = distance[_U(site)]
                    own_slot = slot[_U(site)]
                    descends = robot == captain or (counts == MEETINGS and line[_U(own_slot)] & LEAD != 0)
                    best = _FAR  # Fcost of the best direction, and of the best that is free
                    least = _FAR
                    taken = WAIT
                    to = site
                    via = 0
                    other = np.int32(0)
                    untried = best_moves[_U(site)]
                    while untried:
                        k = np.int64(trailing_zeros(untried))
                        untried &= untried - np.uint16(1)
                        target = site + offset[_U(parity | k)]
                        its_slot = slot[_U(target)]
                        if its_slot == 0:
                            its_slot = find_slot(
                                target, best_moves, table, branch_of_end, first_slot, branch_of_slot, slot
                            )
                        fcost = np.int64(own_distance)
                        if its_slot > 0:
                            if its_slot < low or its_slot >= high:
                                continue
                            collisions = (line[_U(its_slot + 1)] & (LEAD - 1)) - (its_slot + 1 == own_slot)
                            fcost += price * collisions
                        elif its_slot < low_end or its_slot > high_end:
                            continue
                        best = min(best, fcost)
                        other = robot_at[_U(target)]
                        if other:
                            if other > own and asked[_U(other)] != step:  # those listed before have been asked
                                break
                            other = np.int32(0)
                            continue
                        at = (site + vertex[_U(parity | k)]) * (k >= first_vertex_move)
                        if passed[_U(at)] >> 32 == block and passed[_U(at)] >> s & 1:
                            continue
                        if capacity > 0 and entered_step[_U(target)] == step and entered_count[_U(target)] >= capacity:
                            continue
                        if fcost < least:
                            least = fcost
                            taken = k
                            to = target
                            via = at
                            if descends:
                                break
                    if other and j >= first:
                        waiting_for_other[_U(depth)] = robot
                        depth += 1
                        robot = other
                        continue
                    if descends and taken != WAIT:
                        line[_U(own_slot)] &= LEAD - 1
                    elif least > own_distance and (counts == MEETINGS or taken == WAIT or (step + robot) % period == 0):
                        untried = moves[_U(site)] & ~best_moves[_U(site)]
                        while untried:
                            k = np.int64(trailing_zeros(untried))
                            untried &= untried - np.uint16(1)
                            target = site + offset[_U(parity | k)]
                            fcost = np.int64(cost[_U(k)]) + distance[_U(target)]
                            if fcost >= least:
                                continue
                            its_slot = slot[_U(target)]
                            if its_slot == 0:
                                its_slot = find_slot(
                                    target, best_moves, table, branch_of_end, first_slot, branch_of_slot, slot
                                )
                            if its_slot < low or its_slot >= high:
                                continue
                            collisions = (line[_U(its_slot + 1)] & (LEAD - 1)) - (its_slot + 1 == own_slot)
                            fcost += price * collisions
                            best = min(best, fcost)
                            if fcost >= least or robot_at[_U(target)]:
                                continue
                            at = (site + vertex[_U(parity | k)]) * (k >= first_vertex_move)
                            if passed[_U(at)] >> 32 == block and passed[_U(at)] >> s & 1:
                                continue
                            least = fcost
                            taken = k
                            to = target
                            via = at
                        if taken != WAIT and least != best and least >= best + waiting_cost:
                            stays = aside == STAY or distance[_U(to)] > own_distance
                            stays |= aside == WORTH and least > best + waiting_cost
                            stays |= aside == ALWAYS and distance[_U(to)] == own_distance and to == came_from[_U(robot)]
                            if stays:
                                taken = WAIT
                                to = site
                                via = 0
                    asked[_U(robot)] = step
                    action_of_row[_U(row_of_robot[_U(robot)] * steps + s)] = taken
                    if taken == WAIT:
                        loss += waiting_cost
                    else:
                        loss += cost[_U(taken)] + distance[_U(to)] - own_distance
                        before = passed[_U(via)] if passed[_U(via)] >> 32 == block else block << 32
                        passed[_U(via)] = before | 1 << s if via else 0
                        came_from[_U(robot)] = site
                        robot_at[_U(site)] = 0
                        count[_U(own_slot)] -= 1
                        if slot[_U(to)] < 0:
                            arrival[_U(robot)] = step
                            site_of_robot[_U(robot)] = 0
                            if capacity > 0:
                                entered_count[_U(to)] = 1 + entered_count[_U(to)] * (entered_step[_U(to)] == step)
                                entered_step[_U(to)] = step
                        else:
                            robot_at[_U(to)] = robot
                            site_of_robot[_U(robot)] = to
                            count[_U(slot[_U(to)])] += 1
                    if depth > 0:
                        depth -= 1
                        robot = waiting_for_other[_U(depth)]
                if j >= first:
                    listed[_U(kept)] = own
                    kept += site_of_robot[_U(own)] > 0
            count_of_region[region] = kept - first
    lost[0] += loss
