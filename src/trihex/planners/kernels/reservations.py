"""Reservations: which site, lattice vertex and destination the ways of robots take in which step.

Beyond the last row nothing is reserved. For each (row, site) there is one byte: 0 if it is free, 1 + the direction by
which a robot comes there, or `WAIT`. Where all moves last one step and others may follow at once, row t is where robots
are after step t. Else tick t has as many rows as say who owns a cell meanwhile: one if whoever moves owns both cells,
two, its halves, if it owns the one that it leaves for the first half of its move, and then the other.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.doors import DOORS, has_doors, is_door_full
from trihex.kernels.signatures import (
    APART,
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
    duration: IN_I32  # of each direction, in steps
    moves: IN_U16  # bits of the directions that may be taken from a site
    distance: IN_I32  # of a site, what it costs at least to get to a destination
    gates: IN_I32  # the sites beside destinations
    first_vertex_move: types.int64  # from this direction on, vertices are passed that others may not pass
    waiting_cost: types.int64  # of a step
    least_cost: types.int64  # of a step of waiting or any move
    most_cost: types.int64  # of a step of any move


class Reserved(NamedTuple):
    """The tables of what is taken, row after row."""

    rows: types.int64  # how many the tables have
    per_tick: types.int64  # how many of them are one tick; 0: where robots are after each step is all there is
    site: OUT_U8  # rows of all sites: 0, 1 + direction, or `WAIT`
    vertex: OUT_U8  # for each step all vertices: 1 if it is passed (empty where crossing is allowed)
    entries: OUT_I32  # rows of all destinations: how many enter it (empty where any number may)
    number: IN_I32  # of a destination, by site: its place in a row of `entries`
    ends: types.int64  # how many destinations a row of `entries` has
    capacity: types.int64  # how many may enter one destination in a step, 0 for any number
    let_in: OUT_I32  # for each step (tick) all destinations: how many have entered (empty where there are no doors)
    doors: DOORS


TERRAIN, RESERVED = declared(Terrain), declared(Reserved)


@HELPER
def _are_free(site, first, last, terrain, reserved):
    """Tell whether nobody owns a site in the rows from `first` to the one before `last`."""
    row, end = first, min(last, reserved.rows)
    while row < end and reserved.site[row * len(terrain.distance) + site] == 0:
        row += 1
    return row >= end


@HELPER
def _is_door_shut(target, end, terrain, reserved):
    """Tell whether a door lets nobody in in step (tick) `end`, or as many as it lets in have come."""
    if not has_doors(reserved.doors):
        return False
    came, place = np.int64(0), end * reserved.ends + reserved.number[target]
    if terrain.distance[target] == 0 and place < len(reserved.let_in):
        came = np.int64(reserved.let_in[place])
    return is_door_full(target, end, came, reserved.doors)


@HELPER
def _note_door(target, end, change, terrain, reserved):
    """Note how many more robots enter a destination in step (tick) `end`."""
    if has_doors(reserved.doors) and terrain.distance[target] == 0:
        reserved.let_in[end * reserved.ends + reserved.number[target]] += change


@HELPER
def is_free(site, begin, terrain, reserved):
    """Tell whether a robot may stay at a site for the step that follows `begin`."""
    first = begin * reserved.per_tick if reserved.per_tick else begin + 1
    return _are_free(site, first, first + max(np.int64(1), reserved.per_tick), terrain, reserved)


@HELPER
def _rows_of_move(k, begin, terrain, reserved):
    """Return the row in which a move begins, until which it owns the cell left, from which on the next, and its end."""
    first, duration = begin * reserved.per_tick, np.int64(terrain.duration[k])
    if reserved.per_tick == 2:
        return first, first + duration, first + duration, first + 2 * duration
    return first, first + duration, first, first + duration


@APART
def _may_own(site, k, begin, terrain, reserved):
    """Tell whether a robot that leaves `site` by direction `k` at tick `begin` may own all that it needs."""
    first, left, entered, end = _rows_of_move(k, begin, terrain, reserved)
    size, side = len(terrain.distance), site & 1
    if not _are_free(site, first, left, terrain, reserved):
        return False
    if k >= terrain.first_vertex_move:
        vertex = site + terrain.vertex[side, k]
        for tick in range(begin, min(begin + terrain.duration[k], reserved.rows // reserved.per_tick)):
            if reserved.vertex[tick * size + vertex]:
                return False
    target = site + terrain.offset[side, k]
    if terrain.distance[target] == 0:
        for row in range(entered, min(end, reserved.rows) if reserved.capacity else entered):
            if reserved.entries[row * reserved.ends + reserved.number[target]] >= reserved.capacity:
                return False
        return True
    if not _are_free(target, entered, end, terrain, reserved):
        return False
    # Nobody comes the other way: such a move can only begin at the same tick.
    return left >= reserved.rows or reserved.site[left * size + site] != 1 + terrain.back[side, k]


@HELPER
def is_open(site, k, begin, terrain, reserved):
    """Tell whether a robot may leave `site` by direction `k` after step `begin`."""
    if _is_door_shut(site + terrain.offset[site & 1, k], begin + terrain.duration[k], terrain, reserved):
        return False
    if reserved.per_tick:
        return _may_own(site, k, begin, terrain, reserved)
    if begin + 1 >= reserved.rows:
        return True
    row = (begin + 1) * len(terrain.distance)
    side = site & 1
    if k >= terrain.first_vertex_move and reserved.vertex[row + site + terrain.vertex[side, k]]:
        return False
    target = site + terrain.offset[side, k]
    if terrain.distance[target] == 0:
        place = (begin + 1) * reserved.ends
        return reserved.capacity == 0 or reserved.entries[place + reserved.number[target]] < reserved.capacity
    if reserved.site[row + target]:
        return False
    return reserved.site[row + site] != 1 + terrain.back[side, k]  # nobody comes the other way


@HELPER
def _is_way_in(site, step, terrain, reserved):
    """Tell whether a robot may enter a destination in `step` from a site beside it."""
    for k in range(len(terrain.cost)):
        target, begin = site + terrain.offset[site & 1, k], step - np.int64(terrain.duration[k])
        is_early = begin < 0 and reserved.per_tick > 0
        if terrain.distance[target] == 0 and not is_early and is_open(site, k, begin, terrain, reserved):
            return True
    return False


@HELPER
def find_first_entry(step, terrain, reserved):
    """Return the first step from `step` on in which a destination can be entered from one of the gates."""
    while step * max(np.int64(1), reserved.per_tick) < reserved.rows:
        for i in range(len(terrain.gates)):
            site = np.int64(terrain.gates[i])
            if reserved.per_tick == 0 and step > 0 and not is_free(site, step - 2, terrain, reserved):
                continue  # somebody is there before that step
            if _is_way_in(site, step, terrain, reserved):
                return step
        step += 1
    return step


@APART
def _own(site, k, begin, terrain, reserved):
    """Reserve a move of direction `k` from `site` at tick `begin`."""
    first, left, entered, end = _rows_of_move(k, begin, terrain, reserved)
    size = len(terrain.distance)
    target = site + terrain.offset[site & 1, k]
    for row in range(first, left):
        reserved.site[row * size + site] = WAIT
    if k >= terrain.first_vertex_move:
        for tick in range(begin, begin + terrain.duration[k]):
            reserved.vertex[tick * size + site + terrain.vertex[site & 1, k]] = 1
    for row in range(entered, end):
        if terrain.distance[target] > 0:
            reserved.site[row * size + target] = 1 + k
        elif reserved.capacity > 0:
            reserved.entries[row * reserved.ends + reserved.number[target]] += 1


@kernel(types.void(types.int64, types.int64, RESERVED, types.int64))
def hold(site, last, reserved, size):
    """Reserve a site up to the row `last`, which the tables have; each of their rows has so many sites."""
    for row in range(last + 1):
        reserved.site[row * size + site] = WAIT


@kernel(types.void(types.int64, IN_U8, TERRAIN, RESERVED))
def reserve_ticks(start, actions, terrain, reserved):
    """Reserve a way where moves last, or nobody follows at once. The tables have rows for each of its ticks."""
    site, tick = start, np.int64(0)
    for i in range(len(actions)):
        k = np.int64(actions[i])
        if k != WAIT:
            _own(site, k, tick, terrain, reserved)
            tick += terrain.duration[k]
            site += terrain.offset[site & 1, k]
            _note_door(site, tick, 1, terrain, reserved)
            continue
        for row in range(tick * reserved.per_tick, (tick + 1) * reserved.per_tick):
            reserved.site[row * len(terrain.distance) + site] = WAIT
        tick += 1


@kernel(types.void(types.int64, IN_U8, TERRAIN, RESERVED))
def reserve(start, actions, terrain, reserved):
    """Reserve a way, step by step. The tables have a row for each of its steps."""
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
        _note_door(site, step, 1, terrain, reserved)
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
            _note_door(site, i + 1, -1, terrain, reserved)
        if terrain.distance[site] > 0:
            reserved.site[row + site] = 0
        elif reserved.capacity > 0:
            reserved.entries[(i + 1) * reserved.ends + reserved.number[site]] -= 1
