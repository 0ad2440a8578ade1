"""Least-cost flow of robots through layers of steps, by searches from both ends that learn from what they exhaust.

The graph is that of `trihex.planners.network` and is never built. Every node takes one unit, so a byte per node holds
the flow: the arc it leaves by and the arc it comes in by.

Robots get their paths in ascending order of cost, the *level* (successive shortest paths). At each level two searches
take turns until one finds a robot without path and a destination joined by residual arcs of that cost, or has seen all
there is, which proves that there is no such path and ends the level. Both prune by a lower bound that each node keeps:

- ``since``: cost from a robot without path to the node, less `base` a step. Used by the search back from destinations.
- ``ahead``: cost from the node to a destination, less its value in the network. Used by the search from the robots.

Neither cost ever falls as robots get their paths, so bounds stay valid, and a search that has seen all there is raises
those of all that it saw: by the least that any arc out of that set was short of passing, or for ever if there was none.
With equal costs a node is therefore seen by at most one failing search back.

A node that carries flow is entered against it and left against it: whoever enters goes back to where the flow came
from. So the search ahead keeps only nodes that it leaves, and the search back only nodes that it enters.
"""

from typing import Any, NamedTuple

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, OUT_I32, OUT_I64, OUT_U8

# What a call ends with.
DONE, BUDGET_SPENT, LIST_FULL, LAYERS_FULL, LEVELS_FULL = range(5)
# What a search ends with, besides LIST_FULL and BUDGET_SPENT.
FOUND, EXHAUSTED = 5, 6
# Places in `state`.
LEVEL, SERVED, TOTAL, TURN, QUOTA, LAYERS, OPEN_GOALS, SPENT, FIRST_ROBOT, LAST_ROBOT, AGE, SERVED_THEN, SIDE = range(
    13
)
STATE_SIZE = 13
# Whose turn it is.
NEXT_LEVEL, BACK, AHEAD = range(3)
# Places in the state of a search: lengths of its lists, next root, least shortfall.
STACKED, LOGGED, ROOT, SHORT, LAST = range(5)
# Columns of the log of a search: node, slack, entry it was seen from, place of the arc.
NODE, SLACK, FROM, VIA = range(4)
# Flow of a node: place + 1 of the arc out in the low four bits, of the arc in in the high four; a robot starts there.
START = 15
# Place of the arc from the entered to the left side of the same node.
OWN = 14
# Added to the place of arcs that lead to a destination.
TO_GOAL = 16
# Bounds: what is seen by a search under way bears its slack plus MARK.
MARK = 1 << 30
DEAD = MARK - 1
MOST_LEVEL = 1 << 29
FAR_AWAY = 1 << 20
FIRST_QUOTA = 256
# What one node may add to a list.
ROOM = 32


class Layer(NamedTuple):
    """Arcs of one layer, as in `trihex.planners.network`, and what holds for all."""

    out: Any
    into: Any
    hops: Any
    order: Any
    is_vertex: Any
    first_goal: int
    capacity: int
    base: int
    grain: int


class Nodes(NamedTuple):
    """Flow and bounds of all nodes of all layers."""

    flow: Any
    since: Any
    ahead: Any


class Search(NamedTuple):
    """Entries of the log to go on from, the log of what was seen, its state."""

    stack: Any
    log: Any
    state: Any


class Ends(NamedTuple):
    """Start and value of each robot, ascending; whether a robot without path starts in a cell; goals that are open.

    ``away`` is the number of steps from the nearest robot without path, some time ago: a hint where to look.
    """

    start: Any
    value: Any
    lacks: Any
    goals: Any
    away: Any
    queue: Any


TABLE = types.Array(types.int32, 3, "C", readonly=True)
LAYER = types.NamedTuple(
    [TABLE, TABLE, IN_I32, IN_I32, IN_BOOL, types.int64, types.int64, types.int64, types.int64], Layer
)
NODES = types.NamedTuple([OUT_U8, OUT_I32, OUT_I32], Nodes)
SEARCH = types.NamedTuple([OUT_I64, types.Array(types.int64, 2, "C"), OUT_I64], Search)
ENDS = types.NamedTuple([IN_I64, IN_I64, OUT_U8, OUT_I64, OUT_I32, OUT_I32], Ends)


