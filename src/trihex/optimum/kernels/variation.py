"""An optimal flow with one cell opened or closed, as `earliest` goes on from it."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, IN_I64, OUT_I32, OUT_I64, declared, kernel
from trihex.optimum.kernels.flow_byte import arc_in, arc_out
from trihex.optimum.kernels.opening import LOGGED, OPENINGS, WORDS_IN, entered
from trihex.optimum.kernels.residual import OFFSET, OTHER
from trihex.optimum.kernels.slot_paths import PARKED
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.tolls import WHEN
from trihex.optimum.kernels.words import DEAD, FLOW, LABEL, SETTLED, WORDS

# A step that never comes.
NEVER = (1 << 31) - 1
_BURIED = DEAD * LABEL


class Optimum(NamedTuple):
    """The optimal flow that is varied."""

    words: WORDS_IN  # flow and early labels
    due: IN_I32  # in which step the robot arrives that passes each node of each layer, or `NEVER`
    dead_early: IN_I32  # from which slots on no search is to come to a node: sooner ones would have been filled from it
    dead_late: IN_I32  # the same where later robots than those now do not come either, however they are turned back


OPTIMUM = declared(Optimum)


@kernel(types.boolean(WORDS_IN, IN_I32, types.int64))
def is_best(words, late, last):
    """Tell whether no robot could arrive sooner, by the labels: none could be made to pass where a slot is sooner."""
    for at in range(len(words)):
        early = last if words[at] < WHEN else words[at] // WHEN - 1
        if late[at] > early:
            return False
    return True


@kernel(types.void(SLOT_GRAPH, IN_I64, WORDS, OUT_I32))
def write_dues(graph, start, words, due):
    """Write when whoever passes a node arrives."""
    size = len(graph.out)
    for at in range(len(due)):
        due[at] = NEVER
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


@kernel(types.void(SLOT_GRAPH, IN_BOOL, WORDS_IN, IN_I32, OUT_I32, OUT_I32))
def write_deaths(graph, barrier, words, late, dead_early, dead_late):
    """Write from which slots on nobody is to be sought at each node: see `Optimum`."""
    size = len(graph.out)
    for row in range(len(words) // size):
        for node in range(size):
            at = row * size + node
            dead_early[at] = dead_late[at] = NEVER
            if barrier[node] or (row == 0 and words[at] & FLOW == 0):
                dead_early[at] = dead_late[at] = 0
                continue
            before = entered(at, node, graph, words)
            if before < 0:
                continue
            if words[before] >= WHEN:
                dead_early[at] = words[before] // WHEN
            dead_late[at] = min(late[before], dead_early[at]) if node < graph.first_goal else dead_early[at]


@kernel(types.void(OPTIMUM, IN_I32, types.int32, WORDS))
def begin_at_step(optimum, dead, step, words):
    """Write the words for slots from a step on: what arrives before is settled, what leads there is dead."""
    for at in range(len(optimum.words)):
        word = optimum.words[at] & np.uint32(FLOW)
        if optimum.due[at] < step:
            word |= np.uint32(SETTLED)
        if dead[at] <= step:
            word |= np.uint32(_BURIED)
        words[at] = word


@kernel(types.void(SLOT_GRAPH, types.int64, WORDS))
def open_node(graph, node, words):
    """Let a node be entered that was a barrier."""
    size = len(graph.out)
    for row in range(1, len(words) // size):
        words[row * size + node] &= ~_BURIED


@kernel(types.void(SLOT_GRAPH, OPENINGS, types.int64, WORDS))
def revive_raised(graph, openings, step, words):
    """Let nodes be entered to which an opened cell brings robots later than a step: after `begin_at_step`."""
    size = len(graph.out)
    for entry in range(openings.state[LOGGED]):
        at = np.int64(openings.raised[entry])
        if openings.late[at] > step:
            flow = openings.words[at] & FLOW
            if flow:  # the node after it is entered with its label
                node = at % size
                i = arc_out(flow)
                if graph.out[node, i, OTHER] >= graph.first_goal:
                    continue
                at += graph.out[node, i, OFFSET]
            words[at] &= ~_BURIED


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
