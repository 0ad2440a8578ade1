"""Which cells help if they are opened, by the labels of an optimal flow.

Whoever gets through an opened cell, in it after step t, comes there no later than its *late* label says and arrives no
sooner than its *early* label says, both found from those of its neighbours. The arrivals by step s become more just if
for some t the early label is at most s and the late one above it. For a way that comes back to the cell sooner than it
left (others are turned back in between) the late labels are *raised* by what comes out of the cell; that is seldom any.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I64, OUT_I32, OUT_I64, OUT_U32, declared, kernel
from trihex.optimum.kernels.flow_byte import arc_in, arc_out, is_start
from trihex.optimum.kernels.residual import OFFSET, OTHER, PLACE
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.tolls import WHEN
from trihex.optimum.kernels.words import FLOW

WORDS_IN = types.Array(types.uint32, 1, "C", readonly=True)

# Entries of the state.
LOGGED = 0  # labels that were raised
CELL = 1  # place of the cell under way
FIRST = 2  # first step by which more arrive if it is opened
END = 3  # first step after it by which no more do
STATE_SIZE = 4


class Openings(NamedTuple):
    """Labels, and what is found of the cell that is opened."""

    node: IN_I64  # nodes of all cells that may be opened
    barrier: IN_BOOL  # of each node of a layer
    words: WORDS_IN  # flow and early labels of all nodes of all layers
    last: types.int64  # last step of arrival
    late: OUT_I32  # late labels
    early: OUT_I32  # early label of the cell in each step
    raised: OUT_U32  # nodes whose late labels were raised
    before: OUT_I32  # what they were before
    state: OUT_I64  # with the entries above


OPENINGS = declared(Openings)


@HELPER
def early_of(at, openings):
    """Return the early label of a node that is left."""
    word = openings.words[at]
    return openings.last if word < WHEN else min(word // WHEN - 1, openings.last)


@HELPER
def entered(at, node, graph, words):
    """Return the node that has the labels of a node that is entered, -1 if a robot starts there."""
    flow = words[at] & FLOW
    if node < graph.first_goal and flow:
        if is_start(flow):
            return -1
        return at + graph.into[node, arc_in(flow), OFFSET]
    return at


@HELPER
def _fill_early(node, graph, openings):
    """Find when a robot could arrive that is in the opened cell after each step."""
    size, least = len(graph.out), openings.last
    for step in range(openings.last - 1, 0, -1):
        i = 0
        while graph.out[node, i, OFFSET] != 0:
            other = graph.out[node, i, OTHER]
            if not openings.barrier[other]:
                at = entered((step + 1) * size + other, other, graph, openings.words)
                if at >= 0:
                    least = min(least, early_of(at, openings))
            i += 1
        openings.early[step] = least


@HELPER
def _raise(at, label, openings):
    """Raise the late label of a node that is left."""
    if openings.late[at] < label:
        entry = openings.state[LOGGED]
        openings.raised[entry], openings.before[entry] = at, openings.late[at]
        openings.late[at] = label
        openings.state[LOGGED] = entry + 1


@HELPER
def _gains(node, step, graph, openings):
    """Tell whether anybody beside the opened cell could arrive sooner by it."""
    j = 0
    while graph.into[node, j, OFFSET] != 0:
        before = (step - 1) * len(graph.out) + graph.into[node, j, OTHER]
        if openings.late[before] > 0 and early_of(before, openings) > openings.early[step]:
            return True
        j += 1
    return False


@HELPER
def _takes_later(node, step, graph, openings):
    """Tell whether the opened cell brings later robots to any place than came there before."""
    size, i = len(graph.out), 0
    late = openings.late[step * size + node]
    while graph.out[node, i, OFFSET] != 0:
        other = graph.out[node, i, OTHER]
        if not openings.barrier[other]:
            at = entered((step + 1) * size + other, other, graph, openings.words)
            if other >= graph.first_goal or (at >= 0 and late > openings.late[at]):
                return True
        i += 1
    return False


@HELPER
def _fill_late(node, graph, openings):
    """Raise the late labels of the opened cell itself; return whether that may do anything."""
    size, late = len(graph.out), 0
    helps = gains = takes = False
    for step in range(1, openings.last):
        j = 0
        while graph.into[node, j, OFFSET] != 0:
            other = graph.into[node, j, OTHER]
            if not openings.barrier[other]:
                late = max(late, openings.late[(step - 1) * size + other])
            j += 1
        _raise(step * size + node, late, openings)
        helps = helps or late > openings.early[step]
        gains = gains or _gains(node, step, graph, openings)
        takes = takes or _takes_later(node, step, graph, openings)
    return helps or (gains and takes and late > openings.early[1])


@HELPER
def _bound(node, graph, openings):
    """Return the early label above which no way leads to the opened cell again, or to a slot that is sooner."""
    size, most = len(graph.out), 0
    for step in range(1, openings.last):
        most = max(most, openings.late[step * size + node] - 1)
        j = 0
        while graph.into[node, j, OFFSET] != 0:
            other = graph.into[node, j, OTHER]
            if not openings.barrier[other]:
                most = max(most, early_of((step - 1) * size + other, openings))
            j += 1
    return most


@HELPER
def _raise_entered(at, node, label, bound, graph, openings):
    """Raise what a robot comes to that enters a node."""
    if node >= graph.first_goal:
        j = 0
        while graph.into[node, j, OFFSET] != 0:
            before = at + graph.into[node, j, OFFSET]
            flow = openings.words[before] & FLOW
            if flow and arc_out(flow) == graph.into[node, j, PLACE]:
                _raise(before, label, openings)
            j += 1
        return
    at = entered(at, node, graph, openings.words)
    if at >= 0 and (openings.barrier[node] or early_of(at, openings) <= bound):
        _raise(at, label, openings)


@HELPER
def _raise_on(at, opened, bound, graph, openings):
    """Raise the late labels of all that a robot comes to next that leaves a node."""
    size = len(graph.out)
    node, label = at % size, openings.late[at]
    flow = openings.words[at] & FLOW
    taken = -1
    if flow:
        taken = arc_out(flow)
        if not is_start(flow):
            _raise(at + graph.into[node, arc_in(flow), OFFSET], label, openings)
    if at // size >= openings.last:
        return
    i = 0
    while graph.out[node, i, OFFSET] != 0:
        other = graph.out[node, i, OTHER]
        if i != taken and (other == opened or not openings.barrier[other]):
            _raise_entered(at + graph.out[node, i, OFFSET], other, label, bound, graph, openings)
        i += 1


@HELPER
def _raise_all(node, graph, openings):
    """Raise all late labels that become later when a cell is opened, the latest first."""
    size, state = len(graph.out), openings.state
    bound = _bound(node, graph, openings)
    done = state[LOGGED]
    for step in range(openings.last - 1, 0, -1):
        _raise_on(step * size + node, node, bound, graph, openings)
        while done < state[LOGGED]:
            at = openings.raised[done]
            done += 1
            _raise_on(at, node, bound, graph, openings)


@HELPER
def _find_steps(node, graph, openings):
    """Find the first and the last step by which more arrive; return whether there is any."""
    size, state = len(graph.out), openings.state
    state[FIRST], state[END] = openings.last, 0
    for step in range(1, openings.last):
        late = openings.late[step * size + node]
        if late > openings.early[step]:
            state[FIRST] = min(state[FIRST], openings.early[step])
            state[END] = max(state[END], late)
    return state[END] > 0


@HELPER
def _restore(openings):
    """Let all late labels be as they were."""
    for entry in range(openings.state[LOGGED] - 1, -1, -1):
        openings.late[openings.raised[entry]] = openings.before[entry]
    openings.state[LOGGED] = 0


@kernel(types.void(OPENINGS))
def restore_labels(openings):
    """Let all late labels be as they were before the last cell was opened."""
    _restore(openings)


@kernel(types.boolean(SLOT_GRAPH, OPENINGS, types.int64))
def find_opening(graph, openings, cells):
    """Go on, some `cells` far, to the next which it helps to open; then its late labels are left raised."""
    state = openings.state
    _restore(openings)
    while cells > 0 and state[CELL] < len(openings.node):
        cells -= 1
        node = openings.node[state[CELL]]
        state[CELL] += 1
        _fill_early(node, graph, openings)
        if _fill_late(node, graph, openings):
            _raise_all(node, graph, openings)
            if _find_steps(node, graph, openings):
                return True
        _restore(openings)
    return False


@kernel(types.void(SLOT_GRAPH, OPENINGS, IN_I64, OUT_I32, OUT_I64))
def bound_steps_gained(graph, openings, arrived, ways, bounds):
    """Write how many steps are gained at least and at most if the cell under way is opened; `arrived` after each step.

    By each step in which there is any way one more arrives. No more do than there are ways, one for each step in which
    somebody is in the cell, nor than robots that are later, nor than before and slots that are open.
    """
    size, last = len(graph.out), openings.last
    node = openings.node[openings.state[CELL] - 1]
    for step in range(last + 1):
        ways[step] = 0
    for step in range(1, last):
        for by in range(openings.early[step], openings.late[step * size + node]):
            ways[by] += 1
    room, more = 0, 0
    for goal in range(len(graph.room)):
        room += graph.room[goal]
    bounds[0] = bounds[1] = 0
    for step in range(1, last + 1):
        slots = room - (arrived[step] - arrived[step - 1])
        more = min(ways[step], more + slots, arrived[last] - arrived[step])
        bounds[0] += ways[step] > 0
        bounds[1] += more
