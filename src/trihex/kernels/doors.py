"""Doors: when cells may be entered that let robots in by a schedule, see `trihex.areas.Schedule`."""

from typing import NamedTuple

import numpy as np

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, declared

_U = np.uint64


class Doors(NamedTuple):
    """The cells that are doors, and their schedules."""

    number: IN_I32  # of a site: its place in the schedules below, from 1; 0: no door. One entry if there are no doors
    rate: IN_I64  # up to step t so many robots may have entered: (rate * t + phase) // period
    period: IN_I64
    phase: IN_I64


DOORS = declared(Doors)


@HELPER
def has_doors(doors):
    """Tell whether there are any."""
    return len(doors.number) > 1


@HELPER
def is_door_full(site, step, entered, doors):
    """Tell whether nobody may enter a site in a step any more, after so many: never where it is no door."""
    door = np.int64(doors.number[_U(site)]) - 1
    if door < 0:
        return False
    rate, period, phase = doors.rate[_U(door)], doors.period[_U(door)], doors.phase[_U(door)]
    return entered >= (rate * step + phase) // period - (rate * (step - 1) + phase) // period
