"""A robot's cheapest way in space and time past the ways of others, by A* with the distance as estimate.

The ways of others are *reserved*: for each (step, site) one byte, 0 or 1 + the direction by which a robot came there
(or `WAIT` if it waited or starts there), and for each (step, lattice vertex) whether it is passed. Row t of a table is
step t; beyond the last row nothing is reserved. A search keeps its nodes (step, site) in a list, found again by
hashing, and the open ones in a heap.
"""

import numpy as np
from numba import njit, types

from trihex.kernels.signatures import (
    IN_BOOL,
    IN_I32,
    IN_I64,
    IN_U8,
    IN_U16,
    OUT_I32,
    OUT_I64,
    OUT_U8,
    TABLE_I32,
    UNCOUNTED,
)

WAIT = 254
FOUND, NOTHING, BUDGET_SPENT, LIST_FULL = 0, 1, 2, 3
# Entries of the state of a search.
NODES, OPEN, GOAL, LOOKS = range(4)
STATE_SIZE = 4
_NODE_LISTS = types.Array(types.int32, 2, "C")
# Rows of the lists of nodes and of open nodes.
SITE, STEP, PARENT, ACTION, PLACE = range(5)


@njit(nogil=True, **UNCOUNTED)
def _is_before(estimate, left, a, b):
    """Tell whether entry `a` of the heap comes first: the lower estimate, then the nearer node."""
    return estimate[a] < estimate[b] or (estimate[a] == estimate[b] and left[a] < left[b])


@njit(nogil=True, **UNCOUNTED)
def _swap(estimate, left, node, a, b):
    estimate[a], estimate[b] = estimate[b], estimate[a]
    left[a], left[b] = left[b], left[a]
    node[a], node[b] = node[b], node[a]


