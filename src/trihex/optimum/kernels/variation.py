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
def count_reached(graph, barrier, closed, start, queue):
    """Count the robots that can arrive if a cell is closed; `queue`: two a node."""
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
            if seen[other] == 0 and other != closed and not barrier[other]:
                seen[other] = 1
                queue[tail] = other
                tail += 1
    count = 0
    for robot in range(len(start)):
        count += seen[start[robot]]
    return count


@HELPER
def _fill_part(node, part, graph, barrier, parts, queue):
    """Mark all free cells that can be reached from one, if it has no mark yet; return whether a destination can."""
    if barrier[node] or parts[node] >= 0:
        return False
    parts[node], queue[0] = part, node
    head, tail, arrives = 0, 1, False
    while head < tail:
        node = queue[head]
        head += 1
        i = 0
        while graph.out[node, i, OFFSET] != 0:
            other = graph.out[node, i, OTHER]
            i += 1
            if barrier[other]:
                continue
            if other >= graph.first_goal:
                arrives = True
            elif parts[other] < 0:
                parts[other] = part
                queue[tail] = other
                tail += 1
    return arrives


@HELPER
def _arrives(node, graph, barrier, parts, cut_off):
    """Tell whether a robot in a barrier could arrive if that were open; `cut_off`: robots of a part, -1: it arrives."""
    i = 0
    while graph.out[node, i, OFFSET] != 0:
        other = graph.out[node, i, OTHER]
        if other >= graph.first_goal:
            if not barrier[other]:
                return True
        elif not barrier[other] and cut_off[parts[other]] < 0:
            return True
        i += 1
    return False


@HELPER
def _count_beside(node, graph, barrier, parts, cut_off):
    """Count the robots that are cut off in the parts beside a barrier, each part once."""
    count, i = 0, 0
    while graph.out[node, i, OFFSET] != 0:
        other = graph.out[node, i, OTHER]
        if other < graph.first_goal and not barrier[other]:
            is_new = True
            for k in range(i):
                before = graph.out[node, k, OTHER]
                if before < graph.first_goal and not barrier[before] and parts[before] == parts[other]:
                    is_new = False
            if is_new:
                count += max(0, cut_off[parts[other]])
        i += 1
    return count


@kernel(types.void(SLOT_GRAPH, IN_BOOL, IN_I64, IN_I64, OUT_I64, OUT_I64, OUT_I64, OUT_I64))
def count_let_in(graph, barrier, opened, start, parts, cut_off, queue, let_in):
    """Write how many robots more can arrive if each of some barriers is opened: those of the parts that it connects."""
    for node in range(len(parts)):
        parts[node], cut_off[node] = -1, 0
    for node in range(graph.first_goal):
        if _fill_part(node, node, graph, barrier, parts, queue):
            cut_off[node] = -1
    for robot in range(len(start)):
        part = parts[start[robot]]
        if cut_off[part] >= 0:
            cut_off[part] += 1
    for k in range(len(opened)):
        let_in[k] = 0
        if _arrives(opened[k], graph, barrier, parts, cut_off):
            let_in[k] = _count_beside(opened[k], graph, barrier, parts, cut_off)
