"""Order of passing: the moves of a plan laid out, and which of them may be made in a step."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.actions import ACTIONS, site_after
from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import (
    HELPER,
    IN_BOOL,
    IN_I32,
    IN_I64,
    OUT_BOOL,
    OUT_I32,
    OUT_I64,
    TABLE_I32,
    declared,
    kernel,
)


class PlanMoves(NamedTuple):
    """The moves of a plan, robot by robot, waits left out."""

    first: IN_I64  # robot r has the moves first[r] .. first[r + 1] - 1
    begin: OUT_I64  # the tick at which each begins
    there: OUT_I32  # the site that it enters
    passed: OUT_I32  # the lattice vertex that it passes, -1 if none that others may not


class Precedence(NamedTuple):
    """What must come before each move, -1 if nothing, as in `PassingOrder`, and how long moves last."""

    end: IN_I64  # robot r has moves below end[r]
    owner: IN_I64  # who makes each move
    leaves_before: IN_I64  # the move that leaves the cell
    enters_after: IN_I64  # the move that enters the cell that this one leaves
    vertex_before: IN_I64  # the move that passes the vertex
    entry_before: IN_I64  # the move that enters the destination
    lasts: IN_I32  # ticks of each move
    follows: types.int64  # 1 if a robot owns but the half of its move, 0 if nobody may follow before it is over


class Progress(NamedTuple):
    """How far robots have come."""

    tick: types.int64
    at: IN_I64  # the next move of each robot
    due: IN_I64  # the tick at which the one before it ends
    is_late: IN_BOOL  # who cannot begin a move now


@kernel(types.void(IN_I32, ACTIONS, TABLE_I32, types.int64, IN_I32, declared(PlanMoves)))
def lay_out(start, actions, vertex, first_vertex_move, duration, moves):
    """Fill the `moves` of robots that begin at the sites `start`; `duration` is that of each action."""
    for robot in range(len(start)):
        site, tick = np.int64(start[robot]), np.int64(0)
        move = moves.first[robot]
        for i in range(actions.first[robot], actions.first[robot + 1]):
            action = actions.action[i]
            if action == WAIT:
                tick += 1
                continue
            moves.begin[move] = tick
            tick += duration[action]
            moves.passed[move] = -1
            if action >= first_vertex_move:
                moves.passed[move] = site + vertex[site & 1, action]
            site = site_after(site, i, actions)
            moves.there[move] = site
            move += 1


@HELPER
def _half_ticks_left(move, now, order):
    """Return how many half ticks from now on a move that has begun is still under way, 0 if it is over or is none."""
    if move < 0 or move + 1 < now.at[order.owner[move]]:
        return np.int64(0)
    return max(np.int64(0), 2 * (now.due[order.owner[move]] - now.tick))


@HELPER
def _has_begun(move, now, order):
    """Tell whether a move has begun in an earlier tick, or is none."""
    return move < 0 or move < now.at[order.owner[move]]


@HELPER
def _is_free(move, now, order):
    """Tell whether the vertex that a move passes, and the destination that it enters, are left by those before it."""
    vertex, entry = order.vertex_before[move], order.entry_before[move]
    if not _has_begun(vertex, now, order) or not _has_begun(entry, now, order):
        return False
    if _half_ticks_left(vertex, now, order) > 0:
        return False
    return _half_ticks_left(entry, now, order) <= order.follows * order.lasts[move]


@HELPER
def _can_enter(move, now, order, moves):
    """Tell whether who is in the cell that a move enters leaves it in time, if those who may begin now do."""
    before = order.leaves_before[move]
    own = order.follows * order.lasts[move]
    if _has_begun(before, now, order):
        left = _half_ticks_left(before, now, order)
        return left == 0 or left - order.follows * order.lasts[before] <= own
    owner = order.owner[before]
    is_next = before == now.at[owner] and moves[owner]
    return is_next and order.follows == 1 and order.lasts[before] <= own


@HELPER
def _hold_back(held, now, order, stack, moves):
    """Hold back, one after the other, who would enter a cell that those on the stack do not leave."""
    while held > 0:
        held -= 1
        behind = order.enters_after[now.at[stack[held]]]
        if behind >= 0 and now.at[order.owner[behind]] == behind and moves[order.owner[behind]]:
            moves[order.owner[behind]] = False
            stack[held] = order.owner[behind]
            held += 1


@kernel(types.void(declared(Precedence), declared(Progress), OUT_I64, OUT_BOOL))
def choose(order, now, stack, moves):
    """Set who may begin its next move now.

    First all that are at a centre, not late and whose vertex and destination are free; then those are held back who
    would enter a cell that is not left in time, and those behind them. Rings of robots turn together.
    """
    held = np.int64(0)
    for robot in range(len(now.at)):
        move = now.at[robot]
        moves[robot] = False
        if move < order.end[robot]:
            is_able = not now.is_late[robot] and now.due[robot] <= now.tick
            moves[robot] = is_able and _is_free(move, now, order)
    for robot in range(len(now.at)):
        if now.at[robot] < order.end[robot] and not (moves[robot] and _can_enter(now.at[robot], now, order, moves)):
            moves[robot] = False
            stack[held] = robot
            held += 1
    _hold_back(held, now, order, stack, moves)
