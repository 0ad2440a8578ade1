"""Least-cost flow of robots through layers of steps: a primal-dual search that keeps its tree from robot to robot.

The graph is that of `trihex.planners.network` and is never built. Every node takes one unit, so a byte per node holds
the flow: which arc it comes in by and which it leaves by.

Potentials. A node that carries flow has two sides (2 * index: where flow comes in; 2 * index + 1: where it leaves), any
other one. The potential of a side, a lower bound on the cost from there to a destination in the residual graph, is its
value in the network plus an *excess* >= 0. The search goes by levels, ascending. The *tree* holds sides reached from
robots without path; it is closed: all tight arcs out of it end in it. So raising the level raises the potentials of the
whole tree at once, and a side that is in it stores no excess but its *entry*: excess = level - entry. ``label[side]``
is the excess outside the tree and ``~entry`` within; 0, what fresh memory holds, is right for all that was never seen.

When the tree touches a destination, a search backward through tight arcs looks for a robot without path. If it finds
one, the flow is augmented. If not, all that it saw leaves the tree for good or until it is reached anew. Sides of robots
served meanwhile thus stay in the tree until they matter: raising potentials beyond need is harmless, as long as what is
raised is closed, and looking after them at once would cost more. An empty tree, when no robot in it lacks a path, is
swept out instead.
"""

import numpy as np
from numba import njit, types

from trihex.kernels.signatures import IN_I32, IN_I64, OUT_I32, OUT_I64, OUT_U8, OUT_U16

# What a call ends with.
DONE, BUDGET_SPENT, STACK_FULL, ENTRIES_FULL, TRAIL_FULL, LAYERS_FULL, LEVELS_FULL = range(7)
# What is going on.
GROW, SEEK, BURY, REQUEUE, AUGMENT, SWEEP = range(6)
# Places in `state`.
MODE, LEVEL, SERVED, LACKING, NEXT_ROBOT, STACK, ENTRIES, FREE_ENTRY, FRESH_ENTRY, TRAIL, BURIED, CURSOR = range(12)
LOWEST, HIGHEST, TOTAL, WORK, DEFERRED, IS_THOROUGH, SEEN_COUNT, BURIED_BEFORE = range(12, 20)
SPREAD_ROBOT, SPREAD_SERVED = range(20, 22)
STATE_SIZE = 64
# Flow of a node: place + 1 of the arc out in the low four bits, of the arc in in the high four; a robot starts there.
START = 15
# Parent of a side: the other side of the same node.
OWN = 14
# Added to the place of arcs that lead to a destination.
TO_GOAL = 16
# Marks of sides out of the tree: 1 + the level at which they are due, modulo WINDOW; of sides in it: SEEN + when a
# search saw them, by the number of sides seen before, coarsely.
WINDOW = 256
SEEN = 1 << 9
COARSE = 4
LAST_SEEN = (1 << 16) - 1 - SEEN
FAR = 1 << 60
NOT_NEAR = 1 << 30
MOST_LEVEL = 1 << 30

TABLE = types.Array(types.int32, 3, "C", readonly=True)


@njit(
    types.UniTuple(types.int64, 2)(
        types.int64, types.int64, types.int64, OUT_I32, OUT_U8, OUT_U8, TABLE, TABLE
    ),
    cache=True,
    nogil=True,
)
def _support(side, nodes, first_goal, label, flow, parent, out_arcs, in_arcs):
    """Return the least entry that the tree offers to a side along residual arcs, and the place of that arc."""
    at = side >> 1
    node = at % nodes
    if side & 1:
        if flow[at] == 0:
            return FAR, 0
        i = (flow[at] & 15) - 1
        source = label[2 * (at + out_arcs[node, i, 0])]
        if source < 0:
            return ~source - out_arcs[node, i, 1], 0
        return FAR, 0
    best = FAR
    place = 0
    taken = (flow[at] >> 4) - 1
    for j in range(in_arcs.shape[1]):
        offset = in_arcs[node, j, 0]
        if offset == 0:
            break
        other = at + offset
        carries = flow[other] != 0
        source = label[2 * other + carries]
        if source >= 0:
            continue
        if node >= first_goal:
            if (flow[other] & 15) - 1 == in_arcs[node, j, 2]:
                continue
        elif j == taken:
            continue
        entry = ~source + in_arcs[node, j, 1]
        if entry < best:
            best = entry
            place = j
    if node < first_goal and flow[at] != 0 and label[2 * at + 1] < 0 and ~label[2 * at + 1] < best:
        best = ~label[2 * at + 1]
        place = OWN
    return best, place


