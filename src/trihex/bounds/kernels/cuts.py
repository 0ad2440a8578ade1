"""Least cuts, read from a flow of units: see `units`."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.bounds.kernels.nodes import NODE_GRAPH, is_open, node_ahead, way_count
from trihex.kernels.signatures import HELPER, IN_I32, OUT_BOOL, OUT_I32, declared, kernel


class CutSearch(NamedTuple):
    """The search back from the destinations; an *item* is the in or the out of a node."""

    leads_on: OUT_BOOL  # of each item: whether a residual way leads from it to a destination that has room
    queue: OUT_I32  # items of which this has been found out


CUT_SEARCH = declared(CutSearch)


@HELPER
def _add(item, tail, search):
    """Put an item into the queue, unless it has been there; return the new tail."""
    if search.leads_on[item]:
        return tail
    search.leads_on[item] = True
    search.queue[tail] = item
    return tail + 1


@HELPER
def _look_before(node, tail, graph, onward, search):
    """Add the outs from which a node is entered; return the new tail."""
    for k in range(way_count(node, graph)):
        before = np.int64(node_ahead(node, k, graph))
        if not is_open(node, k, graph) or search.leads_on[2 * before + 1]:
            continue
        if before < len(graph.moves) and graph.is_destination[before]:
            continue
        if onward[before] >= 0:
            tail = _add(2 * before + 1, tail, search)
        else:  # the other half of a free node, at once
            search.leads_on[2 * before + 1] = True
            tail = _add(2 * before, tail, search)
    return tail


@kernel(types.int64(NODE_GRAPH, IN_I32, CUT_SEARCH, types.int64, types.int64, types.int64))
def search_back(graph, onward, search, head, tail, budget):
    """Go back along residual arcs from ``queue[head:tail]``, at most `budget` items; return the new tail."""
    for at in range(head, min(tail, head + budget)):
        item = np.int64(search.queue[at])
        node = item >> 1
        if item & 1:
            tail = _add(2 * np.int64(onward[node]), tail, search)
            continue
        if onward[node] >= 0:
            tail = _add(item + 1, tail, search)
        tail = _look_before(node, tail, graph, onward, search)
    return tail
