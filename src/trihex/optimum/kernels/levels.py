"""Least-cost flow of robots through layers of steps, by searches from both ends that learn from what they exhaust.

The graph is that of `trihex.optimum.network` and is never built: a byte per node holds the flow, the arc it leaves by
and the arc it comes in by.

Robots get their paths in ascending order of cost, the *level* (successive shortest paths). At each level two searches,
`back` and `ahead`, take turns until one finds a robot without path and a destination joined
by residual arcs of that cost, or has seen all there is, which proves that there is no such path and ends the level.
Where destinations are crowded the search back is the quicker, where robots hardly meet the search ahead.
"""

from numba import njit, types

from trihex.kernels.signatures import OUT_I64, UNCOUNTED
from trihex.optimum.kernels.back import BITS, NEVER, forget_back, look_back, turn_back
from trihex.optimum.kernels.residual import (
    AGE,
    AT,
    BUDGET_SPENT,
    CURRENT,
    DONE,
    ENDS,
    EXHAUSTED,
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
    LOGGED,
    MARK,
    MOST_LEVEL,
    NODE,
    NODES,
    NONE,
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
    forget,
    leave,
    step_ahead,
    turn_ahead,
    visit,
)

# Whose turn it is.
NEXT_LEVEL, BACK, AHEAD = range(3)
FIRST_QUOTA = 256


@njit(nogil=True, **UNCOUNTED)
def _look_ahead(layer, nodes, search, ends, state, budget):
    """Search from robots without path for an open destination; it is then the entry under way."""
    size = len(layer.hops)
    own, log = search.state, search.log
    out, into, first_goal = layer.out, layer.into, layer.first_goal
    flow, ahead, lacks = nodes.flow, nodes.ahead, ends.lacks
    for _ in range(budget):
        if own[CURRENT] != NONE:
            if own[LOGGED] == len(log):
                return LIST_FULL
            entry = own[CURRENT]
            if log[entry, NODE] >= first_goal and flow[log[entry, AT]] < layer.capacity:
                return FOUND
            if not step_ahead(entry, out, into, first_goal, flow, ahead, log, own):
                leave(ahead, log, own)
            continue
        own[SHORT] = MARK
        if own[ROOT] == state[LAST_ROBOT]:
            return EXHAUSTED
        at = ends.start[own[ROOT]]
        slack = state[LEVEL] - ends.value[own[ROOT]]
        own[ROOT] += 1
        if lacks[at % size] and slack >= ahead[at]:
            visit(at, at % size, 0, slack, NONE, 0, ahead, log, own)
    return BUDGET_SPENT


@njit(nogil=True, **UNCOUNTED)
def _spread(layer, ends, state):
    """Fill `away`."""
    size = len(layer.hops)
    away, queue = ends.away, ends.queue
    away[:] = FAR_AWAY
    tail = 0
    for robot in range(state[FIRST_ROBOT], state[LAST_ROBOT]):
        node = ends.start[robot] % size
        if ends.lacks[node]:
            away[node] = 0
            queue[tail] = node
            tail += 1
    head = 0
    while head < tail:
        node = queue[head]
        head += 1
        for i in range(layer.out.shape[1]):
            if layer.out[node, i, OFFSET] == 0:
                break
            other = layer.out[node, i, OTHER]
            if away[other] < FAR_AWAY:
                continue
            away[other] = away[node] + 1
            if layer.is_vertex[other]:  # to be left in the same step
                for j in range(layer.out.shape[1]):
                    if layer.out[other, j, OFFSET] == 0:
                        break
                    further = layer.out[other, j, OTHER]
                    if away[further] == FAR_AWAY:
                        away[further] = away[other]
                        queue[tail] = further
                        tail += 1
            else:
                queue[tail] = other
                tail += 1
    state[AGE] = 0
    state[SERVED_THEN] = state[SERVED]


@njit(nogil=True, **UNCOUNTED)
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


@njit(nogil=True, **UNCOUNTED)
def _start_level(layer, nodes, back, ahead, ends, state):
    """Open what may be used at the next level and list the roots of the searches."""
    size = len(layer.hops)
    row = (state[LEVEL] + 1) // layer.base
    if (row + SPARE_ROWS) * size > len(nodes.flow):
        return LAYERS_FULL
    if state[LEVEL] == MOST_LEVEL:
        return LEVELS_FULL
    state[LEVEL] += 1
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
    robots = len(ends.start)
    while state[LAST_ROBOT] < robots and ends.value[state[LAST_ROBOT]] <= state[LEVEL]:
        state[LAST_ROBOT] += 1
    while state[FIRST_ROBOT] < state[LAST_ROBOT] and not ends.lacks[ends.start[state[FIRST_ROBOT]] % size]:
        state[FIRST_ROBOT] += 1
    ahead.state[ROOT] = state[FIRST_ROBOT]
    state[QUOTA] = FIRST_QUOTA
    state[TURN] = state[SIDE]
    return BUDGET_SPENT


@njit(types.int64(LAYER, NODES, SEARCH, SEARCH, ENDS, OUT_I64, types.int64), cache=True, nogil=True, **UNCOUNTED)
def search(layer, nodes, back, ahead, ends, state, budget):
    """Serve robots, in order of level, until all have a path, room is needed or some `budget` nodes were looked at."""
    state[SPENT] = 0
    while state[SPENT] < budget:
        if state[SERVED] == len(ends.start):
            return DONE
        if state[TURN] == NEXT_LEVEL:
            state[SPENT] += 1
            status = _start_level(layer, nodes, back, ahead, ends, state)
            if status != BUDGET_SPENT:
                return status
            continue
        quota = state[QUOTA] if state[TURN] == BACK else max(FIRST_QUOTA, state[QUOTA] // 4)
        state[SPENT] += quota
        if state[TURN] == BACK:
            if state[AGE] > len(layer.hops) // 4 and state[SERVED] > state[SERVED_THEN]:
                _spread(layer, ends, state)
                forget_back(nodes.since, back, 0)
            state[AGE] += quota
            status = look_back(layer, nodes, back, ends, state, quota)
        else:
            status = _look_ahead(layer, nodes, ahead, ends, state, quota)
        if status == LIST_FULL:
            return status
        if status == BUDGET_SPENT:
            if state[TURN] == BACK:
                state[QUOTA] = min(2 * state[QUOTA], budget)
            state[TURN] = BACK + AHEAD - state[TURN]
            continue
        if status == FOUND:
            if state[TURN] == BACK:
                start = turn_back(layer, nodes, back.log, back.state[LAST])
            else:
                start = turn_ahead(layer.out, layer.into, layer.first_goal, nodes.flow, ahead.log, ahead.state[CURRENT])
            ends.lacks[start] = 0
            state[SIDE] = state[TURN]
            state[SERVED] += 1
            state[TOTAL] += state[LEVEL]
            state[QUOTA] = FIRST_QUOTA
            more = 0
        else:
            more = back.state[SHORT] if state[TURN] == BACK else layer.grain
            state[TURN] = NEXT_LEVEL
        forget_back(nodes.since, back, more)
        forget(nodes.ahead, ahead, min(more, 1))
    return BUDGET_SPENT
