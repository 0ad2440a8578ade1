"""Prices to begin with: those of nodes where nobody is yet, but arrivals cost tolls.

A toll is fair only where somebody pays it, so robots are *wanted* there: a path may end where a toll is due. What goes
on from there to the destination is laid beforehand.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, MASK, TABLE_I32, declared, kernel
from trihex.optimum.kernels.flow_byte import is_start, with_arc_out
from trihex.optimum.kernels.prices import BITS, NEVER, NODES, PASSED, RISES, WANTED
from trihex.optimum.kernels.residual import LAYER, NONE, OFFSET, REDUCED


class Tolled(NamedTuple):
    """What arrivals cost, and who pays for them."""

    order: IN_I32  # nodes so that arcs within a layer go forward
    hops: IN_I32  # steps from each node to a destination
    cell_count: types.int64
    tolls: TABLE_I32  # by step and destination
    is_limited: MASK  # whether fewer may arrive then than can come there: if so, the toll is due at the destination


TOLLED = declared(Tolled)


@HELPER
def _best_arc(at, node, graph, nodes):
    """Return the index of the node to go on to at the least cost, the place of the arc, and that cost.

    The index is NONE where no way leads on: past a gate behind which a robot stands until it may go.
    """
    least, place, best = NEVER, 0, NONE
    for k in range(graph.out.shape[1]):
        head = at + graph.out[node, k, OFFSET]
        if head == at:
            break
        price = (nodes.entering[head] >> BITS) if head < len(nodes.entering) else 0
        if graph.out[node, k, REDUCED] + price < least:
            least, place, best = graph.out[node, k, REDUCED] + price, k, head
    return best, place, least


@HELPER
def _open_goals(layer, graph, nodes, tolled):
    """Write the prices of the destinations of a layer."""
    for goal in range(graph.first_goal, len(graph.out)):
        at, which = layer * len(graph.out) + goal, goal - graph.first_goal
        toll = tolled.tolls[layer, which] if tolled.is_limited[layer, which] else 0
        if nodes.entering[at] & WANTED:
            nodes.entering[at] |= toll << BITS
        else:
            nodes.entering[at] = NEVER << BITS


@HELPER
def _toll_at(head, graph, nodes, tolled):
    """Return the toll that is due where an arc to a node begins, 0 unless that is a destination."""
    layer, goal = head // len(graph.out), head % len(graph.out) - graph.first_goal
    if head == NONE or goal < 0 or head >= len(nodes.flow) or tolled.is_limited[layer, goal]:
        return 0
    return tolled.tolls[layer, goal]


@kernel(types.int64(LAYER, NODES, TOLLED, types.int64))
def lay_tolls(graph, nodes, tolled, layer):
    """Write the prices of a layer; called from the last one down. Return the cost of what is laid beforehand."""
    laid = 0
    _open_goals(layer, graph, nodes, tolled)
    for i in range(len(graph.out) - 1, -1, -1):
        node = tolled.order[i]
        at = layer * len(graph.out) + node
        if node >= graph.first_goal:
            continue
        if tolled.hops[node] >= layer + (tolled.cell_count <= node) and nodes.flow[at] == 0:  # nobody can be here
            nodes.entering[at] = -NEVER << BITS
            continue
        head, place, least = _best_arc(at, node, graph, nodes)
        if is_start(nodes.flow[at]):  # nobody can come here
            nodes.entering[at] = (NEVER << BITS) | PASSED
            if nodes.leaving[at] & RISES:
                nodes.leaving[at] = (least << BITS) | RISES
            continue
        nodes.entering[at] = nodes.leaving[at] = least << BITS
        toll = _toll_at(head, graph, nodes, tolled)
        if toll > 0:
            nodes.entering[at] = ((least + toll) << BITS) | WANTED | PASSED
            nodes.flow[at] = with_arc_out(0, place)
            nodes.flow[head] += 1
            laid += least
    return laid