@njit(types.void(types.int64, types.int64, types.int64, types.int64, OUT_I32, SEARCH), cache=True, nogil=True)
def _see(at, slack, seen_from, via, bound, search):
    """Note a node to go on from if its bound allows for it, and if not, how much the slack falls short."""
    before = bound[at]
    if before >= MARK:
        if slack <= before - MARK:
            return
    elif slack < before:
        if before < DEAD:
            search.state[SHORT] = min(search.state[SHORT], before - slack)
        return
    bound[at] = MARK + slack
    entry = search.state[LOGGED]
    search.log[entry, NODE] = at
    search.log[entry, SLACK] = slack
    search.log[entry, FROM] = seen_from
    search.log[entry, VIA] = via
    search.state[LOGGED] += 1
    search.stack[search.state[STACKED]] = entry
    search.state[STACKED] += 1


@njit(types.void(OUT_I32, SEARCH), cache=True, nogil=True)
def _learn(bound, search):
    """Raise the bounds of all that was seen: nothing of it leads anywhere."""
    short = search.state[SHORT]
    for entry in range(search.state[LOGGED]):
        at = search.log[entry, NODE]
        if bound[at] >= MARK:
            bound[at] = min(bound[at] - MARK + short, DEAD)
    search.state[LOGGED] = 0
    search.state[SHORT] = MARK


@njit(types.void(OUT_I32, SEARCH, types.int64), cache=True, nogil=True)
def _forget(bound, search, more):
    """Let the search begin again from the same root; what it saw has no bound below its slack plus `more`."""
    if search.state[LOGGED] > 0:
        search.state[ROOT] -= 1
    for entry in range(search.state[LOGGED]):
        at = search.log[entry, NODE]
        if bound[at] >= MARK:
            bound[at] = min(bound[at] - MARK + more, DEAD)
    search.state[LOGGED] = search.state[STACKED] = 0
    search.state[SHORT] = MARK


@njit(types.void(types.int64, LAYER, NODES, SEARCH), cache=True, nogil=True)
def _expand_back(entry, layer, nodes, search):
    """See the nodes from which residual arcs enter a node."""
    at = search.log[entry, NODE]
    slack = search.log[entry, SLACK]
    size = len(layer.hops)
    node = at % size
    is_goal = node >= layer.first_goal
    flow = nodes.flow[at]
    if flow != 0 and not is_goal:
        i = (flow & 15) - 1
        _see(at + layer.out[node, i, 0], slack + layer.out[node, i, 3], entry, OWN, nodes.since, search)
    for j in range(layer.into.shape[1]):
        offset = layer.into[node, j, 0]
        if offset == 0:
            break
        other = at + offset
        passes = nodes.flow[other]
        i = (passes & 15) - 1
        if (i == layer.into[node, j, 2]) if is_goal else (j == (flow >> 4) - 1):
            continue
        left = slack - layer.into[node, j, 3]
        if passes == 0:
            _see(other, left, entry, j, nodes.since, search)
        else:
            tail = other % size
            _see(other + layer.out[tail, i, 0], left + layer.out[tail, i, 3], entry, j, nodes.since, search)


@njit(types.int64(types.int64, types.int64, LAYER, ENDS), cache=True, nogil=True)
def _farness(at, size, layer, ends):
    node = at % size
    step = at // size - layer.hops[node]
    away = ends.away[node]
    return away if away <= step else away + (1 << 20)


@njit(types.void(types.int64, LAYER, SEARCH, ENDS), cache=True, nogil=True)
def _prefer(first, layer, search, ends):
    """Sort what was just put on the stack: nodes that are near a robot without path, and not too early, come last."""
    size = len(layer.hops)
    for k in range(first + 1, search.state[STACKED]):
        entry = search.stack[k]
        key = _farness(search.log[entry, NODE], size, layer, ends)
        m = k
        while m > first and _farness(search.log[search.stack[m - 1], NODE], size, layer, ends) < key:
            search.stack[m] = search.stack[m - 1]
            m -= 1
        search.stack[m] = entry


