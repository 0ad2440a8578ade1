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
    step: OUT_I64  # of each move
    there: OUT_I32  # the site that it enters
    passed: OUT_I32  # the lattice vertex that it passes, -1 if none that others may not


class Precedence(NamedTuple):
    """What must come before each move, -1 if nothing, as in `PassingOrder`."""

    end: IN_I64  # robot r has moves below end[r]
    owner: IN_I64  # who makes each move
    leaves_before: IN_I64  # the move that leaves the cell, in the same step or earlier
    enters_after: IN_I64  # the move that enters the cell that this one leaves
    vertex_before: IN_I64  # the move that passes the vertex, in an earlier step
    entry_before: IN_I64  # the move that enters the destination, in an earlier step


@kernel(types.void(IN_I32, ACTIONS, TABLE_I32, types.int64, declared(PlanMoves)))
def lay_out(start, actions, vertex, first_vertex_move, moves):
    """Fill the `moves` of robots that begin at the sites `start`."""
    for robot in range(len(start)):
        site = np.int64(start[robot])
        move = moves.first[robot]
        for i in range(actions.first[robot], actions.first[robot + 1]):
            action = actions.action[i]
            if action == WAIT:
                continue
            moves.step[move] = i - actions.first[robot] + 1
            moves.passed[move] = -1
            if action >= first_vertex_move:
                moves.passed[move] = site + vertex[site & 1, action]
            site = site_after(site, i, actions)
            moves.there[move] = site
            move += 1


@HELPER
def _is_done(move, at, order):
    """Tell whether a move has been made, or is none."""
    return move < 0 or move < at[order.owner[move]]


@HELPER
def _is_leaving(move, at, order):
    """Tell whether a move has been made or is its robot's next, or is none."""
    return move < 0 or move <= at[order.owner[move]]


@HELPER
def _hold_back(held, at, order, stack, moves):
    """Hold back, one after the other, who would enter a cell that those on the stack do not leave."""
    while held > 0:
        held -= 1
        behind = order.enters_after[at[stack[held]]]
        if behind >= 0 and at[order.owner[behind]] == behind and moves[order.owner[behind]]:
            moves[order.owner[behind]] = False
            stack[held] = order.owner[behind]
            held += 1


@kernel(types.void(declared(Precedence), IN_I64, IN_BOOL, OUT_I64, OUT_BOOL))
def choose(order, at, is_late, stack, moves):
    """Set who may make its next move now.

    ``at[robot]`` is its next move. First all that are not late and whose strict predecessors are done; then those are
    held back who would enter a cell that is not left, and those behind them. Rings of robots turn together.
    """
    held = np.int64(0)
    for robot in range(len(at)):
        move = at[robot]
        moves[robot] = False
        if move >= order.end[robot]:
            continue
        is_free = _is_done(order.vertex_before[move], at, order) and _is_done(order.entry_before[move], at, order)
        moves[robot] = is_free and not is_late[robot]
        if not moves[robot]:
            stack[held] = robot
            held += 1
    for robot in range(len(at)):
        if moves[robot] and not _is_leaving(order.leaves_before[at[robot]], at, order):
            moves[robot] = False
            stack[held] = robot
            held += 1
    _hold_back(held, at, order, stack, moves)
