"""Least-cost paths for one robot after another through the residual graph, for robots that seldom meet.

In any order the flow is the cheapest for the robots served so far, as long as each gets a shortest path. That is found
by A* ahead from its start: each node keeps ``ahead``, the least cost from it to an open destination beyond its value in
the network, shifted by `BITS`, plus the least number of flows turned back (*turns*) on a path of that cost. Neither
ever falls, so what a search learns serves all later ones: a path through a visited node is no less than the path found.
"""

from numba import njit, types

from trihex.kernels.signatures import OUT_I64, UNCOUNTED
from trihex.optimum.kernels.back import BITS, MOST_TURNS
from trihex.optimum.kernels.residual import (
    AT,
    BUDGET_SPENT,
    CURRENT,
    DONE,
    ENDS,
    FROM,
    LAYER,
    LAYERS_FULL,
    LEVEL,
    LEVELS_FULL,
    LIST_FULL,
    LISTS,
    LOGGED,
    MARK,
    MOST_LEVEL,
    NEXT,
    NODE,
    NODES,
    NONE,
    OFFSET,
    OTHER,
    OWN,
    PLACE,
    REDUCED,
    ROOT,
    SEARCH,
    SERVED,
    SLACK,
    SPARE_ROWS,
    SPENT,
    START,
    TOTAL,
    TURN_LISTS,
    TURNS,
    VIA,
    VISITS,
    turn_ahead,
)

# Columns of the log: as in flow_search, but here the cost beyond the value so far.
COST = SLACK
# The last list is for all that cost more.
FURTHER = LISTS - 1
# Of a search: cost that the first list of those stands for.
BASE = ROOT


@njit(nogil=True, **UNCOUNTED)
def _stands_back(seen, cost, turns, log):
    """Tell whether a visit at such a cost and with so many turns is no better than one that has been."""
    return cost > log[seen, COST] or (cost == log[seen, COST] and turns >= log[seen, TURNS])


@njit(nogil=True, **UNCOUNTED)
def _put(entry, ahead, log, own, heads, cost_now):
    """Put an entry on the list of its least total of turns, or, if it costs more, on that of its cost."""
    bound = ahead[log[entry, AT]]
    if bound >= MARK:
        bound = 0
    least = log[entry, COST] + (bound >> BITS)
    if least <= cost_now:
        which = min(log[entry, TURNS] + (bound & MOST_TURNS), TURN_LISTS - 1)
        own[CURRENT] = min(own[CURRENT], which)
    else:
        which = min(TURN_LISTS + least - own[BASE], FURTHER)
    log[entry, NEXT] = heads[which]
    heads[which] = entry


@njit(nogil=True, **UNCOUNTED)
def _offer(at, node, cost, turns, seen_from, via, ahead, log, own, heads, cost_now):
    """Log a node that is worth a visit."""
    if ahead[at] >= MARK and _stands_back(ahead[at] - MARK, cost, turns, log):
        return
    entry = own[LOGGED]
    log[entry, AT], log[entry, NODE], log[entry, COST], log[entry, TURNS] = at, node, cost, turns
    log[entry, FROM], log[entry, VIA] = seen_from, via
    own[LOGGED] += 1
    _put(entry, ahead, log, own, heads, cost_now)


@njit(nogil=True, **UNCOUNTED)
def _visit(entry, out, into, first_goal, flow, ahead, log, own, heads, cost_now):
    """Offer the nodes after one, those nearest to a destination at last."""
    at, node, cost, turns = log[entry, AT], log[entry, NODE], log[entry, COST], log[entry, TURNS]
    if node >= first_goal:  # full: somebody else is to arrive elsewhere
        for j in range(into.shape[1]):
            other = at + into[node, j, OFFSET]
            if other == at:
                break
            if (flow[other] & 15) - 1 == into[node, j, PLACE]:
                less = cost - into[node, j, REDUCED]
                _offer(other, into[node, j, OTHER], less, turns + 1, entry, j, ahead, log, own, heads, cost_now)
        return
    passes = flow[at]
    mine = (passes & 15) - 1
    i = OWN if passes != 0 and passes >> 4 != START else 0  # first back along the flow that comes in
    while True:
        via, more_turns = i, turns
        if i == OWN:
            head, other, more = at, node, cost
            i = 0
        else:
            offset = out[node, i, OFFSET]
            if offset == 0:
                break
            i += 1
            if via == mine:
                continue
            head, other, more = at + offset, out[node, via, OTHER], cost + out[node, via, REDUCED]
            passes = flow[head]
            if passes >> 4 == START:
                continue
        if passes != 0 and other < first_goal:  # turn back who comes there
            j = (passes >> 4) - 1
            head, more, other = head + into[other, j, OFFSET], more - into[other, j, REDUCED], into[other, j, OTHER]
            more_turns += 1
        _offer(head, other, more, more_turns, entry, via, ahead, log, own, heads, cost_now)


