"""Traffic: who stands where, and what has been passed and entered in a step."""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, OUT_I32, OUT_I64, declared

_U = np.uint64


class Traffic(NamedTuple):
    """What robots see of each other, by site or lattice vertex."""

    robot_at: OUT_I32  # who stands at a site, 0: nobody; `greedy` leaves there the rank of who stood there last
    passed: OUT_I64  # number of the block in which a vertex was passed last, above 32 bits for the steps of the block
    entered_step: OUT_I32  # when a destination was entered last
    entered_count: OUT_I32  # by how many robots in that step


class Now(NamedTuple):
    """The step under way."""

    block: types.int64  # number of its block, from 1
    s: types.int64  # which step of the block it is, from 0
    step: types.int64  # which step of all, from 1


TRAFFIC = declared(Traffic)


@HELPER
def is_passed(vertex, traffic, now):
    """Tell whether somebody has passed a vertex in this step; nobody ever passes vertex 0."""
    steps = traffic.passed[_U(vertex)]
    return steps >> 32 == now.block and (steps >> now.s) & 1 != 0


@HELPER
def note_passing(vertex, traffic, now):
    """Note that a vertex is passed in this step; of vertex 0, which is none, nothing."""
    steps = traffic.passed[_U(vertex)]
    earlier = steps if steps >> 32 == now.block else now.block << 32
    traffic.passed[_U(vertex)] = earlier | 1 << now.s if vertex else 0


@HELPER
def is_full(destination, limit, traffic, now):
    """Tell whether as many as may have entered a destination in this step; other sites are never entered."""
    return (
        limit > 0
        and traffic.entered_step[_U(destination)] == now.step
        and traffic.entered_count[_U(destination)] >= limit
    )


@HELPER
def note_entry(destination, limit, traffic, now):
    """Note that a robot enters a destination in this step."""
    if limit > 0:
        earlier = traffic.entered_count[_U(destination)] * (traffic.entered_step[_U(destination)] == now.step)
        traffic.entered_count[_U(destination)] = earlier + 1
        traffic.entered_step[_U(destination)] = now.step
