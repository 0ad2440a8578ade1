"""Lanes: ways to the destinations that share no cell and no lattice vertex, found one robot after the other.

Each robot in turn is sent along its cheapest path through the residual graph of the lanes so far: the path may lead
against a lane, which then goes elsewhere from there (Busacker and Gowen 1961).
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, HELPER, IN_I32, IN_I64, OUT_I64, declared, kernel
from trihex.planners.kernels.key_heap import drop_least, push_key
from trihex.planners.kernels.residual import (
    AFTER,
    BEFORE,
    BEGIN,
    NETWORK,
    NOBODY,
    NOTHING,
    NOWHERE,
    PAID,
    REDUCED,
    SEARCH,
    STREETS,
    VALUE,
    arc_of,
    change_lanes,
    mark,
    node_entered,
    value_of,
)

# Entries of the state: robots tried, lanes found, nodes visited; the catchment under way, and how many robots have got
# no lane there since one did.
TRIED, FOUND, VISITED, CATCHMENT, FAILED = range(5)
STATE_SIZE = 5
# A key of the heap: the reduced cost, and the node in the lower 32 bits.
_NODE = (1 << 32) - 1
_ONE = np.int64(1)


class LaneDemand(NamedTuple):
    """Who is to get a lane."""

    starts: IN_I32  # the sites of the robots, catchment by catchment, in turn
    first: IN_I64  # catchment c has the robots from first[c] on
    found: OUT_I64  # how many lanes each catchment has
    due: OUT_I64  # what a lane of each robot may cost
    price: types.int64  # what a step of waiting costs; -1: a lane may cost anything
    most_visits: types.int64  # how many nodes may be visited; each catchment has its part by its robots
    patience: types.int64  # after so many robots in turn without a lane no others of the catchment are tried
    most_lanes: types.int64  # how many lanes there can be in all
    capacity: types.int64  # how many may end in one destination, 0 for any number


DEMAND = declared(LaneDemand)


class LanePath(NamedTuple):
    """What a search finds."""

    last: types.int64  # the last node before the destination; -1: there is no path that is worth it
    goal: types.int64  # the destination
    reduced: types.int64  # the reduced cost; if there is no path, the least that is too much
    seen: types.int64  # how many nodes the search has seen; -1: the heap was too small for it
    is_limited: types.boolean  # whether any node was left out because it is too expensive


@HELPER
def _next(at, best, waiting, keys, network, heap):
    """Return the nearest node, if any is nearer than `best`, how near it is, and how much is left in stack and heap."""
    if waiting > 0:
        return np.int64(network.level[waiting - 1]), at, waiting - 1, keys
    while keys > 0 and heap[0] >> 32 < best:
        reduced, node = heap[0] >> 32, heap[0] & _NODE
        drop_least(heap, keys)
        keys -= 1
        if network.node[node, REDUCED] == reduced:  # or else it was reached at less cost since
            return node, reduced, waiting, keys
    return NOWHERE, at, waiting, keys


@APART
def _given_up(seen, network):
    """Return what a search finds whose heap is too small; it can be begun again."""
    for i in range(seen):
        network.node[network.seen[i], SEARCH] = 0
    return LanePath(NOWHERE, NOWHERE, NOTHING, NOWHERE, False)


@HELPER
def _search(root, start, most, search, demand, streets, network, heap):
    """Find the cheapest path from a node to a destination, if its reduced cost is at most `most`.

    A Dijkstra search; nodes as near as the one under way wait in a stack, so that of many equally good ways one is
    followed to its end.
    """
    nodes, size, arcs = network.node, len(streets.moves), len(streets.cost) + len(streets.ring) + 1
    last, goal, best, at, is_limited = NOWHERE, NOWHERE, most + 1, NOTHING, False
    mark(root, search, NOTHING, NOWHERE, start, network)
    network.seen[0] = network.level[0] = root
    seen, waiting, keys = _ONE, _ONE, NOTHING
    while best > at:
        if keys + arcs > len(heap):
            return _given_up(seen, network)
        node, at, waiting, keys = _next(at, best, waiting, keys, network, heap)
        if node == NOWHERE:
            break
        value, after = np.int64(nodes[node, VALUE]) - 1, np.int64(nodes[node, AFTER]) - 1
        for i in range(-1, len(streets.cost) if node < size else len(streets.ring)):
            target, paid = arc_of(node, i, streets)
            if target == NOWHERE or target == after:
                continue
            if target < size and streets.catchment[target] != streets.catchment[start]:
                continue
            if target < size and network.ends[target] >= 0:
                is_full = demand.capacity > 0 and network.ends[target] >= demand.capacity
                reduced = at + paid + streets.distance[target] - value
                if reduced < best and not is_full:
                    last, goal, best = node, target, reduced
                continue
            there, extra = node_entered(target, i < 0, network)
            if there == NOWHERE or value_of(there, streets, network) >= NOBODY:
                continue
            reduced = at + paid + extra + nodes[there, VALUE] - 1 - value
            if reduced > most:
                is_limited = True
                continue
            if nodes[there, SEARCH] != search:
                network.seen[seen] = there
                seen += 1
            elif nodes[there, REDUCED] <= reduced:
                continue
            mark(there, search, reduced, node, target, network)
            if reduced == at:
                network.level[waiting] = there
                waiting += 1
            else:
                push_key(heap, keys, reduced << 32 | there)
                keys += 1
    return LanePath(last, goal, best, seen, is_limited)


@HELPER
def _raise_values(path, network):
    """Let the values of all nodes that a search has seen rise to what it has found out."""
    for i in range(path.seen):
        node = network.seen[i]
        value, reduced = np.int64(network.node[node, VALUE]), network.node[node, REDUCED]
        if path.last < 0 and not path.is_limited:
            network.node[node, VALUE] = NOBODY + 1
        elif reduced < path.reduced:
            network.node[node, VALUE] = min(value + path.reduced - reduced, NOBODY + 1)


@HELPER
def _expect(catchment, demand, distance):
    """Fill when each robot of a catchment, the farthest first, would be there if all took turns in its lanes.

    That is without any detours.
    """
    if demand.price < 0:
        return
    lanes, end = demand.found[catchment], demand.first[catchment + 1]
    for i in range(end - 1, demand.first[catchment] - 1, -1):
        demand.due[i] = distance[demand.starts[i]]
        if i + lanes < end:
            demand.due[i] = max(demand.due[i], demand.due[i + lanes] + demand.price)


@kernel(types.void(STREETS, NETWORK))
def close_borders(streets, network):
    """Let no lane pass a lattice vertex that robots of two catchments can pass.

    What a search of one learns about it would be wrong for the other.
    """
    size = len(streets.moves)
    for vertex in range(size if len(network.node) > size else 0):
        own = NOWHERE
        for i in range(len(streets.ring)):
            site = vertex + streets.ring[i]
            if not 0 <= site < size or not streets.moves[site] & streets.via[i]:
                continue
            if own >= 0 and streets.catchment[site] != own:
                network.node[size + vertex, VALUE] = NOBODY + 1
            own = np.int64(streets.catchment[site])


@HELPER
def _follow(robot, state, demand):
    """Go on to the catchment of a robot."""
    while robot >= demand.first[state[CATCHMENT] + 1]:
        state[CATCHMENT] += 1
        state[FAILED] = 0


@kernel(types.boolean(DEMAND, STREETS, NETWORK, OUT_I64, OUT_I64, types.int64))
def link(demand, streets, network, heap, state, budget):
    """Find lanes in turn until about `budget` nodes have been visited, or there is nothing left to try.

    Returns whether the heap is too small to go on.
    """
    done = state[VISITED] + budget
    while state[TRIED] < len(demand.starts) and state[FOUND] < demand.most_lanes and state[VISITED] < done:
        robot = state[TRIED]
        _follow(robot, state, demand)
        end = demand.first[state[CATCHMENT] + 1]
        if state[FAILED] >= demand.patience or state[VISITED] * len(demand.starts) >= demand.most_visits * end:
            state[TRIED] = end
            continue
        state[TRIED] += 1
        state[FAILED] += 1
        start = np.int64(demand.starts[robot])
        before = np.int64(network.node[start, BEFORE])
        if before == BEGIN:
            continue
        root = before - 1 if before > 0 else start  # the lane that passes here goes elsewhere
        most = demand.due[robot] - value_of(root, streets, network) + (network.node[start, PAID] if before > 0 else 0)
        if most < 0:
            continue
        path = _search(root, start, most, state[TRIED], demand, streets, network, heap)
        if path.seen < 0:
            state[TRIED] -= 1
            state[FAILED] -= 1
            return True
        state[VISITED] += path.seen
        _raise_values(path, network)
        if path.last >= 0:
            change_lanes(path, streets, network)
            network.ends[path.goal] += 1
            state[FOUND] += 1
            state[FAILED] = 0
            demand.found[state[CATCHMENT]] += 1
            _expect(state[CATCHMENT], demand, streets.distance)
    return False
