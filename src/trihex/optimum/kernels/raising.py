"""What rises: all that robots without path can reach along tight arcs.

The method of Dial (1969): sides are filed for the rise at which an arc from those that rise becomes tight.
"""

from trihex.kernels.signatures import HELPER
from trihex.optimum.kernels.flow_byte import START, arc_in, arc_out
from trihex.optimum.kernels.prices import (
    ARCS,
    ARRIVALS,
    BITS,
    ENTERING,
    FILED,
    FREE,
    LEAVING,
    LISTED,
    PASSED,
    RISE,
    RISES,
    UNTIL,
    VAIN,
    WANTED,
    price_of,
    put_word,
    word_of,
)
from trihex.optimum.kernels.residual import NONE, OFFSET, OWN, PLACE, REDUCED


@HELPER
def begin_to_rise(side, nodes, search):
    """List a side that rises from now on."""
    state = search.state
    word = word_of(side, nodes)
    if not word & RISES:
        put_word(side, (((word >> BITS) - state[RISE]) << BITS) | (word & PASSED) | RISES, nodes)
        search.sides[state[LISTED]] = side
        state[LISTED] += 1


@HELPER
def _file_for(what, rise, search):
    """File a side, or an arc to a wanted side as -1 less its number, for a rise to come."""
    state, filed = search.state, search.filed
    if rise > state[UNTIL]:
        return
    entry = state[FREE]
    if entry == NONE:
        entry = state[FILED]
        state[FILED] += 1
    else:
        state[FREE] = filed[entry, 1]
    which = rise % len(search.heads)
    filed[entry, 0], filed[entry, 1] = what, search.heads[which]
    search.heads[which] = entry


@HELPER
def reach(side, via, cost, price, nodes, search):
    """Let a side rise, at the end of an arc from one that rises, when that is tight; if it is wanted, note the arc."""
    word, state = word_of(side, nodes), search.state
    if word & RISES:
        return
    slack = cost + price_of(word, state[RISE]) - price
    if word & WANTED:
        if slack <= 0:
            search.arrivals[state[ARRIVALS]] = via
            state[ARRIVALS] += 1
        else:
            _file_for(-1 - via, state[RISE] + slack, search)
    elif slack <= 0:
        begin_to_rise(side, nodes, search)
    else:
        _file_for(side, state[RISE] + slack, search)


@HELPER
def _enter(at, node, price, graph, nodes, search):
    """Reach what comes before a node that carries flow, or before a destination that is full."""
    into = graph.into
    if node < graph.first_goal:
        j = arc_in(nodes.flow[at])
        if j != START - 1:
            before = at + into[node, j, OFFSET]
            reach(before * 2 + LEAVING, before * ARCS + OWN, -into[node, j, REDUCED], price, nodes, search)
        return
    for j in range(into.shape[1]):
        before = at + into[node, j, OFFSET]
        if before == at:
            break
        if arc_out(nodes.flow[before]) == into[node, j, PLACE]:
            reach(before * 2 + LEAVING, before * ARCS + OWN, -into[node, j, REDUCED], price, nodes, search)


@HELPER
def reach_from(side, graph, nodes, search):
    """Let rise, now or later, what can be reached from a side."""
    out, at = graph.out, side >> 1
    node, word, taken = at % len(out), word_of(side, nodes), NONE
    price = price_of(word, search.state[RISE])
    if word & PASSED or node >= graph.first_goal:
        _enter(at, node, price, graph, nodes, search)
        return
    if side & LEAVING:
        taken = arc_out(nodes.flow[at])
        if arc_in(nodes.flow[at]) != START - 1:
            reach(at * 2 + ENTERING, at * ARCS + OWN, 0, price, nodes, search)
    for k in range(out.shape[1]):
        head = at + out[node, k, OFFSET]
        if head == at:
            break
        if k != taken:
            reach(head * 2 + ENTERING, at * ARCS + k, out[node, k, REDUCED], price, nodes, search)


@HELPER
def is_full(graph, search):
    """Tell whether a list may have no room for what comes next."""
    state, more = search.state, graph.out.shape[1] + graph.into.shape[1]
    return (
        state[LISTED] + len(search.seen) + more > len(search.sides)
        or state[FILED] + more > len(search.filed)
        or state[ARRIVALS] + state[VAIN] + more > len(search.arrivals)
    )


@HELPER
def let_rise(graph, nodes, search):
    """Let rise what was filed for the rise that prices have come to, as far as there is room."""
    state, filed = search.state, search.filed
    which = state[RISE] % len(search.heads)
    while search.heads[which] != NONE and not is_full(graph, search):
        entry = search.heads[which]
        what, search.heads[which] = filed[entry, 0], filed[entry, 1]
        if what >= 0:
            begin_to_rise(what, nodes, search)
        else:
            search.arrivals[state[ARRIVALS]] = -1 - what
            state[ARRIVALS] += 1
        filed[entry, 1] = state[FREE]
        state[FREE] = entry
