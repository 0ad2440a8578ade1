"""Robots get their paths: prices rise where robots without path are, until one of them can go where it is wanted.

The Hungarian method on layers of steps, all robots at once. From an arc to a wanted side that has become tight a walk
goes back along tight arcs for a robot without path, which then goes there. What such walks saw in vain stays seen. When
all tight arcs have been tried and one of them was in vain, some of what rises could only be reached by robots that have
their paths by now, and what rises is found anew.
"""

from numba import types

from trihex.kernels.signatures import APART, HELPER, kernel
from trihex.optimum.kernels.flow_byte import START, arc_out, with_arc_in, with_arc_out
from trihex.optimum.kernels.prices import (
    ARCS,
    ARRIVALS,
    BEFORE,
    BITS,
    ENTERING,
    FILED,
    FREE,
    GRAPH,
    LEAVING,
    LISTED,
    MARKED,
    NEXT,
    NODES,
    RISE,
    RISES,
    SEARCH,
    SEEN,
    SERVED,
    TOTAL,
    UNTIL,
    VAIN,
    WANTED,
    price_of,
    put_word,
    word_of,
)
from trihex.optimum.kernels.raising import begin_to_rise, raise_prices, reach, reach_from
from trihex.optimum.kernels.residual import (
    BUDGET_SPENT,
    DONE,
    LAYERS_FULL,
    LIST_FULL,
    NONE,
    OFFSET,
    OTHER,
    OWN,
    PLACE,
    REDUCED,
    SPARE_ROWS,
)

# Columns of the stack.
SIDE, TRIED, VIA = range(3)


@HELPER
def _tail(side, i, graph, nodes):
    """Return the side at the tail of the i-th residual arc to a side, the place of the arc, and its cost.

    The tail is -1 if there is no such arc, and -2 if there are no more.
    """
    into, at = graph.into, side >> 1
    node = at % len(graph.out)
    flow = nodes.flow[at]
    if side & LEAVING:  # from where its flow goes, back to here
        k = arc_out(flow)
        if i > 0 or k < 0:
            return -2, OWN, 0
        head = at + graph.out[node, k, OFFSET]
        if nodes.entering[head] & WANTED:
            return -2, OWN, 0
        return head * 2 + ENTERING, OWN, -graph.out[node, k, REDUCED]
    if i == into.shape[1]:
        if flow == 0 or node >= graph.first_goal:
            return -2, OWN, 0
        return at * 2 + LEAVING, OWN, 0
    if i > into.shape[1]:
        return -2, OWN, 0
    before, k = at + into[node, i, OFFSET], into[node, i, PLACE]
    if before == at or arc_out(nodes.flow[before]) == k:
        return -1, OWN, 0
    return before * 2 + (LEAVING if nodes.flow[before] != 0 else ENTERING), k, into[node, i, REDUCED]


@HELPER
def _see(side, via, depth, nodes, search):
    """Go back to a side."""
    state = search.state
    put_word(side, word_of(side, nodes) | SEEN, nodes)
    search.seen[state[MARKED]] = side
    state[MARKED] += 1
    search.stack[depth, SIDE], search.stack[depth, TRIED], search.stack[depth, VIA] = side, 0, via


@HELPER
def _forget(begin, nodes, search):
    """Forget what walks have seen, from the given entry of the list on."""
    for i in range(begin, search.state[MARKED]):
        side = search.seen[i]
        put_word(side, word_of(side, nodes) & ~SEEN, nodes)
    search.state[MARKED] = begin


@HELPER
def _walk_back(side, via, graph, nodes, search):
    """Walk back from the tail of an arc to a wanted side for a robot without path; return how deep it is.

    The depth is -1 if there is none, -2 if the list of what was seen is full.
    """
    stack, state, flow = search.stack, search.state, nodes.flow
    begin = state[MARKED]
    depth = -1
    if begin < len(search.seen) and not word_of(side, nodes) & SEEN:
        depth = 0
        _see(side, via, depth, nodes, search)
    while depth >= 0:
        side = stack[depth, SIDE]
        if flow[side >> 1] == START << 4 and side & LEAVING:  # starts here and goes nowhere yet
            return depth
        if state[MARKED] == len(search.seen):
            break
        tail, via, cost = _tail(side, stack[depth, TRIED], graph, nodes)
        stack[depth, TRIED] += 1
        if tail == -2:
            depth -= 1
        elif tail >= 0:
            word = word_of(tail, nodes)
            if word & (RISES | SEEN) == RISES:
                if price_of(word, state[RISE]) == cost + price_of(word_of(side, nodes), state[RISE]):
                    depth += 1
                    _see(tail, via, depth, nodes, search)
    if state[MARKED] == len(search.seen):
        _forget(begin, nodes, search)
        return -2
    return -1


