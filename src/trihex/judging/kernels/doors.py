"""Doors as the judge knows them: how many robots a schedule lets into a cell in a step.

Nothing in this folder is shared with the kernels that planners use: a fault in theirs must show.
"""

from typing import NamedTuple

import numpy as np

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, OUT_I32, declared


class GuardedCells(NamedTuple):
    """The cells with a schedule; up to step t ``(rate * t + phase) // period`` robots may have come into each."""

    place: IN_I32  # of each site: which of them it is, -1: none; empty where there are none
    rate: IN_I64
    period: IN_I64
    phase: IN_I64
    step: OUT_I32  # of a destination: when somebody entered it last
    count: OUT_I32  # and how many in that step


GUARDED_CELLS = declared(GuardedCells)


@HELPER
def _room(place, step, cells):
    """Return how many robots a cell lets in in a step."""
    rate, period, phase = cells.rate[place], cells.period[place], cells.phase[place]
    return (rate * step + phase) // period - (rate * (step - 1) + phase) // period


@HELPER
def is_shut(site, step, cells):
    """Tell whether a cell lets nobody in in a step."""
    return len(cells.place) > 0 and cells.place[site] >= 0 and _room(np.int64(cells.place[site]), step, cells) == 0


@HELPER
def enters_in_vain(site, step, cells):
    """Count a robot that enters a destination in a step; tell whether it is one more than the schedule lets in."""
    if len(cells.place) == 0 or cells.place[site] < 0:
        return False
    place = np.int64(cells.place[site])
    if cells.step[place] != step:
        cells.step[place], cells.count[place] = step, 0
    cells.count[place] += 1
    return cells.count[place] > _room(place, step, cells)
