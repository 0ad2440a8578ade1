"""Exits: who leaves where, and when; an exit is a zone with a name, or a group of destinations that touch."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Zone, make_regions
from trihex.errors import check_type
from trihex.plans.motion import Motion
from trihex.record import Record, read_only


@dataclass(frozen=True, eq=False)
class Exits(Record):
    """How many robots have left by each exit after each step.

    Attributes
    ----------
    names : tuple of str
        The name of the zone, or where the first cell lies; in the order of first cells.
    cells : tuple of int64 arrays
        The destinations of each exit.
    arrived : int64 array, shape (exits, steps + 1)
        Robots that have arrived there by the end of step 0, 1, ...: N(t) of each exit.
    """

    names: tuple[str, ...]
    cells: tuple[NDArray[np.int64], ...]
    arrived: NDArray[np.int64]

    @property
    def total(self) -> NDArray[np.int64]:
        """N(t) of all exits together, shape (steps + 1,)."""
        return np.asarray(self.arrived.sum(axis=0))


def make_exits(plan: Motion) -> Exits:
    """Return when robots arrive at each exit of a plan or a run.

    Destinations in a zone are one exit, of its name, and so are others that touch; in a run, all cells count that ever
    were destinations.

    Parameters
    ----------
    plan : Plan or Run

    Examples
    --------
    >>> from trihex import Area, Scenario, make_plan
    >>> scenario = Scenario(Area("square", [[0, 0, 0, 0]]), [(0, 0), (3, 0)], [(1, 0), (2, 0)])
    >>> exits = make_exits(make_plan(scenario, "greedy"))
    >>> exits.names, exits.arrived.tolist()
    (('(0, 0)', '(3, 0)'), [[0, 1], [0, 1]])
    """
    check_type("plan", plan, Motion)
    destinations = [plan.scenario.destinations]
    for _, own in plan.worlds():
        if own is not destinations[-1]:
            destinations.append(own)
    steps, mine = plan.arrival_step_of_robot, plan.last_cell_of_robot
    destinations.append(mine[plan.arrived])  # some are open between two events of one step alone, in no world
    exits = exits_among(plan.scenario.area, np.unique(np.concatenate(destinations)))
    arrived = np.zeros((len(exits), plan.steps + 1), dtype=np.int64)
    for exit_number, one in enumerate(exits):
        here = plan.arrived & np.isin(mine, one.cells)
        arrived[exit_number] = np.cumsum(np.bincount(steps[here], minlength=plan.steps + 1))
    return Exits(tuple(one.name for one in exits), tuple(one.cells for one in exits), read_only(arrived))


def exits_among(area: Area, destinations: NDArray[np.int64]) -> list[Zone]:
    """Return exits in the order of their first cells: zones of the area, and groups of other destinations that touch.

    A destination in several zones belongs to the first of them, so that each robot leaves by one exit.
    """
    exits, rest = [], np.unique(destinations)
    for zone in area.zones:
        own = np.intersect1d(rest, zone.cells)
        if own.size:
            exits.append(Zone(zone.name, own))
        rest = np.setdiff1d(rest, own)
    barriers = np.ones(area.cell_count, dtype=bool)
    barriers[rest] = False
    regions = make_regions(replace(area, barriers=barriers.reshape(area.barriers.shape)))
    region = regions.region_of_cell.reshape(-1)
    for number in range(regions.size_of_region.size):
        own = np.flatnonzero(region == number)
        exits.append(Zone(area.place_of_cell(int(own[0])), own))
    return sorted(exits, key=lambda own: int(own.cells[0]))
