"""Least-cost flow of robots through layers of steps, by searches from both ends that learn from what they exhaust.

The graph is that of `trihex.optimum.network` and is never built: a byte per node holds the flow: see `flow_byte`.

Robots get their paths in ascending order of cost, the *level* (successive shortest paths). At each level two searches,
`back` and `ahead`, take turns until one finds a robot without path and a destination joined
by residual arcs of that cost, or has seen all there is, which proves that there is no such path and ends the level.
Where destinations are crowded the search back is the quicker, where robots hardly meet the search ahead.
"""

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, HELPER, OUT_I64, kernel
from trihex.optimum.kernels.ahead import forget_ahead, look_ahead, turn_ahead
from trihex.optimum.kernels.back import BITS, NEVER, forget_back, look_back, turn_back
from trihex.optimum.kernels.residual import (
    AGE,
    BUDGET_SPENT,
    CURRENT,
    DONE,
    ENDS,
    EXTRA,
    FAR_AWAY,
    FIRST_ROBOT,
    FOUND,
    LAST,
    LAST_ROBOT,
    LAYER,
    LAYERS,
    LAYERS_FULL,
    LEVEL,
    LEVELS_FULL,
    LIST_FULL,
    MOST_LEVEL,
    NODES,
    OFFSET,
    OPEN_GOALS,
    OTHER,
    QUOTA,
    ROOT,
    SEARCH,
    SERVED,
    SERVED_THEN,
    SHORT,
    SIDE,
    SPARE_ROWS,
    SPENT,
    TOTAL,
    TURN,
)

# Whose turn it is.
NEXT_LEVEL, BACK, AHEAD = range(3)
FIRST_QUOTA = 256


@HELPER
def _spread_through(vertex, steps, tail, layer, ends):
    """List the nodes to which a vertex leads, to be left in the same step; return the new tail of the queue."""
    for j in range(layer.out.shape[1]):
        if layer.out[vertex, j, OFFSET] == 0:
            break
        further = layer.out[vertex, j, OTHER]
        if ends.away[further] == FAR_AWAY:
            ends.away[further] = steps
            ends.queue[tail] = further
            tail += 1
    return tail


@HELPER
def _spread_from(node, tail, layer, ends):
    """List the nodes one step on that have not been; return the new tail of the queue."""
    away, steps = ends.away, ends.away[node] + 1
    for i in range(layer.out.shape[1]):
        if layer.out[node, i, OFFSET] == 0:
            break
        other = layer.out[node, i, OTHER]
        if away[other] < FAR_AWAY:
            continue
        away[other] = steps
        if layer.is_vertex[other]:
            tail = _spread_through(other, steps, tail, layer, ends)
        else:
            ends.queue[tail] = other
            tail += 1
    return tail


@APART
def _spread(layer, ends, state):
    """Fill `away`."""
    size = len(layer.hops)
    for node in range(size):
        ends.away[node] = FAR_AWAY
    tail = np.int64(0)
    for robot in range(state[FIRST_ROBOT], state[LAST_ROBOT]):
        node = ends.start[robot] % size
        if ends.lacks[node]:
            ends.away[node] = 0
            ends.queue[tail] = node
            tail += 1
    head = 0
    while head < tail:
        tail = _spread_from(ends.queue[head], tail, layer, ends)
        head += 1
    state[AGE] = 0
    state[SERVED_THEN] = state[SERVED]


@HELPER
def _open_layer(row, layer, nodes, ends):
    """Set the bounds from the robots for the nodes of a layer as if there were no others."""
    size = len(layer.hops)
    for node in layer.order:
        at = row * size + node
        best = NEVER
        if row == layer.hops[node] and not layer.is_vertex[node]:  # step 0
            if ends.lacks[node]:
                best = 0
        elif row >= layer.hops[node]:
            for j in range(layer.into.shape[1]):
                offset = layer.into[node, j, OFFSET]
                if offset == 0:
                    break
                best = min(best, (nodes.since[at + offset] >> BITS) + layer.into[node, j, EXTRA])
        nodes.since[at] = min(best, NEVER) << BITS


