"""Late labels: the other half of what `tolls` finds of a flow.

`tolls` labels each node with the first step in which one more robot could arrive if it stood there: it is *early* from
there. The *late* label is the last step of arrival of any robot that could be made to pass there instead, others being
turned back; 0 where none can. A search goes forward from the arrivals, the last first, through the residual graph. Both
labels are those of a node left; where somebody passes, a node is entered with the labels of the node before it.

Along residual arcs neither label ever falls. In an optimal flow no late label is above the early one.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, OUT_I32, OUT_I64, declared, kernel
from trihex.optimum.kernels.flow_byte import arc_in, arc_out, is_start
from trihex.optimum.kernels.residual import BUDGET_SPENT, DONE, LIST_FULL, OFFSET, OTHER, PLACE
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.words import FLOW, WORDS

# Entries of the state.
ARRIVAL = 0  # step of arrival under way
STACKED = 1  # nodes on the stack
STATE_SIZE = 2


class LateSearch(NamedTuple):
    """Labels, and those whose neighbours are still to be labelled."""

    barrier: IN_BOOL  # of each node of a layer
    words: WORDS  # flow of all nodes of all layers, and their early label, as `tolls` leaves them
    late: OUT_I32
    stack: OUT_I64
    state: OUT_I64  # with the entries above


LATE_SEARCH = declared(LateSearch)


@HELPER
def _label(at, search):
    """Label a node that is left, unless it has a label."""
    if search.late[at] == 0:
        search.late[at] = search.state[ARRIVAL]
        search.stack[search.state[STACKED]] = at
        search.state[STACKED] += 1


@HELPER
def _enter(at, node, graph, search):
    """Label what a robot comes to that enters a node."""
    flow = search.words[at] & FLOW
    if node >= graph.first_goal:
        _turn_back_arrivals(at, node, graph, search)
    elif flow == 0:
        _label(at, search)
    elif not is_start(flow):
        _label(at + graph.into[node, arc_in(flow), OFFSET], search)


@HELPER
def _turn_back_arrivals(slot, goal, graph, search):
    """Label the nodes from which robots arrive in a slot."""
    j = 0
    while graph.into[goal, j, OFFSET] != 0:
        before = slot + graph.into[goal, j, OFFSET]
        if before >= 0:
            flow = search.words[before] & FLOW
            if flow and arc_out(flow) == graph.into[goal, j, PLACE]:
                _label(before, search)
        j += 1


@kernel(types.int64(SLOT_GRAPH, LATE_SEARCH, types.int64))
def label_late(graph, search, budget):
    """Label all nodes that a robot can be made to pass, until done, room is needed or the budget is spent."""
    state, size = search.state, len(graph.out)
    while budget > 0:
        budget -= 1
        if state[STACKED] + (size - graph.first_goal + 1) * graph.into.shape[1] > len(search.stack):
            return LIST_FULL
        if state[STACKED] > 0:
            state[STACKED] -= 1
            at = search.stack[state[STACKED]]
            node = at % size
            flow = search.words[at] & FLOW
            taken = arc_out(flow) if flow else -1
            if flow and not is_start(flow):  # who passes is turned back wholly
                _label(at + graph.into[node, arc_in(flow), OFFSET], search)
            i = 0
            while graph.out[node, i, OFFSET] != 0:
                head = at + graph.out[node, i, OFFSET]
                other = graph.out[node, i, OTHER]
                if i != taken and head < len(search.words) and not search.barrier[other]:
                    _enter(head, other, graph, search)
                i += 1
            continue
        if state[ARRIVAL] == 1:
            return DONE
        state[ARRIVAL] -= 1
        for goal in range(graph.first_goal, size):
            _turn_back_arrivals(state[ARRIVAL] * size + goal, goal, graph, search)
    return BUDGET_SPENT
