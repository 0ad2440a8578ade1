"""The straightest of a robot's cheapest ways that arrive in a given step, past what is reserved, step by step.

A state is a site and the heading with which the robot came there: (parity of the site left) * directions + direction,
or one more before the first move. Of each state in each step the least key is kept, cost first, then the turns.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER, OUT_I32, OUT_I64, OUT_U8, TABLE_I32, declared, kernel
from trihex.planners.kernels.reservations import RESERVED, TERRAIN, is_free, is_open

NOTHING, LIST_FULL = -1, -2
COST_BIT = 32  # a key is cost << COST_BIT | turns


class Layers(NamedTuple):
    """The states that a robot may be in, those of a step after those of the step before."""

    state: OUT_I32  # site * headings + heading
    key: OUT_I64
    parent: OUT_I32  # the state of the step before; -1: none
    action: OUT_U8
    place: OUT_I32  # of each state, where it stands in the lists of this step; -1: it does not


LAYERS = declared(Layers)


@HELPER
def _reach(state, key, parent, action, count, layers):
    """Note that a state is reached in this step, and return how many states there are then."""
    node = np.int64(layers.place[state])
    if node < 0:
        node = count
        layers.state[node] = state
        layers.place[state] = node
        count += 1
    elif layers.key[node] <= key:
        return count
    layers.key[node] = key
    layers.parent[node] = parent
    layers.action[node] = action
    return count


@HELPER
def _leave(node, step, steps, most, turn, terrain, reserved, layers, count):
    """Reach all that a robot can reach in a step from a state and still arrive in time at no more cost than `most`."""
    headings = len(turn)
    site, heading, key = layers.state[node] // headings, layers.state[node] % headings, layers.key[node]
    left, cost = (steps - step) * terrain.most_cost, key >> COST_BIT
    if step < steps and is_free(site, step - 1, terrain, reserved):
        if cost + terrain.waiting_cost + terrain.distance[site] <= most and terrain.distance[site] <= left:
            paid = key + (np.int64(terrain.waiting_cost) << COST_BIT)
            count = _reach(np.int64(site) * headings + heading, paid, node, np.int64(WAIT), count, layers)
    for k in range(len(terrain.cost)):
        target = np.int64(site) + terrain.offset[site & 1, k]
        ahead = np.int64(terrain.distance[target])
        if not terrain.moves[site] >> k & 1 or (ahead == 0) != (step == steps) or ahead > left:
            continue
        if cost + terrain.cost[k] + ahead > most or not is_open(site, k, step - 1, terrain, reserved):
            continue
        came = (site & 1) * len(terrain.cost) + k
        paid = key + (np.int64(terrain.cost[k]) << COST_BIT) + turn[heading, came]
        count = _reach(target * headings + came, paid, node, k, count, layers)
    return count


@HELPER
def _trace(first, last, layers, actions):
    """Fill the actions that lead to the least of the last states, and return its key."""
    best = np.int64(first)
    for i in range(first, last):
        if layers.key[i] < layers.key[best]:
            best = np.int64(i)
    key, node = layers.key[best], best
    for i in range(len(actions) - 1, -1, -1):
        actions[i] = layers.action[node]
        node = np.int64(layers.parent[node])
    return key


@kernel(types.int64(types.int64, types.int64, types.int64, TERRAIN, RESERVED, TABLE_I32, LAYERS, OUT_U8))
def straighten_way(start, start_time, most, terrain, reserved, turn, layers, actions):
    """Fill `actions` with the straightest of the cheapest ways that arrive with the last of them, and return its key.

    No way costs more than `most` or leaves before the start time. `turn` is by how much a robot turns from one heading
    to another. Returns `LIST_FULL` if there are more states than room.
    """
    headings = len(turn)
    layers.state[0], layers.key[0], layers.parent[0] = start * headings + headings - 1, 0, -1
    first, last = 0, 1
    steps = len(actions)
    for step in range(1, steps + 1):
        count = last
        for node in range(first, last):
            if count + len(terrain.cost) + 1 > len(layers.state):
                break
            if step <= start_time:
                paid = layers.key[node] + (np.int64(terrain.waiting_cost) << COST_BIT)
                count = _reach(np.int64(layers.state[node]), paid, node, np.int64(WAIT), count, layers)
                continue
            count = _leave(node, step, steps, most, turn, terrain, reserved, layers, count)
        is_full = count + len(terrain.cost) + 1 > len(layers.state)
        for node in range(last, count):
            layers.place[layers.state[node]] = -1
        if is_full:
            return LIST_FULL
        if count == last:
            return NOTHING
        first, last = last, count
    return _trace(first, last, layers, actions)
