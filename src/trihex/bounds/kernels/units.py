"""Units of flow, one for each robot, on their ways to the destinations; at most one passes each node but these.

So ``onward[node]`` (-1: no unit) and its inverse ``source_of[node]`` (the node itself: the unit starts there) hold the
whole flow. Nodes are entered at their *in*, 2 * node, and left at their *out*, 2 * node + 1. A unit may be led along
any *residual arc* between these: on, or back where another came, which then goes elsewhere.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.bounds.kernels.nodes import NODE_GRAPH, is_open, node_ahead, site_behind, way_count
from trihex.kernels.signatures import HELPER, IN_I32, OUT_I32, OUT_I64, declared, kernel

DEAD = 2**31 - 1
# Entries of `state`: number of the search under way, units sent, robots that none could be sent for since the last one,
# looks in all; of the search under way: height of its stack, length of its trail.
STAMP, SENT, FAILED, LOOKS, HEIGHT, MARKS = range(6)


class Units(NamedTuple):
    """The flow."""

    room: OUT_I32  # of each site: how many more units may end there
    onward: OUT_I32  # of each node: where its unit goes
    source_of: OUT_I32  # of each node: where its unit comes from


class UnitSearch(NamedTuple):
    """The search for a way for one more unit; an *item* is the in or the out of a node."""

    seen: OUT_I32  # of each item: the last search that has seen it; `DEAD` where it leads nowhere ever after
    parent: OUT_I32  # of each item: the one from which it was seen, -1 at the start
    stack: OUT_I32  # items from which to look on
    trail: OUT_I32  # all items seen
    ahead: OUT_I32  # nodes that can be entered from one node
    state: OUT_I64


UNITS, UNIT_SEARCH = declared(Units), declared(UnitSearch)


@HELPER
def _see(item, parent, search):
    """Put an item on the stack, unless this search has seen it."""
    state = search.state
    if search.seen[item] < state[STAMP]:
        search.seen[item] = state[STAMP]
        search.parent[item] = parent
        search.stack[state[HEIGHT]] = item
        search.trail[state[MARKS]] = item
        state[HEIGHT] += 1
        state[MARKS] += 1


@HELPER
def _list_ahead(node, graph, ahead):
    """List the nodes that can be entered from `node` (the same that it can be entered from); the nearest comes last."""
    count = nearest = 0
    least = DEAD
    for k in range(way_count(node, graph)):
        if is_open(node, k, graph):
            steps = graph.steps[site_behind(node, k, graph)]
            if steps < least:
                nearest, least = count, steps
            ahead[count] = node_ahead(node, k, graph)
            count += 1
    ahead[nearest], ahead[count - 1] = ahead[count - 1], ahead[nearest]
    return count


@HELPER
def _look_ahead(item, graph, units, search):
    """See what the residual arcs from an item lead to."""
    node = item >> 1
    if item & 1:
        for i in range(_list_ahead(node, graph, search.ahead)):
            _see(2 * np.int64(search.ahead[i]), item, search)
        if units.onward[node] >= 0:
            _see(2 * node, item, search)
    elif node < len(graph.moves) and graph.is_destination[node]:
        for i in range(_list_ahead(node, graph, search.ahead)):
            before = np.int64(search.ahead[i])
            if units.onward[before] == node:
                _see(2 * before + 1, item, search)
    elif units.onward[node] < 0:
        _see(2 * node + 1, item, search)
    elif units.source_of[node] != node:
        _see(2 * np.int64(units.source_of[node]) + 1, item, search)


@HELPER
def _find_room(start, graph, units, search):
    """Search depth first for a destination with room; return its item, or -1. Near destinations are tried first."""
    state = search.state
    state[STAMP] += 1
    state[HEIGHT] = state[MARKS] = 0
    _see(2 * start, np.int64(-1), search)
    while state[HEIGHT] > 0:
        state[HEIGHT] -= 1
        state[LOOKS] += 1
        item = np.int64(search.stack[state[HEIGHT]])
        node = item >> 1
        if item & 1 == 0 and node < len(graph.moves) and graph.is_destination[node] and units.room[node] > 0:
            return item
        _look_ahead(item, graph, units, search)
    return np.int64(-1)


@HELPER
def _send(item, units, parent):
    """Send a unit along the way that the search has found to `item`."""
    units.room[item >> 1] -= 1
    while parent[item] >= 0:
        before = np.int64(parent[item])
        here, there = before >> 1, item >> 1
        if before & 1 and here != there:
            units.onward[here] = there
            units.source_of[there] = here
        elif before & 1:
            units.onward[here] = -1
        item = before
    units.source_of[item >> 1] = item >> 1


@kernel(types.int64(IN_I32, types.int64, NODE_GRAPH, UNITS, UNIT_SEARCH, types.int64))
def send_units(start, first, graph, units, search, budget):
    """Send units from the sites ``start[first:]`` to the destinations; return the index of the next one to send.

    Returns before a unit that can be sent though the one before it could not, after about `budget` looks, or at the
    end.
    """
    state = search.state
    most_looks = state[LOOKS] + budget
    for r in range(first, len(start)):
        if state[LOOKS] >= most_looks:
            return r
        site = np.int64(start[r])
        if search.seen[2 * site] == DEAD:
            state[FAILED] += 1
            continue
        item = _find_room(site, graph, units, search)
        if item < 0:
            for i in range(state[MARKS]):
                search.seen[search.trail[i]] = DEAD
            state[FAILED] += 1
            continue
        if state[FAILED] > 0:
            return r
        state[SENT] += 1
        _send(item, units, search.parent)
    return len(start)
