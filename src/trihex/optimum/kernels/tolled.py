"""Prices to begin with: those of nodes where nobody is yet, but arrivals cost tolls.

A toll is fair only where somebody pays it, so robots are *wanted* there: a path may end where a toll is due. What goes
on from there to the destination is laid beforehand.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, declared, kernel
from trihex.optimum.kernels.flow_byte import with_arc_out
from trihex.optimum.kernels.prices import BITS, NODES, PASSED, WANTED
from trihex.optimum.kernels.residual import LAYER, OFFSET, REDUCED

# More than any way costs.
NEVER = 1 << 26
TABLE = types.Array(types.int32, 2, "C", readonly=True)


class Tolled(NamedTuple):
    """What arrivals cost, and who pays for them."""

    order: IN_I32  # nodes so that arcs within a layer go forward
    hops: IN_I32  # steps from each node to a destination
    cell_count: types.int64
    tolls: TABLE  # by step and destination
    is_limited: IN_BOOL  # whether fewer get into a destination in a step than come to it: then the toll is due there


TOLLED = declared(Tolled)


@HELPER
def _best_arc(at, node, graph, nodes):
    """Return the place of the arc by which it costs least to go on, and that cost."""
    least, place = NEVER, 0
    for k in range(graph.out.shape[1]):
        head = at + graph.out[node, k, OFFSET]
        if head == at:
            break
        price = (nodes.entering[head] >> BITS) if head < len(nodes.entering) else 0
        if graph.out[node, k, REDUCED] + price <= least:
            least, place = graph.out[node, k, REDUCED] + price, k
    return place, least


@kernel(types.int64(LAYER, NODES, TOLLED, types.int64))
def lay_tolls(graph, nodes, tolled, layer):
    """Write the prices of a layer; called from the last one down. Return the cost of what is laid beforehand."""
    size, laid = len(graph.out), 0
    for goal in range(graph.first_goal, size):
        toll = tolled.tolls[layer, goal - graph.first_goal] if tolled.is_limited[goal - graph.first_goal] else 0
        nodes.entering[layer * size + goal] = (toll << BITS) | WANTED
    for i in range(size - 1, -1, -1):
        node = tolled.order[i]
        at = layer * size + node
        if node >= graph.first_goal:
            continue
        if tolled.hops[node] >= layer + (tolled.cell_count <= node) and nodes.flow[at] == 0:  # nobody can be here
            nodes.entering[at] = -NEVER << BITS
            continue
        place, least = _best_arc(at, node, graph, nodes)
        nodes.entering[at] = (least << BITS) | (nodes.entering[at] & PASSED)
        nodes.leaving[at] = least << BITS
        head = at + graph.out[node, place, OFFSET]
        goal = head % size - graph.first_goal
        if goal < 0 or head >= len(nodes.flow) or nodes.flow[at] != 0 or tolled.is_limited[goal]:
            continue
        toll = tolled.tolls[head // size, goal]
        if toll > 0:
            nodes.entering[at] = ((least + toll) << BITS) | WANTED | PASSED
            nodes.flow[at] = with_arc_out(0, place)
            nodes.flow[head] += 1
            laid += least
    return laid
