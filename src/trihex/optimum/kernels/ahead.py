"""Depth-first search ahead for a path of one cost, from robots without path to an open destination.

As in the method of Tarjan (1972), when it leaves the first visited node of a strongly connected component, all visited
since then are done with. Their bounds are raised by the least slack that any visit was short of.
"""

from trihex.kernels.signatures import HELPER
from trihex.optimum.kernels.flow_byte import START, arc_in, arc_out, is_start, with_arc_in, with_arc_out
from trihex.optimum.kernels.residual import (
    AT,
    BUDGET_SPENT,
    CURRENT,
    DEAD,
    EXHAUSTED,
    FOUND,
    FROM,
    LAST_ROBOT,
    LEVEL,
    LIST_FULL,
    LOGGED,
    LOW,
    MARK,
    NODE,
    NONE,
    OFFSET,
    OTHER,
    OWN,
    PLACE,
    REDUCED,
    ROOT,
    SHORT,
    SLACK,
    TRIED,
    VIA,
)


@HELPER
def _visit(at, node, slack, seen_from, via, nodes, search):
    """Log a node that is visited."""
    log, own = search.log, search.state
    entry = own[LOGGED]
    log[entry, AT], log[entry, NODE], log[entry, SLACK] = at, node, slack
    log[entry, FROM], log[entry, VIA], log[entry, TRIED], log[entry, LOW] = seen_from, via, 0, entry
    nodes.ahead[at] = MARK + entry
    own[LOGGED] += 1
    own[CURRENT] = entry


@HELPER
def _may_visit(at, slack, entry, nodes, search):
    """Tell whether a node is worth a visit from an entry, and if not, note why."""
    log, own = search.log, search.state
    before = nodes.ahead[at]
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


@HELPER
def _step_against(at, node, j, entry, via, layer, nodes, search):
    """Visit the node from which flow comes along arc j into a node, if that is worth it."""
    log, into = search.log, layer.into
    slack = log[entry, SLACK] + into[node, j, REDUCED]
    if via != OWN and node < layer.first_goal:
        slack -= layer.out[log[entry, NODE], via, REDUCED]
    other = at + into[node, j, OFFSET]
    if not _may_visit(other, slack, entry, nodes, search):
        return False
    _visit(other, into[node, j, OTHER], slack, entry, via, nodes, search)
    return True


@HELPER
def _step_from_goal(entry, layer, nodes, search):
    """Visit the node before a destination that is full: somebody else is to arrive elsewhere."""
    log, into = search.log, layer.into
    at, node = log[entry, AT], log[entry, NODE]
    for j in range(into.shape[1]):
        other = at + into[node, j, OFFSET]
        if other == at:
            break
        if log[entry, TRIED] >> j & 1:
            continue
        log[entry, TRIED] |= 1 << j
        if arc_out(nodes.flow[other]) == into[node, j, PLACE]:
            if _step_against(at, node, j, entry, j, layer, nodes, search):
                return True
    return False


@HELPER
def _step_out(entry, layer, nodes, search):
    """Visit a node to which an arc leads that carries no flow, or the one before if somebody else comes there."""
    log, out = search.log, layer.out
    at, node = log[entry, AT], log[entry, NODE]
    taken = arc_out(nodes.flow[at])
    for i in range(out.shape[1] - 1, -1, -1):
        offset = out[node, i, OFFSET]
        if offset == 0 or log[entry, TRIED] >> i & 1 or i == taken:
            continue
        log[entry, TRIED] |= 1 << i
        head, other = at + offset, out[node, i, OTHER]
        passes = nodes.flow[head]
        if passes == 0 or other >= layer.first_goal:
            slack = log[entry, SLACK] - out[node, i, REDUCED]
            if _may_visit(head, slack, entry, nodes, search):
                _visit(head, other, slack, entry, i, nodes, search)
                return True
        elif not is_start(passes):
            if _step_against(head, other, arc_in(passes), entry, i, layer, nodes, search):
                return True
    return False


@HELPER
def _step_ahead(entry, layer, nodes, search):
    """Visit that node after the one under way which is nearest to a destination; False if none is left."""
    log = search.log
    at, node = log[entry, AT], log[entry, NODE]
    if node >= layer.first_goal:
        return _step_from_goal(entry, layer, nodes, search)
    if _step_out(entry, layer, nodes, search):
        return True
    flow = nodes.flow[at]
    if flow == 0 or is_start(flow) or log[entry, TRIED] >> OWN & 1:
        return False
    log[entry, TRIED] |= 1 << OWN
    return _step_against(at, node, arc_in(flow), entry, OWN, layer, nodes, search)


@HELPER
def _leave(nodes, search):
    """Go back from the entry under way; what cannot reach anything visited before it is done with."""
    log, own, ahead = search.log, search.state, nodes.ahead
    entry = own[CURRENT]
    own[CURRENT] = log[entry, FROM]
    if log[entry, LOW] < entry:
        log[own[CURRENT], LOW] = min(log[own[CURRENT], LOW], log[entry, LOW])
        return
    for done in range(entry, own[LOGGED]):
        at = log[done, AT]
        if ahead[at] == MARK + done:
            ahead[at] = min(log[done, SLACK] + own[SHORT], DEAD)
    own[LOGGED] = entry


@HELPER
def look_ahead(layer, nodes, search, ends, state, budget):
    """Search from robots without path for an open destination; it is then the entry under way."""
    size = len(layer.hops)
    own, log = search.state, search.log
    for _ in range(budget):
        if own[CURRENT] != NONE:
            if own[LOGGED] == len(log):
                return LIST_FULL
            entry = own[CURRENT]
            if log[entry, NODE] >= layer.first_goal and nodes.flow[log[entry, AT]] < layer.capacity:
                return FOUND
            if not _step_ahead(entry, layer, nodes, search):
                _leave(nodes, search)
            continue
        own[SHORT] = MARK
        if own[ROOT] == state[LAST_ROBOT]:
            return EXHAUSTED
        at = ends.start[own[ROOT]]
        slack = state[LEVEL] - ends.value[own[ROOT]]
        own[ROOT] += 1
        if ends.lacks[at % size] and slack >= nodes.ahead[at]:
            _visit(at, at % size, slack, NONE, 0, nodes, search)
    return BUDGET_SPENT


@HELPER
def forget_ahead(nodes, search, more):
    """Begin again from the same root; the bounds of what is not done with are no less than its slack plus `more`."""
    log, own, ahead = search.log, search.state, nodes.ahead
    if own[LOGGED] > 0:
        own[ROOT] -= 1
    for entry in range(own[LOGGED]):
        at = log[entry, AT]
        if ahead[at] == MARK + entry:
            ahead[at] = min(log[entry, SLACK] + more, DEAD)
    own[LOGGED] = 0
    own[CURRENT] = NONE
    own[SHORT] = MARK


@HELPER
def turn_ahead(layer, flow, log, entry):
    """Let a robot go from the root to an entry; return the node where it starts."""
    out = layer.out
    flow[log[entry, AT]] += 1
    while log[entry, FROM] >= 0:
        via = log[entry, VIA]
        entry = log[entry, FROM]
        at, node = log[entry, AT], log[entry, NODE]
        if node >= layer.first_goal:
            continue
        if via == OWN:
            flow[at] = 0
            continue
        head = at + out[node, via, OFFSET]
        flow[at] = with_arc_out(flow[at], via)
        if out[node, via, OTHER] < layer.first_goal:
            flow[head] = with_arc_in(flow[head], out[node, via, PLACE])
    at = log[entry, AT]
    flow[at] = with_arc_in(flow[at], START - 1)
    return log[entry, NODE]
