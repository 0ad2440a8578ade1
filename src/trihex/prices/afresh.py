"""Optima made afresh for areas that differ in one cell, where steps cost differently and nothing quicker is at hand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario
from trihex.bounds import make_lower_bound, slot_bound
from trihex.errors import PlanError
from trihex.fields import NScheme, make_n_scheme
from trihex.kernels.codes import NOT_REACHED
from trihex.planners import make_plan
from trihex.plans import Plan


class AfreshVariations:
    """The same of an area as `trihex.optimum.Variations`, in units of time.

    Parameters
    ----------
    plan : Plan
        It must be known to be the best.
    n_scheme : NScheme
    memory_limit : int, optional
    """

    unit = 1
    is_quick = False

    def __init__(self, plan: Plan, n_scheme: NScheme, memory_limit: int | None) -> None:
        self._scenario, self._memory_limit = plan.scenario, memory_limit
        self._total = plan.total_time
        self.robot_count = int(_can_arrive(n_scheme).size)
        self.all_arrive = self.robot_count == plan.scenario.robot_count

    @property
    def area(self) -> Area:
        """The area of the plan."""
        return self._scenario.area

    def check(self, plan: Plan) -> None:
        """Raise PlanError unless the plan is the best, and whole."""
        least = self._least(plan.scenario)
        if plan.total_time != least or plan.arrived.sum() < self.robot_count:
            raise PlanError(f"prices need the best plan: its sum of t_r is {plan.total_time}, the least is {least}")

    def robots_if_opened(self, cells: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return how many robots could arrive if a barrier were opened, for each of them."""
        return np.array([self.robots_if_closed(cell) for cell in cells.tolist()], dtype=np.int64)

    def robots_if_closed(self, cell: int) -> int:
        """Return how many robots could arrive if a cell were closed; of a barrier: opened."""
        scenario = self._changed(np.array([cell]))
        return int(_can_arrive(make_n_scheme(scenario)).size)

    def openings(self, cells: NDArray[np.int64]) -> Iterator[tuple[int, int, int]]:
        """Yield the place of each barrier, and what opening it saves at least and at most: nothing is known of it."""
        for place in range(cells.size):
            yield place, 0, max(1, self._total)

    def saved_if_open(self, cell: int) -> int:
        """Return what opening a barrier saves."""
        scenario = self._changed(np.array([cell]))
        if make_lower_bound(make_n_scheme(scenario)).value >= self._total:
            return 0
        return self._total - self._least(scenario)

    def lost_if_closed(self, cell: int) -> int:
        """Return what closing a free cell costs."""
        return self._least(self._changed(np.array([cell]))) - self._total

    def most_saved_by_door(self, cells: NDArray[np.int64]) -> int:
        """Return what is saved at most if one of the barriers becomes a destination, whichever it is."""
        return self._total - slot_bound(make_n_scheme(self._changed(cells, is_door=True))).value

    def well_bounded_by_door(self, cell: int) -> int:
        """Return the same of one barrier: much less, after some more work."""
        return self._total - make_lower_bound(make_n_scheme(self._changed(np.array([cell]), is_door=True))).value

    def saved_by_door(self, cell: int) -> int:
        """Return what is saved if a barrier becomes a destination."""
        return self._total - self._least(self._changed(np.array([cell]), is_door=True))

    def _changed(self, cells: NDArray[np.int64], *, is_door: bool = False) -> Scenario:
        """Return the scenario with barriers open or a free cell closed; who starts in it is left out."""
        scenario = self._scenario
        barriers = scenario.area.barriers.copy()
        barriers.reshape(-1)[cells] = ~barriers.reshape(-1)[cells]
        area = Area(scenario.area.tessellation, barriers, frame=scenario.area.frame)
        destinations = np.append(scenario.destinations, cells) if is_door else scenario.destinations
        stays = ~np.isin(scenario.robots, cells)
        doors = tuple(replace(door, cells=door.cells[~np.isin(door.cells, cells)]) for door in scenario.doors)
        return replace(
            scenario,
            area=area,
            destinations=destinations,
            robots=scenario.robots[stays],
            start_times=scenario.start_times[stays],
            slowness=scenario.slowness[stays],
            doors=tuple(door for door in doors if door.cells.size),
        )

    def _least(self, scenario: Scenario) -> int:
        plan = make_plan(scenario, "optimal", memory_limit=self._memory_limit)
        if not plan.optimal:
            raise PlanError(
                "prices need optima that are proven, and where waiting costs more than a move, or triangles have "
                "euclidean costs, some are not; choose a smaller waiting_cost or costs='paper'"
            )
        return int(plan.total_time)


def _can_arrive(n_scheme: NScheme) -> NDArray[np.int64]:
    """Return the robots that can arrive."""
    distance = n_scheme.distance_of_cell(n_scheme.scenario.robots)
    return np.flatnonzero(distance != NOT_REACHED)
