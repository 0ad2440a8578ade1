"""Robots that descend a field: region by region, a block of steps in each.

A *region* is what leads to the same few destinations. Robots keep to their region, so that one region after the other
can be simulated, many steps at a time: what its robots look at stays in the cache, which makes a step three times as
fast as in a sweep over all robots. All that regions share are lattice vertices at their borders: for each of these it
is kept in which steps of the block it has been passed, one bit each.

Who waits behind others that wait *sleeps*: nobody asks it until one of the cells it waits for is left. So standing
queues cost nothing but the moves of those who move up.

Sites are made unsigned before they index an array, or numba would test each for being negative; no array goes to a
helper that is called for each robot, because its references would be counted. Each made a step a fifth faster.
"""

import numpy as np
from numba import njit, types
from numba.cpython.unsafe.numbers import trailing_zeros

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import IN_I32, IN_I64, OUT_I32, OUT_I64, OUT_U8, OUT_U16

# Flags of a site above its direction bits.
DIRECTIONS = (1 << 12) - 1
OCCUPIED = 1 << 12
WATCHED = 1 << 13  # somebody may wait for it
CHECKED = 1 << 14  # its directions lead to its own region only
DESTINATION = 1 << 15
# Tables of moves have a row of 16 for each parity of sites.
ROW = 4
_NOBODY = 1 << 40
_U = np.uint64


@njit(nogil=True)
def _find_region(site, cells, offset, region):
    """Fill and return the region of a site: that of the destination at the end of its first best directions."""
    at = site
    while region[_U(at)] == 0:
        at += offset[_U((at & 1) << ROW | trailing_zeros(cells[_U(at)]))]
    found = region[_U(at)]
    at = site
    while region[_U(at)] == 0:
        region[_U(at)] = found
        at += offset[_U((at & 1) << ROW | trailing_zeros(cells[_U(at)]))]
    return found


@njit(types.void(OUT_I32, OUT_U16, IN_I32, OUT_I32, OUT_I32), cache=True, nogil=True)
def find_regions(starts, cells, offset, region, region_of_robot):
    """Fill the region of each start; ``region[site]`` is known (above 0) of destinations, elsewhere 0 at first."""
    for robot in range(len(starts)):
        region_of_robot[robot] = _find_region(np.int64(starts[robot]), cells, offset, region)


@njit(nogil=True)
def _check(site, own, cells, offset, region):
    """Leave of the best directions of a site those that lead to its own region, as the first does; return its flags."""
    here = cells[_U(site)]
    region[_U(site)] = own
    untried = here & DIRECTIONS
    untried &= untried - np.uint16(1)
    while untried:
        k = np.int64(trailing_zeros(untried))
        untried &= untried - np.uint16(1)
        if _find_region(site + offset[_U((site & 1) << ROW | k)], cells, offset, region) != own:
            here &= ~np.uint16(1 << k)
    here |= CHECKED
    cells[_U(site)] = here
    return here


@njit(nogil=True)
def _has_passed(steps, block, s):
    """Whether step `s` of the block is one of the steps in which a vertex was passed."""
    return steps >> 32 == block and (steps >> s) & 1 != 0


@njit(nogil=True)
def _with_step(steps, block, s, via):
    """Return the steps in which vertex `via` was passed, now step `s` as well; of vertex 0, which is none, nothing."""
    if via == 0:
        return 0
    return (steps if steps >> 32 == block else block << 32) | 1 << s


