"""Least cuts between robots and destinations, by a flow that sends one unit a step through each place.

A *node* is a site, or ``size + vertex`` for a lattice vertex where crossing is forbidden. Each node but a destination
passes at most one unit, so ``onward[node]`` (-1: no unit) and its inverse ``source_of[node]`` (the node itself: the
unit starts there) hold the whole flow. Nodes are entered at their *in*, 2 * node, and left at their *out*,
2 * node + 1; a unit may be led along any *residual arc*: on, or back where another came, which then goes elsewhere.
"""

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32

DEAD = 2**31 - 1
# Entries of the state of `send_units`.
STAMP, SENT, FAILED, LOOKS = range(4)


@njit(nogil=True)
def _list_ahead(node, steps, moves, offset, vertex, ring, via, edge_count, has_vertices, ahead):
    """List the nodes that can be entered from `node` (the same that it can be entered from); the nearest comes last."""
    size = len(moves)
    count = 0
    nearest = 0
    least = DEAD
    if node >= size:
        for i in range(len(ring)):
            site = node - size + ring[i]
            if moves[site] & via[i]:
                ahead[count] = site
                if steps[site] < least:
                    nearest, least = count, steps[site]
                count += 1
    else:
        for k in range(offset.shape[1]):
            if moves[node] >> k & 1:
                site = node + offset[node & 1, k]
                if steps[site] < least:
                    nearest, least = count, steps[site]
                if has_vertices and k >= edge_count:
                    site = size + node + vertex[node & 1, k]
                ahead[count] = site
                count += 1
    ahead[nearest], ahead[count - 1] = ahead[count - 1], ahead[nearest]
    return count


@njit(
    types.int64(
        IN_I32,
        types.int64,
        IN_I32,
        IN_U16,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        IN_U16,
        types.int64,
        types.boolean,
        IN_BOOL,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I64,
        types.int64,
    ),
    cache=True,
    nogil=True,
)
def send_units(
    start, first, steps, moves, offset, vertex, ring, via, edge_count, has_vertices, is_destination, room,
    onward, source_of, seen, parent, stack, trail, ahead, state, budget,
):  # fmt: skip
    """Send units from the sites ``start[first:]`` to the destinations; return the index of the next one to send.

    Returns before a unit that can be sent though the one before it could not, after about `budget` looks, or at the
    end. Searches go depth first to where the fewest `steps` are left. What a failing search has seen leads nowhere ever
    after (`DEAD` in `seen`).
    """
    size = len(moves)
    for r in range(first, len(start)):
        if budget <= 0:
            return r
        item = 2 * start[r]
        if seen[item] == DEAD:
            state[FAILED] += 1
            continue
        state[STAMP] += 1
        stamp = state[STAMP]
        seen[item] = stamp
        parent[item] = -1
        stack[0] = item
        trail[0] = item
        height = 1
        marks = 1
        found = -1
        while height > 0:
            height -= 1
            budget -= 1
            state[LOOKS] += 1
            item = stack[height]
            node = item >> 1
            is_onto = node < size and is_destination[node]
            count = 0
            if item & 1:
                count = _list_ahead(node, steps, moves, offset, vertex, ring, via, edge_count, has_vertices, ahead)
                for i in range(count):
                    ahead[i] *= 2
                if onward[node] >= 0:
                    ahead[count] = 2 * node
                    count += 1
            elif is_onto:
                if room[node] > 0:
                    found = item
                    break
                count = _list_ahead(node, steps, moves, offset, vertex, ring, via, edge_count, has_vertices, ahead)
                for i in range(count):
                    ahead[i] = 2 * ahead[i] + 1 if onward[ahead[i]] == node else -1
            elif onward[node] < 0:
                ahead[0] = 2 * node + 1
                count = 1
            elif source_of[node] != node:
                ahead[0] = 2 * source_of[node] + 1
                count = 1
            for i in range(count):
                after = ahead[i]
                if after >= 0 and seen[after] < stamp:
                    seen[after] = stamp
                    parent[after] = item
                    stack[height] = after
                    trail[marks] = after
                    height += 1
                    marks += 1
        if found < 0:
            for i in range(marks):
                seen[trail[i]] = DEAD
            state[FAILED] += 1
            continue
        if state[FAILED] > 0:
            return r
        state[SENT] += 1
        item = found
        room[item >> 1] -= 1
        while parent[item] >= 0:
            before = parent[item]
            here, there = before >> 1, item >> 1
            if before & 1 and here != there:
                onward[here] = there
                source_of[there] = here
            elif before & 1:
                onward[here] = -1
            item = before
        source_of[item >> 1] = item >> 1
    return len(start)


