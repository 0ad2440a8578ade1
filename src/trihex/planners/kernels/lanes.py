"""Lanes: ways to the destinations that share no cell and no lattice vertex, found one robot after the other.

Each robot in turn is sent along its cheapest path through the *residual graph* of the lanes so far: the path may lead
against a lane, which then goes elsewhere from there (Busacker and Gowen 1961). A node that carries a lane is entered
against it only. Nodes are sites, and size + number of a lattice vertex where nobody may cross. Each has a *value*: what
a way from it costs at least, at first the distance, of a vertex the least of those around it. Values rise as lanes are
found, so that no residual arc costs less than what it comes nearer (Edmonds and Karp 1972): its *reduced* cost is >= 0.
For that a vertex is entered at the cost of the dearest move through it (which matters for euclidean triangles only).
What is not touched stays 0, in arrays as in memory: nodes in arrays are given + 1.
"""

import numpy as np
from numba import njit, types
from numba.cpython.unsafe.numbers import trailing_zeros

from trihex.kernels.signatures import IN_I32, IN_I64, IN_U16, OUT_I32, OUT_I64, OUT_U16, TABLE_I32

# Entries of the state: robots tried, lanes found, nodes visited.
TRIED, FOUND, VISITED = range(3)
SITE = (1 << 32) - 1
NOBODY = 1 << 30  # value of nodes from which nobody can reach a destination any more
# Columns of the nodes: the node before and after on a lane (+ 1), what the lane paid to come here; the value (+ 1); the
# number of the search that has seen the node, at which reduced cost, from which node and entering which (+ 1).
BEFORE, AFTER, PAID, VALUE, SEARCH, REDUCED, PARENT, ENTERED = range(8)
COLUMNS = 8
# In BEFORE: here a lane begins.
BEGIN = -1


@njit(nogil=True)
def _first_value(node, moves, distance, ring, via):
    """Return what a way from a node to a destination costs at least, as long as there are no lanes."""
    if node < len(moves):
        return min(np.int64(distance[node]), NOBODY)
    least = np.int64(NOBODY)
    for i in range(len(ring)):
        site = node - len(moves) + ring[i]
        if moves[site] & via[i]:
            least = min(least, np.int64(distance[site]))
    return least


@njit(nogil=True)
def _cost(node, target, moves, offset, cost):
    """Return what it costs to get from a node to the next one."""
    if node >= len(moves):
        return np.int64(0)
    if target >= len(moves):
        return np.int64(cost.max())
    least = np.int64(NOBODY)
    for k in range(len(cost)):
        if moves[node] >> k & 1 and node + offset[node & 1, k] == target:
            least = min(least, np.int64(cost[k]))
    return least


@njit(nogil=True)
def _push(heap, size, key):
    """Add a key to a heap of `size` keys; return the heap, which may have to grow."""
    if size == len(heap):
        heap = np.append(heap, np.empty_like(heap))
    at = size
    while at > 0 and heap[(at - 1) >> 1] > key:
        heap[at] = heap[(at - 1) >> 1]
        at = (at - 1) >> 1
    heap[at] = key
    return heap


@njit(nogil=True)
def _drop_first(heap, size):
    """Remove the least of `size` keys."""
    key = heap[size - 1]
    at = 0
    while 2 * at + 1 < size - 1:
        child = 2 * at + 1
        if child + 1 < size - 1 and heap[child + 1] < heap[child]:
            child += 1
        if heap[child] >= key:
            break
        heap[at] = heap[child]
        at = child
    heap[at] = key


