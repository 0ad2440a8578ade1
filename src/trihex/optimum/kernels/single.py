"""Least-cost paths for one robot after another through the residual graph, for robots that seldom meet.

In any order the flow is the cheapest for the robots served so far, as long as each gets a shortest path. That is found
by A* ahead from its start: each node keeps ``ahead``, the least cost from it to an open destination beyond its value in
the network, shifted by `BITS`, plus the least number of flows turned back (*turns*) on a path of that cost. Neither
ever falls, so what a search learns serves all later ones: a path through a visited node is no less than the path found.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, HELPER, OUT_I64, kernel
from trihex.optimum.kernels.flow_byte import START, arc_in, arc_out, is_start, with_arc_in, with_arc_out
from trihex.optimum.kernels.residual import (
    AT,
    BASE,
    BUDGET_SPENT,
    COST,
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
    SEARCH,
    SERVED,
    SPARE_ROWS,
    SPENT,
    TOTAL,
    TURN_LISTS,
    TURNS,
    VIA,
    VISITS,
)

# Bits of the least number of turns in a bound, and the most that it tells.
BITS = 6
MOST_TURNS = (1 << BITS) - 1
# The last list is for all that cost more.
FURTHER = LISTS - 1


class Reach(NamedTuple):
    """A node that can be reached, at what cost beyond the value, and with how many flows turned back."""

    at: types.int64
    node: types.int64
    cost: types.int64
    turns: types.int64


@HELPER
def _stands_back(seen, cost, turns, log):
    """Tell whether a visit at such a cost and with so many turns is no better than one that has been."""
    return cost > log[seen, COST] or (cost == log[seen, COST] and turns >= log[seen, TURNS])


@HELPER
def _is_past(entry, nodes, log):
    """Tell whether the node of an entry has had a visit that was as good."""
    seen = nodes.ahead[log[entry, AT]] - MARK
    return seen >= 0 and _stands_back(seen, log[entry, COST], log[entry, TURNS], log)


@HELPER
def _put(entry, nodes, search, cost_now):
    """Put an entry on the list of its least total of turns, or, if it costs more, on that of its cost."""
    log, own, heads = search.log, search.state, search.heads
    bound = nodes.ahead[log[entry, AT]]
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


@HELPER
def _offer(reached, seen_from, via, nodes, search, cost_now):
    """Log a node that is worth a visit."""
    log, own = search.log, search.state
    at, node, cost, turns = reached
    if nodes.ahead[at] >= MARK and _stands_back(nodes.ahead[at] - MARK, cost, turns, log):
        return
    entry = own[LOGGED]
    log[entry, AT], log[entry, NODE], log[entry, COST], log[entry, TURNS] = at, node, cost, turns
    log[entry, FROM], log[entry, VIA] = seen_from, via
    own[LOGGED] += 1
    _put(entry, nodes, search, cost_now)


@HELPER
def _turn_back(at, node, j, cost, turns, into):
    """Return the node from which flow comes along arc j into a node."""
    before = np.int64(into[node, j, OTHER])
    return Reach(at + into[node, j, OFFSET], before, cost - into[node, j, REDUCED], turns + 1)


@HELPER
def _visit_goal(entry, layer, nodes, search, cost_now):
    """Offer the nodes before a destination that is full: somebody else is to arrive elsewhere."""
    log, into = search.log, layer.into
    at, node = log[entry, AT], log[entry, NODE]
    for j in range(into.shape[1]):
        other = at + into[node, j, OFFSET]
        if other == at:
            break
        if arc_out(nodes.flow[other]) == into[node, j, PLACE]:
            reached = _turn_back(at, node, j, log[entry, COST], log[entry, TURNS], into)
            _offer(reached, entry, j, nodes, search, cost_now)


@HELPER
def _visit(entry, layer, nodes, search, cost_now):
    """Offer the nodes after one, those nearest to a destination at last."""
    log, out = search.log, layer.out
    at, node, cost, turns = log[entry, AT], log[entry, NODE], log[entry, COST], log[entry, TURNS]
    passes = nodes.flow[at]
    taken = arc_out(passes)
    i = np.int64(OWN if passes != 0 and not is_start(passes) else 0)  # first back along the flow that comes in
    while True:
        via = i
        reached = Reach(at, node, cost, turns)
        if i == OWN:
            i = np.int64(0)
        else:
            offset = out[node, i, OFFSET]
            if offset == 0:
                break
            i += 1
            if via == taken:
                continue
            reached = Reach(at + offset, np.int64(out[node, via, OTHER]), cost + out[node, via, REDUCED], turns)
            passes = nodes.flow[reached.at]
            if is_start(passes):
                continue
        if passes != 0 and reached.node < layer.first_goal:  # turn back who comes there
            reached = _turn_back(reached.at, reached.node, arc_in(passes), reached.cost, turns, layer.into)
        _offer(reached, entry, via, nodes, search, cost_now)


@HELPER
def _forget(nodes, search, cost_now):
    """End the search: no path from the root costs less, nor as much with fewer turns."""
    log, own, ahead = search.log, search.state, nodes.ahead
    for entry in range(own[LOGGED]):
        at = log[entry, AT]
        if ahead[at] == MARK + entry:
            turns = max(0, min(own[CURRENT] - log[entry, TURNS], MOST_TURNS))
            ahead[at] = ((cost_now - log[entry, COST]) << BITS) + turns
    own[LOGGED] = 0


@HELPER
def _least_cost(entry, nodes, log):
    """Return the least cost of a path through any entry of a list."""
    least = np.int64(MARK)
    while entry != NONE:
        bound = nodes.ahead[log[entry, AT]]
        least = min(least, log[entry, COST] + ((bound >> BITS) if bound < MARK else 0))
        entry = log[entry, NEXT]
    return least


@APART
def _raise_cost(nodes, search, cost_now):
    """Go on with the nodes of the next higher cost, and return that."""
    log, own, heads = search.log, search.state, search.heads
    which = TURN_LISTS + cost_now + 1 - own[BASE]
    while which < FURTHER and heads[which] == NONE:
        which += 1
    entry = heads[which]
    heads[which] = NONE
    own[CURRENT] = TURN_LISTS
    if which < FURTHER:
        cost_now = own[BASE] + which - TURN_LISTS
    else:  # to the last list came all that cost more: its least is the new base
        own[BASE] = cost_now = _least_cost(entry, nodes, log)
    while entry != NONE:
        following = log[entry, NEXT]
        if not _is_past(entry, nodes, log):
            _put(entry, nodes, search, cost_now)
        entry = following
    return cost_now


@HELPER
def _begin(robot, layer, nodes, search, ends, state):
    """Begin the search for a robot at its start."""
    own = search.state
    at = ends.start[robot]
    for which in range(LISTS):
        search.heads[which] = NONE
    own[BASE] = state[LEVEL] = nodes.ahead[at] >> BITS
    own[CURRENT] = TURN_LISTS
    state[SPENT] = 0
    none = np.int64(0)
    _offer(Reach(at, at % len(layer.out), none, none), NONE, 0, nodes, search, state[LEVEL])


@HELPER
def _turn(layer, flow, log, entry):
    """Let a robot go from the root to an entry."""
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


@HELPER
def _serve(robot, entry, layer, nodes, search, ends, state):
    """Let a robot go to an open destination, the node of an entry."""
    _turn(layer, nodes.flow, search.log, entry)
    _forget(nodes, search, state[LEVEL])
    state[TOTAL] += ends.value[robot] + state[LEVEL]
    state[LEVEL] = NONE
    state[SERVED] += 1


@kernel(types.int64(LAYER, NODES, SEARCH, ENDS, OUT_I64, types.int64))
def serve_singly(layer, nodes, search, ends, state, budget):
    """Serve robots, the farthest first, until all have a path, room is needed or some `budget` nodes were visited.

    The cost beyond its value of the robot under way is ``state[LEVEL]``, or NONE between two robots; nodes visited for
    it and for all so far are ``state[SPENT]`` and ``state[VISITS]``.
    """
    own, log, heads = search.state, search.log, search.heads
    for _ in range(budget):
        if state[SERVED] == len(ends.start):
            return DONE
        robot = len(ends.start) - 1 - state[SERVED]
        if own[LOGGED] + layer.into.shape[1] > len(log):
            return LIST_FULL
        if state[LEVEL] == NONE:
            _begin(robot, layer, nodes, search, ends, state)
            continue
        while own[CURRENT] < TURN_LISTS and heads[own[CURRENT]] == NONE:
            own[CURRENT] += 1
        if own[CURRENT] == TURN_LISTS:
            state[LEVEL] = _raise_cost(nodes, search, state[LEVEL])
            if state[LEVEL] > MOST_LEVEL:
                return LEVELS_FULL
            continue
        entry = heads[own[CURRENT]]
        at, node = log[entry, AT], log[entry, NODE]
        if at + SPARE_ROWS * len(layer.out) > len(nodes.flow):
            return LAYERS_FULL
        heads[own[CURRENT]] = log[entry, NEXT]
        if _is_past(entry, nodes, log):
            continue
        if node >= layer.first_goal and nodes.flow[at] < layer.capacity:
            _serve(robot, entry, layer, nodes, search, ends, state)
            continue
        state[SPENT] += 1
        state[VISITS] += 1
        nodes.ahead[at] = MARK + entry
        if node >= layer.first_goal:
            _visit_goal(entry, layer, nodes, search, state[LEVEL])
        else:
            _visit(entry, layer, nodes, search, state[LEVEL])
    return BUDGET_SPENT