@njit(types.int64(LAYER, NODES, SEARCH, ENDS, OUT_I64, types.int64), cache=True, nogil=True)
def _look_back(layer, nodes, search, ends, state, budget):
    """Search back from open destinations for a robot without path; it is then the last entry of the log."""
    size = len(layer.hops)
    own = search.state
    for _ in range(budget):
        if own[STACKED] == 0:
            _learn(nodes.since, search)
            if own[ROOT] == state[OPEN_GOALS]:
                return EXHAUSTED
            at = ends.goals[state[OPEN_GOALS] - 1 - own[ROOT]]  # latest first: with time to spare nobody pays more
            own[ROOT] += 1
            slack = state[LEVEL] - layer.base * (at // size)
            if nodes.flow[at] < layer.capacity and slack % layer.grain == 0:
                _see(at, slack, -1, 0, nodes.since, search)
            continue
        if own[LOGGED] + ROOM > len(search.stack):
            return LIST_FULL
        own[STACKED] -= 1
        entry = search.stack[own[STACKED]]
        if nodes.since[search.log[entry, NODE]] != MARK + search.log[entry, SLACK]:
            continue
        first = own[LOGGED]
        top = own[STACKED]
        _expand_back(entry, layer, nodes, search)
        _prefer(top, layer, search, ends)
        for seen in range(first, own[LOGGED]):
            at = search.log[seen, NODE]
            if ends.lacks[at % size] and at // size == layer.hops[at % size]:
                own[LAST] = seen
                return FOUND
    return BUDGET_SPENT


@njit(types.int64(LAYER, NODES, SEARCH), cache=True, nogil=True)
def _turn_back(layer, nodes, search):
    """Let a robot go from the last node of the log to the root; return where it starts."""
    entry = search.state[LAST]
    start = search.log[entry, NODE]
    nodes.flow[start] = START << 4
    at = start
    while search.log[entry, FROM] >= 0:
        via = search.log[entry, VIA]
        entry = search.log[entry, FROM]
        to = search.log[entry, NODE]
        if via == OWN:  # nobody passes there any more
            nodes.flow[to] = 0
        else:
            node = to % len(layer.hops)
            tail = to + layer.into[node, via, 0]
            nodes.flow[tail] = (nodes.flow[tail] & 0xF0) | (layer.into[node, via, 2] + 1)
            if node < layer.first_goal:
                nodes.flow[to] = (nodes.flow[to] & 15) | ((via + 1) << 4)
        at = to
    nodes.flow[at] += 1
    return start


@njit(types.void(types.int64, LAYER, NODES, SEARCH), cache=True, nogil=True)
def _expand_ahead(entry, layer, nodes, search):
    """See the nodes that are left next after a node."""
    at = search.log[entry, NODE]
    slack = search.log[entry, SLACK]
    size = len(layer.hops)
    node = at % size
    flow = nodes.flow[at]
    if node >= layer.first_goal:  # full: somebody else is to arrive elsewhere
        for j in range(layer.into.shape[1]):
            other = at + layer.into[node, j, 0]
            if other == at:
                break
            if (nodes.flow[other] & 15) - 1 == layer.into[node, j, 2]:
                _see(other, slack + layer.into[node, j, 1], entry, j, nodes.ahead, search)
        return
    j = (flow >> 4) - 1
    if flow != 0 and j != START - 1:
        _see(at + layer.into[node, j, 0], slack + layer.into[node, j, 1], entry, OWN, nodes.ahead, search)
    for i in range(layer.out.shape[1]):
        offset = layer.out[node, i, 0]
        if offset == 0:
            break
        left = slack - layer.out[node, i, 1]
        if i == (flow & 15) - 1:
            continue
        head = at + offset
        passes = nodes.flow[head]
        if passes == 0 or layer.out[node, i, 2] >= TO_GOAL:
            _see(head, left, entry, i, nodes.ahead, search)
        elif passes >> 4 != START:
            head_node = head % size
            j = (passes >> 4) - 1
            other = head + layer.into[head_node, j, 0]
            _see(other, left + layer.into[head_node, j, 1], entry, i, nodes.ahead, search)


@njit(types.int64(LAYER, NODES, SEARCH, ENDS, OUT_I64, types.int64), cache=True, nogil=True)
def _look_ahead(layer, nodes, search, ends, state, budget):
    """Search from robots without path for an open destination; it is then the last entry of the log."""
    size = len(layer.hops)
    own = search.state
    for _ in range(budget):
        if own[STACKED] == 0:
            _learn(nodes.ahead, search)
            if own[ROOT] == state[LAST_ROBOT]:
                return EXHAUSTED
            at = ends.start[own[ROOT]]
            if ends.lacks[at % size]:
                _see(at, state[LEVEL] - ends.value[own[ROOT]], -1, 0, nodes.ahead, search)
            own[ROOT] += 1
            continue
        if own[LOGGED] + ROOM > len(search.stack):
            return LIST_FULL
        own[STACKED] -= 1
        entry = search.stack[own[STACKED]]
        if nodes.ahead[search.log[entry, NODE]] != MARK + search.log[entry, SLACK]:
            continue
        first = own[LOGGED]
        _expand_ahead(entry, layer, nodes, search)
        for seen in range(first, own[LOGGED]):
            at = search.log[seen, NODE]
            if at % size >= layer.first_goal and nodes.flow[at] < layer.capacity:
                own[LAST] = seen
                return FOUND
    return BUDGET_SPENT


@njit(types.int64(LAYER, NODES, SEARCH), cache=True, nogil=True)
def _turn_ahead(layer, nodes, search):
    """Let a robot go from the root to the last node of the log; return where it starts."""
    entry = search.state[LAST]
    nodes.flow[search.log[entry, NODE]] += 1
    size = len(layer.hops)
    while search.log[entry, FROM] >= 0:
        via = search.log[entry, VIA]
        entry = search.log[entry, FROM]
        at = search.log[entry, NODE]
        node = at % size
        if node >= layer.first_goal:
            continue
        if via == OWN:
            nodes.flow[at] = 0
            continue
        head = at + layer.out[node, via, 0]
        nodes.flow[at] = (nodes.flow[at] & 0xF0) | (via + 1)
        if head % size < layer.first_goal:
            nodes.flow[head] = (nodes.flow[head] & 15) | ((layer.out[node, via, 2] + 1) << 4)
    nodes.flow[at] = (nodes.flow[at] & 15) | (START << 4)
    return at


@njit(types.void(LAYER, ENDS, OUT_I64), cache=True, nogil=True)
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
            offset = layer.out[node, i, 0]
            if offset == 0:
                break
            other = (node + offset) % size
            if away[other] < FAR_AWAY:
                continue
            away[other] = away[node] + 1
            if layer.is_vertex[other]:  # to be left in the same step
                for j in range(layer.out.shape[1]):
                    offset = layer.out[other, j, 0]
                    if offset == 0:
                        break
                    further = (other + offset) % size
                    if away[further] == FAR_AWAY:
                        away[further] = away[other]
                        queue[tail] = further
                        tail += 1
            else:
                queue[tail] = other
                tail += 1
    state[AGE] = 0
    state[SERVED_THEN] = state[SERVED]


@njit(types.void(types.int64, LAYER, NODES, ENDS), cache=True, nogil=True)
def _open_layer(row, layer, nodes, ends):
    """Set the bounds from the robots for the nodes of a layer as if there were no others."""
    size = len(layer.hops)
    for node in layer.order:
        at = row * size + node
        best = DEAD
        if row == layer.hops[node]:
            if ends.lacks[node]:
                best = 0
        elif row > layer.hops[node]:
            for j in range(layer.into.shape[1]):
                offset = layer.into[node, j, 0]
                if offset == 0:
                    break
                best = min(best, nodes.since[at + offset] + layer.into[node, j, 3])
        nodes.since[at] = min(best, DEAD)


@njit(types.int64(LAYER, NODES, SEARCH, SEARCH, ENDS, OUT_I64), cache=True, nogil=True)
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
    size = len(layer.hops)
    state[SPENT] = 0
    while state[SPENT] < budget:
        if state[SERVED] == len(ends.start):
            return DONE
        state[SPENT] += 1
        if state[TURN] == NEXT_LEVEL:
            status = _start_level(layer, nodes, back, ahead, ends, state)
            if status != BUDGET_SPENT:
                return status
            continue
        quota = state[QUOTA] if state[TURN] == BACK else max(FIRST_QUOTA, state[QUOTA] // 4)
        quota = min(quota, budget - state[SPENT])
        state[SPENT] += quota
        if state[TURN] == BACK:
            if state[AGE] > size // 4 and state[SERVED] > state[SERVED_THEN]:
                _spread(layer, ends, state)
                _forget(nodes.since, back, 0)
            state[AGE] += quota
            status = _look_back(layer, nodes, back, ends, state, quota)
        else:
            status = _look_ahead(layer, nodes, ahead, ends, state, quota)
        if status == LIST_FULL:
            return status
        if status == BUDGET_SPENT:
            if state[TURN] == BACK:
                state[QUOTA] *= 2
            state[TURN] = BACK + AHEAD - state[TURN]
            continue
        if status == FOUND:
            start = _turn_back(layer, nodes, back) if state[TURN] == BACK else _turn_ahead(layer, nodes, ahead)
            ends.lacks[start % size] = 0
            state[SIDE] = state[TURN]
            state[SERVED] += 1
            state[TOTAL] += state[LEVEL]
            state[QUOTA] = FIRST_QUOTA
        else:
            state[TURN] = NEXT_LEVEL
        _forget(nodes.since, back, layer.grain if status == EXHAUSTED else 0)
        _forget(nodes.ahead, ahead, status == EXHAUSTED)
    return BUDGET_SPENT