@HELPER
def _open_goals(layer, nodes, ends, state):
    """Leave of the open destinations those that somebody may still come to, and add those of a layer that is new."""
    size = len(layer.hops)
    row = state[LEVEL] // layer.base
    count = 0
    for k in range(state[OPEN_GOALS]):
        at = ends.goals[k]
        if nodes.flow[at] < layer.capacity and nodes.since[at] < NEVER << BITS:
            ends.goals[count] = at
            count += 1
    if row == state[LAYERS]:
        _open_layer(row, layer, nodes, ends)
        state[LAYERS] += 1
        for node in range(layer.first_goal, size):
            ends.goals[count] = row * size + node
            count += 1
    state[OPEN_GOALS] = count


@HELPER
def _list_robots(ends, size, state):
    """Find the robots without path that may have one now."""
    while state[LAST_ROBOT] < len(ends.start) and ends.value[state[LAST_ROBOT]] <= state[LEVEL]:
        state[LAST_ROBOT] += 1
    while state[FIRST_ROBOT] < state[LAST_ROBOT] and not ends.lacks[ends.start[state[FIRST_ROBOT]] % size]:
        state[FIRST_ROBOT] += 1


@APART
def _start_level(layer, nodes, ahead, ends, state):
    """Open what may be used at the next level and list the roots of the searches."""
    size = len(layer.hops)
    if ((state[LEVEL] + 1) // layer.base + SPARE_ROWS) * size > len(nodes.flow):
        return LAYERS_FULL
    if state[LEVEL] == MOST_LEVEL:
        return LEVELS_FULL
    state[LEVEL] += 1
    _open_goals(layer, nodes, ends, state)
    _list_robots(ends, size, state)
    ahead.state[ROOT] = state[FIRST_ROBOT]
    state[QUOTA] = FIRST_QUOTA
    state[TURN] = state[SIDE]
    return BUDGET_SPENT


@HELPER
def _look(layer, nodes, back, ahead, ends, state):
    """Let the search whose turn it is go on, and count what it may spend."""
    quota = state[QUOTA] if state[TURN] == BACK else max(FIRST_QUOTA, state[QUOTA] // 4)
    state[SPENT] += quota
    if state[TURN] == AHEAD:
        return look_ahead(layer, nodes, ahead, ends, state, quota)
    if state[AGE] > len(layer.hops) // 4 and state[SERVED] > state[SERVED_THEN]:
        _spread(layer, ends, state)
        forget_back(nodes, back, np.int64(0))
    state[AGE] += quota
    return look_back(layer, nodes, back, ends, state, quota)


@HELPER
def _serve(layer, nodes, back, ahead, ends, state):
    """Let the robot that was found go."""
    if state[TURN] == BACK:
        start = turn_back(layer, nodes, back.log, back.state[LAST])
    else:
        start = turn_ahead(layer, nodes.flow, ahead.log, ahead.state[CURRENT])
    ends.lacks[start] = 0
    state[SIDE] = state[TURN]
    state[SERVED] += 1
    state[TOTAL] += state[LEVEL]
    state[QUOTA] = FIRST_QUOTA


@kernel(types.int64(LAYER, NODES, SEARCH, SEARCH, ENDS, OUT_I64, types.int64))
def search(layer, nodes, back, ahead, ends, state, budget):
    """Serve robots, in order of level, until all have a path, room is needed or some `budget` nodes were looked at."""
    state[SPENT] = 0
    while state[SPENT] < budget:
        if state[SERVED] == len(ends.start):
            return DONE
        if state[TURN] == NEXT_LEVEL:
            state[SPENT] += 1
            status = _start_level(layer, nodes, ahead, ends, state)
            if status != BUDGET_SPENT:
                return status
            continue
        status = _look(layer, nodes, back, ahead, ends, state)
        if status == LIST_FULL:
            return status
        if status == BUDGET_SPENT:
            if state[TURN] == BACK:
                state[QUOTA] = min(2 * state[QUOTA], budget)
            state[TURN] = BACK + AHEAD - state[TURN]
            continue
        more = np.int64(0)
        if status == FOUND:
            _serve(layer, nodes, back, ahead, ends, state)
        else:
            more = back.state[SHORT] if state[TURN] == BACK else layer.grain
            state[TURN] = NEXT_LEVEL
        forget_back(nodes, back, more)
        forget_ahead(nodes, ahead, min(more, 1))
    return BUDGET_SPENT
