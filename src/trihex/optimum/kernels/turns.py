"""Turns: the labels of all nodes found anew at once, as exact as they can be.

The label of a node is the least number of flows that a path from a late one to it turns back. Searches learn it little
by little: where late robots are fewer than open slots, the labels of all that lies between rise one by one, up to
`DEAD`. Here they are found in one sweep forward from all late paths, in order of turns, and what is not reached is dead
for ever (global relabelling, as Goldberg and Tarjan, 1988, do where flow is pushed).

Layers far beyond the step under way are left out: flow that is turned back from there would arrive there, and is late.
Late paths count as if they were not there. The nodes of one are free as soon as it is given up, so they are as near as
what it leads to; without that what is dead would come to life again.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, OUT_I64, declared, kernel
from trihex.optimum.kernels.flow_byte import START, arc_in, arc_out
from trihex.optimum.kernels.residual import BUDGET_SPENT, DONE, LIST_FULL, OFFSET, OTHER, PLACE
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.words import DEAD, FLOW, LABEL, SEEN, SETTLED, WORDS, label_of, seen_of

# Entries of the state.
ROW = 0  # row under way: first late paths are looked for in all, then labels are cleaned in all, the last first
ROWS = 1  # so many are labelled
LEVEL = 2  # flows turned back to what is labelled now
STACKED = 3  # nodes on the stack
WAITING = 4  # nodes in the queue
TURNED = 5  # nodes of the queue that are done with
LABELLED = 6  # nodes that got a label
STATE_SIZE = 7


class Turning(NamedTuple):
    """The nodes, and those whose neighbours are still to be labelled."""

    words: WORDS  # of all nodes of all layers, no search under way
    stack: OUT_I64  # nodes without flow, of the level under way
    queue: OUT_I64  # nodes with flow that is to be turned back, in ascending order of level
    state: OUT_I64  # with the entries above


TURNING = declared(Turning)


@HELPER
def _label(at, node, graph, turning):
    """Label a node that is entered, unless it is dead or has a label; note where it leads."""
    words, state = turning.words, turning.state
    if at >= state[ROWS] * len(graph.out):
        return
    word = words[at]
    if seen_of(word) or label_of(word) == DEAD:
        return
    words[at] = (word & ~(DEAD * LABEL)) | min(state[LEVEL], DEAD - 1) * LABEL | SEEN
    state[LABELLED] += 1
    if word & FLOW == 0:
        turning.stack[state[STACKED]] = at
        state[STACKED] += 1
    elif node >= graph.first_goal or word & SETTLED:
        turning.queue[state[WAITING]] = at
        state[WAITING] += 1


@HELPER
def _leave(at, node, graph, turning):
    """Label all nodes that may be entered from that one, but for the one whither flow goes that stays."""
    word = turning.words[at]
    taken = arc_out(word & FLOW) if word & SETTLED else -1
    i = 0
    while graph.out[node, i, OFFSET] != 0:
        if i != taken:
            _label(at + graph.out[node, i, OFFSET], graph.out[node, i, OTHER], graph, turning)
        i += 1


@HELPER
def _turn_back(at, node, graph, turning):
    """Label what is reached by whoever enters a node and turns back those who pass."""
    words, into = turning.words, graph.into
    if node < graph.first_goal:
        j = arc_in(words[at] & FLOW)
        if j != START - 1:
            before, tail = at + into[node, j, OFFSET], into[node, j, OTHER]
            _leave(before, tail, graph, turning)
            _label(before, tail, graph, turning)
        return
    j = 0
    while into[node, j, OFFSET] != 0:
        before, tail = at + into[node, j, OFFSET], into[node, j, OTHER]
        if before >= 0 and words[before] & FLOW and arc_out(words[before] & FLOW) == into[node, j, PLACE]:
            _leave(before, tail, graph, turning)
            _label(before, tail, graph, turning)
        j += 1


@HELPER
def _begin_row(graph, turning):
    """Label what late paths in a row lead to, their own next nodes, too: those are free once the path is given up."""
    words, size = turning.words, len(graph.out)
    at = turning.state[ROW] * size
    for node in range(graph.first_goal):
        word = words[at + node]
        if word & FLOW and not word & SETTLED:
            _leave(at + node, node, graph, turning)
    turning.state[ROW] += 1


@HELPER
def _clean_row(graph, turning):
    """Mark dead what was not reached in a row."""
    words, size = turning.words, len(graph.out)
    turning.state[ROW] -= 1
    first = turning.state[ROW] * size
    for at in range(first, first + size):
        word = words[at]
        words[at] = word & ~(DEAD * SEEN) if seen_of(word) else word | DEAD * LABEL


@kernel(types.int64(SLOT_GRAPH, TURNING, types.int64))
def find_turns(graph, turning, budget):
    """Label all nodes, until done, room is needed or some `budget` nodes were looked at."""
    state, size = turning.state, len(graph.out)
    room = size * graph.out.shape[1]  # neither a row nor all who arrive in a slot add more
    while budget > 0:
        if state[STACKED] + room > len(turning.stack) or state[WAITING] + room > len(turning.queue):
            return LIST_FULL
        if state[STACKED] > 0:
            budget -= 1
            state[STACKED] -= 1
            at = turning.stack[state[STACKED]]
            _leave(at, at % size, graph, turning)
        elif state[LEVEL] == 0 and state[ROW] < state[ROWS]:
            budget -= size
            _begin_row(graph, turning)
        elif state[TURNED] < state[WAITING]:
            budget -= 1
            at = turning.queue[state[TURNED]]
            state[TURNED] += 1
            state[LEVEL] = label_of(turning.words[at]) + 1
            _turn_back(at, at % size, graph, turning)
        elif state[ROW] > 0:
            budget -= size
            state[LEVEL] = DEAD
            _clean_row(graph, turning)
        else:
            return DONE
    return BUDGET_SPENT
