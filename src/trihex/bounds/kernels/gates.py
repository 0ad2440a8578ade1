"""How soon robots can arrive at best, if they hinder each other at certain gates only.

A gate passes one robot in each step; everywhere else there is room for all. A *slot* is a gate in a step,
``gate * width + step``, where `width` is the number of steps looked at.
"""

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32

OUT_U8 = types.Array(types.uint8, 1, "C")
SINK = -2
DEAD = 2**31 - 1
# Entries of `state`.
STEP, SERVED, TOTAL, WORK, STAMP = range(5)
# How a node of the search was found from its parent.
PASS, STEAL, SKIP, FEED, CHANGE = range(5)


@njit(
    types.void(
        types.int64,
        IN_I32,
        IN_U16,
        TABLE_I32,
        TABLE_I32,
        types.int64,
        types.boolean,
        IN_BOOL,
        IN_BOOL,
        IN_I32,
        IN_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I64,
    ),
    cache=True,
    nogil=True,
)
def steps_from_gate(
    gate, starts, moves, offset, vertex, edge_count, has_vertices, is_special, is_destination, gate_of_node, robot_at,
    steps, queue, near_gate, gate_steps, near_robot, robot_steps, count,
):  # fmt: skip
    """Find what lies around `gate` (-1: around a destination): gates, robots and destinations, in steps from it.

    The search in breadth begins at the sites `starts`, and passes neither other gates nor destinations. It lists gates
    in `near_gate` and robots in `near_robot` from ``count[0]`` and ``count[1]`` on, raises these, and sets ``count[2]``
    to the steps to a destination that is no gate (-1: none near). `steps` must be -1 at all nodes; it is left so.
    Gates, robots and destinations are all `is_special`, so that at most nodes one look is enough.
    """
    size = len(moves)
    head = 0
    tail = 0
    count[2] = -1
    for site in starts:
        steps[site] = 0
        queue[tail] = site
        tail += 1
    while head < tail:
        node = queue[head]
        head += 1
        here = steps[node]
        if is_special[node]:
            is_start = here == 0 and (gate < 0 or gate_of_node[node] == gate)
            if gate_of_node[node] >= 0 and not is_start:
                near_gate[count[0]] = gate_of_node[node]
                gate_steps[count[0]] = here
                count[0] += 1
                continue
            if is_destination[node] and not is_start:
                if count[2] < 0:
                    count[2] = here
                continue
            if robot_at[node] >= 0:
                near_robot[count[1]] = robot_at[node]
                robot_steps[count[1]] = here
                count[1] += 1
        bits = moves[node]
        for k in range(offset.shape[1]):
            if bits >> k & 1:
                target = node + offset[node & 1, k]
                if has_vertices and k >= edge_count:
                    crossed = size + node + vertex[node & 1, k]
                    if gate_of_node[crossed] >= 0:
                        target = crossed
                if steps[target] < 0 and (gate < 0 or gate_of_node[target] != gate):
                    steps[target] = here + 1
                    queue[tail] = target
                    tail += 1
    for i in range(tail):
        steps[queue[i]] = -1


