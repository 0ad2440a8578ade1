"""Least cuts between robots and destinations, by a flow that sends one unit a step through each place.

A *node* is a site, or ``size + vertex`` for a lattice vertex where crossing is forbidden. Each node but a destination
passes at most one unit, so ``onward[node]`` (-1: no unit) holds the whole flow. Nodes are entered at their *in* and
left at their *out*. The search runs back from the destinations over all residual arcs; ``next_of_in`` and
``next_of_out`` name the node ahead on the way there (a node itself: its other half), -1 where no way leads there.
"""

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_U16, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32

NO, ROOT = -1, -2


@njit(
    types.void(
        IN_U16,
        TABLE_I32,
        TABLE_I32,
        IN_I32,
        IN_U16,
        types.int64,
        types.boolean,
        IN_BOOL,
        IN_I32,
        OUT_I32,
        OUT_I32,
        OUT_I32,
        OUT_I64,
        types.int64,
    ),
    cache=True,
    nogil=True,
)
def search_back(
    moves, offset, vertex, ring, via, edge_count, has_vertices, is_destination, onward, next_of_in, next_of_out,
    queue, state, budget,
):  # fmt: skip
    """Go on with the search from ``queue[state[0]:state[1]]`` (2 * node, + 1 for an out), at most `budget` entries."""
    size = len(moves)
    head, tail = state[0], state[1]
    end = head + budget
    while head < tail and head < end:
        node = queue[head] >> 1
        is_out = queue[head] & 1
        head += 1
        if is_out:
            target = onward[node] if onward[node] >= 0 else node
            if next_of_in[target] == NO:
                next_of_in[target] = node
                queue[tail] = 2 * target
                tail += 1
            continue
        if onward[node] >= 0 and next_of_out[node] == NO:
            next_of_out[node] = node
            queue[tail] = 2 * node + 1
            tail += 1
        if node >= size:
            for i in range(len(ring)):
                site = node - size + ring[i]
                if moves[site] & via[i] and not is_destination[site] and next_of_out[site] == NO:
                    next_of_out[site] = node
                    queue[tail] = 2 * site + 1
                    tail += 1
            continue
        for k in range(offset.shape[1]):
            if moves[node] >> k & 1:
                if has_vertices and k >= edge_count:
                    before = size + node + vertex[node & 1, k]
                else:
                    before = node + offset[node & 1, k]
                    if is_destination[before]:
                        continue
                if next_of_out[before] == NO:
                    next_of_out[before] = node
                    queue[tail] = 2 * before + 1
                    tail += 1
    state[0], state[1] = head, tail


@njit(types.void(types.int64, OUT_I32, IN_I32, IN_I32, OUT_I32), cache=True, nogil=True)
def send_unit(start, onward, next_of_in, next_of_out, room):
    """Send one more unit from the site `start` along the way that the search has found."""
    node = start
    while True:
        ahead = next_of_in[node]
        if ahead == ROOT:
            room[node] -= 1
            return
        node = ahead  # itself, or the one whose unit need not come here any more
        while next_of_out[node] == node:  # nor anywhere else: who fed it feeds another
            onward[node] = NO
            node = next_of_in[node]
        onward[node] = next_of_out[node]
        node = next_of_out[node]


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