@njit(nogil=True, **UNCOUNTED)
def _forget(ahead, log, own, cost_now):
    """End the search: no path from the root costs less, nor as much with fewer turns."""
    for entry in range(own[LOGGED]):
        at = log[entry, AT]
        if ahead[at] == MARK + entry:
            turns = max(0, min(own[CURRENT] - log[entry, TURNS], MOST_TURNS))
            ahead[at] = ((cost_now - log[entry, COST]) << BITS) + turns
    own[LOGGED] = 0


@njit(nogil=True, **UNCOUNTED)
def _raise_cost(ahead, log, own, heads, cost_now):
    """Go on with the nodes of the next higher cost, and return that."""
    which = TURN_LISTS + cost_now + 1 - own[BASE]
    while which < FURTHER and heads[which] == NONE:
        which += 1
    entry = heads[which]
    heads[which] = NONE
    own[CURRENT] = TURN_LISTS
    if which < FURTHER:
        cost_now = own[BASE] + which - TURN_LISTS
    else:  # to the last list came all that cost more: its least is the new base
        cost_now, other = MARK, entry
        while other != NONE:
            bound = ahead[log[other, AT]]
            cost_now = min(cost_now, log[other, COST] + ((bound >> BITS) if bound < MARK else 0))
            other = log[other, NEXT]
        own[BASE] = cost_now
    while entry != NONE:
        following = log[entry, NEXT]
        seen = ahead[log[entry, AT]] - MARK
        if seen < 0 or not _stands_back(seen, log[entry, COST], log[entry, TURNS], log):
            _put(entry, ahead, log, own, heads, cost_now)
        entry = following
    return cost_now


@njit(nogil=True, **UNCOUNTED)
def _serve(start, value, out, into, first_goal, capacity, flow, ahead, log, own, heads, state, budget):
    size = len(out)
    for _ in range(budget):
        if state[SERVED] == len(start):
            return DONE
        robot = len(start) - 1 - state[SERVED]
        if own[LOGGED] + into.shape[1] > len(log):
            return LIST_FULL
        if state[LEVEL] == NONE:
            at = start[robot]
            heads[:] = NONE
            own[BASE] = state[LEVEL] = ahead[at] >> BITS
            own[CURRENT] = TURN_LISTS
            state[SPENT] = 0
            _offer(at, at % size, 0, 0, NONE, 0, ahead, log, own, heads, state[LEVEL])
            continue
        while own[CURRENT] < TURN_LISTS and heads[own[CURRENT]] == NONE:
            own[CURRENT] += 1
        if own[CURRENT] == TURN_LISTS:
            state[LEVEL] = _raise_cost(ahead, log, own, heads, state[LEVEL])
            if state[LEVEL] > MOST_LEVEL:
                return LEVELS_FULL
            continue
        entry = heads[own[CURRENT]]
        if log[entry, AT] + SPARE_ROWS * size > len(flow):
            return LAYERS_FULL
        heads[own[CURRENT]] = log[entry, NEXT]
        seen = ahead[log[entry, AT]] - MARK
        if seen >= 0 and _stands_back(seen, log[entry, COST], log[entry, TURNS], log):
            continue
        if log[entry, NODE] >= first_goal and flow[log[entry, AT]] < capacity:
            turn_ahead(out, into, first_goal, flow, log, entry)
            _forget(ahead, log, own, state[LEVEL])
            state[TOTAL] += value[robot] + state[LEVEL]
            state[LEVEL] = NONE
            state[SERVED] += 1
            continue
        state[SPENT] += 1
        state[VISITS] += 1
        ahead[log[entry, AT]] = MARK + entry
        _visit(entry, out, into, first_goal, flow, ahead, log, own, heads, state[LEVEL])
    return BUDGET_SPENT


@njit(types.int64(LAYER, NODES, SEARCH, ENDS, OUT_I64, types.int64), cache=True, nogil=True, **UNCOUNTED)
def serve_singly(layer, nodes, search, ends, state, budget):
    """Serve robots, the farthest first, until all have a path, room is needed or some `budget` nodes were visited.

    The cost beyond its value of the robot under way is ``state[LEVEL]``, or NONE between two robots; nodes visited for
    it and for all so far are ``state[SPENT]`` and ``state[VISITS]``.
    """
    # Arrays in place of tuples of them: each access to a tuple counts references, which takes half of the time.
    return _serve(
        ends.start,
        ends.value,
        layer.out,
        layer.into,
        layer.first_goal,
        layer.capacity,
        nodes.flow,
        nodes.ahead,
        search.log,
        search.state,
        search.heads,
        state,
        budget,
    )
