"""Robots get their paths: prices rise where robots without path are, until one of them can go where it is wanted.

The Hungarian method on layers of steps, all robots at once. From an arc to a wanted side that has become tight a walk
goes back along tight arcs for a robot without path, which then goes there. What such walks saw in vain stays seen. When
all tight arcs have been tried and one of them was in vain, some of what rises could only be reached by robots that have
their paths by now, and what rises is found anew.
"""

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, HELPER, kernel
from trihex.optimum.kernels.flow_byte import START, arc_out
from trihex.optimum.kernels.prices import (
    AHEAD,
    ANEW,
    ARCS,
    ARRIVALS,
    BEFORE,
    BITS,
    ENTERING,
    FILED,
    FREE,
    GRAPH,
    IS_EAGER,
    LEAVING,
    LISTED,
    MARKED,
    NEVER,
    NEXT,
    NODES,
    PASSED,
    RISE,
    RISES,
    SEARCH,
    SERVED,
    TOTAL,
    UNTIL,
    VAIN,
    WANTED,
    price_of,
    put_word,
    word_of,
)
from trihex.optimum.kernels.raising import begin_to_rise, is_full, let_rise, reach, reach_from
from trihex.optimum.kernels.residual import (
    BUDGET_SPENT,
    DONE,
    EXHAUSTED,
    LAYERS_FULL,
    LIST_FULL,
    NONE,
    OFFSET,
    OWN,
    REDUCED,
    SPARE_ROWS,
)
from trihex.optimum.kernels.walking import SIDE, arrive, forget, lay, walk_back


@HELPER
def _try_again(nodes, search):
    """Forget what walks have seen, and list again the arrivals for which they were in vain."""
    state = search.state
    forget(0, nodes, search)
    for i in range(state[VAIN]):
        search.arrivals[i] = search.vain[i]
    state[ARRIVALS], state[VAIN], state[BEFORE] = state[VAIN], 0, state[SERVED]


@HELPER
def settle(nodes, search):
    """Let nothing rise any more."""
    state = search.state
    forget(0, nodes, search)
    for i in range(state[LISTED]):
        side = search.sides[i]
        word = word_of(side, nodes)
        put_word(side, (price_of(word, state[RISE]) << BITS) | (word & (WANTED | PASSED)), nodes)
    search.heads[:] = NONE
    state[FREE] = NONE
    state[NEXT] = state[LISTED] = state[FILED] = state[ARRIVALS] = state[VAIN] = 0


@APART
def begin_anew(nodes, search):
    """Let rise no longer what no robot without path may come to any more: all but where these robots are."""
    state = search.state
    settle(nodes, search)
    state[BEFORE] = state[ANEW] = state[SERVED]
    state[UNTIL] = state[RISE] + state[AHEAD]
    for start in search.start:
        if nodes.flow[start] == START << 4:
            begin_to_rise(start * 2 + LEAVING, nodes, search)


@HELPER
def _serve(arrival, graph, nodes, search):
    """Let a robot go to a wanted side by an arc, if one can and the arc is still tight; False if a list is full."""
    state, flow = search.state, nodes.flow
    at, place = arrival // ARCS, arrival % ARCS
    side = at * 2 + (LEAVING if flow[at] != 0 else ENTERING)
    if not word_of(side, nodes) & RISES or arc_out(flow[at]) == place:
        return True
    head, cost = at, np.int64(0)
    if place != OWN:
        node = at % len(graph.out)
        head, cost = at + graph.out[node, place, OFFSET], np.int64(graph.out[node, place, REDUCED])
    price, asked = price_of(word_of(side, nodes), state[RISE]), price_of(nodes.entering[head], state[RISE])
    if not nodes.entering[head] & WANTED or price < cost + asked:  # somebody else has got there
        reach(head * 2 + ENTERING, arrival, cost, price, nodes, search)
        return True
    depth = walk_back(side, place, RISES, graph, nodes, search)
    if depth == -1:
        search.vain[state[VAIN]] = arrival
        state[VAIN] += 1
    if depth < 0:
        return depth == -1
    state[TOTAL] += price_of(word_of(search.stack[depth, SIDE], nodes), state[RISE]) - asked
    lay(depth, 0, graph, nodes, search)
    arrive(head, graph, nodes)
    state[SERVED] += 1
    return True


@kernel(types.int64(GRAPH, NODES, SEARCH, types.int64))
def serve_at_prices(graph, nodes, search, budget):
    """Serve robots until all have a path, room is needed or about `budget` sides have been seen; to be called again.

    It is `EXHAUSTED` if somebody pays more than words can hold, or cannot come where all that rises leads back to him,
    which unfair prices alone can bring about.
    """
    state = search.state
    while budget > 0:
        if state[SERVED] == len(search.start):
            return DONE
        if is_full(graph, search):
            return LIST_FULL
        budget -= 1
        if search.heads[state[RISE] % len(search.heads)] != NONE:
            let_rise(graph, nodes, search)
        elif state[NEXT] < state[LISTED] and not (state[IS_EAGER] and state[ARRIVALS] > 0):
            side = search.sides[state[NEXT]]
            if (side >> 1) + SPARE_ROWS * len(graph.out) > len(nodes.flow):
                return LAYERS_FULL
            state[NEXT] += 1
            reach_from(side, graph, nodes, search)
        elif state[ARRIVALS] > 0:
            state[ARRIVALS] -= 1
            seen, served = state[MARKED], state[SERVED]
            if not _serve(search.arrivals[state[ARRIVALS]], graph, nodes, search):
                state[ARRIVALS] += 1
                return LIST_FULL
            budget -= state[MARKED] - seen
            if state[IS_EAGER] and state[SERVED] > served:
                begin_anew(nodes, search)
        elif state[VAIN] and state[SERVED] > state[BEFORE]:
            _try_again(nodes, search)
        elif state[RISE] == NEVER or (state[VAIN] and state[ANEW] == state[SERVED]):
            return EXHAUSTED
        elif state[VAIN]:
            state[AHEAD] = max(state[AHEAD] // 2, 1)
            begin_anew(nodes, search)
        elif state[RISE] == state[UNTIL]:
            state[AHEAD] = min(state[AHEAD] * 4, len(search.heads) - 1)
            begin_anew(nodes, search)
        else:
            _try_again(nodes, search)
            state[RISE] += 1
    return BUDGET_SPENT
