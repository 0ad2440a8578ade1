"""A robot's cheapest way in space and time past what is reserved, by A*.

A search keeps its nodes (step, site) in a list, found again by hashing, and the open ones in a heap.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, IN_BOOL, OUT_I32, OUT_I64, OUT_U8, declared, kernel
from trihex.planners.kernels.estimates import ESTIMATES, MOST_MORE, least_left
from trihex.planners.kernels.heap import HEAP, drop_first, push
from trihex.planners.kernels.reservations import RESERVED, TERRAIN, find_first_entry, is_free, is_open

FOUND, NOTHING, BUDGET_SPENT, LIST_FULL = 0, 1, 2, 3
# Entries of the state of a search: how many nodes there are, how many entries of the heap (0: none is under way), the
# last node of the way that was found, the first step in which it may arrive.
NODES, OPEN, GOAL, EARLIEST = range(4)
STATE_SIZE = 4
_NEW = -1  # in the hash table: no node


class SpaceTime(NamedTuple):
    """The nodes of a search, each a site and a step."""

    site: OUT_I32
    step: OUT_I32
    parent: OUT_I32  # the node before; -1: none
    action: OUT_U8  # what leads here from the node before, a direction or `WAIT`
    cost: OUT_I64  # the least known to get here
    place: OUT_I32  # where in the hash table it stands
    table: OUT_I32  # hash table of nodes, -1 for none; its size is a power of two


SPACE_TIME = declared(SpaceTime)


@HELPER
def _find_place(site, step, nodes):
    """Return where in the hash table a node stands, or would."""
    mask = len(nodes.table) - 1
    mixed = np.uint64(site) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(step) * np.uint64(0xC2B2AE3D27D4EB4F)
    place = np.int64(mixed >> np.uint64(33)) & mask
    while True:
        node = nodes.table[place]
        if node == _NEW or (nodes.site[node] == site and nodes.step[node] == step):
            return place
        place = (place + 1) & mask


@HELPER
def _add(site, step, place, nodes, state):
    """Add a node, which stands at a place of the hash table from now on, and return its number."""
    new = state[NODES]
    nodes.site[new] = site
    nodes.step[new] = step
    nodes.place[new] = place
    nodes.table[place] = new
    state[NODES] += 1
    return new


@HELPER
def _begin(start, step, terrain, reserved, nodes, heap, state):
    """Begin a search at a site after a step; the nodes of the last one are forgotten."""
    for i in range(state[NODES]):
        nodes.table[nodes.place[i]] = _NEW
    state[NODES] = 0
    first = np.int64(0)
    node = _add(start, step, _find_place(start, step, nodes), nodes, state)
    nodes.parent[node] = -1
    nodes.cost[node] = 0
    push(heap, first, np.int64(terrain.distance[start]), terrain.distance[start], node)
    state[OPEN] = 1
    state[EARLIEST] = find_first_entry(step + terrain.distance[start] // terrain.most_cost, terrain, reserved)


@HELPER
def _reach(parent, action, target, cost, terrain, estimates, nodes, heap, state):
    """Open the node to which an action leads, unless it has been reached at no more than this cost."""
    step = np.int64(nodes.step[parent]) + (1 if action == WAIT else np.int64(terrain.duration[action]))
    place = _find_place(target, step, nodes)
    node = np.int64(nodes.table[place])
    if node == _NEW:
        node = _add(target, step, place, nodes, state)
    elif nodes.cost[node] <= cost:
        return
    nodes.parent[node] = parent
    nodes.action[node] = action
    nodes.cost[node] = cost
    # Nodes of equal promise are taken nearest first, so that a robot whom nobody hinders walks straight on.
    left = least_left(target, step, state[EARLIEST], terrain, estimates)
    push(heap, state[OPEN], cost + left, terrain.distance[target], node)
    state[OPEN] += 1


@HELPER
def _leave(node, terrain, reserved, is_shut, estimates, nodes, heap, state):
    """Open all nodes to which a robot may get from a node: by each direction, and by waiting for a step."""
    site, step, cost = np.int64(nodes.site[node]), np.int64(nodes.step[node]), nodes.cost[node]
    for k in range(len(terrain.cost)):
        target = site + terrain.offset[site & 1, k]
        if not terrain.moves[site] >> k & 1 or (len(is_shut) > 0 and is_shut[target]):
            continue
        if is_open(site, k, step, terrain, reserved):
            _reach(node, k, target, cost + terrain.cost[k], terrain, estimates, nodes, heap, state)
    if is_free(site, step, terrain, reserved):
        _reach(node, np.int64(WAIT), site, cost + terrain.waiting_cost, terrain, estimates, nodes, heap, state)


_SPACE = (TERRAIN, RESERVED, IN_BOOL, ESTIMATES, SPACE_TIME, HEAP, OUT_I64)


@kernel(types.int64(types.int64, types.int64, *_SPACE, types.int64))
def search(start, step, terrain, reserved, is_shut, estimates, nodes, heap, state, budget):
    """Search from a site, or go on if the last search was interrupted; tell whether a way was found, or why not yet.

    The way begins after `step`. At most `budget` nodes are looked at. ``is_shut[site]`` bars a site in all steps
    (empty: none). No way arrives before the first step in which a destination can be entered: behind one that is busy
    until then that spares nearly all nodes (600 robots on one side of 64 x 64 cells: 0.2 s in place of 50).
    """
    if state[OPEN] == 0:
        _begin(start, step, terrain, reserved, nodes, heap, state)
    most = len(terrain.cost) + 1
    while state[OPEN] > 0:
        if budget <= 0:
            return BUDGET_SPENT
        if state[NODES] + most > len(nodes.site) or state[OPEN] + most > len(heap.key):
            return LIST_FULL
        budget -= 1
        promised, node = heap.key[0], np.int64(heap.item[0])
        drop_first(heap, state[OPEN])
        state[OPEN] -= 1
        site = np.int64(nodes.site[node])
        left = least_left(site, np.int64(nodes.step[node]), state[EARLIEST], terrain, estimates)
        if promised > nodes.cost[node] + left:
            continue  # it was reached at less cost since
        if terrain.distance[site] == 0:
            state[GOAL] = node
            state[OPEN] = 0
            return FOUND
        _leave(node, terrain, reserved, is_shut, estimates, nodes, heap, state)
    return NOTHING


@kernel(types.void(TERRAIN, SPACE_TIME, OUT_I64, ESTIMATES))
def learn(terrain, nodes, state, estimates):
    """Learn from a search that has found its way: from a node the rest costs no less than what was left of the whole.

    That stays true while ever more is reserved ("adaptive A*": Koenig and Likhachev, 2005).
    """
    size, total = len(terrain.distance), nodes.cost[state[GOAL]]
    for node in range(state[NODES]):
        site, step = np.int64(nodes.site[node]), np.int64(nodes.step[node])
        more = min(total - nodes.cost[node] - terrain.distance[site], MOST_MORE)
        if step < estimates.rows and more > estimates.learned[step * size + site]:
            estimates.learned[step * size + site] = more


@kernel(types.int64(SPACE_TIME, OUT_I64, OUT_U8))
def write_way(nodes, state, actions):
    """Fill the actions that lead to the goal, from the end of `actions` back, and return their number."""
    node, count = state[GOAL], 0
    while nodes.parent[node] >= 0:
        count += 1
        actions[len(actions) - count] = nodes.action[node]
        node = np.int64(nodes.parent[node])
    return count
