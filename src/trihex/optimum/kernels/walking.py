"""Walks in depth back along tight arcs, and the paths that are laid along them."""

from trihex.kernels.signatures import HELPER
from trihex.optimum.kernels.flow_byte import START, arc_out, with_arc_in, with_arc_out
from trihex.optimum.kernels.prices import (
    ENTERING,
    LEAVING,
    LISTED,
    MARKED,
    PASSED,
    RISE,
    SEEN,
    WANTED,
    price_of,
    put_word,
    word_of,
)
from trihex.optimum.kernels.residual import OFFSET, OWN, PLACE, REDUCED

# Columns of the stack.
SIDE, TRIED, VIA, NODE = range(4)


@HELPER
def tail(side, node, i, graph, nodes):
    """Return the side at the tail of the i-th residual arc to a side of a node, the place of the arc, and its cost.

    The tail is -1 if there is no such arc, and -2 if there are no more.
    """
    into, at = graph.into, side >> 1
    if side & LEAVING:  # from where its flow goes, back to here
        k = arc_out(nodes.flow[at])
        if i > 0 or k < 0:
            return -2, OWN, 0
        head = at + graph.out[node, k, OFFSET]
        return head * 2 + ENTERING, OWN, -graph.out[node, k, REDUCED]
    if i == into.shape[1]:
        if not nodes.entering[at] & PASSED:
            return -2, OWN, 0
        return at * 2 + LEAVING, OWN, 0
    if i > into.shape[1]:
        return -2, OWN, 0
    before, k = at + into[node, i, OFFSET], into[node, i, PLACE]
    if before == at:
        return -1, OWN, 0
    if not nodes.entering[before] & PASSED:
        return before * 2 + ENTERING, k, into[node, i, REDUCED]
    return -1 if arc_out(nodes.flow[before]) == k else before * 2 + LEAVING, k, into[node, i, REDUCED]


@HELPER
def _see(side, via, depth, graph, nodes, search):
    """Go back to a side."""
    state, stack = search.state, search.stack
    put_word(side, word_of(side, nodes) | SEEN, nodes)
    search.seen[state[MARKED]] = side
    state[MARKED] += 1
    stack[depth, SIDE], stack[depth, TRIED], stack[depth, VIA] = side, 0, via
    stack[depth, NODE] = (side >> 1) % len(graph.out)


@HELPER
def forget(begin, nodes, search):
    """Forget what walks have seen, from the given entry of the list on."""
    for i in range(begin, search.state[MARKED]):
        side = search.seen[i]
        put_word(side, word_of(side, nodes) & ~SEEN, nodes)
    search.state[MARKED] = begin


@HELPER
def _is_end(side, node, among, graph, nodes):
    """Tell whether a walk ends at a side of a node."""
    at = side >> 1
    if among:
        return side & LEAVING and nodes.flow[at] == START << 4  # a robot starts here and goes nowhere yet
    return node >= graph.first_goal and nodes.flow[at] > 0 and nodes.entering[at] & ~(SEEN | WANTED) == 0


@HELPER
def walk_back(side, via, among, graph, nodes, search):
    """Walk back along tight arcs for what may go on by `via`; return how deep it is.

    Among sides that rise (`RISES`) that is a robot without path, among all (0) a destination that costs nothing, where
    somebody arrives who may go elsewhere. The depth is -1 if there is none, -2 if the list of what was seen is full.
    """
    stack, state = search.stack, search.state
    begin = state[MARKED]
    depth = -1
    if begin < len(search.seen) and not word_of(side, nodes) & SEEN:
        depth = 0
        _see(side, via, depth, graph, nodes, search)
    while depth >= 0:
        side = stack[depth, SIDE]
        node = stack[depth, NODE]
        if _is_end(side, node, among, graph, nodes):
            return depth
        if state[MARKED] == len(search.seen):
            break
        other, via, cost = tail(side, node, stack[depth, TRIED], graph, nodes)
        stack[depth, TRIED] += 1
        if other == -2:
            depth -= 1
        elif other >= 0:
            word = word_of(other, nodes)
            if word & (among | SEEN) == among:
                if price_of(word, state[RISE]) == cost + price_of(word_of(side, nodes), state[RISE]):
                    depth += 1
                    _see(other, via, depth, graph, nodes, search)
    if state[MARKED] == len(search.seen):
        forget(begin, nodes, search)
        return -2
    return -1


@HELPER
def lay(depth, last, graph, nodes, search):
    """Lay the path that was walked, to depth `last`: one goes along it, others on where they were turned back."""
    stack, flow = search.stack, nodes.flow
    while depth >= last:
        side, via, node = stack[depth, SIDE], stack[depth, VIA], stack[depth, NODE]
        at = side >> 1
        put_word(side, word_of(side, nodes) & ~SEEN, nodes)
        depth -= 1
        if via == OWN:
            if side & LEAVING:  # nobody passes there any more
                flow[at] = 0
                nodes.entering[at] &= ~PASSED
            continue
        head = at + graph.out[node, via, OFFSET]
        flow[at] = with_arc_out(flow[at], via)
        if head % len(graph.out) < graph.first_goal:
            if flow[head] == 0:
                nodes.leaving[head] = nodes.entering[head] & ~SEEN
                nodes.entering[head] |= PASSED
                search.sides[search.state[LISTED]] = head * 2 + LEAVING
                search.state[LISTED] += 1
            flow[head] = with_arc_in(flow[head], graph.out[node, via, PLACE])


@HELPER
def arrive(head, graph, nodes):
    """Note that a robot has come to where it was wanted."""
    if head % len(graph.out) >= graph.first_goal:
        nodes.flow[head] += 1
        if nodes.flow[head] < graph.capacity:
            return
    nodes.entering[head] &= ~WANTED