@njit(
    types.void(
        IN_I32,
        IN_I64,
        IN_I32,
        IN_I32,
        IN_I64,
        IN_I32,
        IN_I32,
        types.int64,
        types.int64,
        OUT_BOOL,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I64,
        OUT_I32,
        OUT_I64,
        OUT_I64,
        OUT_I32,
        OUT_I32,
        OUT_U8,
        OUT_I32,
        OUT_I32,
        OUT_I64,
        types.int64,
    ),
    cache=True,
    nogil=True,
)
def arrive(
    steps_out, first_arc, arc_gate, arc_steps, first_robot, robot, robot_steps, robots, width,
    is_used, onward, seen_in, seen_out, first_slot, reach, next_robot, dead_reach, dead_robot, next_unserved,
    node, parent, way, changed, stack, state, budget,
):  # fmt: skip
    """Serve as many robots as possible by each step in turn, about `budget` looks long or until all are served.

    In step T, from every gate g that leads to a destination in ``steps_out[g]`` steps, a search runs back from slot
    (g, T - steps_out[g]) along residual arcs for a robot that is not served yet. Slots that can be opened in order
    form a matroid, so the number served by each T is the largest possible. A search looks for *ins* (who might enter a
    slot) and *outs* (what leaves it). ``reach[g]`` is the last step of gate g for which all who might enter it have
    been looked at, robots up to ``next_robot[g]`` in its list. What a failing search has seen is of no use ever after.
    """
    gates = len(steps_out)
    while state[SERVED] < robots and state[STEP] + 1 < width and budget > 0:
        state[STEP] += 1
        step = state[STEP]
        for last in range(gates):
            if steps_out[last] < 0 or steps_out[last] > step or state[SERVED] == robots:
                continue
            root = last * width + step - steps_out[last]
            if seen_out[root] == DEAD:
                continue
            state[STAMP] += 1
            stamp = state[STAMP]
            for gate in range(gates):
                reach[gate] = dead_reach[gate]
                next_robot[gate] = dead_robot[gate]
            node[0] = 2 * root + 1
            parent[0] = -1
            seen_out[root] = stamp
            count = 1
            stack[0] = 0
            height = 1
            found = -1
            looks = 0
            while height > 0:
                height -= 1
                at = stack[height]
                slot = node[at] >> 1
                looks += 1
                if node[at] & 1:
                    target = slot
                    how = PASS
                    if is_used[slot]:
                        target = onward[slot]
                        how = STEAL
                    if target >= 0 and seen_in[target] < stamp:
                        seen_in[target] = stamp
                        node[count] = 2 * target
                        parent[count] = at
                        way[count] = how
                        stack[height] = count
                        height += 1
                        count += 1
                    continue
                gate = slot // width
                when = slot - gate * width
                end = first_robot[gate + 1]
                while next_unserved[gate] < end and first_slot[robot[next_unserved[gate]]] >= 0:
                    next_unserved[gate] += 1
                if next_unserved[gate] < end and robot_steps[next_unserved[gate]] <= when:
                    found = at
                    break
                if is_used[slot] and seen_out[slot] < stamp:
                    seen_out[slot] = stamp
                    node[count] = 2 * slot + 1
                    parent[count] = at
                    way[count] = SKIP
                    stack[height] = count
                    height += 1
                    count += 1
                if when <= reach[gate]:
                    continue
                for arc in range(first_arc[gate], first_arc[gate + 1]):
                    other = arc_gate[arc] * width
                    early = max(0, reach[gate] + 1 - arc_steps[arc])
                    for slot_before in range(other + early, other + when + 1 - arc_steps[arc]):
                        looks += 1
                        if seen_out[slot_before] < stamp:
                            seen_out[slot_before] = stamp
                            node[count] = 2 * slot_before + 1
                            parent[count] = at
                            way[count] = FEED
                            stack[height] = count
                            height += 1
                            count += 1
                reach[gate] = when
                i = next_robot[gate]
                while i < end and robot_steps[i] <= when:
                    looks += 1
                    target = first_slot[robot[i]]
                    if target >= 0 and seen_in[target] < stamp:
                        seen_in[target] = stamp
                        node[count] = 2 * target
                        parent[count] = at
                        way[count] = CHANGE
                        changed[count] = robot[i]
                        stack[height] = count
                        height += 1
                        count += 1
                    i += 1
                next_robot[gate] = i
            budget -= looks
            state[WORK] += looks
            if found < 0:
                for i in range(count):
                    if node[i] & 1:
                        seen_out[node[i] >> 1] = DEAD
                    else:
                        seen_in[node[i] >> 1] = DEAD
                for gate in range(gates):
                    dead_reach[gate] = reach[gate]
                    dead_robot[gate] = next_robot[gate]
                continue
            slot = node[found] >> 1
            first_slot[robot[next_unserved[slot // width]]] = slot
            at = found
            while parent[at] >= 0:
                slot = node[at] >> 1
                slot_ahead = node[parent[at]] >> 1
                if way[at] == PASS:
                    is_used[slot] = True
                elif way[at] == SKIP:
                    is_used[slot] = False
                elif way[at] == FEED:
                    onward[slot] = slot_ahead
                elif way[at] == CHANGE:
                    first_slot[changed[at]] = slot_ahead
                at = parent[at]
            onward[root] = SINK
            state[SERVED] += 1
            state[TOTAL] += step