@njit(
    types.boolean(types.int64, types.int64, types.int64, OUT_U16, OUT_I64, OUT_I64, OUT_I64, OUT_I64),
    cache=True,
    nogil=True,
)
def _queue(side, due, level, mark, due_first, entry_side, entry_next, state):
    """Put a side down for level `due`, or for the last level of the window; tell whether that is earlier than before."""
    due = min(due, level + WINDOW - 2)
    if mark[side] >= SEEN or mark[side] != 0 and (mark[side] - 1 - level) % WINDOW <= due - level:
        return False
    mark[side] = due % WINDOW + 1
    entry = state[FREE_ENTRY]
    if entry >= 0:
        state[FREE_ENTRY] = entry_next[entry]
    else:
        entry = state[FRESH_ENTRY]
        state[FRESH_ENTRY] += 1
    state[ENTRIES] += 1
    entry_side[entry] = side
    entry_next[entry] = due_first[due % WINDOW]
    due_first[due % WINDOW] = entry
    return True


@njit(
    types.int64(
        types.int64, types.int64, types.int64, types.int64, types.int64,
        OUT_I32, OUT_U8, OUT_U16, OUT_I64, OUT_I64, OUT_I64, OUT_I64, OUT_I64,
    ),
    cache=True,
    nogil=True,
)
def _reach(side, entry, place, level, top, label, parent, mark, stack, due_first, entry_side, entry_next, state):
    """Take a side that an arc leads to into the tree, or put it down for the level at which the arc gets tight."""
    excess = label[side]
    if excess < 0:
        return top
    due = entry + excess
    if due > level:
        if _queue(side, due, level, mark, due_first, entry_side, entry_next, state) and not side & 1:
            parent[side >> 1] = place & 15
        return top
    if not side & 1:
        parent[side >> 1] = place & 15
    if place < TO_GOAL:
        mark[side] = 0
        label[side] = ~(level - excess)
    stack[top] = side
    return top + 1


@njit(
    types.void(types.int64, types.int64, IN_I64, OUT_U8, TABLE, types.int64, OUT_I32, OUT_I32, types.int64, IN_I32),
    cache=True,
    nogil=True,
)
def _spread(first_robot, last_robot, start_of_robot, lacking, out_arcs, first_goal, away, queue, lam, hops):
    """Lower `away`, the number of moves from the nearest robot without path, by what further robots offer."""
    nodes = len(away)
    head = 0
    tail = 0
    for robot in range(first_robot, last_robot):
        node = start_of_robot[robot] % nodes
        if lacking[node]:
            away[node] = lam * (100000 - hops[node])
            queue[tail] = node
            tail += 1
    while head < tail:
        node = queue[head % len(queue)]
        head += 1
        for i in range(out_arcs.shape[1]):
            if out_arcs[node, i, 0] == 0:
                break
            other = out_arcs[node, i, 3]
            if other < first_goal and away[other] > away[node] + 1:
                away[other] = away[node] + 1
                queue[tail % len(queue)] = other
                tail += 1


