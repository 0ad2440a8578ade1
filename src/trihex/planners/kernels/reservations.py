"""Reservations: which site, lattice vertex and destination the ways of robots take in which step.

Row t of a table is step t; beyond the last row nothing is reserved. For each (step, site) there is one byte: 0 if it is
free, 1 + the direction by which a robot came there, or `WAIT` if it waited or starts there.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import (
    HELPER,
    IN_I32,
    IN_U8,
    IN_U16,
    OUT_I32,
    OUT_U8,
    TABLE_I32,
    declared,
    kernel,
)


class Terrain(NamedTuple):
    """What a robot may do in a step, and what it costs."""

    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    vertex: TABLE_I32  # what it adds to get the lattice vertex passed
    back: TABLE_I32  # the direction that leads back
    cost: IN_I32  # of each direction
    moves: IN_U16  # bits of the directions that may be taken from a site
    distance: IN_I32  # of a site, what it costs at least to get to a destination
    gates: IN_I32  # the sites beside destinations
    first_vertex_move: types.int64  # from this direction on, vertices are passed that others may not pass
    waiting_cost: types.int64  # of a step
    least_cost: types.int64  # of any step, a wait or a move
    most_cost: types.int64  # of any move


class Reserved(NamedTuple):
    """The tables of what is taken, row after row."""

    rows: types.int64  # how many steps the tables have
    site: OUT_U8  # rows of all sites: 0, 1 + direction, or `WAIT`
    vertex: OUT_U8  # rows of all vertices: 1 if it is passed (empty where crossing is allowed)
    entries: OUT_I32  # rows of all destinations: how many enter it (empty where any number may)
    number: IN_I32  # of a destination, by site: its place in a row of `entries`
    ends: types.int64  # how many destinations a row of `entries` has
    capacity: types.int64  # how many may enter one destination in a step, 0 for any number


TERRAIN, RESERVED = declared(Terrain), declared(Reserved)


@HELPER
def is_free(site, step, terrain, reserved):
    """Tell whether nobody is at a site after a step."""
    return step >= reserved.rows or reserved.site[step * len(terrain.distance) + site] == 0


@HELPER
def is_open(site, k, step, terrain, reserved):
    """Tell whether a robot may leave `site` by direction `k` so that it is there in `step`."""
    if step >= reserved.rows:
        return True
    row = step * len(terrain.distance)
    side = site & 1
    if k >= terrain.first_vertex_move and reserved.vertex[row + site + terrain.vertex[side, k]]:
        return False
    target = site + terrain.offset[side, k]
    if terrain.distance[target] == 0:
        place = step * reserved.ends
        return reserved.capacity == 0 or reserved.entries[place + reserved.number[target]] < reserved.capacity
    if reserved.site[row + target]:
        return False
    return reserved.site[row + site] != 1 + terrain.back[side, k]  # nobody comes the other way


@HELPER
def _is_way_in(site, step, terrain, reserved):
    """Tell whether a robot may enter a destination in `step` from a site beside it."""
    for k in range(len(terrain.cost)):
        target = site + terrain.offset[site & 1, k]
        if terrain.distance[target] == 0 and is_open(site, k, step, terrain, reserved):
            return True
    return False


@HELPER
def find_first_entry(step, terrain, reserved):
    """Return the first step from `step` on in which a destination can be entered from one of the gates."""
    while step < reserved.rows:
        for i in range(len(terrain.gates)):
            site = np.int64(terrain.gates[i])
            if (step == 0 or is_free(site, step - 1, terrain, reserved)) and _is_way_in(site, step, terrain, reserved):
                return step
        step += 1
    return step


@kernel(types.void(types.int64, IN_U8, TERRAIN, RESERVED))
def reserve(start, actions, terrain, reserved):
    """Reserve a way. The tables have a row for each of its steps."""
    size = len(terrain.distance)
    site = start
    reserved.site[site] = WAIT
    for i in range(len(actions)):
        step = i + 1
        k = np.int64(actions[i])
        if k == WAIT:
            reserved.site[step * size + site] = WAIT
            continue
        if k >= terrain.first_vertex_move:
            reserved.vertex[step * size + site + terrain.vertex[site & 1, k]] = 1
        site += terrain.offset[site & 1, k]
        if terrain.distance[site] > 0:
            reserved.site[step * size + site] = 1 + k
        elif reserved.capacity > 0:
            reserved.entries[step * reserved.ends + reserved.number[site]] += 1


@kernel(types.void(types.int64, IN_U8, TERRAIN, RESERVED))
def unreserve(start, actions, terrain, reserved):
    """Free what `reserve` took for a way."""
    size = len(terrain.distance)
    site = start
    reserved.site[site] = 0
    for i in range(len(actions)):
        row = (i + 1) * size
        k = np.int64(actions[i])
        if k != WAIT:
            if k >= terrain.first_vertex_move:
                reserved.vertex[row + site + terrain.vertex[site & 1, k]] = 0
            site += terrain.offset[site & 1, k]
        if terrain.distance[site] > 0:
            reserved.site[row + site] = 0
        elif reserved.capacity > 0:
            reserved.entries[(i + 1) * reserved.ends + reserved.number[site]] -= 1
