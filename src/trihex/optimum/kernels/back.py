"""Search back from open destinations for a robot without path: A* that estimates by what it has learnt.

Of the paths that cost the level it finds one that turns the fewest flows back (*turns*). Each node keeps ``since``, the
least cost from a robot without path, shifted by `BITS`, plus the least number of turns at that cost. Nodes are visited
in the order of turns so far plus turns to come, the latest found first. Whatever the search ends with, every path takes
at least as many turns as it has come to; so those to a visited node are at least the difference, which it keeps.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, HELPER
from trihex.optimum.kernels.flow_byte import START, arc_in, arc_out, with_arc_in, with_arc_out
from trihex.optimum.kernels.residual import (
    AT,
    BUDGET_SPENT,
    CURRENT,
    EXHAUSTED,
    EXTRA,
    FAR_AWAY,
    FOUND,
    FROM,
    LAST,
    LEVEL,
    LIST_FULL,
    LOGGED,
    MARK,
    NEXT,
    NODE,
    NONE,
    OFFSET,
    OPEN_GOALS,
    OTHER,
    OWN,
    PLACE,
    ROOT,
    ROW,
    ROWS,
    SHORT,
    SLACK,
    TURN_LISTS,
    TURNS,
    VIA,
)

# Bits of the least number of turns in a bound, and the most that it tells.
BITS = 6
MOST_TURNS = (1 << BITS) - 1
# No robot without path ever comes to such a node.
NEVER = (MARK >> BITS) - 1
# More steps than any node is away.
_NOWHERE = 4 * FAR_AWAY


class Approach(NamedTuple):
    """A node before an entry, as a visit would log it."""

    at: types.int64
    node: types.int64
    row: types.int64
    slack: types.int64
    via: types.int64
    turns: types.int64


@HELPER
def _stands_back(seen, slack, turns, log):
    """Tell whether a visit with so much slack and so many turns is no better than one that has been."""
    return slack < log[seen, SLACK] or (slack == log[seen, SLACK] and turns >= log[seen, TURNS])


@HELPER
def _offer(node_before, seen_from, nodes, search):
    """Log a node that is worth a visit."""
    log, own, heads = search.log, search.state, search.heads
    at, node, row, slack, via, turns = node_before
    before = nodes.since[at]
    total = turns
    if before < MARK:
        least = before >> BITS
        if slack < least:
            if least < NEVER:
                own[SHORT] = min(own[SHORT], least - slack)
            return
        if slack == least:
            total += before & MOST_TURNS
    elif _stands_back(before - MARK, slack, turns, log):
        return
    total = min(total, TURN_LISTS - 1)
    entry = own[LOGGED]
    log[entry, AT], log[entry, NODE], log[entry, ROW], log[entry, SLACK] = at, node, row, slack
    log[entry, FROM], log[entry, VIA], log[entry, TURNS], log[entry, NEXT] = seen_from, via, turns, heads[total]
    heads[total] = entry
    own[CURRENT] = min(own[CURRENT], total)
    own[LOGGED] += 1


@HELPER
def _carries(at, node, j, layer, nodes):
    """Tell whether somebody comes to a node by arc j."""
    if node < layer.first_goal:
        return j == arc_in(nodes.flow[at])
    return arc_out(nodes.flow[at + layer.into[node, j, OFFSET]]) == layer.into[node, j, PLACE]


@HELPER
def _turned_back(seen, layer, nodes):
    """Return a node as it is where nobody passes; else the next on the way of who does, who is to be turned back."""
    at, node = seen.at, seen.node
    if nodes.flow[at] == 0:
        return seen
    i = arc_out(nodes.flow[at])
    row, slack = seen.row + layer.out[node, i, ROWS], seen.slack + layer.out[node, i, EXTRA]
    head, other = at + layer.out[node, i, OFFSET], np.int64(layer.out[node, i, OTHER])
    return Approach(head, other, row, slack, seen.via, seen.turns + 1)


@HELPER
def _steps_away(seen, layer, ends):
    """Return how far a node seems to be from a robot without path."""
    far = np.int64(ends.away[seen.node])
    if far > seen.row - layer.hops[seen.node]:  # too far for the steps that are left
        far += FAR_AWAY
    return far


@HELPER
def _visit(entry, layer, nodes, search, ends):
    """Offer the nodes before one, the nearest to a robot without path at last."""
    log, into = search.log, layer.into
    at, node, row, slack = log[entry, AT], log[entry, NODE], log[entry, ROW], log[entry, SLACK]
    turns = log[entry, TURNS]
    nearest = np.int64(_NOWHERE)
    best = Approach(at, node, row, slack, np.int64(OWN), turns)
    for j in range(into.shape[1]):
        seen = Approach(at, node, row, slack, np.int64(OWN), turns)
        offset = into[node, j, OFFSET]
        if offset == 0:  # after the last arc: back along the flow that leaves
            if node >= layer.first_goal or nodes.flow[at] == 0:
                break
        elif _carries(at, node, j, layer, nodes):
            continue
        else:
            before = np.int64(into[node, j, OTHER])
            seen = Approach(at + offset, before, row + into[node, j, ROWS], slack - into[node, j, EXTRA], j, turns)
        seen = _turned_back(seen, layer, nodes)
        far = _steps_away(seen, layer, ends)
        if far <= nearest:
            seen, far, best, nearest = best, nearest, seen, far
        if far < _NOWHERE:
            _offer(seen, entry, nodes, search)
        if offset == 0:
            break
    if nearest < _NOWHERE:
        _offer(best, entry, nodes, search)


@HELPER
def _offer_goals(layer, nodes, search, ends, state):
    """Begin at all destinations that are open."""
    size = len(layer.hops)
    own, heads = search.state, search.heads
    own[ROOT], own[CURRENT], own[SHORT] = 1, TURN_LISTS, MARK
    for turns in range(TURN_LISTS):
        heads[turns] = NONE
    none = np.int64(0)
    for k in range(state[OPEN_GOALS]):
        at = ends.goals[k]
        row = at // size
        slack = state[LEVEL] - layer.base * row
        if nodes.flow[at] < layer.capacity and slack % layer.grain == 0:
            _offer(Approach(at, at % size, row, slack, none, none), NONE, nodes, search)


@HELPER
def _go_back(layer, nodes, search, ends, budget):
    """Visit nodes until one is where a robot without path starts."""
    own, log, heads = search.state, search.log, search.heads
    for _ in range(budget):
        while own[CURRENT] < TURN_LISTS and heads[own[CURRENT]] == NONE:
            own[CURRENT] += 1
        if own[CURRENT] == TURN_LISTS:
            return EXHAUSTED
        if own[LOGGED] + layer.into.shape[1] > len(log):
            return LIST_FULL
        entry = heads[own[CURRENT]]
        heads[own[CURRENT]] = log[entry, NEXT]
        at, node = log[entry, AT], log[entry, NODE]
        seen = nodes.since[at] - MARK
        if seen >= 0 and _stands_back(seen, log[entry, SLACK], log[entry, TURNS], log):
            continue
        if ends.lacks[node] and log[entry, ROW] == layer.hops[node]:
            own[LAST] = entry
            return FOUND
        nodes.since[at] = MARK + entry
        _visit(entry, layer, nodes, search, ends)
    return BUDGET_SPENT


@HELPER
def look_back(layer, nodes, search, ends, state, budget):
    """Search for a robot without path; it is then the entry `LAST`."""
    if search.state[ROOT] == 0:
        if state[OPEN_GOALS] >= len(search.log):
            return LIST_FULL
        _offer_goals(layer, nodes, search, ends, state)
    return _go_back(layer, nodes, search, ends, budget)


@APART
def forget_back(nodes, search, more):
    """End the search; if no path of this level is left, what was visited costs `more` than was allowed for it."""
    log, own, since = search.log, search.state, nodes.since
    for entry in range(own[LOGGED]):
        at = log[entry, AT]
        if since[at] == MARK + entry:
            if more > 0:
                since[at] = min(log[entry, SLACK] + more, NEVER) << BITS
            else:
                turns = max(0, min(own[CURRENT] - log[entry, TURNS], MOST_TURNS))
                since[at] = (log[entry, SLACK] << BITS) + turns
    own[LOGGED] = own[ROOT] = 0


@HELPER
def turn_back(layer, nodes, log, entry):
    """Let a robot go from an entry to the root; return the node where it starts."""
    flow, into = nodes.flow, layer.into
    start = log[entry, NODE]
    flow[log[entry, AT]] = START << 4
    while log[entry, FROM] >= 0:
        via = log[entry, VIA]
        entry = log[entry, FROM]
        to, node = log[entry, AT], log[entry, NODE]
        if via == OWN:  # nobody passes there any more
            flow[to] = 0
            continue
        tail = to + into[node, via, OFFSET]
        flow[tail] = with_arc_out(flow[tail], into[node, via, PLACE])
        if node < layer.first_goal:
            flow[to] = with_arc_in(flow[to], via)
    flow[log[entry, AT]] += 1
    return start
