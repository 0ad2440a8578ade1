"""Least-cost flow of robots through layers of steps, by searches from both ends that learn from what they exhaust.

The graph is that of `trihex.planners.network` and is never built: a byte per node holds the flow, the arc it leaves by
and the arc it comes in by.

Robots get their paths in ascending order of cost, the *level* (successive shortest paths). At each level two searches
(`trihex.kernels.flow_search`) take turns until one finds a robot without path and a destination joined by residual arcs
of that cost, or has seen all there is, which proves that there is no such path and ends the level. Where destinations
are crowded the search back is the quicker, where robots hardly meet the search ahead.
"""

from numba import njit, types

from trihex.kernels.flow_search import (
    AT,
    BUDGET_SPENT,
    CURRENT,
    DEAD,
    ENDS,
    EXHAUSTED,
    EXTRA,
    FAR_AWAY,
    FOUND,
    FROM,
    LAYER,
    LIST_FULL,
    LOGGED,
    MARK,
    NODE,
    NODES,
    NONE,
    OFFSET,
    OTHER,
    OWN,
    PLACE,
    ROOT,
    ROW,
    SEARCH,
    SHORT,
    START,
    VIA,
    forget,
    leave,
    step_ahead,
    step_back,
    visit,
)
from trihex.kernels.signatures import OUT_I64

# What a call ends with, besides BUDGET_SPENT and LIST_FULL.
DONE, LAYERS_FULL, LEVELS_FULL = range(4, 7)
# Places in `state`.
LEVEL, SERVED, TOTAL, TURN, QUOTA, LAYERS, OPEN_GOALS, SPENT, FIRST_ROBOT, LAST_ROBOT = range(10)
AGE, SERVED_THEN, SIDE = range(10, 13)
STATE_SIZE = 13
# Whose turn it is.
NEXT_LEVEL, BACK, AHEAD = range(3)
MOST_LEVEL = 1 << 29
FIRST_QUOTA = 256


@njit(nogil=True)
def _look_back(layer, nodes, search, ends, state, budget):
    """Search back from open destinations for a robot without path; it is then the entry under way."""
    size = len(layer.hops)
    own, log = search.state, search.log
    out, into, hops, first_goal = layer.out, layer.into, layer.hops, layer.first_goal
    flow, since, away = nodes.flow, nodes.since, ends.away
    lacks, goals = ends.lacks, ends.goals
    for _ in range(budget):
        if own[CURRENT] != NONE:
            if own[LOGGED] == len(log):
                return LIST_FULL
            entry = own[CURRENT]
            node = log[entry, NODE]
            if lacks[node] and log[entry, ROW] == hops[node]:
                return FOUND
            if not step_back(entry, out, into, hops, first_goal, flow, since, away, log, own):
                leave(since, log, own)
            continue
        own[SHORT] = MARK
        if own[ROOT] == state[OPEN_GOALS]:
            return EXHAUSTED
        at = goals[state[OPEN_GOALS] - 1 - own[ROOT]]  # latest first: with time to spare nobody pays more
        own[ROOT] += 1
        row = at // size
        slack = state[LEVEL] - layer.base * row
        if flow[at] < layer.capacity and slack % layer.grain == 0 and slack >= since[at]:
            visit(at, at % size, row, slack, NONE, 0, since, log, own)
    return BUDGET_SPENT


@njit(nogil=True)
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


@njit(nogil=True)
def _turn_back(layer, nodes, search):
    """Let a robot go from the entry under way to the root; return the node where it starts."""
    log = search.log
    entry = search.state[CURRENT]
    start = log[entry, NODE]
    nodes.flow[log[entry, AT]] = START << 4
    while log[entry, FROM] >= 0:
        via = log[entry, VIA]
        entry = log[entry, FROM]
        to, node = log[entry, AT], log[entry, NODE]
        if via == OWN:  # nobody passes there any more
            nodes.flow[to] = 0
            continue
        tail = to + layer.into[node, via, OFFSET]
        nodes.flow[tail] = (nodes.flow[tail] & 0xF0) | (layer.into[node, via, PLACE] + 1)
        if node < layer.first_goal:
            nodes.flow[to] = (nodes.flow[to] & 15) | ((via + 1) << 4)
    nodes.flow[log[entry, AT]] += 1
    return start


