"""Prices are lowered where nobody came though it was wanted: a toll there was too dear.

All that could come there along tight arcs costs one unit less, and so on, until somebody who arrives elsewhere may as
well come there, or the toll is no more.

That ends whatever the prices were: each call lets somebody come, which leaves one place fewer to come to, or lowers the
prices of all nodes missed by at least 1, and does not go on if one of them is below 0. Among fair prices none can be: a
node missed is a destination, or an arc with flow leads from it to one, and its price is at least the cost of that arc;
and at a destination that costs nothing a walk ends. (Once a toll was laid at a gate from which no way led on, as a
robot stood behind it, and it fell below all that there was.)
"""

from numba import types

from trihex.kernels.signatures import HELPER, IN_I64, kernel
from trihex.optimum.kernels.prices import (
    BITS,
    ENTERING,
    GRAPH,
    MARKED,
    NEVER,
    NODES,
    SEARCH,
    SEEN,
    TOTAL,
    WANTED,
    put_word,
    word_of,
)
from trihex.optimum.kernels.residual import BUDGET_SPENT, DONE, EXHAUSTED, LIST_FULL, OWN
from trihex.optimum.kernels.serving import settle
from trihex.optimum.kernels.walking import SIDE, arrive, forget, lay, tail, walk_back


@HELPER
def _is_missed(at, graph, nodes):
    """Tell whether a toll is due at a node where somebody is still wanted."""
    word = nodes.entering[at]
    return word & WANTED and (at % len(graph.out) < graph.first_goal or word >> BITS > 0)


@HELPER
def _slack(side, graph, nodes):
    """Return by how much a side that a walk has seen can fall until it has seen more."""
    price = word_of(side, nodes) >> BITS
    node = (side >> 1) % len(graph.out)
    least = price if node >= graph.first_goal else 1 << 29
    i = 0
    while True:
        other, _, cost = tail(side, node, i, graph, nodes)
        if other == -2:
            return least
        if other >= 0 and not word_of(other, nodes) & SEEN:
            least = min(least, cost + price - (word_of(other, nodes) >> BITS))
        i += 1


@HELPER
def _lower(graph, nodes, search):
    """Lower the prices of all that walks have seen until they see more; return whether they could."""
    least = NEVER
    for i in range(search.state[MARKED]):
        least = min(least, _slack(search.seen[i], graph, nodes))
    if least <= 0 or least == NEVER:
        return False
    for i in range(search.state[MARKED]):
        side = search.seen[i]
        put_word(side, word_of(side, nodes) - (least << BITS), nodes)
    return True


@HELPER
def _come(at, depth, graph, nodes, search):
    """Let one who arrives where the walk ended come to a node instead."""
    search.state[TOTAL] -= nodes.entering[at] >> BITS
    left = search.stack[depth, SIDE] >> 1
    lay(depth, 1, graph, nodes, search)
    nodes.flow[left] -= 1
    nodes.entering[left] |= WANTED
    arrive(at, graph, nodes)
    forget(0, nodes, search)


@kernel(types.int64(IN_I64, GRAPH, NODES, SEARCH))
def lower_prices(wanted, graph, nodes, search):
    """Let somebody come to one of the nodes, or lower prices, all robots having paths; to be called until done.

    It is `EXHAUSTED` if neither goes on, which unfair prices alone can bring about.
    """
    settle(nodes, search)
    is_done = True
    for at in wanted:
        if _is_missed(at, graph, nodes):
            is_done = False
            depth = walk_back(at * 2 + ENTERING, OWN, 0, graph, nodes, search)
            if depth == -2:
                return LIST_FULL
            if depth >= 0:
                _come(at, depth, graph, nodes, search)
                return BUDGET_SPENT
    if is_done:
        return DONE
    if not _lower(graph, nodes, search):
        return EXHAUSTED
    for at in wanted:
        if _is_missed(at, graph, nodes) and nodes.entering[at] < 0:
            return EXHAUSTED
    return BUDGET_SPENT