@njit(nogil=True)
def _move_up(
    hole,
    block,
    s,
    steps,
    first_row,
    moves,
    tables,
    cells,
    robot_at,
    passed,
    site,
    first_way,
    acted,
    asked,
    coming,
    actions,
):
    """Let robots move up: one into the hole, then one into the place that it has left, as long as somebody waits there.

    Of those that have not moved in this step the first one goes, if the cell is one of its best and any of them waits,
    be it asleep or since it was asked in this step. Return how many have moved.
    """
    offset, vertex, back = tables
    count, first_vertex_move = moves
    moved = 0
    while True:
        parity = (hole & 1) << ROW
        taker, taken, via, start = np.int64(_NOBODY), np.int64(0), 0, 0
        candidates, waiting = 0, 0
        for j in range(count):
            beside = hole + offset[_U(parity | j)]
            flags = np.int64(cells[_U(beside)])
            k = np.int64(back[_U(parity | j)])
            if not (flags >> k) & (flags >> 12) & (flags >> 14) & 1:  # its way leads here, occupied, checked
                continue
            i = np.int64(robot_at[_U(beside)])
            if acted[_U(i)] == s:
                continue
            waits = 1 - (asked[_U(i >> 6)] >> (i & 63) & 1)
            candidates += 1
            waiting += waits
            at = (hole + vertex[_U(parity | j)]) * (k >= first_vertex_move)
            if first_vertex_move < count and _has_passed(passed[_U(at)], block, s):
                coming[_U(i >> 6)] |= waits << (i & 63)
            elif i < taker:
                taker, taken, via, start = i, k, at, beside
        if taker == _NOBODY or waiting == 0:
            return moved
        if first_vertex_move < count:
            passed[_U(via)] = _with_step(passed[_U(via)], block, s, via)
        here = cells[_U(hole)]
        cells[_U(hole)] = here | OCCUPIED | (WATCHED if candidates > 1 else 0)
        robot_at[_U(hole)] = taker
        site[_U(taker)] = hole
        first_way[_U(taker)] = trailing_zeros(here)
        acted[_U(taker)] = s
        bit = np.int64(1) << (taker & 63)
        asked[_U(taker >> 6)] &= ~bit
        coming[_U(taker >> 6)] |= bit
        actions[_U((first_row + taker) * steps + s)] = taken
        moved += 1
        hole = start
        flags = np.int64(cells[_U(hole)])
        cells[_U(hole)] = flags & ~(OCCUPIED | WATCHED)
        if not flags & WATCHED:
            return moved


