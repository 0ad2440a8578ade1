"""Robots that descend a field: region by region, a block of steps in each.

Robots keep to their region (`cells`), so that one region after the other can be simulated, many steps at a time: what
its robots look at stays in the cache, which makes a step three times as fast as in a sweep over all robots. All that
regions share are lattice vertices at their borders (`traffic`).

Who waits behind others that wait *sleeps*: nobody asks it until one of the cells it waits for is left. So standing
queues cost nothing but the moves of those who move up.

While a region is simulated its robots go by *rank*, from 0, in the order in which they are asked; ``robot_at[site]`` is
a rank, and means something only where the cell is flagged as occupied.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import (
    APART,
    HELPER,
    IN_I64,
    OUT_I8,
    OUT_I32,
    OUT_I64,
    OUT_U8,
    declared,
    kernel,
)
from trihex.planners.kernels.cells import CELLS, CHECKED, DESTINATION, DIRECTIONS, OCCUPIED, WATCHED, check, may_go
from trihex.planners.kernels.robots import ROBOTS
from trihex.planners.kernels.rows import ROWS
from trihex.planners.kernels.traffic import TRAFFIC, Now, is_full, is_passed, note_entry, note_passing
from trihex.planners.kernels.ways import WAYS, back_of, first_of, neighbour, vertex_of, without_first

# What a robot that has no way does, above all directions.
SLEEP = np.int64(16)
ASK_AGAIN = np.int64(17)
NOBODY = 1 << 40
_U = np.uint64


class Ranks(NamedTuple):
    """The robots of the region under way."""

    site: OUT_I32  # where one is, 0 once it has arrived
    first_way: OUT_U8  # the first of its best directions
    acted: OUT_I8  # the step of the block in which it moved last


class Awake(NamedTuple):
    """Who of the region under way is to be asked, a bit for each rank."""

    asked: OUT_I64  # still to be asked in this step
    coming: OUT_I64  # to be asked in the next


RANKS, AWAKE = declared(Ranks), declared(Awake)


@HELPER
def _is_closed(to, via, ways, traffic, now):
    """Tell whether a vertex has been passed in this step, or as many have entered a destination as may."""
    forbids = ways.first_vertex_move < ways.count
    return (forbids and is_passed(via, traffic, now)) or is_full(to, ways.entry_limit, traffic, now)


@HELPER
def _find_way(rank, at, ways, cells, traffic, ranks, now):
    """Return the first best direction that is free, or `SLEEP` or `ASK_AGAIN`; watch the cells waited for."""
    k = np.int64(ranks.first_way[_U(rank)])
    to = neighbour(at, k, ways)
    if not cells.flags[_U(to)] & OCCUPIED and not _is_closed(to, vertex_of(at, k, ways), ways, traffic, now):
        return k
    otherwise = SLEEP
    untried = np.int64(cells.flags[_U(at)] & DIRECTIONS)
    while untried:
        k = first_of(untried)
        untried = without_first(untried)
        to = neighbour(at, k, ways)
        there = cells.flags[_U(to)]
        if there & OCCUPIED:
            cells.flags[_U(to)] = there | WATCHED
        elif not _is_closed(to, vertex_of(at, k, ways), ways, traffic, now):
            return k
        else:
            otherwise = ASK_AGAIN
    return otherwise


@HELPER
def _stand(rank, at, flags, cells, traffic, ranks):
    """Let a robot stand in a cell that has these flags so far."""
    cells.flags[_U(at)] = flags | OCCUPIED
    traffic.robot_at[_U(at)] = rank
    ranks.site[_U(rank)] = at
    ranks.first_way[_U(rank)] = first_of(flags)


@HELPER
def _enter(rank, to, region, ways, cells, traffic, robots, ranks, now):
    """Let a robot enter a cell, or leave the area by a destination; tell whether it is still there."""
    there = cells.flags[_U(to)]
    if there & DESTINATION:
        robots.arrival[_U(robots.listed[_U(robots.first_of_region[region] + rank)])] = now.step
        ranks.site[_U(rank)] = 0
        note_entry(to, ways.entry_limit, traffic, now)
        return False
    if not there & CHECKED:
        there = check(to, region + 1, cells, ways)
    _stand(rank, to, there, cells, traffic, ranks)
    return True


@HELPER
def _find_taker(hole, ways, cells, traffic, ranks, awake, now):
    """Return who moves into a hole, against which direction from it; how many could, and how many of them wait.

    Those could of whose best cells it is one and who have not moved in this step; they wait if they sleep or have been
    asked in this step. The first one goes. Whom a passed vertex holds up is asked again in the next step.
    """
    taker, against, candidates, waiting = np.int64(NOBODY), np.int64(0), np.int64(0), np.int64(0)
    for j in range(ways.count):
        beside = neighbour(hole, j, ways)
        flags = np.int64(cells.flags[_U(beside)])
        k = back_of(hole, j, ways)
        if not may_go(flags, k):
            continue
        rank = np.int64(traffic.robot_at[_U(beside)])
        if ranks.acted[_U(rank)] == now.s:
            continue
        waits = 1 - (awake.asked[_U(rank >> 6)] >> (rank & 63) & 1)
        candidates += 1
        waiting += waits
        if ways.first_vertex_move < ways.count and is_passed(vertex_of(hole, j, ways), traffic, now):
            awake.coming[_U(rank >> 6)] |= waits << (rank & 63)
        elif rank < taker:
            taker, against = rank, np.int64(j)
    return taker, against, candidates, waiting


@APART
def _move_up(hole, first_row, ways, cells, traffic, rows, ranks, awake, now):
    """Let robots move up: one into the hole, then one into the place that it has left, as long as somebody waits there.

    Return how many have moved.
    """
    moved = 0
    while True:
        taker, against, candidates, waiting = _find_taker(hole, ways, cells, traffic, ranks, awake, now)
        if taker == NOBODY or waiting == 0:
            return moved
        if ways.first_vertex_move < ways.count:
            note_passing(vertex_of(hole, against, ways), traffic, now)
        watched = WATCHED if candidates > 1 else 0
        _stand(taker, hole, np.int64(cells.flags[_U(hole)]) | watched, cells, traffic, ranks)
        ranks.acted[_U(taker)] = now.s
        bit = np.int64(1) << (taker & 63)
        awake.asked[_U(taker >> 6)] &= ~bit
        awake.coming[_U(taker >> 6)] |= bit
        rows.action[_U((first_row + taker) * rows.steps + now.s)] = back_of(hole, against, ways)
        moved += 1
        hole = neighbour(hole, against, ways)
        if not _leave(hole, cells):
            return moved


@HELPER
def _leave(at, cells):
    """Let a cell be empty; tell whether somebody may wait for it."""
    flags = np.int64(cells.flags[_U(at)])
    cells.flags[_U(at)] = flags & ~(OCCUPIED | WATCHED)
    return flags & WATCHED != 0


@HELPER
def _begin(region, first_row, asleep, ways, cells, traffic, robots, rows, ranks, awake):
    """Give each robot of a region a rank and a row, in which it waits so far, and note who is awake."""
    first, count = robots.first_of_region[region], robots.count_of_region[region]
    for word in range((count + 63) >> 6):
        awake.asked[word] = 0
        awake.coming[word] = 0
    for rank in range(count):
        robot = robots.listed[first + rank]
        rows.robot[first_row + rank] = robot
        at = np.int64(robots.site[robot])
        here = cells.flags[at]
        if not here & CHECKED:
            here = check(at, region + 1, cells, ways)
        _stand(rank, at, np.int64(here), cells, traffic, ranks)
        ranks.acted[rank] = -1
        awake.asked[rank >> 6] |= np.int64(1 - asleep[robot]) << (rank & 63)
    for i in range(first_row * rows.steps, (first_row + count) * rows.steps):
        rows.action[i] = WAIT


@HELPER
def _end(region, asleep, robots, ranks, awake):
    """List who has not arrived, and note who sleeps."""
    first = kept = robots.first_of_region[region]
    for rank in range(robots.count_of_region[region]):
        robot = robots.listed[first + rank]
        robots.site[robot] = ranks.site[rank]
        asleep[robot] = 1 - (awake.asked[rank >> 6] >> (rank & 63) & 1)
        robots.listed[kept] = robot
        kept += ranks.site[rank] > 0
    robots.count_of_region[region] = kept - first


@HELPER
def _step(region, first_row, ways, cells, traffic, robots, rows, ranks, awake, now):
    """Ask all of a region who are awake, in order; return how many have moved and how many of them have arrived."""
    moved, arrived = np.int64(0), np.int64(0)
    for word in range((robots.count_of_region[region] + 63) >> 6):
        asked = awake.asked[_U(word)]
        again = np.int64(0)
        while asked:
            bit = asked & -asked
            asked ^= bit
            rank = word << 6 | first_of(bit)
            at = np.int64(ranks.site[_U(rank)])
            k = _find_way(rank, at, ways, cells, traffic, ranks, now)
            if k >= SLEEP:
                again |= bit * (k == ASK_AGAIN)
                continue
            moved += 1
            ranks.acted[_U(rank)] = now.s
            rows.action[_U((first_row + rank) * rows.steps + now.s)] = k
            if ways.first_vertex_move < ways.count:
                note_passing(vertex_of(at, k, ways), traffic, now)
            is_watched = _leave(at, cells)
            is_there = _enter(rank, neighbour(at, k, ways), region, ways, cells, traffic, robots, ranks, now)
            again |= bit * is_there
            arrived += not is_there
            if is_watched:
                awake.asked[_U(word)] = asked
                moved += _move_up(at, first_row, ways, cells, traffic, rows, ranks, awake, now)
                asked = awake.asked[_U(word)]
        awake.asked[_U(word)] = 0
        awake.coming[_U(word)] |= again
    return moved, arrived


@kernel(types.int64(WAYS, CELLS, OUT_U8, RANKS, AWAKE, IN_I64, TRAFFIC, ROBOTS, ROWS))
def descend(ways, cells, asleep, ranks, awake, regions, traffic, robots, rows):
    """Let the robots of some regions descend for a block of steps; fill `rows` and return what they lose by waiting.

    In order of rank those who are awake are asked. Each takes the first of its best directions that is free; then
    others move up behind it. Nobody waits for a cell that becomes free in the same step. (Asking who is in the way
    before oneself gives totals 0.02 % less, but then nobody can sleep; letting only those move up that wait already,
    not those that are still to be asked, makes them 0.3 % larger.)

    A robot whose best cells are all occupied sleeps, one that a passed vertex or a full destination holds up is asked
    again in the next step. So of each sleeper all best cells are occupied: whoever leaves one fills it at once, or
    wakes the sleeper. The nearest robot of all finds its way free unless another has taken it, so in every step
    something comes nearer. ``asleep[robot]`` is kept from block to block; `ranks` and `awake` are scratch, with room
    for all of a region.
    """
    first_row = np.int64(0)  # no literal, for which numba would compile all helpers anew
    waits = np.int64(0)
    for region in regions:
        count = going = robots.count_of_region[region]
        _begin(region, first_row, asleep, ways, cells, traffic, robots, rows, ranks, awake)
        turn = awake
        for s in range(rows.steps):
            now = Now(rows.block, s, rows.first_step + s + 1)
            moved, arrived = _step(region, first_row, ways, cells, traffic, robots, rows, ranks, turn, now)
            waits += going - moved
            going -= arrived
            turn = Awake(turn.coming, turn.asked)
        _end(region, asleep, robots, ranks, turn)
        first_row += count
    return waits * ways.waiting_cost