@njit(
    types.int64(
        IN_U16,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        IN_U16,
        types.int64,
        types.boolean,
        IN_BOOL,
        IN_I32,
        OUT_BOOL,
        OUT_I32,
        types.int64,
        types.int64,
        types.int64,
    ),
    cache=True,
    nogil=True,
)
def search_back(
    moves, offset, vertex, ring, via, edge_count, has_vertices, is_destination,
    onward, leads_on, queue, head, tail, budget,
):  # fmt: skip
    """Go back along residual arcs from ``queue[head:tail]``, at most `budget` items; return the new tail.

    ``leads_on[item]`` tells whether a residual way leads from the item to a destination that has room.
    """
    size = len(moves)
    for at in range(head, min(tail, head + budget)):
        item = queue[at]
        node = item >> 1
        if item & 1:
            item = 2 * onward[node]
            if not leads_on[item]:
                leads_on[item] = True
                queue[tail] = item
                tail += 1
            continue
        if onward[node] >= 0 and not leads_on[item + 1]:
            leads_on[item + 1] = True
            queue[tail] = item + 1
            tail += 1
        for i in range(len(ring) if node >= size else offset.shape[1]):
            if node >= size:
                before = node - size + ring[i]
                is_open = moves[before] & via[i] != 0
            elif has_vertices and i >= edge_count:
                before = size + node + vertex[node & 1, i]
                is_open = moves[node] >> i & 1 != 0
            else:
                before = node + offset[node & 1, i]
                is_open = moves[node] >> i & 1 != 0
            if is_open and not leads_on[2 * before + 1] and not (before < size and is_destination[before]):
                leads_on[2 * before + 1] = True
                if onward[before] >= 0:
                    queue[tail] = 2 * before + 1
                    tail += 1
                elif not leads_on[2 * before]:  # the other half of a free node, at once
                    leads_on[2 * before] = True
                    queue[tail] = 2 * before
                    tail += 1
    return tail


@njit(
    types.void(
        IN_I32,
        IN_I32,
        IN_U16,
        TABLE_I32,
        TABLE_I32,
        types.int64,
        types.boolean,
        OUT_I32,
        OUT_I64,
        OUT_I64,
        OUT_BOOL,
    ),
    cache=True,
    nogil=True,
)
def count_meetings(start, steps, moves, offset, vertex, edge_count, has_vertices, site, seen, meetings, moving):
    """Count at each node how often robots meet that all descend `steps` without regard to each other.

    Ties are broken by a hash of robot and step. ``seen[node]`` is room for the last step in which it was used.
    """
    size = len(moves)
    for r in range(len(start)):
        site[r] = start[r]
        moving[r] = steps[start[r]] > 0
    step = 0
    some_move = True
    while some_move:
        some_move = False
        step += 1
        for r in range(len(start)):
            if not moving[r]:
                continue
            some_move = True
            here = site[r]
            best = -1
            least = 0
            for k in range(offset.shape[1]):
                if moves[here] >> k & 1 and steps[here + offset[here & 1, k]] < steps[here]:
                    lot = (r * 40503 + step * 30011 + k * 9973) * 2654435761 >> 16 & 65535
                    if best < 0 or lot < least:
                        best, least = k, lot
            node = here + offset[here & 1, best]
            site[r] = node
            if has_vertices and best >= edge_count:
                crossed = size + here + vertex[here & 1, best]
                meetings[crossed] += seen[crossed] == step
                seen[crossed] = step
            if steps[node] == 0:
                moving[r] = False
            else:
                meetings[node] += seen[node] == step
                seen[node] = step
