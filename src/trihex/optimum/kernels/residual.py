"""Depth-first search ahead for a path of one cost through the residual graph, and what all searches share.

Every node takes one unit of flow. A node that carries flow is entered against it and left against it: whoever enters
goes back to where the flow came from. So the search ahead keeps only nodes that it leaves, and the search back only
nodes that it enters.

All prune by a lower bound that each node keeps: ``since``, the cost from a robot without path to the node, less `base`
a step; ``ahead``, the cost from the node to a destination, less its value in the network. A node is visited while its
*slack*, what the path may still cost beyond that, is not below its bound. Neither cost ever falls as robots get their
paths, so a bound may be raised as soon as a node is known to lead nowhere. The search here is depth-first: as in the
method of Tarjan (1972), when it leaves the first visited node of a strongly connected component, all visited since then
are done with. They are raised by the least slack that any visit was short of.
"""

from typing import Any, NamedTuple

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, OUT_I32, OUT_I64, OUT_U8, UNCOUNTED

# What a search ends with.
BUDGET_SPENT, LIST_FULL, FOUND, EXHAUSTED, DONE, LAYERS_FULL, LEVELS_FULL = range(7)
# Places in the state of a search: length of its log, entry under way, next root, least shortfall, entry found.
LOGGED, CURRENT, ROOT, SHORT, LAST = range(5)
SEARCH_STATE_SIZE = 5
# Places in the state of the whole.
LEVEL, SERVED, TOTAL, TURN, QUOTA, LAYERS, OPEN_GOALS, SPENT, FIRST_ROBOT, LAST_ROBOT = range(10)
AGE, SERVED_THEN, SIDE, VISITS = range(10, 14)
STATE_SIZE = 14
MOST_LEVEL = 1 << 23
# Layers beyond that of a node that its neighbours may lie in.
SPARE_ROWS = 4
# Lists of the searches by A*: one for each number of flows turned back, then one for each higher cost.
TURN_LISTS, LISTS = 512, 4096
# Columns of the log: index, node and (search back only) layer; slack; entry it was visited from and by which arc;
# places of the arcs that have been tried, as bits; first entry that is known to be reached from here.
AT, NODE, ROW, SLACK, FROM, VIA, TRIED, LOW = range(8)
# In the searches by A* in place of the last two: flows turned back on the way, next entry of the same list.
TURNS, NEXT = TRIED, LOW
# Columns of the arcs: see `trihex.optimum.network`.
OFFSET, REDUCED, PLACE, EXTRA, OTHER, ROWS = range(6)
# Flow of a node: place + 1 of the arc out in the low four bits, of the arc in in the high four; a robot starts there.
START = 15
# Place of the arc from the entered to the left side of the same node.
OWN = 14
# Bounds: MARK + entry while a node is visited and not done with.
MARK = 1 << 30
DEAD = MARK - 1
FAR_AWAY = 1 << 20
NONE = -1


class Layer(NamedTuple):
    """Arcs of one layer, as in `trihex.optimum.network`, and what holds for all.

    ``order`` lists the nodes so that arcs within a layer go forward; ``grain`` is what slacks are multiples of.
    """

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
    """What was visited, the state, and first entries of the lists of what is to be visited."""

    log: Any
    state: Any
    heads: Any


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
LAYER = types.NamedTuple([TABLE, TABLE, IN_I32, IN_I32, IN_BOOL, *[types.int64] * 4], Layer)
NODES = types.NamedTuple([OUT_U8, OUT_I32, OUT_I32], Nodes)
SEARCH = types.NamedTuple([types.Array(types.int64, 2, "C"), OUT_I64, OUT_I64], Search)
ENDS = types.NamedTuple([IN_I64, IN_I64, OUT_U8, OUT_I64, OUT_I32, OUT_I32], Ends)


@njit(nogil=True, **UNCOUNTED)
def visit(at, node, row, slack, seen_from, via, bound, log, own):
    """Log a node that is visited."""
    entry = own[LOGGED]
    log[entry, AT], log[entry, NODE], log[entry, ROW] = at, node, row
    log[entry, SLACK], log[entry, FROM], log[entry, VIA] = slack, seen_from, via
    log[entry, TRIED], log[entry, LOW] = 0, entry
    bound[at] = MARK + entry
    own[LOGGED] += 1
    own[CURRENT] = entry


@njit(nogil=True, **UNCOUNTED)
def _may_visit(at, slack, entry, bound, log, own):
    """Tell whether a node is worth a visit, and if not, note why."""
    before = bound[at]
    if before < MARK:
        if slack >= before:
            return True
        if before - slack < own[SHORT] and before < DEAD:
            own[SHORT] = before - slack
        return False
    seen = before - MARK
    if slack > log[seen, SLACK]:
        return True
    if seen < log[entry, LOW]:
        log[entry, LOW] = seen
    return False


