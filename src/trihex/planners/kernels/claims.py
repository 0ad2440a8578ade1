"""Claims: which cells, lattice vertices and destinations robots own, and until when, where moves last.

Time runs in ticks; a tick is two *half ticks*, because a robot may own the cell that it leaves for half of its move. A
robot that stands in a cell or enters it is its *owner*; whoever leaves it owns it, too, until a certain half tick.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.doors import DOORS, has_doors, is_door_full
from trihex.kernels.signatures import APART, HELPER, IN_I32, OUT_I32, OUT_I64, declared
from trihex.planners.kernels.slots import SITES, SLOTS
from trihex.planners.kernels.ways import WAYS, neighbour, vertex_of

# Flag of an owner: somebody waits until this cell is left.
AWAITED = 1 << 30
# A tick at which nothing ever happens.
NEVER = np.int64(1 << 30)
# Bits that a vertex has for ticks: one for each of a window and, above, for as long as moves last that begin in it.
BITS = 40
_BITS = np.int64(BITS)
# Ticks ahead for which it is kept how many enter a destination: more than a block and any move last.
AHEAD = np.int64(64)
_U = np.uint64


class Clock(NamedTuple):
    """How long moves last, and who owns a cell meanwhile."""

    duration: IN_I32  # ticks of a move of the fastest in each direction
    slowness: IN_I32  # how many times as long a move of each robot lasts
    window: types.int64  # ticks of a window
    follows: types.int64  # 1 if a robot owns but the half of its move; 0 if nobody may follow before it is over
    shortest: types.int64  # ticks of the shortest move
    headway: types.int64  # how many of the shortest moves there are between two robots that go through one cell


class Claims(NamedTuple):
    """What is owned."""

    owner: OUT_I32  # of a site: who stands there or enters, 0 for nobody; with the flag `AWAITED`
    left_until: OUT_I32  # of a site: the half tick until which somebody owns it who leaves it
    passed: OUT_I64  # of a vertex: the window in which somebody passed it last, above the bits of the ticks
    entered_until: OUT_I32  # of each destination as often as its capacity: until which half tick a robot enters it
    let_in: OUT_I32  # of each destination, where there are doors, `AHEAD` counts of robots that enter in a tick
    let_in_at: OUT_I32  # in which tick that is: tick t has place t % AHEAD


class Stage(NamedTuple):
    """Where robots act."""

    clock: declared(Clock)
    ways: WAYS
    sites: SITES
    slots: SLOTS
    claims: declared(Claims)
    doors: DOORS


CLOCK, CLAIMS, STAGE = declared(Clock), declared(Claims), declared(Stage)


@HELPER
def owner_of(site, claims):
    """Return who stands at a site or enters it, 0: nobody."""
    return np.int64(claims.owner[_U(site)] & (AWAITED - 1))


@HELPER
def duration_of(robot, k, clock):
    """Return how many ticks a move of a robot in direction `k` lasts."""
    return np.int64(clock.duration[_U(k)]) * clock.slowness[_U(robot)]


@HELPER
def _tick_after(half_tick, tick):
    """Return the first tick at or after a half tick, but not before `tick`."""
    return max(tick, (half_tick + 1) >> 1)


@HELPER
def _ticks_passed(vertex, window, stage):
    """Return, as bits from the first tick of a window, when a vertex is owned."""
    word = stage.claims.passed[_U(vertex)]
    gone, ticks = (window - (word >> _BITS)) * stage.clock.window, word & ((1 << _BITS) - 1)
    return ticks >> gone if gone < _BITS else np.int64(0)


@HELPER
def tick_of_leave(robot, to, k, tick, stage):
    """Return from which tick on a robot may take direction `k` into a cell that somebody leaves."""
    owned = np.int64(stage.claims.left_until[_U(to)])
    return _tick_after(owned - stage.clock.follows * duration_of(robot, k, stage.clock), tick)


@HELPER
def _place_at(number, stage):
    """Return which place of a destination's, by its number, is free first."""
    limit = stage.ways.entry_limit
    first = number * limit
    for i in range(number * limit + 1, (number + 1) * limit):
        if stage.claims.entered_until[_U(i)] < stage.claims.entered_until[_U(first)]:
            first = i
    return first


@HELPER
def _count_at(number, tick):
    """Return where it is kept how many enter a destination in a tick."""
    return number * AHEAD + tick % AHEAD


@APART
def _tick_of_door(to, slot, begin, duration, stage):
    """Return the first tick from `begin` on in which a move into a door can begin."""
    claims = stage.claims
    while True:
        end, came = begin + duration, np.int64(0)
        if slot < 0:
            at = _count_at(-1 - slot, end)
            came = np.int64(claims.let_in[at]) * (claims.let_in_at[at] == end)
        if not is_door_full(to, end, came, stage.doors):
            return begin
        begin += 1


@HELPER
def tick_of_opening(robot, site, k, to, slot, tick, stage):
    """Return the tick at which a robot at `site` can begin to move in direction `k`, `NEVER` if nobody knows.

    `slot` is that of the cell `to`, negative for destinations. An opposite move is never under way: whoever makes it
    would have become the owner of `site`.
    """
    clock, claims = stage.clock, stage.claims
    duration = duration_of(robot, k, clock)
    ready = tick
    if slot > 0:
        if owner_of(to, claims):
            return NEVER
        ready = tick_of_leave(robot, to, k, tick, stage)
    elif stage.ways.entry_limit:
        entered_until = np.int64(claims.entered_until[_U(_place_at(-1 - slot, stage))])
        ready = _tick_after(entered_until - clock.follows * duration, tick)
    if k >= stage.ways.first_vertex_move:
        window = tick // clock.window
        ticks = _ticks_passed(vertex_of(site, k, stage.ways), window, stage) >> (tick - window * clock.window)
        if ticks & ((1 << duration) - 1):
            free = tick
            while ticks:
                ticks >>= 1
                free += 1
            ready = max(ready, free)
    if has_doors(stage.doors) and stage.doors.number[_U(to)]:
        ready = _tick_of_door(to, slot, ready, duration, stage)
    return ready


@HELPER
def claim(robot, site, k, slot, tick, stage):
    """Let a robot begin to move: it leaves `site`, passes a vertex and enters a cell, or a destination (slot < 0).

    Return whether somebody waits until `site` is left.
    """
    clock, claims = stage.clock, stage.claims
    duration = duration_of(robot, k, clock)
    is_awaited = claims.owner[_U(site)] & AWAITED != 0
    claims.owner[_U(site)] = 0
    claims.left_until[_U(site)] = 2 * tick + duration * (2 - clock.follows)
    if slot > 0:
        claims.owner[_U(neighbour(site, k, stage.ways))] = robot
    elif stage.ways.entry_limit:
        claims.entered_until[_U(_place_at(-1 - slot, stage))] = 2 * (tick + duration)
    if slot < 0 and has_doors(stage.doors):
        end = tick + duration
        at = _count_at(-1 - slot, end)
        claims.let_in[at] = claims.let_in[at] * (claims.let_in_at[at] == end) + 1
        claims.let_in_at[at] = end
    if k >= stage.ways.first_vertex_move:
        vertex, window = vertex_of(site, k, stage.ways), tick // clock.window
        ticks = _ticks_passed(vertex, window, stage) | ((1 << duration) - 1) << (tick - window * clock.window)
        claims.passed[_U(vertex)] = window << _BITS | ticks
    return is_awaited
