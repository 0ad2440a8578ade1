"""Queues at destinations, as if robots met nowhere else: what it costs to arrive when, and what each arrival is worth."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, OUT_I32, OUT_I64, OUT_U8, declared, kernel
from trihex.optimum.kernels.flow_byte import with_arc_out
from trihex.optimum.kernels.prices import BITS, WANTED
from trihex.optimum.kernels.residual import LAYER, OFFSET, OTHER, REDUCED, ROWS

NEVER = 1 << 28
NONE = -1
TABLE = types.Array(types.int32, 2, "C")


class Ways(NamedTuple):
    """Nodes of a layer, and those where robots start."""

    order: IN_I32  # so that arcs within a layer go forward
    hops: IN_I32
    cells: IN_I64  # node of each robot


class Slots(NamedTuple):
    """Arrivals at a destination in a step, and who takes them."""

    room: IN_I64  # how many robots get into each slot
    price: OUT_I64  # what its best use by others is worth
    taken: OUT_I64  # by how many
    slot_of_robot: OUT_I64  # or NONE
    first: OUT_I64  # robot in each slot, or NONE
    following: OUT_I64  # next robot in the slot of each robot, or NONE
    # of the search under way, for each slot:
    cost: OUT_I64
    before: OUT_I64  # slot that the robot gives up who comes here, or NONE
    robot: OUT_I64
    done: OUT_U8


WAYS, SLOTS = declared(Ways), declared(Slots)


@kernel(types.void(LAYER, WAYS, types.int64, TABLE, TABLE))
def find_costs(graph, ways, goal, layers, costs):
    """Fill `costs` by robot and steps beyond its least number with the least cost to arrive so late at one goal.

    `layers` is room for some layers, more than an arc spans.
    """
    out, order = graph.out, ways.order
    for late in range(costs.shape[1]):
        layer = layers[late % len(layers)]
        for i in range(len(order) - 1, -1, -1):
            node = order[i]
            least = NEVER
            if node == goal and late == 0:
                least = 0
            elif node < graph.first_goal:
                for k in range(out.shape[1]):
                    if out[node, k, OFFSET] == 0:
                        break
                    rows = out[node, k, ROWS]
                    if rows <= late:
                        least = min(least, out[node, k, REDUCED] + layers[(late - rows) % len(layers), out[node, k, OTHER]])
            layer[node] = least
        for robot in range(len(ways.cells)):
            costs[robot, late] = layer[ways.cells[robot]]


@HELPER
def _offer(robot, before, so_far, costs, slots):
    """Offer a robot all slots, if it gives up its own."""
    for slot in range(len(slots.room)):
        cost = so_far + costs[robot, slot] + slots.price[slot]
        if cost < slots.cost[slot] and not slots.done[slot]:
            slots.cost[slot], slots.before[slot], slots.robot[slot] = cost, before, robot


@HELPER
def _cheapest(slots):
    """Return the slot that costs least of those that are not done."""
    best = NONE
    for slot in range(len(slots.room)):
        if not slots.done[slot] and (best == NONE or slots.cost[slot] < slots.cost[best]):
            best = slot
    return best


@HELPER
def _leave(robot, slots):
    """Strike a robot off the list of its slot."""
    slot = slots.slot_of_robot[robot]
    other = slots.first[slot]
    if other == robot:
        slots.first[slot] = slots.following[robot]
        return
    while slots.following[other] != robot:
        other = slots.following[other]
    slots.following[other] = slots.following[robot]


@HELPER
def _move_up(slot, slots):
    """Let robots change their slots, so that the one under way gets one."""
    slots.taken[slot] += 1
    while slot != NONE:
        robot, before = slots.robot[slot], slots.before[slot]
        if before != NONE:
            _leave(robot, slots)
        slots.slot_of_robot[robot], slots.following[robot], slots.first[slot] = slot, slots.first[slot], robot
        slot = before


@kernel(types.void(TABLE, SLOTS))
def share_slots(costs, slots):
    """Share slots among robots at the least sum of costs, robot by robot; find the least prices that prove it."""
    for late in range(len(costs)):
        robot = len(costs) - 1 - late
        slots.cost[:] = 2 * NEVER
        slots.done[:] = 0
        _offer(robot, NONE, 0, costs, slots)
        while True:
            slot = _cheapest(slots)
            if slots.taken[slot] < slots.room[slot]:
                break
            slots.done[slot] = 1
            other = slots.first[slot]
            while other != NONE:
                _offer(other, slot, slots.cost[slot] - costs[other, slot] - slots.price[slot], costs, slots)
                other = slots.following[other]
        for passed in range(len(slots.room)):
            if slots.done[passed]:
                slots.price[passed] += slots.cost[slot] - slots.cost[passed]
        _move_up(slot, slots)


@kernel(types.int64(LAYER, WAYS, TABLE, OUT_U8, OUT_I32))
def lay_prices(graph, ways, tolls, flow, entering):
    """Fill in what nodes cost to enter where nobody is but arrivals cost tolls; return the costs of last arcs.

    With `tolls` by layer and destination. Where any number may arrive, the toll is paid by those who enter a node before:
    that is wanted, and has an arc to the destination.
    """
    out, size, last_cost = graph.out, len(graph.out), 0
    for row in range(len(tolls) - 1, -1, -1):
        for i in range(size - 1, -1, -1):
            node = ways.order[i]
            at = row * size + node
            if ways.hops[node] > row or node >= graph.first_goal:
                continue
            least, place = NEVER, 0
            for k in range(out.shape[1]):
                if out[node, k, OFFSET] == 0:
                    break
                head = at + out[node, k, OFFSET]
                price = (entering[head] >> BITS) if head < len(entering) else 0
                if price + out[node, k, REDUCED] <= least:
                    least, place = price + out[node, k, REDUCED], k
            entering[at] = least << BITS
            goal = out[node, place, OTHER] - graph.first_goal
            if goal >= 0 and flow[at] == 0:
                toll = tolls[row + out[node, place, ROWS], goal] if row + out[node, place, ROWS] < len(tolls) else 0
                if toll > 0:
                    entering[at] = ((least + toll) << BITS) | WANTED
                    flow[at] = with_arc_out(0, place)
                    flow[at + out[node, place, OFFSET]] += 1
                    last_cost += least
    return last_cost
