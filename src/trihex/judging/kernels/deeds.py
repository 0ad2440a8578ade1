"""Deeds: what the robots of a plan do, and where it leads them."""

from typing import NamedTuple

import numpy as np

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.prefetch import prefetch
from trihex.kernels.signatures import APART, HELPER, IN_I32, IN_I64, IN_U8, declared

NO_VERTEX = np.int64(-1)

# Indices that are never counted from the end: numba would ask each whether it is negative, which takes a twelfth.
_U = np.uint64


class Deeds(NamedTuple):
    """Actions of a plan, one robot after the other."""

    action: IN_U8  # a direction, `WAIT` or `JUMP`
    first: IN_I64  # robot r has the actions first[r] .. first[r + 1] - 1
    jump_at: IN_I64  # which of the actions are jumps, ascending
    jump_to: IN_I32  # the sites to which they lead


class Deed(NamedTuple):
    """What one robot does in one step."""

    robot: np.int64
    step: np.int64
    action: np.int64  # a direction, `WAIT` or `JUMP`
    here: np.int64  # the site that it leaves
    target: np.int64  # the site that it comes to, the same if it waits
    vertex: np.int64  # the lattice vertex that it passes, or `NO_VERTEX`
    onto: np.int64  # what lies at `target`, and who came there last: its entry of `place`


DEEDS = declared(Deeds)


@APART
def _end_of_jump(i, deeds):
    low, high = 0, len(deeds.jump_at)
    while low < high:
        middle = (low + high) // 2
        if deeds.jump_at[middle] < i:
            low = middle + 1
        else:
            high = middle
    return np.int64(deeds.jump_to[low])


@HELPER
def deed_of(robot, step, here, place, law, deeds):
    """Return what a robot that stands at `here` does in this step, where each action lasts one."""
    return deed_at(deeds.first[_U(robot)] + step - 1, robot, step, here, place, law, deeds)


@HELPER
def deed_at(i, robot, step, here, place, law, deeds):
    """Return what action `i` does, the one by which a robot leaves `here` in this step."""
    action = np.int64(deeds.action[_U(i)])
    target, vertex = here, NO_VERTEX
    if action == JUMP:
        target = _end_of_jump(i, deeds)
    elif action != WAIT:
        target = here + law.offset[_U(here & 1), _U(action)]
        if action >= law.edge_count:
            vertex = here + law.vertex[_U(here & 1), _U(action)]
    return Deed(robot, step, action, here, target, vertex, np.int64(place[_U(target)]))


@HELPER
def prefetch_deed(robot, step, robots, places, law, deeds):
    """Ask for the places that a robot will need in this step."""
    action = deeds.action[_U(deeds.first[_U(robot)] + step - 1)]
    if action < JUMP:
        here = robots.site[_U(robot)]
        prefetch(places.place, here + law.offset[_U(here & 1), _U(action)])
        if law.forbids_crossing and action >= law.edge_count:
            prefetch(places.vertex_holder, here + law.vertex[_U(here & 1), _U(action)])
