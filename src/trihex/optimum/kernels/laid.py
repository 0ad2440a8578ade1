"""A plan laid into the words of the nodes, and where nobody can be."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, IN_I64, IN_U8, TABLE_I32, declared, kernel
from trihex.optimum.kernels.flow_byte import START, with_arc_out
from trihex.optimum.kernels.residual import OFFSET, OTHER, PLACE
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.words import DEAD, LABEL, WORDS


class LaidPlan(NamedTuple):
    """A plan, and where robots are in the network."""

    start: IN_I64  # index of the node of each robot in step 0
    first_action: IN_I64  # what it does is action[first_action[robot]] and on
    action: IN_U8
    site_of_node: IN_I32
    node_of_site: IN_I32
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site


LAID_PLAN = declared(LaidPlan)


@HELPER
def _arc_to(node, target, out):
    """Return the place of the arc to a node, -1 if there is none."""
    for i in range(out.shape[1]):
        if out[node, i, OFFSET] == 0:
            break
        if out[node, i, OTHER] == target:
            return i
    return -1


@HELPER
def _leads_past(node, target, graph):
    """Tell whether a lattice vertex leads to a node past the gate of a door."""
    out = graph.out
    for i in range(out.shape[1]):
        if out[node, i, OFFSET] == 0:
            break
        gate = out[node, i, OTHER]
        if graph.cell_count <= gate < graph.first_goal and _arc_to(gate, target, out) >= 0:
            return True
    return False


@HELPER
def _arc_past(node, target, graph):
    """Return the place of the arc by which a node is reached past a lattice vertex or a gate, or both; -1: none."""
    out, past_both = graph.out, -1
    for i in range(out.shape[1]):
        if out[node, i, OFFSET] == 0:
            break
        between = out[node, i, OTHER]
        if not graph.cell_count <= between < graph.first_goal:
            continue
        if _arc_to(between, target, out) >= 0:
            return i
        if _leads_past(between, target, graph):
            past_both = i
    return past_both


@HELPER
def _go(at, node, i, graph, words):
    """Let a robot go along an arc; return where it is then."""
    words[at] = with_arc_out(words[at], i)
    head = at + graph.out[node, i, OFFSET]
    if graph.out[node, i, OTHER] >= graph.first_goal:
        words[head] += 1
    else:
        words[head] = (graph.out[node, i, PLACE] + 1) << 4
    return head


@kernel(types.boolean(LAID_PLAN, SLOT_GRAPH, WORDS))
def lay_plan(plan, graph, words):
    """Write the paths of a plan into the words of the nodes; False if it takes a move that there is not."""
    size = len(graph.out)
    for robot in range(len(plan.start)):
        at, k = plan.start[robot], plan.first_action[robot]
        node = at % size
        words[at] = START << 4
        while node < graph.first_goal:
            site, action = plan.site_of_node[node], plan.action[k]
            k += 1
            target = node
            if action != WAIT:
                target = np.int64(plan.node_of_site[site + plan.offset[site & 1, action]])
            i = _arc_to(node, target, graph.out)
            while i < 0:
                i = _arc_past(node, target, graph)
                if i < 0:
                    return False
                at, node = _go(at, node, i, graph, words), np.int64(graph.out[node, i, OTHER])
                i = _arc_to(node, target, graph.out)
            at, node = _go(at, node, i, graph, words), target
    return True


@kernel(types.void(IN_I32, IN_BOOL, WORDS))
def bury_starts(hops, is_vertex, words):
    """Label dead, after `lay_plan`, where nobody can be: in a cell in step 0 but for the robots, and before that."""
    size = len(hops)
    for row in range(len(words) // size):
        buried = 0
        for node in range(size):
            at = row * size + node
            if hops[node] > row or (hops[node] == row and not is_vertex[node] and words[at] == 0):
                words[at] = DEAD * LABEL
                buried += 1
        if buried == 0:
            break