@njit(nogil=True, **UNCOUNTED)
def leave(bound, log, own):
    """Go back from the entry under way; what cannot reach anything visited before it is done with."""
    entry = own[CURRENT]
    own[CURRENT] = log[entry, FROM]
    if log[entry, LOW] < entry:
        log[own[CURRENT], LOW] = min(log[own[CURRENT], LOW], log[entry, LOW])
        return
    for done in range(entry, own[LOGGED]):
        at = log[done, AT]
        if bound[at] == MARK + done:
            bound[at] = min(log[done, SLACK] + own[SHORT], DEAD)
    own[LOGGED] = entry


@njit(nogil=True, **UNCOUNTED)
def forget(bound, search, more):
    """Begin again from the same root; the bounds of what is not done with are no less than its slack plus `more`."""
    log, state = search.log, search.state
    if state[LOGGED] > 0:
        state[ROOT] -= 1
    for entry in range(state[LOGGED]):
        at = log[entry, AT]
        if bound[at] == MARK + entry:
            bound[at] = min(log[entry, SLACK] + more, DEAD)
    state[LOGGED] = 0
    state[CURRENT] = NONE
    state[SHORT] = MARK


@njit(nogil=True, **UNCOUNTED)
def _step_against(at, node, j, entry, via, out, into, first_goal, all_flow, ahead, log, own):
    """Visit the node from which flow comes along arc j into a node, if that is worth it."""
    slack = log[entry, SLACK] + into[node, j, REDUCED]
    if via != OWN and node < first_goal:
        slack -= out[log[entry, NODE], via, REDUCED]
    other = at + into[node, j, OFFSET]
    if not _may_visit(other, slack, entry, ahead, log, own):
        return False
    visit(other, into[node, j, OTHER], 0, slack, entry, via, ahead, log, own)
    return True


@njit(nogil=True, **UNCOUNTED)
def step_ahead(entry, out, into, first_goal, all_flow, ahead, log, own):
    """Visit that node after the one under way which is nearest to a destination; False if none is left."""
    at, node, slack = log[entry, AT], log[entry, NODE], log[entry, SLACK]
    flow = all_flow[at]
    if node >= first_goal:  # full: somebody else is to arrive elsewhere
        for j in range(into.shape[1]):
            other = at + into[node, j, OFFSET]
            if other == at:
                break
            if log[entry, TRIED] >> j & 1:
                continue
            log[entry, TRIED] |= 1 << j
            if (all_flow[other] & 15) - 1 == into[node, j, PLACE]:
                if _step_against(at, node, j, entry, j, out, into, first_goal, all_flow, ahead, log, own):
                    return True
        return False
    for i in range(out.shape[1] - 1, -1, -1):
        offset = out[node, i, OFFSET]
        if offset == 0 or log[entry, TRIED] >> i & 1 or i == (flow & 15) - 1:
            continue
        log[entry, TRIED] |= 1 << i
        head, other = at + offset, out[node, i, OTHER]
        left = slack - out[node, i, REDUCED]
        passes = all_flow[head]
        if passes == 0 or other >= first_goal:
            if _may_visit(head, left, entry, ahead, log, own):
                visit(head, other, 0, left, entry, i, ahead, log, own)
                return True
        elif passes >> 4 != START:
            if _step_against(
                head, other, (passes >> 4) - 1, entry, i, out, into, first_goal, all_flow, ahead, log, own
            ):
                return True
    j = (flow >> 4) - 1
    if flow == 0 or j == START - 1 or log[entry, TRIED] >> OWN & 1:
        return False
    log[entry, TRIED] |= 1 << OWN
    return _step_against(at, node, j, entry, OWN, out, into, first_goal, all_flow, ahead, log, own)


@njit(nogil=True, **UNCOUNTED)
def turn_ahead(out, into, first_goal, flow, log, entry):
    """Let a robot go from the root to an entry; return the node where it starts."""
    flow[log[entry, AT]] += 1
    while log[entry, FROM] >= 0:
        via = log[entry, VIA]
        entry = log[entry, FROM]
        at, node = log[entry, AT], log[entry, NODE]
        if node >= first_goal:
            continue
        if via == OWN:
            flow[at] = 0
            continue
        head = at + out[node, via, OFFSET]
        flow[at] = (flow[at] & 0xF0) | (via + 1)
        if out[node, via, OTHER] < first_goal:
            flow[head] = (flow[head] & 15) | ((out[node, via, PLACE] + 1) << 4)
    at = log[entry, AT]
    flow[at] = (flow[at] & 15) | (START << 4)
    return log[entry, NODE]
