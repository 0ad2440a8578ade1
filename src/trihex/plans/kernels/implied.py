"""Implied dependencies: those that others enforce already, found by looking for another way round."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_I64, OUT_BOOL, OUT_I64, declared, kernel


class Waiting(NamedTuple):
    """What each move waits for, as in `Dependencies`; a move has the number of the waypoint to which it leads."""

    first: IN_I64  # move w waits by the dependencies first[w] .. first[w + 1] - 1, and for move w - 1 of its robot
    earlier: IN_I64  # of each dependency the waypoint that must have been reached
    start: IN_I64  # of each waypoint that with which its robot starts
    moment: IN_I64  # of each waypoint; it never falls from a move to one that waits for it
    kept: OUT_BOOL  # of each dependency: whether it is not known to be implied
    seen: OUT_I64  # scratch, of each waypoint: the last dependency for which it was looked at
    stack: OUT_I64  # scratch, of each waypoint


@HELPER
def _push(waypoint, wanted, edge, height, waiting):
    """Put a waypoint on the stack if it may come after `wanted` and is new; return the height of the stack."""
    if waypoint > waiting.start[waypoint] and waiting.moment[waypoint] >= waiting.moment[wanted]:
        if waiting.seen[waypoint] != edge:
            waiting.seen[waypoint] = edge
            waiting.stack[height] = waypoint
            return height + 1
    return height


@HELPER
def _look_around(waypoint, edge, waiting):
    """Return how many waypoints were looked at, negative if the other dependencies do not enforce this one."""
    wanted = waiting.earlier[edge]
    height = 0
    at = waypoint
    looked = 0
    while True:
        looked += 1
        height = _push(at - 1, wanted, edge, height, waiting)
        for other in range(waiting.first[at], waiting.first[at + 1]):
            if waiting.kept[other] and other != edge:
                height = _push(waiting.earlier[other], wanted, edge, height, waiting)
        if height == 0:
            return -looked
        height -= 1
        at = waiting.stack[height]
        if at >= wanted and waiting.start[at] == waiting.start[wanted]:
            return looked


@kernel(types.int64(declared(Waiting), types.int64, types.int64))
def drop_implied(waiting, waypoint, budget):
    """Drop what is implied by what is kept, from `waypoint` on until the budget is spent; return the next waypoint.

    Each is dropped while all others still hold, so what is left enforces the same, even where rings wait in circles.
    """
    while waypoint < len(waiting.first) - 1 and budget > 0:
        for edge in range(waiting.first[waypoint], waiting.first[waypoint + 1]):
            looked = _look_around(waypoint, edge, waiting)
            waiting.kept[edge] = looked < 0
            budget -= abs(looked)
        budget -= 1
        waypoint += 1
    return waypoint
