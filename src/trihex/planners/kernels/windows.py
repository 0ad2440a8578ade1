"""Windows: the cheapest way of so many steps between two sites of a robot's way, past what others take.

What the rest of a way costs is known but for barriers and others: from the `Frame`, and on the way to a destination
from the distance. So nodes, pairs of step and place, are looked at level by level of what a way through them costs at
least (A*). Within a level the last one is taken up first, and of the actions of a node to wait before edges, and those
before vertices: of equal ways one is found that goes late, and what a robot hurries for comes nearer to where it waits.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, IN_I32, IN_U16, OUT_I32, OUT_U8, declared
from trihex.planners.kernels.frame import entry_of, first_actions, place_after
from trihex.planners.kernels.taken import may_move, may_wait
from trihex.planners.kernels.ways import first_of, neighbour, without_first

_U = np.uint64
_WAIT = np.int64(WAIT)
_FAR = np.int64(1 << 40)
NOTHING = np.int64(-1)
_DONE = -1
# How many nodes a step may add: the moves, and to wait.
_SPARE = 16


class Ground(NamedTuple):
    """What is known of each site."""

    distance: IN_I32
    moves: IN_U16  # the directions that are open, a bit each
    most_cost: types.int64  # of any move


class Window(NamedTuple):
    """What is looked for."""

    begin: types.int64  # after which step
    steps: types.int64
    start: types.int64  # the site at which the robot is then
    end: types.int64  # the place at which it has to be in the end
    is_last: types.int64  # 1: it has to arrive instead, in the last step or earlier
    most: types.int64  # the way has to cost less


class Nodes(NamedTuple):
    """The nodes of a search."""

    site: OUT_I32
    place: OUT_I32  # step << bits of a place | place
    cost: OUT_I32  # paid so far
    level: OUT_I32  # what a way through it costs at least; `_DONE`: it has been looked at
    parent: OUT_I32
    action: OUT_U8
    node_of_place: OUT_I32  # of no worth where that node is at another place
    now: OUT_I32  # nodes to be looked at, the last one first
    later: OUT_I32  # nodes of higher levels


class Counts(NamedTuple):
    """How many nodes there are, in all and in the two lists."""

    nodes: types.int64
    now: types.int64
    later: types.int64


GROUND, NODES = declared(Ground), declared(Nodes)


@HELPER
def least_left(site, place, left, window, frame, ground):
    """Return what a robot has to pay at least in the steps that are left."""
    if window.is_last:
        distance = np.int64(ground.distance[_U(site)])
        return distance if distance <= left * ground.most_cost else _FAR
    return np.int64(frame.least[_U(entry_of(left, site, place, window.end, frame))])


@HELPER
def _reach(site, place, cost, level, parent, action, count, nodes):
    """Note that a node is reached; return its number, or `NOTHING` if it had been at no more cost."""
    node = np.int64(nodes.node_of_place[_U(place)])
    if not 0 <= node < count or nodes.place[_U(node)] != place:
        node = count
        nodes.node_of_place[_U(place)] = node
        nodes.place[_U(node)] = place
        nodes.site[_U(node)] = site
    elif nodes.cost[_U(node)] <= cost:
        return NOTHING
    nodes.cost[_U(node)] = cost
    nodes.level[_U(node)] = level
    nodes.parent[_U(node)] = parent
    nodes.action[_U(node)] = action
    return node


@HELPER
def _actions_of(site, place, left, level, window, frame, ground):
    """Return what a robot could do at a site, so many steps before the end: bit 0 to wait, and then the moves."""
    actions = np.int64(ground.moves[_U(site)]) << 1 | 1
    if window.is_last:
        return actions
    return first_actions(actions, entry_of(left, site, place, window.end, frame), window.most - level, frame)


@HELPER
def _turn_over(first, end, nodes):
    """Turn over a part of the list of what is looked at now."""
    last = end - 1
    while first < last:
        nodes.now[_U(first)], nodes.now[_U(last)] = nodes.now[_U(last)], nodes.now[_U(first)]
        first += 1
        last -= 1


@HELPER
def _leave(node, level, counts, window, frame, ground, ways, taken, nodes):
    """Reach all that a robot can reach in a step from a node; return how many there are then."""
    count, now, later = counts
    site, cost, code = np.int64(nodes.site[_U(node)]), np.int64(nodes.cost[_U(node)]), np.int64(nodes.place[_U(node)])
    step, place = (code >> frame.bits) + 1, code & ((1 << frame.bits) - 1)
    left, time = window.steps - step, window.begin + step
    untried = _actions_of(site, place, left + 1, np.int64(nodes.level[_U(node)]), window, frame, ground)
    nodes.level[_U(node)] = _DONE
    while untried:
        k = first_of(untried) - 1
        untried = without_first(untried)
        target, there, action, paid = site, place, _WAIT, cost + ways.waiting_cost
        if k >= 0:
            target, there, action = neighbour(site, k, ways), place_after(place, site, k, frame), k
            paid = cost + ways.cost[_U(k)]
        least = paid + least_left(target, there, left, window, frame, ground)
        if least >= window.most:
            continue
        if k < 0:
            if not may_wait(site, time, taken):
                continue
        else:
            is_end = ground.distance[_U(target)] == 0
            if is_end > window.is_last or not may_move(site, k, time, is_end, ways, taken):
                continue
        reached = _reach(target, step << frame.bits | there, paid, least, node, action, count, nodes)
        if reached == NOTHING:
            continue
        count = max(count, reached + 1)
        if least <= level:
            nodes.now[_U(now)] = reached
            now += 1
        else:
            nodes.later[_U(later)] = reached
            later += 1
    _turn_over(counts.now, now, nodes)
    return Counts(count, now, later)


@HELPER
def _next_level(later, nodes):
    """Return the least level of the nodes that are kept for later."""
    level = _FAR
    for i in range(later):
        own = np.int64(nodes.level[_U(nodes.later[_U(i)])])
        if own != _DONE:
            level = min(level, own)
    return level


@HELPER
def _take_up(level, counts, nodes):
    """Let nodes of a level be looked at now; return how many there are then."""
    now, kept = np.int64(0), np.int64(0)
    for i in range(counts.later):
        node = nodes.later[_U(i)]
        own = nodes.level[_U(node)]
        if own == _DONE:
            continue
        if own <= level:
            nodes.now[_U(now)] = node
            now += 1
        else:
            nodes.later[_U(kept)] = node
            kept += 1
    return Counts(counts.nodes, now, kept)


@HELPER
def _is_end(node, window, frame, ground, nodes):
    """Tell whether a node is the end of the window."""
    if window.is_last:
        return ground.distance[_U(nodes.site[_U(node)])] == 0
    return nodes.place[_U(node)] == window.steps << frame.bits | window.end


@HELPER
def find_way(window, least, frame, ground, ways, taken, nodes):
    """Return the node at the end of the cheapest way, or `NOTHING` if none is cheap enough or nodes run out.

    No way costs less than `least`.
    """
    nodes.site[0], nodes.place[0], nodes.cost[0] = window.start, frame.centre, 0
    nodes.level[0], nodes.parent[0], nodes.node_of_place[_U(frame.centre)], nodes.now[0] = least, NOTHING, 0, 0
    level, counts, room = least, Counts(np.int64(1), np.int64(1), np.int64(0)), len(nodes.site) - _SPARE
    while level < window.most:
        while counts.now > 0:
            node = np.int64(nodes.now[_U(counts.now - 1)])
            counts = Counts(counts.nodes, counts.now - 1, counts.later)
            if nodes.level[_U(node)] == _DONE:
                continue
            if _is_end(node, window, frame, ground, nodes):
                return node
            if max(counts.nodes, counts.now, counts.later) > room:
                return NOTHING
            counts = _leave(node, level, counts, window, frame, ground, ways, taken, nodes)
        level = _next_level(counts.later, nodes)
        counts = _take_up(level, counts, nodes)
    return NOTHING
