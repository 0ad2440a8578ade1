"""Tolls that prove a flow of earliest arrivals to be the best: for each node, when a further robot there would arrive.

The *label* of a node is the first step in which one more robot could arrive if it stood there and others may be
turned back; plus 1 it takes the bits above the flow in the words of `words`. A search goes back from the destinations,
step by step of arrival, through the residual graph. A node that carries flow is entered with the label of the node
before it, and left with its own; what is lost in between is its *toll*.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, OUT_I32, OUT_I64, declared, kernel
from trihex.optimum.kernels.flow_byte import arc_out
from trihex.optimum.kernels.residual import BUDGET_SPENT, DONE, LIST_FULL, OFFSET, OTHER
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.words import FLOW, WORDS

# Where the label begins.
WHEN = 1 << 8
# Entries of the state.
ARRIVAL = 0  # step of arrival under way
STACKED = 1  # nodes on the stack
LAST = 2  # last step of arrival
STATE_SIZE = 3


class Labelling(NamedTuple):
    """The nodes, and those whose neighbours are still to be labelled."""

    hops: IN_I32  # steps from each node of a layer to a destination
    capacity: types.int64  # how many robots may get into a destination in a step, 0: any number
    words: WORDS  # of all nodes of all layers
    stack: OUT_I64
    state: OUT_I64  # with the entries above


class TollsOut(NamedTuple):
    """Where the tolls of cells go, one for each action: that of the node which it leads to."""

    first: IN_I64  # action 0 of robot r is action[first[r]]
    label: OUT_I64  # label of the start of each robot
    node: OUT_I32
    toll: OUT_I32


LABELLING, TOLLS_OUT = declared(Labelling), declared(TollsOut)


@HELPER
def _label(at, labelling):
    """Label a node that has no label yet with the step under way."""
    if labelling.words[at] < WHEN:
        labelling.words[at] |= (labelling.state[ARRIVAL] + 1) * WHEN
        labelling.stack[labelling.state[STACKED]] = at
        labelling.state[STACKED] += 1


@HELPER
def _label_before(at, node, graph, labelling):
    """Label all nodes from which a robot may come to that one."""
    size = len(labelling.hops)
    j = 0
    while graph.into[node, j, OFFSET] != 0:
        before = at + graph.into[node, j, OFFSET]
        if before // size >= labelling.hops[graph.into[node, j, OTHER]]:  # not before step 0
            _label(before, labelling)
        j += 1


@HELPER
def _go_on(at, graph, labelling):
    """Label what leads to a node that has its label."""
    node = at % len(labelling.hops)
    flow = labelling.words[at] & FLOW
    if node < graph.first_goal and flow != 0:
        i = arc_out(flow)  # only who is turned back comes here: whoever enters the next node against the flow
        at, node = at + graph.out[node, i, OFFSET], graph.out[node, i, OTHER]
        _label(at, labelling)
    _label_before(at, node, graph, labelling)


@kernel(types.int64(SLOT_GRAPH, LABELLING, types.int64))
def label_nodes(graph, labelling, budget):
    """Label all nodes that lead to an open slot, step by step, until done, room is needed or the budget is spent."""
    state, size = labelling.state, len(labelling.hops)
    while budget > 0:
        budget -= 1
        if state[STACKED] + size - graph.first_goal + graph.into.shape[1] > len(labelling.stack):
            return LIST_FULL
        if state[STACKED] > 0:
            state[STACKED] -= 1
            _go_on(labelling.stack[state[STACKED]], graph, labelling)
            continue
        if state[ARRIVAL] == state[LAST]:
            return DONE
        state[ARRIVAL] += 1
        for goal in range(graph.first_goal, size):
            slot = state[ARRIVAL] * size + goal
            if labelling.capacity == 0 or labelling.words[slot] & FLOW < labelling.capacity:
                _label(slot, labelling)
    return BUDGET_SPENT


@HELPER
def _label_of(at, labelling):
    """Return the label of a node; what leads nowhere in time gets the last step."""
    word = labelling.words[at]
    return labelling.state[LAST] if word < WHEN else word // WHEN - 1


@kernel(types.void(SLOT_GRAPH, LABELLING, IN_I64, TOLLS_OUT))
def write_tolls(graph, labelling, start, out):
    """Write what robots lose where they pass."""
    for robot in range(len(start)):
        at, k = start[robot], out.first[robot]
        node = at % len(labelling.hops)
        label = out.label[robot] = _label_of(at, labelling)
        while node < graph.first_goal:
            i = arc_out(labelling.words[at] & FLOW)
            at, node = at + graph.out[node, i, OFFSET], graph.out[node, i, OTHER]
            own = _label_of(at, labelling)
            out.node[k] = node
            out.toll[k] = max(0, label - own) if node < graph.first_goal else 0
            label = own
            k += 1
