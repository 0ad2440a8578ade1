"""Exits: who leaves where, and when; an exit is a group of destinations that touch."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, make_regions
from trihex.errors import check_type
from trihex.plans.motion import Motion
from trihex.record import Record, read_only


@dataclass(frozen=True, eq=False)
class Exits(Record):
    """How many robots have left by each exit after each step.

    Attributes
    ----------
    names : tuple of str
        Where the first cell of each exit lies, by the number of the cell.
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

    Destinations that touch are one exit; in a run, all cells count that ever were destinations.

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
    cells = exits_among(plan.scenario.area, np.unique(np.concatenate(destinations)))
    steps, mine = plan.arrival_step_of_robot, plan.last_cell_of_robot
    arrived = np.zeros((len(cells), plan.steps + 1), dtype=np.int64)
    for exit_number, own in enumerate(cells):
        here = plan.arrived & np.isin(mine, own)
        arrived[exit_number] = np.cumsum(np.bincount(steps[here], minlength=plan.steps + 1))
    names = tuple(plan.scenario.area.place_of_cell(int(own[0])) for own in cells)
    return Exits(names, tuple(read_only(own) for own in cells), read_only(arrived))


def exits_among(area: Area, destinations: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Return groups of destinations that touch, each ascending, in the order of their first cells."""
    barriers = np.ones(area.cell_count, dtype=bool)
    barriers[destinations] = False
    regions = make_regions(replace(area, barriers=barriers.reshape(area.barriers.shape)))
    region = regions.region_of_cell.reshape(-1)
    groups = [np.flatnonzero(region == number) for number in range(regions.size_of_region.size)]
    return sorted(groups, key=lambda own: int(own[0]))