@njit(nogil=True)
def _turn_ahead(layer, nodes, search):
    """Let a robot go from the root to the entry under way; return the node where it starts."""
    log = search.log
    entry = search.state[CURRENT]
    nodes.flow[log[entry, AT]] += 1
    while log[entry, FROM] >= 0:
        via = log[entry, VIA]
        entry = log[entry, FROM]
        at, node = log[entry, AT], log[entry, NODE]
        if node >= layer.first_goal:
            continue
        if via == OWN:
            nodes.flow[at] = 0
            continue
        head = at + layer.out[node, via, OFFSET]
        nodes.flow[at] = (nodes.flow[at] & 0xF0) | (via + 1)
        if layer.out[node, via, OTHER] < layer.first_goal:
            nodes.flow[head] = (nodes.flow[head] & 15) | ((layer.out[node, via, PLACE] + 1) << 4)
    at = log[entry, AT]
    nodes.flow[at] = (nodes.flow[at] & 15) | (START << 4)
    return log[entry, NODE]


@njit(nogil=True)
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


@njit(nogil=True)
def _open_layer(row, layer, nodes, ends):
    """Set the bounds from the robots for the nodes of a layer as if there were no others."""
    size = len(layer.hops)
    for node in layer.order:
        at = row * size + node
        best = DEAD
        if row == layer.hops[node] and not layer.is_vertex[node]:  # step 0
            if ends.lacks[node]:
                best = 0
        elif row >= layer.hops[node]:
            for j in range(layer.into.shape[1]):
                offset = layer.into[node, j, OFFSET]
                if offset == 0:
                    break
                best = min(best, nodes.since[at + offset] + layer.into[node, j, EXTRA])
        nodes.since[at] = min(best, DEAD)


@njit(nogil=True)
def _start_level(layer, nodes, back, ahead, ends, state):
    """Open what may be used at the next level and list the roots of the searches."""
    size = len(layer.hops)
    row = (state[LEVEL] + 1) // layer.base
    if (row + 4) * size > len(nodes.flow):
        return LAYERS_FULL
    if state[LEVEL] == MOST_LEVEL:
        return LEVELS_FULL
    state[LEVEL] += 1
    count = 0
    for k in range(state[OPEN_GOALS]):
        at = ends.goals[k]
        if nodes.flow[at] < layer.capacity and nodes.since[at] < DEAD:
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
    back.state[ROOT] = 0
    ahead.state[ROOT] = state[FIRST_ROBOT]
    state[QUOTA] = FIRST_QUOTA
    state[TURN] = state[SIDE]
    return BUDGET_SPENT


@njit(types.int64(LAYER, NODES, SEARCH, SEARCH, ENDS, OUT_I64, types.int64), cache=True, nogil=True)
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
                forget(nodes.since, back, 0)
            state[AGE] += quota
            status = _look_back(layer, nodes, back, ends, state, quota)
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
            start = _turn_back(layer, nodes, back) if state[TURN] == BACK else _turn_ahead(layer, nodes, ahead)
            ends.lacks[start] = 0
            state[SIDE] = state[TURN]
            state[SERVED] += 1
            state[TOTAL] += state[LEVEL]
            state[QUOTA] = FIRST_QUOTA
        else:
            state[TURN] = NEXT_LEVEL
        forget(nodes.since, back, layer.grain if status == EXHAUSTED else 0)
        forget(nodes.ahead, ahead, 1 if status == EXHAUSTED else 0)
    return BUDGET_SPENT
