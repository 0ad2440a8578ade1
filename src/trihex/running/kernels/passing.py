"""Order of passing: the moves of a plan laid out, and which of them may be made in a step."""

from numba import njit, types

from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, IN_U8, OUT_BOOL, OUT_I32, OUT_I64, TABLE_I32


@njit(
    types.void(
        IN_I32, IN_U8, IN_I64, TABLE_I32, TABLE_I32, types.int64, IN_I64, OUT_I64, OUT_I32, OUT_I32, OUT_I32
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def lay_out(start, actions, first_action, offset, vertex, edge_count, first_move, step, here, there, passed):
    """Fill for each move its step, where it comes from and leads to, and the vertex it passes, -1 if none."""
    for robot in range(len(start)):
        site = start[robot]
        move = first_move[robot]
        for i in range(first_action[robot], first_action[robot + 1]):
            action = actions[i]
            if action == WAIT:
                continue
            step[move] = i - first_action[robot] + 1
            here[move] = site
            passed[move] = -1
            if action >= edge_count:
                passed[move] = site + vertex[site & 1, action]
            site += offset[site & 1, action]
            there[move] = site
            move += 1


@njit(
    types.int64(IN_I64, IN_I64, IN_I64, IN_I64, IN_I64, IN_I64, IN_I64, IN_BOOL, OUT_I64, OUT_BOOL),
    cache=True,
    nogil=True,
)
def choose(last_move, owner, leaves_before, enters_after, vertex_before, entry_before, at, is_late, stack, moves):
    """Set who may make its next move now; return how many.

    ``at[robot]`` is its next move. First all that are not late and whose strict predecessors are done; then those are
    held back who would enter a cell that is not left, and those behind them. Rings of robots turn together.
    """
    held = 0
    for robot in range(len(at)):
        move = at[robot]
        moves[robot] = move < last_move[robot]
        if not moves[robot]:
            continue
        is_held = is_late[robot]
        for before in (vertex_before[move], entry_before[move]):
            is_held |= before >= 0 and before >= at[owner[before]]
        if is_held:
            moves[robot] = False
            stack[held] = robot
            held += 1
    for robot in range(len(at)):
        if moves[robot]:
            before = leaves_before[at[robot]]
            # The robot before it has not come as far as to leave with its next move.
            if before > at[owner[before]] and before >= 0:
                moves[robot] = False
                stack[held] = robot
                held += 1
    while held > 0:
        held -= 1
        behind = enters_after[at[stack[held]]]
        if behind >= 0 and at[owner[behind]] == behind and moves[owner[behind]]:
            moves[owner[behind]] = False
            stack[held] = owner[behind]
            held += 1
    count = 0
    for robot in range(len(at)):
        count += moves[robot]
    return count
