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

    node: IN_I64  # nodes of the barriers that may become doors
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
def _walk_away(door, graph, search):
    """Find the steps from each node to the door; return how many nodes lie beside it."""
    away, queue = search.away, search.queue
    for node in range(len(away)):
        away[node] = -1
    away[door] = 0
    queue[0] = door
    head, tail, beside = 0, 1, 0
    while head < tail:
        node = queue[head]
        head += 1
        j = 0
        while graph.into[node, j, OFFSET] != 0:
            other = graph.into[node, j, OTHER]
            if away[other] < 0 and not search.barrier[other]:
                away[other] = away[node] + 1
                beside += node == door
                queue[tail] = other
                tail += 1
            j += 1
    return beside


@HELPER
def _is_inside(node, graph, search):
    """Tell whether a barrier lies among barriers alone: most do in thick walls."""
    j = 0
    while graph.into[node, j, OFFSET] != 0:
        if not search.barrier[graph.into[node, j, OTHER]]:
            return False
        j += 1
    return True


@kernel(types.void(SLOT_GRAPH, DOOR_SEARCH, OUT_I64, types.int64, types.int64))
def bound_doors(graph, search, saved, first, end):
    """Write how many steps each of the doors `first` to `end` - 1 saves at most.

    By each step no more come to the destinations than before, no more to the door than its entries let in of those who
    are near enough, and no more in all than are near enough to either.
    """
    last = len(search.arrived) - 1
    for k in range(first, end):
        if _is_inside(search.node[k], graph, search):
            saved[k] = 0
            continue
        beside = _walk_away(search.node[k], graph, search)
        room = min(beside, search.capacity) if search.capacity else beside
        for step in range(last + 1):
            search.near[step] = search.near_door[step] = 0
        for robot in range(len(search.start)):
            steps, away = search.steps[robot], search.away[search.start[robot]]
            if 0 <= away <= last:
                search.near_door[away] += 1
                steps = min(steps, away)
            search.near[steps] += 1
        near = near_door = through = 0
        saved[k] = 0
        for step in range(last + 1):
            near += search.near[step]
            near_door += search.near_door[step]
            through = min(through + room, near_door)
            saved[k] += min(through, near - search.arrived[step])


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
