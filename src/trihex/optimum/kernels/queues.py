"""Queues at the destinations, as if robots met nowhere else: what it costs each robot to arrive when, and who does.

A *slot* is an arrival at a destination in a step, numbered ``step * destinations + destination``.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, OUT_BOOL, OUT_I64, declared, kernel
from trihex.optimum.kernels.residual import LAYER, NONE, OFFSET, OTHER, REDUCED, ROWS

# More than any way costs.
NEVER = 1 << 29
TABLE = types.Array(types.int32, 2, "C")


class SlotWays(NamedTuple):
    """Nodes of a layer, and those where robots start."""

    order: IN_I32  # so that arcs within a layer go forward
    cells: IN_I64  # node of each robot
    earliest: IN_I64  # step in which it can arrive, the nearest destination being free


class Sharing(NamedTuple):
    """Who has which slot, and the search for one."""

    costs: TABLE  # of each robot and slot
    room: IN_I64  # how many robots get into each slot
    price: OUT_I64  # of each slot, what others would pay for it at least
    taken: OUT_I64  # robots in each slot
    first: OUT_I64  # one of them, or NONE
    following: OUT_I64  # another one in the slot of each robot, or NONE
    # The search under way, for each slot: least cost and price so far; who takes it then and which slot he gives up for
    # it, or NONE; whether that is final.
    least: OUT_I64
    robot: OUT_I64
    before: OUT_I64
    done: OUT_BOOL


WAYS, SHARING = declared(SlotWays), declared(Sharing)


@kernel(types.void(LAYER, WAYS, types.int64, TABLE, TABLE, types.int64))
def find_costs(graph, ways, goal, layers, costs, late):
    """Write into `costs` what robots pay beyond their values who come to a goal `late` steps later than they can.

    Called for 0, 1, ... in turn; `layers` has a row more than arcs lead layers on.
    """
    out, layer = graph.out, layers[late % len(layers)]
    for i in range(len(ways.order) - 1, -1, -1):
        node = ways.order[i]
        least = NEVER
        if node >= graph.first_goal:
            least = 0 if node == goal and late == 0 else NEVER
        else:
            for k in range(out.shape[1]):
                rows = out[node, k, ROWS]
                if out[node, k, OFFSET] == 0:
                    break
                if rows <= late:
                    least = min(least, out[node, k, REDUCED] + layers[(late - rows) % len(layers), out[node, k, OTHER]])
        layer[node] = least
    goals = len(out) - graph.first_goal
    for robot in range(len(ways.cells)):
        slot = (ways.earliest[robot] + late) * goals + goal - graph.first_goal
        if slot < costs.shape[1]:
            costs[robot, slot] = layer[ways.cells[robot]]


@HELPER
def _offer(robot, before, spent, sharing):
    """Offer all slots to a robot that has spent so much and gives up its own."""
    for slot in range(len(sharing.room)):
        least = spent + sharing.costs[robot, slot] + sharing.price[slot]
        if least < sharing.least[slot] and not sharing.done[slot]:
            sharing.least[slot], sharing.robot[slot], sharing.before[slot] = least, robot, before


@HELPER
def _next_slot(sharing):
    """Return the slot of least cost that is not done."""
    best = NONE
    for slot in range(len(sharing.room)):
        if not sharing.done[slot] and (best == NONE or sharing.least[slot] < sharing.least[best]):
            best = slot
    return best


@HELPER
def _give_up(robot, slot, sharing):
    """Strike a robot off the list of its slot."""
    other = sharing.first[slot]
    if other == robot:
        sharing.first[slot] = sharing.following[robot]
        return
    while sharing.following[other] != robot:
        other = sharing.following[other]
    sharing.following[other] = sharing.following[robot]


@HELPER
def _move_up(slot, sharing):
    """Let each robot on the way to an open slot take it and give up its own for the next one."""
    sharing.taken[slot] += 1
    while slot != NONE:
        robot, before = sharing.robot[slot], sharing.before[slot]
        if before != NONE:
            _give_up(robot, before, sharing)
        sharing.following[robot], sharing.first[slot] = sharing.first[slot], robot
        slot = before


@kernel(types.void(types.int64, SHARING))
def share_slot(robot, sharing):
    """Let a robot have a slot, too, if there is one, so that all together pay least; prices prove that."""
    sharing.least[:] = 2 * NEVER
    sharing.done[:] = False
    _offer(robot, NONE, 0, sharing)
    while True:
        slot = _next_slot(sharing)
        if slot == NONE or sharing.least[slot] >= NEVER:
            return
        if sharing.taken[slot] < sharing.room[slot]:
            break
        sharing.done[slot] = True
        other = sharing.first[slot]
        while other != NONE:
            _offer(other, slot, sharing.least[slot] - sharing.costs[other, slot] - sharing.price[slot], sharing)
            other = sharing.following[other]
    for passed in range(len(sharing.room)):
        if sharing.done[passed]:
            sharing.price[passed] += sharing.least[slot] - sharing.least[passed]
    _move_up(slot, sharing)