@njit(nogil=True)
def _search(
    root, start, most, search, first_vertex_move, capacity, moves, distance, offset, vertex, ring, via, cost, ends,
    nodes, seen, level, result,
):  # fmt: skip
    """Find the cheapest path from a node to a destination, if its reduced cost is at most `most`.

    Fills `result` with its last node, the destination (-1: there is none), its reduced cost, the number of nodes seen,
    and whether any was left out because it is too expensive. A Dijkstra search; nodes as near as the one under way wait
    in a stack, so that of many equally good ways one is followed to its end.
    """
    size = len(moves)
    toll = np.int64(cost.max())
    heap = np.empty(1024, np.int64)
    keys = 0
    at = np.int64(0)
    best = most + 1
    result[:] = -1
    is_limited = 0
    nodes[root, SEARCH], nodes[root, REDUCED], nodes[root, PARENT], nodes[root, ENTERED] = search, 0, 0, start + 1
    seen[0] = level[0] = root
    count, waiting = 1, 1
    while best > at:
        if waiting > 0:
            waiting -= 1
            node = np.int64(level[waiting])
        elif keys > 0 and heap[0] >> 32 < best:
            key = heap[0]
            _drop_first(heap, keys)
            keys -= 1
            node = key & SITE
            if nodes[node, REDUCED] < key >> 32:
                continue
            at = key >> 32
        else:
            break
        value = np.int64(nodes[node, VALUE]) - 1
        after = np.int64(nodes[node, AFTER]) - 1
        # Arc -1 leads back along the lane through the node.
        for i in range(-1, len(cost) if node < size else len(ring)):
            paid = np.int64(0)
            if i < 0:
                target = node
            elif node >= size:
                target = node - size + ring[i]
                if not moves[target] & via[i]:
                    continue
            else:
                if not moves[node] >> i & 1:
                    continue
                paid = np.int64(cost[i])
                target = node + offset[node & 1, i]
                if i >= first_vertex_move:
                    paid = toll
                    target = size + node + vertex[node & 1, i]
            if target == after:
                continue
            if target < size and distance[target] == 0:
                if at + paid - value < best and (capacity == 0 or ends[target] < capacity):
                    best = at + paid - value
                    result[0], result[1] = node, target
                continue
            there = target
            before = np.int64(nodes[target, BEFORE])
            if before > 0:  # a lane passes there: back along it
                there = before - 1
                paid -= nodes[target, PAID]
            elif before == BEGIN or i < 0:
                continue
            if nodes[there, VALUE] == 0:
                nodes[there, VALUE] = 1 + _first_value(there, moves, distance, ring, via)
            if nodes[there, VALUE] > NOBODY:
                continue
            reduced = at + paid + nodes[there, VALUE] - 1 - value
            if reduced > most:
                is_limited = 1
                continue
            if nodes[there, SEARCH] != search:
                seen[count] = there
                count += 1
            elif nodes[there, REDUCED] <= reduced:
                continue
            nodes[there, SEARCH], nodes[there, REDUCED] = search, reduced
            nodes[there, PARENT], nodes[there, ENTERED] = node + 1, target + 1
            if reduced == at:
                level[waiting] = there
                waiting += 1
            else:
                heap = _push(heap, keys, reduced << 32 | there)
                keys += 1
    result[2], result[3], result[4] = best, count, is_limited


@njit(nogil=True)
def _expect(starts, distance, lanes, price, due):
    """Fill when each robot, the farthest first, would be there if all took turns in so many lanes without detours."""
    if price < 0:
        return
    for i in range(len(starts) - 1, -1, -1):
        due[i] = distance[starts[i]]
        if i + lanes < len(starts):
            due[i] = max(due[i], due[i + lanes] + price)


@njit(nogil=True)
def _change_lanes(last, goal, moves, offset, cost, nodes):
    """Lead lanes along the path that was found, from its last node back to the start, where the new lane begins."""
    node = last
    nodes[node, AFTER] = goal + 1
    while True:
        parent, entered = np.int64(nodes[node, PARENT]) - 1, np.int64(nodes[node, ENTERED]) - 1
        if parent < 0:
            nodes[entered, BEFORE] = BEGIN
            return
        if entered == parent:  # back along the lane through the node, which passes there no more
            nodes[parent, BEFORE] = nodes[parent, AFTER] = 0
        else:
            nodes[parent, AFTER], nodes[entered, BEFORE] = entered + 1, parent + 1
            nodes[entered, PAID] = _cost(parent, entered, moves, offset, cost)
        node = parent