@njit(
    types.int64(
        types.int64, types.int64, types.int64, types.boolean, TABLE, TABLE, IN_I32, IN_I64, IN_I64,
        OUT_U8, OUT_I32, OUT_I32, OUT_I32, OUT_U8, OUT_U8, OUT_U16,
        OUT_I64, OUT_I64, OUT_I64, OUT_I64,
        OUT_I64, OUT_I64, OUT_U8, OUT_I64, OUT_I64, OUT_I64, OUT_I64, OUT_I64, OUT_I64, OUT_I64, types.int64,
    ),
    cache=True,
    nogil=True,
)
def search(
    first_goal,
    cell_count,
    capacity,
    walled,
    out_arcs,
    in_arcs,
    hops,
    start_of_robot,
    level_of_robot,
    lacking,
    away,
    queue,
    label,
    flow,
    parent,
    mark,
    stack,
    due_first,
    entry_side,
    entry_next,
    trail,
    trail_tried,
    trail_place,
    trail_entry,
    trail_index,
    trail_low,
    trail_buried,
    buried,
    deferred,
    state,
    budget,
):
    """Serve robots, in order of level, until all have a path or `budget` small pieces of work are done."""
    nodes = len(hops)
    size = len(flow)
    arcs = out_arcs.shape[1]
    reach = 3 * nodes
    room = 2 * arcs + 8
    robots = len(start_of_robot)
    lam = np.int64(state[60])
    pen = np.int64(state[62])
    inf = np.int64(state[63])
    lost = 200 + nodes // 8
    mode = state[MODE]
    level = state[LEVEL]
    top = state[STACK]
    depth = state[TRAIL]
    seen = state[SEEN_COUNT]
    low, high = state[LOWEST], state[HIGHEST]
    status = BUDGET_SPENT
    work = 0
    while work < budget:
        work += 1
        if mode == SEEK: state[40+mode+10*state[IS_THOROUGH]]+=1
        else: state[40+mode] += 1
        if mode == SEEK: state[40+mode+10*state[IS_THOROUGH]]+=1
        else: state[40+mode] += 1
        if top + room > len(stack):
            status = STACK_FULL
            break
        if state[ENTRIES] + room > len(entry_side):
            status = ENTRIES_FULL
            break
        if max(depth, state[BURIED], state[DEFERRED]) + room > len(trail):
            status = TRAIL_FULL
            break

        if mode == GROW:
            if top > 0:
                top -= 1
                side = stack[top]
                at = side >> 1
                node = at % nodes
                entry = label[side]
                if node >= first_goal:
                    if flow[at] < capacity:
                        mode = SEEK
                        state[IS_THOROUGH] = 0
                        depth = 0
                        trail[0] = side
                        trail_tried[0] = 0
                        trail_entry[0] = FAR
                        seen = 0
                        trail_index[0] = 0
                        trail_low[0] = FAR
                        trail_buried[0] = 0
                        continue
                    if entry >= 0:
                        mark[side] = 0
                        entry = ~(level - entry)
                        label[side] = entry
                if entry >= 0:
                    continue
                entry = ~entry
                low = min(low, side)
                high = max(high, side)
                if node >= first_goal:
                    for j in range(in_arcs.shape[1]):
                        offset = in_arcs[node, j, 0]
                        if offset == 0:
                            break
                        other = at + offset
                        if flow[other] != 0 and (flow[other] & 15) - 1 == in_arcs[node, j, 2]:
                            top = _reach(
                                2 * other + 1, entry - in_arcs[node, j, 1], 0, level, top, label, parent, mark, stack,
                                due_first, entry_side, entry_next, state,
                            )
                    continue
                leaving = -1
                if flow[at] != 0:
                    if side & 1:
                        leaving = (flow[at] & 15) - 1
                        top = _reach(
                            2 * at, entry, OWN, level, top, label, parent, mark, stack,
                            due_first, entry_side, entry_next, state,
                        )
                    else:
                        j = (flow[at] >> 4) - 1
                        if j != START - 1:
                            top = _reach(
                                2 * (at + in_arcs[node, j, 0]) + 1, entry - in_arcs[node, j, 1], 0, level, top,
                                label, parent, mark, stack, due_first, entry_side, entry_next, state,
                            )
                        continue
                elif side & 1:
                    continue
                if at + reach >= size and not walled:
                    stack[top] = side
                    top += 1
                    status = LAYERS_FULL
                    break
                for i in range(arcs):
                    offset = out_arcs[node, i, 0]
                    if offset == 0:
                        break
                    if i == leaving or at + offset >= size:
                        continue
                    top = _reach(
                        2 * (at + offset), entry + out_arcs[node, i, 1], out_arcs[node, i, 2], level, top,
                        label, parent, mark, stack, due_first, entry_side, entry_next, state,
                    )
                continue
            robot = state[NEXT_ROBOT]
            if robot < robots and level_of_robot[robot] <= level:
                state[NEXT_ROBOT] = robot + 1
                state[LACKING] += 1
                at = start_of_robot[robot]
                lacking[at % nodes] = 1
                if label[2 * at] >= 0:
                    mark[2 * at] = 0
                    label[2 * at] = ~(level - label[2 * at])
                stack[top] = 2 * at
                top += 1
                continue
            slot = level % WINDOW
            found = due_first[slot]
            if found < 0 and state[DEFERRED] > 0:
                state[DEFERRED] -= 1
                side = deferred[state[DEFERRED]]
                mark[side] = 0
                if flow[side >> 1] < capacity:
                    mode = SEEK
                    state[IS_THOROUGH] = 1
                    depth = 0
                    trail[0] = side
                    trail_tried[0] = 0
                    trail_entry[0] = FAR
                    seen = 0
                    trail_index[0] = 0
                    trail_low[0] = FAR
                    trail_buried[0] = 0
                else:
                    stack[top] = side
                    top += 1
                continue
            if found < 0:
                if state[SERVED] == robots:
                    status = DONE
                    break
                if level == MOST_LEVEL:
                    status = LEVELS_FULL
                    break
                level += 1
                continue
            side = entry_side[found]
            due_first[slot] = entry_next[found]
            entry_next[found] = state[FREE_ENTRY]
            state[FREE_ENTRY] = found
            state[ENTRIES] -= 1
            if mark[side] != slot + 1:
                continue
            mark[side] = 0
            if label[side] < 0:
                continue
            entry, j = _support(side, nodes, first_goal, label, flow, parent, out_arcs, in_arcs)
            if entry == FAR:
                continue
            if not side & 1:
                parent[side >> 1] = j
            if entry + label[side] > level:
                _queue(side, entry + label[side], level, mark, due_first, entry_side, entry_next, state)
                continue
            if (side >> 1) % nodes < first_goal:
                label[side] = ~(level - label[side])
            stack[top] = side
            top += 1

        elif mode == SEEK:
            is_thorough = state[IS_THOROUGH] != 0
            if is_thorough and (depth == 0 or seen > lost and state[SERVED] > state[SPREAD_SERVED]):
                if depth > 0:
                    for i in range(state[BURIED]):
                        mark[buried[i]] = 0
                    for i in range(1, depth + 1):
                        mark[trail[i]] = 0
                    depth = 0
                    seen = 0
                    state[BURIED] = 0
                    trail_tried[0] = 0
                    trail_low[0] = FAR
                    away[:] = NOT_NEAR
                    state[SPREAD_ROBOT] = 0
                    state[SPREAD_SERVED] = state[SERVED]
                    state[29] += 1
                _spread(state[SPREAD_ROBOT], state[NEXT_ROBOT], start_of_robot, lacking, out_arcs, first_goal, away, queue, lam, hops)
                state[SPREAD_ROBOT] = state[NEXT_ROBOT]
            side = trail[depth]
            at = side >> 1
            node = at % nodes
            entry = level if depth == 0 else ~label[side]
            tried = trail_tried[depth]
            found = -1
            if side & 1:
                j = (flow[at] & 15) - 1
                other = 2 * (at + out_arcs[node, j, 0])
                if not tried and label[other] < 0 and ~label[other] - out_arcs[node, j, 1] == entry:
                    if mark[other] >= SEEN:
                        trail_low[depth] = min(trail_low[depth], (mark[other] - SEEN) << COARSE)
                    else:
                        found = other
                tried = 1
            else:
                taken = (flow[at] >> 4) - 1
                first, last = (0, in_arcs.shape[1]) if is_thorough else (parent[at], parent[at] + 1)
                if first == OWN:
                    last = first
                best = FAR
                for j in range(first, last):
                    offset = in_arcs[node, j, 0]
                    if offset == 0:
                        break
                    if tried >> j & 1:
                        continue
                    other = at + offset
                    carries = flow[other] != 0
                    source = label[2 * other + carries]
                    if source >= 0 or (
                        carries and (flow[other] & 15) - 1 == in_arcs[node, j, 2] if node >= first_goal else j == taken
                    ):
                        tried |= 1 << j
                        continue
                    source = ~source + in_arcs[node, j, 1]
                    other = 2 * other + carries
                    if source != entry:
                        trail_entry[depth] = min(trail_entry[depth], source)
                        tried |= 1 << j
                    elif mark[other] >= SEEN:
                        trail_low[depth] = min(trail_low[depth], (mark[other] - SEEN) << COARSE)
                        tried |= 1 << j
                    else:
                        near = in_arcs[node, j, 3]
                        far = 2 * away[near]
                        t = (other >> 1) // nodes - hops[near]
                        if carries:
                            near = out_arcs[near, (flow[other >> 1] & 15) - 1, 3]
                            far = 2 * away[near] + pen
                            t += 1
                        if away[near] > t:
                            far += inf
                        if far < best:
                            best = far
                            found = other
                            trail_place[depth] = j
                if (is_thorough or first == OWN) and node < first_goal and flow[at] != 0 and not tried >> OWN & 1:
                    other = 2 * at + 1
                    if label[other] >= 0:
                        tried |= 1 << OWN
                    elif ~label[other] != entry:
                        trail_entry[depth] = min(trail_entry[depth], ~label[other])
                        tried |= 1 << OWN
                    elif mark[other] >= SEEN:
                        trail_low[depth] = min(trail_low[depth], (mark[other] - SEEN) << COARSE)
                        tried |= 1 << OWN
                    elif 2 * away[out_arcs[node, (flow[at] & 15) - 1, 3]] + pen + (inf if away[out_arcs[node, (flow[at] & 15) - 1, 3]] > at//nodes-hops[node]+1 else 0)< best:
                        found = other
                        trail_place[depth] = OWN
                if found >= 0:
                    tried |= 1 << trail_place[depth]
            trail_tried[depth] = tried
            if found >= 0:
                depth += 1
                seen += 1
                mark[found] = SEEN + min(seen >> COARSE, LAST_SEEN)
                trail[depth] = found
                trail_tried[depth] = 0
                trail_entry[depth] = FAR
                trail_index[depth] = seen
                trail_low[depth] = FAR
                trail_buried[depth] = state[BURIED]
                at = found >> 1
                node = at % nodes
                if node < cell_count and lacking[node] and not found & 1 and at // nodes == hops[node]:
                    mode = AUGMENT
            elif not is_thorough:  # the chain of parents is broken
                for i in range(1, depth + 1):
                    mark[trail[i]] = 0
                depth = 0
                side = trail[0]
                if mark[side] < SEEN:
                    mark[side] = SEEN
                    deferred[state[DEFERRED]] = side
                    state[DEFERRED] += 1
                mode = GROW
            elif trail_low[depth] < trail_index[depth] and depth > 0:
                depth -= 1
                trail_low[depth] = min(trail_low[depth], trail_low[depth + 1])
                buried[state[BURIED]] = side
                state[BURIED] += 1
            elif state[BURIED] == trail_buried[depth] and depth > 0:
                depth -= 1
                state[32]+=1
                state[32]+=1
                mark[side] = 0
                label[side] = level - entry
                if trail_entry[depth + 1] < FAR:
                    _queue(
                        side, trail_entry[depth + 1] + level - entry, level, mark, due_first, entry_side, entry_next, state
                    )
            else:  # none that it comes from, directly or in a circle, is reached from a robot without path
                mode = BURY
                if depth==0: state[30]+=1
                if depth==0: state[30]+=1
                state[CURSOR] = state[BURIED_BEFORE] = trail_buried[depth]
                buried[state[BURIED]] = side
                state[BURIED] += 1
                depth -= 1

        elif mode == BURY:
            cursor = state[CURSOR]
            if cursor < state[BURIED]:
                side = buried[cursor]
                mark[side] = 0
                if label[side] < 0:
                    label[side] = level - ~label[side]
                state[CURSOR] = cursor + 1
            else:
                mode = REQUEUE

        elif mode == REQUEUE:
            if state[BURIED] == state[BURIED_BEFORE]:
                mode = SEEK if depth >= 0 else GROW
                depth = max(depth, 0)
                continue
            state[BURIED] -= 1
            side = buried[state[BURIED]]
            entry, j = _support(side, nodes, first_goal, label, flow, parent, out_arcs, in_arcs)
            if entry < FAR:
                if not side & 1:
                    parent[side >> 1] = j
                _queue(side, entry + label[side], level, mark, due_first, entry_side, entry_next, state)

        elif mode == AUGMENT:
            if top + 2 * depth + room > len(stack):
                status = STACK_FULL
                break
            state[33+state[IS_THOROUGH]]+=1
            state[35]+=state[BURIED]
            state[33+state[IS_THOROUGH]]+=1
            state[35]+=state[BURIED]
            for i in range(state[BURIED]):
                mark[buried[i]] = 0
            state[BURIED] = 0
            for i in range(1, depth + 1):
                side = trail[i]
                at = side >> 1
                mark[side] = 0
                if flow[at] == 0:
                    mark[side + 1] = 0
                    label[side + 1] = label[side]
            at = trail[depth] >> 1
            if False: print(level, state[LACKING], seen, depth, away[at%nodes], at//nodes, 'root cell', at%nodes, 'z t', trail[0]>>1//nodes, state[BURIED])
            lacking[at % nodes] = 0
            flow[at] = START << 4
            for i in range(depth, 0, -1):
                at = trail[i] >> 1
                side = trail[i - 1]
                other = side >> 1
                if side & 1:
                    continue
                if at == other:
                    flow[at] = 0
                    continue
                j = trail_place[i - 1]
                node = other % nodes
                flow[at] = (flow[at] & 0xF0) | (in_arcs[node, j, 2] + 1)
                if node < first_goal:
                    flow[other] = (flow[other] & 15) | ((j + 1) << 4)
                elif i == 1:
                    flow[other] += 1
            for i in range(depth + 1):
                at = trail[i] >> 1
                stack[top] = 2 * at
                top += 1
                if i > 0 and flow[at] != 0:
                    stack[top] = 2 * at + 1
                    top += 1
            side = trail[0]
            if flow[side >> 1] == capacity:
                stack[top] = side
                top += 1
            elif mark[side] < SEEN:
                mark[side] = SEEN
                deferred[state[DEFERRED]] = side
                state[DEFERRED] += 1
            mode = GROW
            state[SERVED] += 1
            state[TOTAL] += level
            state[LACKING] -= 1
            if state[LACKING] == 0:
                for i in range(top):
                    low = min(low, stack[i])
                    high = max(high, stack[i])
                top = 0
                for i in range(state[DEFERRED]):
                    mark[deferred[i]] = 0
                state[DEFERRED] = 0
                mode = SWEEP
                state[CURSOR] = low

        else:  # SWEEP
            cursor = state[CURSOR]
            end = min(high + 2, cursor + (1 << 16))
            for side in range(cursor, min(end, 2 * size)):
                if label[side] < 0:
                    label[side] = level - ~label[side]
            state[CURSOR] = end
            work += (end - cursor) >> 4
            if end >= high + 2:
                mode = GROW
                low, high = 2 * size, -1
    state[MODE] = mode
    state[LEVEL] = level
    state[STACK] = top
    state[TRAIL] = depth
    state[SEEN_COUNT] = seen
    state[LOWEST], state[HIGHEST] = low, high
    state[WORK] += work
    return status
