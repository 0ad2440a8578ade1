"""Fair prices of a flow that is given: the least that are, or that there are none, as it is not of least cost.

A node that carries flow has two sides: whoever *enters* it goes back to where its flow came from; whoever has been
turned back to it *leaves* it by another arc, or goes back further. A node that is free is only entered. A price is fair
where no residual arc costs less than the difference of the prices at its ends. At first all are 0, but those of each
path: what it still costs beyond the values of its nodes. Then what is too low is raised, in turn. Where a robot can go
to a destination along free nodes the price must stay 0: if that would rise, another flow costs less.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I64, OUT_BOOL, OUT_I32, OUT_I64, declared, kernel
from trihex.optimum.kernels.flow_byte import arc_in, arc_out, is_start
from trihex.optimum.kernels.residual import BUDGET_SPENT, DONE, EXHAUSTED, LIST_FULL, LOG, OFFSET, REDUCED
from trihex.optimum.kernels.slots import SLOT_GRAPH
from trihex.optimum.kernels.words import FLOW, WORDS, comes_by

# Sides of a node: 2 * its index, plus
ENTERING, LEAVING = 0, 1
# Entries of the state: sides in the first queue and in the second, which of the two is filled and which side of the
# other one is next; whether what must not rise would have to.
FIRST, SECOND, FILLED, NEXT, UNFAIR = range(5)
STATE_SIZE = 5


class FairPrices(NamedTuple):
    """The flow, the prices and what is still to be looked at."""

    capacity: types.int64  # how many robots may get into a destination in a step, 0: any number
    words: WORDS  # flow of all nodes of all layers
    price: OUT_I32  # of all sides
    is_queued: OUT_BOOL  # of all sides
    queue: LOG  # two queues of sides from which on prices are to be raised; one is filled while the other is emptied
    state: OUT_I64


FAIR_PRICES = declared(FairPrices)


@HELPER
def _raise(side, price, graph, fair):
    """Raise a side to a price if it has less."""
    at, state = side >> 1, fair.state
    if price <= 0 or (at < len(fair.words) and price <= fair.price[side]):
        return
    # Beyond the last layer nobody is in the way, nor at a destination with room.
    is_goal = at < len(fair.words) and at % len(graph.out) >= graph.first_goal
    if at >= len(fair.words) or (is_goal and (fair.capacity == 0 or fair.words[at] & FLOW < fair.capacity)):
        state[UNFAIR] = 1
        return
    fair.price[side] = price
    if not fair.is_queued[side]:
        fair.is_queued[side] = True
        fair.queue[state[FILLED], state[state[FILLED]]] = side
        state[state[FILLED]] += 1


@HELPER
def _raise_before(at, node, j, price, graph, fair):
    """Raise where flow comes from to what it pays here, and for the arc."""
    _raise((at + graph.into[node, j, OFFSET]) * 2 + LEAVING, price + graph.into[node, j, REDUCED], graph, fair)


@HELPER
def _spread(side, graph, fair):
    """Raise what a price makes rise."""
    at, price = side >> 1, fair.price[side]
    node, flow = at % len(graph.out), fair.words[at] & FLOW
    if node >= graph.first_goal:
        for j in range(graph.into.shape[1]):
            if graph.into[node, j, OFFSET] == 0:
                break
            # Destinations have no arcs into layers before the first.
            if at + graph.into[node, j, OFFSET] >= 0 and comes_by(at, node, j, graph, fair.words):
                _raise_before(at, node, j, price, graph, fair)
        return
    if side & LEAVING == 0 and flow != 0:
        if not is_start(flow):
            _raise_before(at, node, arc_in(flow), price, graph, fair)
        return
    if flow != 0:
        _raise(at * 2 + ENTERING, price, graph, fair)
    for i in range(graph.out.shape[1]):
        if graph.out[node, i, OFFSET] == 0:
            break
        _raise((at + graph.out[node, i, OFFSET]) * 2 + ENTERING, price - graph.out[node, i, REDUCED], graph, fair)


@HELPER
def _cost_of_path(at, graph, words):
    """Return what a path costs from a node on beyond the value of that."""
    node, cost = at % len(graph.out), 0
    while node < graph.first_goal:
        i = arc_out(words[at] & FLOW)
        cost += graph.out[node, i, REDUCED]
        at += graph.out[node, i, OFFSET]
        node = at % len(graph.out)
    return cost


@kernel(types.int64(IN_I64, types.int64, SLOT_GRAPH, FAIR_PRICES))
def price_paths(start, first, graph, fair):
    """Price the paths from `start`, from the `first` on; return the next one, before what has no room."""
    for robot in range(first, len(start)):
        at = start[robot]
        if fair.state[FIRST] + 4 * len(fair.words) // len(graph.out) + 4 > fair.queue.shape[1]:
            return robot
        cost, node = _cost_of_path(at, graph, fair.words), at % len(graph.out)
        while node < graph.first_goal:
            _raise(at * 2 + LEAVING, cost, graph, fair)
            if at != start[robot]:
                _raise(at * 2 + ENTERING, cost, graph, fair)
            i = arc_out(fair.words[at] & FLOW)
            cost -= graph.out[node, i, REDUCED]
            at += graph.out[node, i, OFFSET]
            node = at % len(graph.out)
    return len(start)


@kernel(types.int64(SLOT_GRAPH, FAIR_PRICES, types.int64))
def make_fair(graph, fair, budget):
    """Raise prices until all are fair (`DONE`) or cannot be (`EXHAUSTED`); to be called again else."""
    state, arcs = fair.state, graph.out.shape[1] + graph.into.shape[1]
    while budget > 0 and state[UNFAIR] == 0:
        budget -= 1
        emptied = 1 - state[FILLED]
        if state[NEXT] == state[emptied]:
            if state[state[FILLED]] == 0:
                return DONE
            state[emptied] = state[NEXT] = 0
            state[FILLED] = emptied
            continue
        if state[state[FILLED]] + arcs > fair.queue.shape[1]:
            return LIST_FULL
        side = fair.queue[emptied, state[NEXT]]
        state[NEXT] += 1
        fair.is_queued[side] = False
        _spread(side, graph, fair)
    return EXHAUSTED if state[UNFAIR] else BUDGET_SPENT