@njit(
    types.void(
        *[IN_I32, IN_I32, IN_I32, types.int64, types.int64, types.int64, types.int64, types.int64, types.int64],
        *[OUT_U16, OUT_I32, OUT_I32, OUT_I64, OUT_I32, OUT_I32],
        *[IN_I64, IN_I64, OUT_I64, OUT_I32, OUT_I32, OUT_U8],
        *[OUT_I32, OUT_U8, OUT_I64, types.int64, OUT_I64],
    ),
    cache=True,
    nogil=True,
)
def descend(
    offset,
    vertex,
    back,
    move_count,
    first_vertex_move,
    capacity,
    block,
    first_step,
    steps,
    cells,
    region_of_site,
    robot_at,
    passed,
    entered_step,
    entered_count,
    regions,
    first_of_region,
    count_of_region,
    listed,
    site_of_robot,
    asleep,
    robot_of_row,
    action_of_row,
    arrival,
    waiting_cost,
    lost,
):
    """Let the robots of `regions` descend for `steps` steps after `first_step`; fill a row of actions for each.

    ``cells[site]`` holds the best directions and the flags of a site. The robots of a region stand in its part of
    `listed`, those that started nearest first; here they are numbered in that order, ``robot_at[site]`` is such a
    number. In that order they are asked. Each takes the first of its best directions that is free; then others move up
    behind it (`_move_up`). Nobody waits for a cell that becomes free in the same step. (Asking who is in the way before
    oneself gives totals 0.02 % less, but then nobody can sleep; letting only those move up that wait already, not
    those that are still to be asked, makes them 0.3 % larger.)

    A robot whose best cells are all occupied sleeps, one that a passed vertex or a full destination holds up is asked
    again in the next step. So of each sleeper all best cells are occupied: whoever leaves one fills it at once, or
    wakes the sleeper.

    A move from `first_vertex_move` on passes a lattice vertex: ``passed`` holds the block in its upper half and the
    steps of the block in its lower. A destination takes `capacity` robots a step (0: any number). The nearest robot of
    all finds its way free unless another has taken it, so in every step something comes nearer.
    `lost` counts what waiting costs.
    """
    forbids = first_vertex_move < move_count
    most = 0
    for region in regions:
        most = max(most, count_of_region[region])
    # Of each robot of the region where it is, the first of its best directions, and the step in which it moved last;
    # and in bits who is still to be asked in this step, and who in the next.
    site = np.empty(most, np.int32)
    first_way = np.empty(most, np.uint8)
    acted = np.empty(most, np.int8)
    asked = np.zeros((most >> 6) + 1, np.int64)
    coming = np.zeros((most >> 6) + 1, np.int64)
    first_row = 0
    waits = 0
    for region in regions:
        first, count = first_of_region[region], count_of_region[region]
        words = (count + 63) >> 6
        asked[:words] = 0
        coming[:words] = 0
        for i in range(count):
            robot = listed[first + i]
            robot_of_row[first_row + i] = robot
            at = np.int64(site_of_robot[robot])
            here = cells[at]
            if not here & CHECKED:
                here = _check(at, region + 1, cells, offset, region_of_site)
            robot_at[at] = i
            site[i] = at
            first_way[i] = trailing_zeros(here)
            acted[i] = -1
            asked[i >> 6] |= np.int64(1 - asleep[robot]) << (i & 63)
        action_of_row[first_row * steps : (first_row + count) * steps] = WAIT
        going = count
        for s in range(steps):
            step = first_step + s + 1
            waits += going
            for w in range(words):
                word = asked[_U(w)]
                again = np.int64(0)
                while word:
                    bit = word & -word
                    word ^= bit
                    i = w << 6 | trailing_zeros(bit)
                    at = np.int64(site[_U(i)])
                    parity = (at & 1) << ROW
                    here = cells[_U(at)]
                    k = np.int64(first_way[_U(i)])
                    to = at + offset[_U(parity | k)]
                    there = cells[_U(to)]
                    via = (at + vertex[_U(parity | k)]) * (k >= first_vertex_move)
                    is_free = not there & OCCUPIED
                    if forbids:
                        is_free &= not _has_passed(passed[_U(via)], block, s)
                    if capacity > 0:
                        is_free &= entered_step[_U(to)] != step or entered_count[_U(to)] < capacity
                    untried = here & DIRECTIONS
                    sleeps = True
                    while untried and not is_free:
                        k = np.int64(trailing_zeros(untried))
                        untried &= untried - np.uint16(1)
                        to = at + offset[_U(parity | k)]
                        there = cells[_U(to)]
                        via = (at + vertex[_U(parity | k)]) * (k >= first_vertex_move)
                        if there & OCCUPIED:
                            cells[_U(to)] = there | WATCHED
                            continue
                        is_free = not forbids or not _has_passed(passed[_U(via)], block, s)
                        if capacity > 0:
                            is_free &= entered_step[_U(to)] != step or entered_count[_U(to)] < capacity
                        sleeps = False
                    if not is_free:
                        again |= bit * (not sleeps)
                        continue
                    waits -= 1
                    acted[_U(i)] = s
                    action_of_row[_U((first_row + i) * steps + s)] = k
                    if forbids:
                        passed[_U(via)] = _with_step(passed[_U(via)], block, s, via)
                    cells[_U(at)] = here & ~np.uint16(OCCUPIED | WATCHED)
                    if there & DESTINATION:
                        arrival[_U(listed[_U(first + i)])] = step
                        site[_U(i)] = 0
                        going -= 1
                        if capacity > 0:
                            entered_count[_U(to)] = 1 + entered_count[_U(to)] * (entered_step[_U(to)] == step)
                            entered_step[_U(to)] = step
                    else:
                        if not there & CHECKED:
                            there = _check(to, region + 1, cells, offset, region_of_site)
                        cells[_U(to)] = there | OCCUPIED
                        robot_at[_U(to)] = i
                        site[_U(i)] = to
                        first_way[_U(i)] = trailing_zeros(there)
                        again |= bit
                    if here & WATCHED:
                        asked[_U(w)] = word
                        waits -= _move_up(
                            *(at, block, s, steps, first_row, (move_count, first_vertex_move), (offset, vertex, back)),
                            *(cells, robot_at, passed, site, first_way, acted, asked, coming, action_of_row),
                        )
                        word = asked[_U(w)]
                asked[_U(w)] = 0
                coming[_U(w)] |= again
            asked, coming = coming, asked
        kept = first
        for i in range(count):
            robot = listed[first + i]
            site_of_robot[robot] = site[i]
            asleep[robot] = 1 - (asked[i >> 6] >> (i & 63) & 1)
            listed[kept] = robot
            kept += site[i] > 0
        count_of_region[region] = kept - first
        first_row += count
    lost[0] += waits * waiting_cost