@HELPER
def _lay(depth, graph, nodes, search):
    """Lay the path that was walked: a robot goes along it, and others on where it turned them back."""
    stack, flow = search.stack, nodes.flow
    while depth >= 0:
        side, via = stack[depth, SIDE], stack[depth, VIA]
        at = side >> 1
        node = at % len(graph.out)
        put_word(side, word_of(side, nodes) & ~SEEN, nodes)
        depth -= 1
        if via == OWN:
            if side & LEAVING:  # nobody passes there any more
                flow[at] = 0
            continue
        head = at + graph.out[node, via, OFFSET]
        flow[at] = with_arc_out(flow[at], via)
        if graph.out[node, via, OTHER] >= graph.first_goal:
            if depth < 0:
                flow[head] += 1
                if flow[head] >= graph.capacity:
                    nodes.entering[head] &= ~WANTED
        else:
            if flow[head] == 0:
                nodes.leaving[head] = nodes.entering[head] & ~SEEN
                search.sides[search.state[LISTED]] = head * 2 + LEAVING
                search.state[LISTED] += 1
            flow[head] = with_arc_in(flow[head], graph.out[node, via, PLACE])


@HELPER
def _try_again(nodes, search):
    """Forget what walks have seen, and list again the arrivals for which they were in vain."""
    state = search.state
    _forget(0, nodes, search)
    for i in range(state[VAIN]):
        search.arrivals[i] = search.vain[i]
    state[ARRIVALS], state[VAIN], state[BEFORE] = state[VAIN], 0, state[SERVED]


@APART
def _begin_anew(nodes, search):
    """Let rise no longer what no robot without path may come to any more: all but where these robots are."""
    state = search.state
    _forget(0, nodes, search)
    for i in range(state[LISTED]):
        side = search.sides[i]
        word = word_of(side, nodes)
        put_word(side, (price_of(word, state[RISE]) << BITS) | (word & WANTED), nodes)
    search.heads[:] = NONE
    state[FREE] = NONE
    state[NEXT] = state[LISTED] = state[FILED] = state[ARRIVALS] = state[VAIN] = 0
    state[BEFORE] = state[SERVED]
    state[UNTIL] = state[RISE] + len(search.heads) - 1
    for start in search.start:
        if nodes.flow[start] == START << 4:
            begin_to_rise(start * 2 + LEAVING, nodes, search)


@HELPER
def _serve(arrival, graph, nodes, search):
    """Let a robot go to a wanted side by a tight arc, if one can and the arc is still to be had; False if a list is full.
    """
    state, flow = search.state, nodes.flow
    at, place = arrival // ARCS, arrival % ARCS
    node = at % len(graph.out)
    side = at * 2 + (LEAVING if flow[at] != 0 else ENTERING)
    word = word_of(side, nodes)
    if not word & RISES or arc_out(flow[at]) == place:
        return True
    head, cost = at * 2, 0
    if place != OWN:
        head, cost = (at + graph.out[node, place, OFFSET]) * 2, graph.out[node, place, REDUCED]
    price = price_of(nodes.entering[head >> 1], state[RISE])
    if not nodes.entering[head >> 1] & WANTED or price_of(word, state[RISE]) < cost + price:
        reach(head, arrival, cost, price_of(word, state[RISE]), nodes, search)  # somebody else got there
        return True
    depth = _walk_back(side, place, graph, nodes, search)
    if depth < 0:
        if depth == -1:
            search.vain[state[VAIN]] = arrival
            state[VAIN] += 1
        return depth == -1
    state[TOTAL] += price_of(word_of(search.stack[depth, SIDE], nodes), state[RISE]) - price
    nodes.entering[head >> 1] &= ~WANTED if head >> 1 == at or graph.out[node, place, OTHER] < graph.first_goal else -1
    _lay(depth, graph, nodes, search)
    state[SERVED] += 1
    return True


@HELPER
def _is_full(graph, search):
    """Tell whether a list may have no room for what comes next."""
    state = search.state
    more = graph.out.shape[1] + graph.into.shape[1]
    most = max(state[LISTED], state[ARRIVALS] + state[VAIN], state[FILED])
    return most + more + len(search.seen) > len(search.sides)


@kernel(types.int64(GRAPH, NODES, SEARCH, types.int64))
def serve_at_prices(graph, nodes, search, budget):
    """Serve robots until all have a path, room is needed or about `budget` sides have been seen; to be called again."""
    state = search.state
    while budget > 0:
        if state[SERVED] == len(search.start):
            return DONE
        if _is_full(graph, search):
            return LIST_FULL
        budget -= 1
        if state[NEXT] < state[LISTED]:
            side = search.sides[state[NEXT]]
            if (side >> 1) + SPARE_ROWS * len(graph.out) > len(nodes.flow):
                return LAYERS_FULL
            state[NEXT] += 1
            reach_from(side, graph, nodes, search)
        elif state[ARRIVALS] > 0:
            state[ARRIVALS] -= 1
            seen = state[MARKED]
            if not _serve(search.arrivals[state[ARRIVALS]], graph, nodes, search):
                state[ARRIVALS] += 1
                return LIST_FULL
            budget -= state[MARKED] - seen
        elif state[VAIN] and state[SERVED] > state[BEFORE]:
            _try_again(nodes, search)
        elif state[VAIN] or state[RISE] == state[UNTIL]:
            _begin_anew(nodes, search)
        else:
            _try_again(nodes, search)
            raise_prices(nodes, search)
    return BUDGET_SPENT
