"""Search back from open destinations for a robot without path: A* that estimates by what it has learnt.

Of the paths that cost the level it finds one that turns the fewest flows back (*turns*). Each node keeps ``since``, the
least cost from a robot without path, shifted by `BITS`, plus the least number of turns at that cost. Nodes are visited
in the order of turns so far plus turns to come, the latest found first. Whatever the search ends with, every path takes
at least as many turns as it has come to; so those to a visited node are at least the difference, which it keeps.
"""

from numba import njit

from trihex.kernels.signatures import UNCOUNTED
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
    START,
    TURN_LISTS,
    TURNS,
    VIA,
)

# Bits of the least number of turns in a bound, and the most that it tells.
BITS = 6
MOST_TURNS = (1 << BITS) - 1
# No robot without path ever comes to such a node.
NEVER = (MARK >> BITS) - 1


@njit(nogil=True, **UNCOUNTED)
def _stands_back(seen, slack, turns, log):
    """Tell whether a visit with so much slack and so many turns is no better than one that has been."""
    return slack < log[seen, SLACK] or (slack == log[seen, SLACK] and turns >= log[seen, TURNS])


@njit(nogil=True, **UNCOUNTED)
def _offer(at, node, row, slack, seen_from, via, turns, since, log, own, heads):
    """Log a node that is worth a visit."""
    before = since[at]
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


@njit(nogil=True, **UNCOUNTED)
def _visit(entry, out, into, hops, first_goal, flow, away, since, log, own, heads):
    """Offer the nodes before one, the nearest to a robot without path at last."""
    at, node, row, slack = log[entry, AT], log[entry, NODE], log[entry, ROW], log[entry, SLACK]
    is_goal = node >= first_goal
    nearest = 4 * FAR_AWAY
    best_at = best_node = best_row = best_slack = best_place = best_turns = 0
    for j in range(into.shape[1]):
        offset = into[node, j, OFFSET]
        place, turns = j, log[entry, TURNS]
        other, tail, other_row, left = at, node, row, slack
        if offset == 0:  # after the last arc: back along the flow that leaves
            if is_goal or flow[at] == 0:
                break
            place = OWN
        else:
            other, tail = at + offset, into[node, j, OTHER]
            other_row, left = row + into[node, j, ROWS], slack - into[node, j, EXTRA]
            if ((flow[other] & 15) - 1 == into[node, j, PLACE]) if is_goal else (j == (flow[at] >> 4) - 1):
                continue
        if flow[other] != 0:
            i = (flow[other] & 15) - 1
            other += out[tail, i, OFFSET]
            other_row += out[tail, i, ROWS]
            left += out[tail, i, EXTRA]
            tail = out[tail, i, OTHER]
            turns += 1
        far = away[tail]
        if far > other_row - hops[tail]:  # too far for the steps that are left
            far += FAR_AWAY
        if far > nearest:
            _offer(other, tail, other_row, left, entry, place, turns, since, log, own, heads)
        else:
            if nearest < 4 * FAR_AWAY:
                _offer(best_at, best_node, best_row, best_slack, entry, best_place, best_turns, since, log, own, heads)
            nearest, best_place, best_turns = far, place, turns
            best_at, best_node, best_row, best_slack = other, tail, other_row, left
        if place == OWN:
            break
    if nearest < 4 * FAR_AWAY:
        _offer(best_at, best_node, best_row, best_slack, entry, best_place, best_turns, since, log, own, heads)


@njit(nogil=True, **UNCOUNTED)
def _offer_goals(layer, nodes, search, ends, state):
    """Begin at all destinations that are open."""
    size = len(layer.hops)
    own, heads = search.state, search.heads
    own[ROOT], own[CURRENT], own[SHORT] = 1, TURN_LISTS, MARK
    heads[:TURN_LISTS] = NONE
    for k in range(state[OPEN_GOALS]):
        at = ends.goals[k]
        row = at // size
        slack = state[LEVEL] - layer.base * row
        if nodes.flow[at] < layer.capacity and slack % layer.grain == 0:
            _offer(at, at % size, row, slack, NONE, 0, 0, nodes.since, search.log, own, heads)


@njit(nogil=True, **UNCOUNTED)
def _look(out, into, hops, first_goal, flow, since, away, lacks, log, own, heads, budget):
    for _ in range(budget):
        while own[CURRENT] < TURN_LISTS and heads[own[CURRENT]] == NONE:
            own[CURRENT] += 1
        if own[CURRENT] == TURN_LISTS:
            return EXHAUSTED
        if own[LOGGED] + into.shape[1] > len(log):
            return LIST_FULL
        entry = heads[own[CURRENT]]
        heads[own[CURRENT]] = log[entry, NEXT]
        at, node = log[entry, AT], log[entry, NODE]
        seen = since[at] - MARK
        if seen >= 0 and _stands_back(seen, log[entry, SLACK], log[entry, TURNS], log):
            continue
        if lacks[node] and log[entry, ROW] == hops[node]:
            own[LAST] = entry
            return FOUND
        since[at] = MARK + entry
        _visit(entry, out, into, hops, first_goal, flow, away, since, log, own, heads)
    return BUDGET_SPENT


@njit(nogil=True, **UNCOUNTED)
def look_back(layer, nodes, search, ends, state, budget):
    """Search for a robot without path; it is then the entry `LAST`."""
    own, log, heads = search.state, search.log, search.heads
    if own[ROOT] == 0:
        if state[OPEN_GOALS] >= len(log):
            return LIST_FULL
        _offer_goals(layer, nodes, search, ends, state)
    arcs = layer.out, layer.into, layer.hops, layer.first_goal
    return _look(*arcs, nodes.flow, nodes.since, ends.away, ends.lacks, log, own, heads, budget)


@njit(nogil=True, **UNCOUNTED)
def forget_back(since, search, more):
    """End the search; if no path of this level is left, what was visited costs `more` than was allowed for it."""
    log, own = search.log, search.state
    for entry in range(own[LOGGED]):
        at = log[entry, AT]
        if since[at] == MARK + entry:
            if more > 0:
                since[at] = min(log[entry, SLACK] + more, NEVER) << BITS
            else:
                turns = max(0, min(own[CURRENT] - log[entry, TURNS], MOST_TURNS))
                since[at] = (log[entry, SLACK] << BITS) + turns
    own[LOGGED] = own[ROOT] = 0


@njit(nogil=True, **UNCOUNTED)
def turn_back(layer, nodes, log, entry):
    """Let a robot go from an entry to the root; return the node where it starts."""
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
