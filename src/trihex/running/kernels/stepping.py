"""One step of robots in a world that may change before the next: greedy descent, or the least Fcost.

As in the kernels of the planners, but nothing is kept that a change of the world would spoil: the branch of a cell of
the forest of shortest ways, and its steps to the end, are found when first asked for and stamped with the version of
the field. Robots are asked in the order of their distance; so the nearest of those that can act always comes nearer.
"""

from numba import njit, types

from trihex.kernels.signatures import IN_I32, IN_I64, IN_U16, OUT_I32, OUT_I64, OUT_U8, TABLE_I32

GREEDY, FCOST = 0, 1
# When a robot that had better wait steps to a place no farther than its own: never, if that costs no more, or always
# unless it has just left that place.
STAY, WORTH, ALWAYS = 0, 1, 2
_FIELD = [IN_I32, IN_U16, TABLE_I32, IN_I32]
_FOREST = [types.int32, OUT_I32, OUT_I32, OUT_I32]


@njit(types.int64(types.int64, *_FIELD), cache=True, nogil=True)
def _first_best(site, distance, moves, offset, cost):
    """Return the first best direction of a site that is reached and no destination."""
    for k in range(len(cost)):
        if moves[site] >> k & 1 and distance[site + offset[site & 1, k]] == distance[site] - cost[k]:
            return k
    return -1


@njit(types.int64(types.int64, *_FIELD, *_FOREST), cache=True, nogil=True)
def _slot_of(site, distance, moves, offset, cost, version, seen, branch, steps):
    """Return branch << 32 | steps of a site; the branch is the last site of its shortest way."""
    at = site
    walked = 0
    while seen[at] != version:
        parent = at + offset[at & 1, _first_best(at, distance, moves, offset, cost)]
        if distance[parent] == 0:
            seen[at] = version
            branch[at] = at
            steps[at] = 1
            break
        at = parent
        walked += 1
    last = types.int64(branch[at])
    left = steps[at] + walked
    at = site
    result = last << 32 | left
    while seen[at] != version:
        seen[at] = version
        branch[at] = last
        steps[at] = left
        left -= 1
        at += offset[at & 1, _first_best(at, distance, moves, offset, cost)]
    return result


@njit(types.void(IN_I32, *_FIELD, *_FOREST, OUT_I64), cache=True, nogil=True)
def find_slots(sites, distance, moves, offset, cost, version, seen, branch, steps, slots):
    """Fill the slots of `sites`."""
    for i in range(len(sites)):
        slots[i] = _slot_of(sites[i], distance, moves, offset, cost, version, seen, branch, steps)


@njit(types.int64(IN_I64, OUT_I64, OUT_I64), cache=True, nogil=True)
def line_up(slots, slot_of_line, line):
    """Fill how long the line is in each slot that is taken, given the sorted slots of all robots; return how many.

    One robot leaves the line with each step towards the end of the branch, those that stand in the slot join.
    """
    count = 0
    for i in range(len(slots)):
        if count > 0 and slots[i] == slot_of_line[count - 1]:
            line[count - 1] += 1
            continue
        line[count] = 1
        if count > 0 and slots[i] >> 32 == slot_of_line[count - 1] >> 32:
            line[count] += max(0, line[count - 1] - (slots[i] - slot_of_line[count - 1]))
        slot_of_line[count] = slots[i]
        count += 1
    return count


@njit(types.int64(types.int64, types.int64, IN_I64, IN_I64), cache=True, nogil=True)
def _line_at(slot, lines, slot_of_line, line):
    """Return how long the line is that a robot finds in a slot."""
    low, high = 0, lines
    while low < high:
        middle = (low + high) // 2
        if slot_of_line[middle] <= slot:
            low = middle + 1
        else:
            high = middle
    if low == 0 or slot_of_line[low - 1] >> 32 != slot >> 32:
        return 0
    return max(0, line[low - 1] - (slot - slot_of_line[low - 1]))


@njit(
    types.void(
        IN_I64, IN_I32, *_FIELD, TABLE_I32, *_FOREST, types.int64, IN_I64, IN_I64,
        OUT_I32, OUT_I32, OUT_U8, OUT_I32, OUT_I32, OUT_I32, OUT_U8,
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def act(
    rules, order, distance, moves, offset, cost, vertex, version, seen, branch, steps, lines, slot_of_line, line,
    site, came_from, occupied, passed, entered_step, entered_count, action,
):  # fmt: skip
    """Let each robot of `order` move or wait, and put its `action`; `site` and `occupied` follow.

    `rules` are: greedy or Fcost, when to step aside, w_t, the first vertex move that may not be crossed, the capacity
    of a destination (0: any), the number of the step. A robot only ever enters a cell that is empty at that moment,
    so no two exchange cells; who is asked later may enter a cell that was left in the same step.
    """  # fmt: skip
    mode, aside, waiting_cost, first_vertex_move, capacity, step = rules
    for i in range(len(order)):
        robot = order[i]
        here = site[robot]
        parity = here & 1
        own_slot = types.int64(0)
        if mode == FCOST:
            own_slot = _slot_of(here, distance, moves, offset, cost, version, seen, branch, steps)
        own_branch = own_slot >> 32
        # A branch is named by its last site, where no destination is: there the stamp of capacity is free to tell
        # that a robot nearer than this one leads the branch in this step.
        is_first = mode == FCOST and entered_step[own_branch] != step
        if mode == FCOST:
            entered_step[own_branch] = step
        best = 1 << 60
        least = 1 << 60
        nearest = 1 << 60
        taken = -1
        descent = -1
        for k in range(len(cost)):
            if not moves[here] >> k & 1:
                continue
            target = here + offset[parity, k]
            there = types.int64(distance[target])
            is_descent = there + cost[k] == distance[here]
            if mode == GREEDY and not is_descent:
                continue
            fcost = there + cost[k]
            if mode == FCOST and there > 0:
                slot = _slot_of(target, distance, moves, offset, cost, version, seen, branch, steps) + 1
                found = _line_at(slot, lines, slot_of_line, line) - (slot == own_slot)
                fcost += waiting_cost * max(0, found)
            best = min(best, fcost)
            if occupied[target]:
                continue
            if k >= first_vertex_move and passed[here + vertex[parity, k]] == step:
                continue
            if capacity > 0 and there == 0 and entered_step[target] == step and entered_count[target] >= capacity:
                continue
            if is_descent and descent < 0:
                descent = k
            if fcost < least or (fcost == least and there < nearest):
                least = fcost
                nearest = there
                taken = k
        if mode == GREEDY or (is_first and descent >= 0):
            taken = descent
        elif taken >= 0 and least != best and least >= best + waiting_cost:
            steps_aside = aside != STAY and nearest <= distance[here]
            if aside == WORTH and least > best + waiting_cost:
                steps_aside = False
            if aside == ALWAYS and nearest == distance[here] and here + offset[parity, taken] == came_from[robot]:
                steps_aside = False
            if not steps_aside:
                taken = -1
        if taken < 0:
            continue
        target = here + offset[parity, taken]
        action[robot] = taken
        occupied[here] = 0
        came_from[robot] = here
        site[robot] = target
        if taken >= first_vertex_move:
            passed[here + vertex[parity, taken]] = step
        if distance[target] == 0:
            entered_count[target] = 1 + entered_count[target] * (entered_step[target] == step)
            entered_step[target] = step
        else:
            occupied[target] = 1
