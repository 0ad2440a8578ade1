"""An optimal flow with one cell opened or closed, as `earliest` goes on from it."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, IN_I64, OUT_I32, OUT_I64, declared, kernel
from trihex.optimum.kernels.flow_byte import arc_in, arc_out
from trihex.optimum.kernels.opening import WORDS_IN, entered
from trihex.optimum.kernels.residual import OFFSET, OTHER
from trihex.optimum.kernels.slot_paths import PARKED
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.tolls import WHEN
from trihex.optimum.kernels.words import DEAD, FLOW, LABEL, SETTLED, WORDS


class Optimum(NamedTuple):
    """The optimal flow that is varied."""

    barrier: IN_BOOL  # of each node of a layer
    words: WORDS_IN  # flow and early labels
    due: IN_I32  # in which step the robot arrives that passes each node of each layer
    late: IN_I32  # late labels, raised where a cell was opened


OPTIMUM = declared(Optimum)


@kernel(types.void(SLOT_GRAPH, IN_I64, WORDS, OUT_I32))
def write_dues(graph, start, words, due):
    """Write when whoever passes a node arrives."""
    size = len(graph.out)
    for robot in range(len(start)):
        at = start[robot]
        node = at % size
        while node < graph.first_goal:
            i = arc_out(words[at] & FLOW)
            at, node = at + graph.out[node, i, OFFSET], graph.out[node, i, OTHER]
        step = at // size
        at = start[robot]
        node = at % size
        while node < graph.first_goal:
            due[at] = step
            i = arc_out(words[at] & FLOW)
            at, node = at + graph.out[node, i, OFFSET], graph.out[node, i, OTHER]


@HELPER
def _is_dead(at, node, step, raised, graph, optimum):
    """Tell whether a further robot could arrive before a step if it entered a node, or no later robot comes there."""
    at = entered(at, node, graph, optimum.words)
    if at < 0:
        return False
    word = optimum.words[at]
    if raised and node < graph.first_goal and optimum.late[at] <= step:
        return True
    return word >= WHEN and word // WHEN - 1 < step


@kernel(types.void(SLOT_GRAPH, OPTIMUM, types.int64, types.int64, WORDS))
def begin_at_step(graph, optimum, opened, step, words):
    """Write the words for slots from a step on: what arrives before is settled, what leads there is dead."""
    size = len(graph.out)
    filled = len(optimum.words)
    for row in range(len(words) // size):
        for node in range(size):
            at = row * size + node
            flow = optimum.words[at] & FLOW if at < filled else 0
            word = flow
            if node < graph.first_goal and flow and optimum.due[at] < step:
                word |= SETTLED
            is_dead = optimum.barrier[node] or (row == 0 and flow == 0)
            if node == opened:
                is_dead = row == 0
            elif not is_dead and at < filled:
                is_dead = _is_dead(at, node, step, opened >= 0, graph, optimum)
            if is_dead:
                word |= DEAD * LABEL
            words[at] = word


@HELPER
def _clear_from(at, node, graph, words):
    """Take a path away from a node on."""
    while node < graph.first_goal:
        i = arc_out(words[at] & FLOW)
        words[at] &= ~FLOW
        at, node = at + graph.out[node, i, OFFSET], graph.out[node, i, OTHER]
    words[at] -= 1


@kernel(types.void(SLOT_GRAPH, types.int64, WORDS))
def close_node(graph, node, words):
    """Close a cell, in which nobody starts: who passes there waits before it for a new way."""
    size = len(graph.out)
    for row in range(len(words) // size):
        at = row * size + node
        flow = words[at] & FLOW
        if flow:
            before = at + graph.into[node, arc_in(flow), OFFSET]
            _clear_from(at, node, graph, words)
            words[before] = (words[before] & ~15) | (PARKED + 1)
        words[at] = DEAD * LABEL


@kernel(types.int64(SLOT_GRAPH, IN_BOOL, types.int64, IN_I64, OUT_I64))
def count_reached(graph, barrier, changed, start, queue):
    """Count the robots that can arrive if a cell is opened that was a barrier, or closed; `queue`: two a node."""
    size = len(graph.out)
    seen = queue[size:]
    seen[:] = 0
    tail = 0
    for goal in range(graph.first_goal, size - 1):
        seen[goal] = 1
        queue[tail] = goal
        tail += 1
    head = 0
    while head < tail:
        node = queue[head]
        head += 1
        j = 0
        while graph.into[node, j, OFFSET] != 0:
            other = graph.into[node, j, OTHER]
            j += 1
            if seen[other] == 0 and barrier[other] == (other == changed):
                seen[other] = 1
                queue[tail] = other
                tail += 1
    count = 0
    for robot in range(len(start)):
        count += seen[start[robot]]
    return count