@njit(
    types.void(
        *[IN_I64, IN_I32, IN_U16, IN_I32, TABLE_I32, TABLE_I32, IN_I32, IN_U16, IN_I32],
        *[types.Array(types.int32, 2, "C"), OUT_I32, OUT_I64, OUT_I32, OUT_I32, OUT_I64, types.int64],
    ),
    cache=True,
    nogil=True,
)
def link(
    rules, starts, moves, distance, offset, vertex, ring, via, cost, nodes, ends, due, seen, level, state, budget
):  # fmt: skip
    """Find lanes from `starts` in turn until about `budget` nodes have been visited, or there is nothing left to try.

    `rules` are: the first vertex move that may not be crossed, how many lanes may end in a destination (0: any), how
    many there can be in all, what a step of waiting costs (-1: find all there are). ``via[i]`` has the bits of the
    moves from ``vertex + ring[i]`` that pass the vertex; ``due[i]`` is what a lane of robot i may cost; ``ends[site]``
    counts the lanes that end in a destination; `seen` and `level` have room for all nodes.
    """
    first_vertex_move, capacity, most_lanes, price = rules
    result = np.empty(5, np.int64)
    done = state[VISITED] + budget
    while state[TRIED] < len(starts) and state[FOUND] < most_lanes and state[VISITED] < done:
        start = np.int64(starts[state[TRIED]])
        state[TRIED] += 1
        if nodes[start, BEFORE] == BEGIN:
            continue
        root = start
        if nodes[start, BEFORE] > 0:  # the lane that passes here goes elsewhere
            root = np.int64(nodes[start, BEFORE]) - 1
        if nodes[root, VALUE] == 0:
            nodes[root, VALUE] = 1 + _first_value(root, moves, distance, ring, via)
        most = due[state[TRIED] - 1] - nodes[root, VALUE] + 1
        if root != start:
            most += nodes[start, PAID]
        if most < 0:
            continue
        _search(
            root, start, most, state[TRIED], first_vertex_move, capacity, moves, distance, offset, vertex, ring, via,
            cost, ends, nodes, seen, level, result,
        )  # fmt: skip
        last, goal, best, count, is_limited = result
        state[VISITED] += count
        for i in range(count):
            node = seen[i]
            if last < 0 and not is_limited:
                nodes[node, VALUE] = NOBODY + 1
            elif nodes[node, REDUCED] < best:
                nodes[node, VALUE] = min(nodes[node, VALUE] + best - nodes[node, REDUCED], NOBODY + 1)
        if last >= 0:
            _change_lanes(last, goal, moves, offset, cost, nodes)
            ends[goal] += 1
            state[FOUND] += 1
            _expect(starts, distance, state[FOUND], price, due)


@njit(
    types.int64(
        *[IN_I32, TABLE_I32, IN_I32, types.Array(types.int32, 2, "C", readonly=True)],
        *[OUT_U16, OUT_I32, OUT_U16, OUT_I32],
    ),
    cache=True,
    nogil=True,
)
def lay(starts, offset, cost, nodes, moves, distance, direction, sites):
    """Fill the sites of all lanes, their distances along them and their directions; return how many sites there are.

    Of `moves` those that lead into a lane are taken away, so that a wave from the lanes leaves them as they are.
    """
    size = len(moves)
    filled = 0
    for start in starts:
        if nodes[start, BEFORE] != BEGIN:
            continue
        first = filled
        site = np.int64(start)
        while distance[site] != 0:
            following = np.int64(nodes[site, AFTER]) - 1
            if following >= size:
                following = np.int64(nodes[following, AFTER]) - 1
            for k in range(len(cost) - 1, -1, -1):  # of two moves to one place the first is the cheaper
                if moves[site] >> k & 1 and site + offset[site & 1, k] == following:
                    direction[site] = 1 << k
            sites[filled] = site
            filled += 1
            site = following
        for i in range(filled - 1, first - 1, -1):
            k = trailing_zeros(direction[sites[i]])
            distance[sites[i]] = cost[k] + distance[sites[i] + offset[sites[i] & 1, k]]
    for i in range(filled):
        site = sites[i]
        for k in range(len(cost)):
            beside = site + offset[site & 1, k]
            for j in range(len(cost)):
                if beside + offset[beside & 1, j] == site:
                    moves[beside] &= ~np.uint16(1 << j)
    return filled