@njit(nogil=True, **UNCOUNTED)
def _push(estimate, left, node, size, its_estimate, its_left, its_node):
    estimate[size] = its_estimate
    left[size] = its_left
    node[size] = its_node
    at = size
    while at > 0 and _is_before(estimate, left, at, (at - 1) // 2):
        _swap(estimate, left, node, at, (at - 1) // 2)
        at = (at - 1) // 2


@njit(nogil=True, **UNCOUNTED)
def _drop_first(estimate, left, node, size):
    """Remove the first entry of a heap of `size` entries."""
    size -= 1
    _swap(estimate, left, node, 0, size)
    at = 0
    while True:
        child = 2 * at + 1
        if child >= size:
            return
        if child + 1 < size and _is_before(estimate, left, child + 1, child):
            child += 1
        if not _is_before(estimate, left, child, at):
            return
        _swap(estimate, left, node, at, child)
        at = child


@njit(nogil=True, **UNCOUNTED)
def _find_place(site, step, nodes, table):
    """Return where in the hash table a node stands, or would."""
    mask = len(table) - 1
    mixed = np.uint64(site) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(step) * np.uint64(0xC2B2AE3D27D4EB4F)
    place = np.int64(mixed >> np.uint64(33)) & mask
    while table[place] >= 0 and (nodes[SITE, table[place]] != site or nodes[STEP, table[place]] != step):
        place = (place + 1) & mask
    return place


@njit(nogil=True, **UNCOUNTED)
def _is_open(site, k, step, rules, offset, vertex, back, distance, number, reserved, passed, entries):
    """Tell whether a robot may leave `site` by direction `k` so that it is there in `step`."""
    _, first_vertex_move, capacity, rows, size, ends = rules
    if step >= rows:
        return True
    target = site + offset[site & 1, k]
    if k >= first_vertex_move and passed[step * size + site + vertex[site & 1, k]]:
        return False
    if distance[target] == 0:
        return capacity == 0 or entries[step * ends + number[target]] < capacity
    if reserved[step * size + target]:
        return False
    return reserved[step * size + site] != 1 + back[site & 1, k]


@njit(nogil=True, **UNCOUNTED)
def clear(nodes, table, state):
    """Forget the nodes of the last search."""
    for i in range(state[NODES]):
        table[nodes[PLACE, i]] = -1
    state[NODES] = 0
    state[OPEN] = 0


@njit(
    types.int64(types.int64, IN_I32, IN_I64, TABLE_I32, TABLE_I32, TABLE_I32, IN_I32, IN_I32, IN_U8, IN_U8, IN_I32),
    cache=True,
    nogil=True,
    **UNCOUNTED,
)
def find_first_entry(step, gates, rules, offset, vertex, back, distance, number, reserved, passed, entries):
    """Return the first step from `step` on in which a destination can be entered from one of the sites `gates`."""
    rows, size = rules[3], rules[4]
    while step < rows:
        for site in gates:
            if step > 0 and reserved[(step - 1) * size + site]:
                continue
            for k in range(offset.shape[1]):
                if distance[site + offset[site & 1, k]] == 0 and _is_open(
                    np.int64(site), k, step, rules, offset, vertex, back, distance, number, reserved, passed, entries
                ):
                    return step
        step += 1
    return step


@njit(
    types.void(types.int64, IN_I32, _NODE_LISTS, OUT_I64, OUT_I32, OUT_I64, OUT_I32, OUT_I32, OUT_I64),
    cache=True,
    nogil=True,
    **UNCOUNTED,
)
def begin(start, distance, nodes, cost_of_node, table, estimate, left, node, state):
    """Begin a search at a site."""
    clear(nodes, table, state)
    nodes[SITE, 0] = start
    nodes[STEP, 0] = 0
    nodes[PARENT, 0] = -1
    nodes[ACTION, 0] = 0
    cost_of_node[0] = 0
    place = _find_place(start, 0, nodes, table)
    table[place] = 0
    nodes[PLACE, 0] = place
    _push(estimate, left, node, 0, np.int64(distance[start]), distance[start], 0)
    state[NODES] = 1
    state[OPEN] = 1


@njit(
    types.int64(
        *[IN_I64, TABLE_I32, TABLE_I32, IN_I32, TABLE_I32, IN_I32, IN_U16, IN_I32, IN_BOOL],
        *[IN_U8, IN_U8, IN_I32, types.int64, types.int64],
        *[_NODE_LISTS, OUT_I64, OUT_I32, OUT_I64, OUT_I32, OUT_I32, OUT_I64, types.int64],
    ),
    cache=True,
    nogil=True,
    **UNCOUNTED,
)
def search(
    rules,
    offset,
    vertex,
    cost,
    back,
    distance,
    moves,
    number,
    is_shut,
    reserved,
    passed,
    entries,
    limit,
    earliest,
    nodes,
    cost_of_node,
    table,
    estimate,
    left,
    node,
    state,
    budget,
):
    """Go on with a search for at most `budget` nodes; tell whether a way of a cost below `limit` was found.

    `rules` are w_t, the first vertex move that may not be crossed, the capacity of a destination (0: any), how many
    rows the tables have, the number of sites and that of destinations. ``is_shut[site]`` bars a site in all steps
    (empty: none). No way arrives before step `earliest`: behind a destination that is busy until then that spares
    nearly all nodes (600 robots on one side of 64 x 64 cells: 0.2 s in place of 50). Nodes of equal estimate are taken
    nearest first, so that a robot whom nobody hinders walks straight on.
    """
    waiting_cost, _, _, rows, size, _ = rules
    directions = offset.shape[1]
    least_cost = waiting_cost
    for k in range(directions):
        least_cost = min(least_cost, np.int64(cost[k]))
    most = nodes.shape[1]
    while state[OPEN] > 0:
        if budget <= 0:
            return BUDGET_SPENT
        if state[NODES] + directions + 1 > most or state[OPEN] + directions + 1 > len(estimate):
            return LIST_FULL
        budget -= 1
        state[LOOKS] += 1
        at = np.int64(node[0])
        promised = estimate[0]
        _drop_first(estimate, left, node, state[OPEN])
        state[OPEN] -= 1
        site = np.int64(nodes[SITE, at])
        step = np.int64(nodes[STEP, at]) + 1
        if promised >= limit:
            return NOTHING
        if promised > cost_of_node[at] + max(np.int64(distance[site]), (earliest - step + 1) * least_cost):
            continue  # it was reached at less cost since
        if distance[site] == 0:
            state[GOAL] = at
            return FOUND
        for k in range(directions + 1):
            target = site
            its_cost = cost_of_node[at]
            if k == directions:
                if step < rows and reserved[step * size + site]:
                    continue
                its_cost += waiting_cost
            else:
                if not moves[site] >> k & 1:
                    continue
                target = site + offset[site & 1, k]
                its_cost += cost[k]
                if len(is_shut) > 0 and is_shut[target]:
                    continue
                if not _is_open(
                    site, k, step, rules, offset, vertex, back, distance, number, reserved, passed, entries
                ):
                    continue
            promise = its_cost + max(np.int64(distance[target]), (earliest - step) * least_cost)
            if promise >= limit:
                continue
            place = _find_place(target, step, nodes, table)
            new = np.int64(table[place])
            if new >= 0 and cost_of_node[new] <= its_cost:
                continue
            if new < 0:
                new = state[NODES]
                state[NODES] += 1
                nodes[SITE, new] = target
                nodes[STEP, new] = step
                nodes[PLACE, new] = place
                table[place] = new
            nodes[PARENT, new] = at
            nodes[ACTION, new] = k
            cost_of_node[new] = its_cost
            _push(estimate, left, node, state[OPEN], promise, distance[target], new)
            state[OPEN] += 1
    return NOTHING


@njit(types.int64(_NODE_LISTS, OUT_I64, types.int64, OUT_U8), cache=True, nogil=True, **UNCOUNTED)
def write_way(nodes, state, directions, actions):
    """Fill the actions that lead to the goal, 255 for a wait, and return their number."""
    at = state[GOAL]
    steps = nodes[STEP, at]
    while nodes[PARENT, at] >= 0:
        action = nodes[ACTION, at]
        actions[nodes[STEP, at] - 1] = 255 if action == directions else action
        at = nodes[PARENT, at]
    return steps


@njit(
    types.void(
        *[types.int64, IN_U8, types.boolean, IN_I64, TABLE_I32, TABLE_I32, IN_I32, IN_I32, OUT_U8, OUT_U8, OUT_I32]
    ),
    cache=True,
    nogil=True,
    **UNCOUNTED,
)
def reserve(start, actions, is_on, rules, offset, vertex, distance, number, reserved, passed, entries):
    """Reserve a way, or free it again. The tables have a row for each of its steps."""
    _, first_vertex_move, capacity, _, size, ends = rules
    site = start
    reserved[site] = 1 + WAIT if is_on else 0
    for i in range(len(actions)):
        step = i + 1
        k = np.int64(actions[i])
        if k == 255:
            reserved[step * size + site] = 1 + WAIT if is_on else 0
            continue
        if k >= first_vertex_move:
            passed[step * size + site + vertex[site & 1, k]] = is_on
        site += offset[site & 1, k]
        if distance[site] > 0:
            reserved[step * size + site] = 1 + k if is_on else 0
        elif capacity > 0:
            entries[step * ends + number[site]] += 1 if is_on else -1
