"""Doors: what it can save at most, and by which steps more arrive, if a barrier becomes a destination."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, IN_I64, OUT_I64, declared, kernel
from trihex.optimum.kernels.residual import OFFSET, OTHER
from trihex.optimum.kernels.slots import SLOT_GRAPH

# Entries of what `find_door_steps` finds.
FIRST = 0  # first step by which more arrive
END = 1  # first step after it by which no more do


class DoorSearch(NamedTuple):
    """What holds for all doors, and scratch."""

    barrier: IN_BOOL  # of each node of a layer
    start: IN_I64  # node where each robot starts
    steps: IN_I64  # steps from there to the nearest destination
    arrived: IN_I64  # how many have arrived after each step
    capacity: types.int64  # how many robots may get into a destination in a step, 0: any number
    away: OUT_I64  # scratch: steps from each node to the door, -1 where there is no way
    queue: OUT_I64  # scratch
    near: OUT_I64  # scratch: robots that may come to any destination in each step, one for each of `arrived`
    near_door: OUT_I64  # scratch: to the door


DOOR_SEARCH = declared(DoorSearch)


@HELPER
def _walk_away(doors, graph, search):
    """Find the steps from each node to the nearest of the doors; return the most nodes that lie beside one of them."""
    away, queue = search.away, search.queue
    for node in range(len(away)):
        away[node] = -1
    head, tail, most = 0, 0, 0
    for door in doors:
        beside, j = 0, 0
        while graph.into[door, j, OFFSET] != 0:
            beside += not search.barrier[graph.into[door, j, OTHER]]
            j += 1
        if beside > 0:  # most barriers of thick walls lie among barriers alone
            most = max(most, beside)
            away[door] = 0
            queue[tail] = door
            tail += 1
    while head < tail:
        node = queue[head]
        head += 1
        j = 0
        while graph.into[node, j, OFFSET] != 0:
            other = graph.into[node, j, OTHER]
            if away[other] < 0 and not search.barrier[other]:
                away[other] = away[node] + 1
                queue[tail] = other
                tail += 1
            j += 1
    return most


@kernel(types.int64(SLOT_GRAPH, DOOR_SEARCH, IN_I64))
def bound_door(graph, search, doors):
    """Return how many steps one of the doors saves at most, whichever it is.

    By each step no more come to the destinations than before, no more to the door than its entries let in of those who
    are near enough, and no more in all than are near enough to either.
    """
    last = len(search.arrived) - 1
    room = _walk_away(doors, graph, search)
    if search.capacity:
        room = min(room, search.capacity)
    for step in range(last + 1):
        search.near[step] = search.near_door[step] = 0
    for robot in range(len(search.start)):
        steps, away = search.steps[robot], search.away[search.start[robot]]
        if 0 <= away <= last:
            search.near_door[away] += 1
            steps = min(steps, away)
        search.near[steps] += 1
    near = near_door = through = saved = 0
    for step in range(last + 1):
        near += search.near[step]
        near_door += search.near_door[step]
        through = min(through + room, near_door)
        saved += min(through, near - search.arrived[step])
    return saved


@kernel(types.void(SLOT_GRAPH, DOOR_SEARCH, IN_I32, types.int64, OUT_I64))
def find_door_steps(graph, search, late, door, found):
    """Write the first and the last step by which more arrive if a barrier becomes a door; 0 as last if none."""
    size, last = len(graph.out), len(search.arrived) - 1
    found[FIRST], found[END] = last, 0
    for step in range(1, last):
        j = 0
        while graph.into[door, j, OFFSET] != 0:
            label = late[(step - 1) * size + graph.into[door, j, OTHER]]
            if label > step:
                found[FIRST], found[END] = min(found[FIRST], step), max(found[END], label)
            j += 1
