"""Robots go to the arrivals that they have in the queues at the destinations, as far as nobody is in the way.

At prices by which the queues were shared out their paths are tight. Whoever has time to spare waits at his start until
he comes just in time, and then goes the way on which a step that is lost costs less than waiting. So robots are in
different layers, and hardly ever meet.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I64, OUT_BOOL, OUT_I64, declared, kernel
from trihex.optimum.kernels.flow_byte import with_arc_in, with_arc_out
from trihex.optimum.kernels.prices import (
    BITS,
    GRAPH,
    IS_EAGER,
    LEAVING,
    MARKED,
    NODES,
    PASSED,
    SEARCH,
    SEEN,
    SERVED,
    TOTAL,
    WANTED,
    word_of,
)
from trihex.optimum.kernels.residual import NONE, OFFSET, PLACE, REDUCED
from trihex.optimum.kernels.serving import begin_anew
from trihex.optimum.kernels.walking import arrive, forget

# Columns of the stack.
AT, TRIED, VIA = range(3)
# A key holds a cost, times this, and layers.
LAYERS = 1 << 20
FAR = 1 << 60
# So many robots that are left go as soon as they can; for each what rises is found anew.
FEW = 16


class Queue(NamedTuple):
    """Who is to arrive where and when."""

    goal: IN_I64  # index of the destination, in the layer in which each robot is to arrive, or NONE
    base: types.int64  # what robots pay at least for a step
    patience: types.int64  # how many nodes are looked at for a robot; fewer than the stack has room for
    rest: OUT_I64  # scratch, for each node: on how many layers the way leads of those who have time to spare
    key: OUT_I64  # scratch: what that costs
    waiting: OUT_I64  # scratch
    is_waiting: OUT_BOOL  # scratch, False


QUEUE = declared(Queue)


@HELPER
def _come_before(node, first, last, queue, graph):
    """Let nodes before one lead on to it where that costs less; return where the list of those under way ends."""
    into, size, key = graph.into, len(graph.out), queue.key
    for k in range(into.shape[1]):
        offset = into[node, k, OFFSET]
        if offset == 0:
            break
        before = (node + offset) % size
        layers = (before - node - offset) // size
        cost = key[node] + (into[node, k, REDUCED] - queue.base * layers) * LAYERS + layers
        if cost < key[before]:
            key[before] = cost
            if not queue.is_waiting[before]:
                queue.is_waiting[before] = True
                queue.waiting[last % size] = before
                last += 1
    return last


@HELPER
def _find_rest(queue, graph):
    """Find on how many layers ways lead that cost least, where a layer later saves what a step costs at least."""
    size, first, last = len(graph.out), 0, 0
    queue.key[:] = FAR
    for goal in range(graph.first_goal, size):
        queue.key[goal] = 0
        queue.waiting[last] = goal
        last += 1
    while first < last:
        node = queue.waiting[first % size]
        first += 1
        queue.is_waiting[node] = False
        last = _come_before(node, first, last, queue, graph)
    for node in range(size):
        queue.rest[node] = queue.key[node] % LAYERS


@HELPER
def _place(node, tried, hurries, graph):
    """Return the place of the arc that is tried next, NONE where there is none.

    Who has time to spare waits, or goes on as cheaply as he can; who hurries loses what time there is at first.
    """
    arcs = graph.out.shape[1]
    k = tried if hurries else arcs - tried
    if tried == 0 and not hurries:
        k = 0
        while k < arcs and graph.out[node, k, OFFSET] != len(graph.out):
            k += 1
    return k if k < arcs and graph.out[node, k, OFFSET] != 0 else NONE


@HELPER
def _leads_on(head, price, goal, hurries, queue, graph, nodes):
    """Tell whether a path to a goal may go on to a node for a price."""
    size = len(graph.out)
    layers = goal // size - head // size
    if layers < 0 or head >= len(nodes.flow) or nodes.entering[head] >> BITS != price:
        return False
    if head % size >= graph.first_goal:
        return head == goal and nodes.entering[head] & WANTED != 0
    return nodes.flow[head] == 0 and not nodes.entering[head] & SEEN and (hurries or layers >= queue.rest[head % size])


@HELPER
def _walk(start, goal, queue, graph, nodes, search):
    """Walk to a goal along tight arcs where nobody is; return how deep it is, NONE if there is no way."""
    stack, state, depth, size = search.stack, search.state, 0, len(graph.out)
    hurries = goal // size - start // size < queue.rest[start % size]
    stack[0, AT], stack[0, TRIED] = start, 0
    while depth >= 0 and state[MARKED] < queue.patience:
        at, tried = stack[depth, AT], stack[depth, TRIED]
        node = at % size
        if tried > graph.out.shape[1]:
            depth -= 1
            continue
        stack[depth, TRIED] += 1
        k = _place(node, tried, hurries, graph)
        if k == NONE:
            continue
        head = at + graph.out[node, k, OFFSET]
        price = (word_of(at * 2 + (LEAVING if depth == 0 else 0), nodes) >> BITS) - graph.out[node, k, REDUCED]
        if _leads_on(head, price, goal, hurries, queue, graph, nodes):
            stack[depth, VIA] = k
            if head == goal:
                return depth
            depth += 1
            stack[depth, AT], stack[depth, TRIED] = head, 0
            nodes.entering[head] |= SEEN
            search.seen[state[MARKED]] = head * 2
            state[MARKED] += 1
    return NONE


@HELPER
def _lay(depth, graph, nodes, search):
    """Lay the path that was walked."""
    stack, flow = search.stack, nodes.flow
    for i in range(depth + 1):
        at, k = stack[i, AT], stack[i, VIA]
        flow[at] = with_arc_out(flow[at], k)
        if i < depth:
            head = stack[i + 1, AT]
            flow[head] = with_arc_in(flow[head], graph.out[at % len(graph.out), k, PLACE])
            nodes.leaving[head] = nodes.entering[head] & ~SEEN
            nodes.entering[head] |= PASSED


@kernel(types.void(QUEUE, GRAPH, NODES, SEARCH))
def go_to_goals(queue, graph, nodes, search):
    """Let robots go to their goals, those of the greatest value first, before any price has risen."""
    state = search.state
    _find_rest(queue, graph)
    for robot in range(len(queue.goal) - 1, -1, -1):
        start, goal = search.start[robot], queue.goal[robot]
        if goal == NONE:
            continue
        depth = _walk(start, goal, queue, graph, nodes, search)
        if depth != NONE:
            state[TOTAL] += (nodes.leaving[start] >> BITS) - (nodes.entering[goal] >> BITS)
            state[SERVED] += 1
            _lay(depth, graph, nodes, search)
            arrive(goal, graph, nodes)
        forget(0, nodes, search)
    state[IS_EAGER] = len(queue.goal) - state[SERVED] <= FEW
    begin_anew(nodes, search)
