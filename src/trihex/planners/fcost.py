"""Planner `fcost`: the paper's planner, which weighs a longer way against waiting."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError, check_choice
from trihex.fields import DScheme, NScheme, make_d_scheme
from trihex.planners.crowd import make_crowd, regions_of, tables_of
from trihex.planners.greedy import run_greedy
from trihex.planners.lanes import make_lanes, price_of_waiting
from trihex.planners.recording import Progress, Recording
from trihex.plans import Arrivals, Plan

RULES = ("best", "paper", "queue", "aside", "lanes")
# Robot-steps up to which "best" tries "lanes" as well, and how many cells times destinations there may be for each of
# them: a search for a lane may visit all cells, once for each way into a destination.
_FEW, _SPARSE = 2_000_000, 32
# Looking for lanes may take about as long as planning does: so many nodes, and one for every fourth robot-step.
_VISITS = 50_000
# Of so many robots and more each looks for a way better than a free one in every fourth step only: half the time, and
# totals 0.2 % larger; in small crowds it would be 1 to 2 %.
_MANY, _PERIOD = 10_000, 4
# Slots beyond the robot of a branch that is farthest at first, for those that detours bring there.
_SPARE = 40


def plan_fcost(n_scheme: NScheme, *, rule: str = "best", progress: Progress | None = None) -> Plan:
    """Plan by the least Fcost = v + V + w_t * c (section IV of the paper), step by step.

    In each step each robot takes the free direction of least Fcost, and waits where the best direction, though taken,
    promises less. Who stands in the way of another is asked before it. Regions are as in `plan_greedy`; under "paper"
    there are none.

    Parameters
    ----------
    n_scheme : NScheme
    rule : {"best", "paper", "queue", "aside", "lanes"}
        What c is. "paper": the number of other robots whose shortest path meets the path that starts with a direction
        (same cell, same step); the first robot of each branch of the D-scheme descends. "queue": the length of the line
        that they have formed when the robot gets there, each place at w_t or the cheapest move, whichever is less; a
        robot that would wait may step to a cell no farther away if that costs no more. "aside": the same, and a blocked
        robot always steps to such a cell unless it has just left it. "lanes": the same, and V is not the least distance
        but that along lanes, as many as there is room for, see `trihex.planners.lanes`. "best": "aside" or greedy
        descent, whichever takes less total time, and "lanes", too, where to look for them takes no longer than to plan.
    progress : callable, optional
        Called with (robots arrived, robots that can arrive), of one rule after the other.
    """
    return _run(n_scheme, rule, True, progress).make_plan("fcost")


def arrivals_fcost(n_scheme: NScheme, *, rule: str = "best", progress: Progress | None = None) -> Arrivals:
    """Return the arrivals of what `plan_fcost` plans."""
    return _run(n_scheme, rule, False, progress).make_arrivals("fcost")


class Slots:
    """Branches and slots of a scenario, see `trihex.planners.kernels.slots`.

    Parameters
    ----------
    d_scheme : DScheme
        Whose first best directions are the forest.
    is_literal : bool
        One region, and slots for all branches. Otherwise only those branches have slots of their own in which robots
        start; all others of a region share some.
    """

    def __init__(self, d_scheme: DScheme, is_literal: bool) -> None:
        scenario = d_scheme.n_scheme.scenario
        self.n_scheme, self.is_literal = d_scheme.n_scheme, is_literal
        self.layout, self.tessellation = scenario.area.layout, scenario.area.tessellation
        self.directions = d_scheme.directions_of_site
        region = regions_of(scenario, at_once=is_literal)
        order = np.argsort(region, kind="stable")
        self.destinations = self.layout.cell_to_site(scenario.destinations[order])
        #: Destinations by region: those of region r have the numbers from first_end[r] to first_end[r + 1].
        self.first_end = np.append(0, np.cumsum(np.bincount(region))).astype(np.int64)
        self.slot_of_site = np.zeros(self.layout.size, dtype=np.int32)
        self.slot_of_site[self.destinations] = -1 - np.arange(order.size)

    def find_regions(self, starts: NDArray[np.int32]) -> NDArray[np.int64]:
        """Lay slots for robots that start at these sites, and return their regions."""
        from trihex.planners.kernels import slots as kernels

        offset, many = self.layout.offset_of_direction, self.tessellation.direction_count
        number = np.full(self.layout.size, -1, dtype=np.int32)
        number[self.destinations] = np.arange(self.destinations.size)
        branch = np.empty(starts.size, dtype=np.int32)
        kernels.find_branches(starts, self.directions, offset, number, np.zeros_like(number), branch)
        own = np.arange(self.destinations.size * many) if self.is_literal else np.unique(branch)
        region_of_end = np.repeat(np.arange(self.first_end.size - 1), np.diff(self.first_end))
        first = np.append(0, np.cumsum(np.bincount(region_of_end[own // many], minlength=self.first_end.size - 1)))
        #: Branches by region, the last of each region for all that have no slots of their own.
        self.first_branch = (first + np.arange(first.size)).astype(np.int64)
        self.branch_of_end = np.repeat(self.first_branch[1:] - 1, np.diff(self.first_end) * many).astype(np.int32)
        self.branch_of_end[own] = np.arange(own.size) + region_of_end[own // many]
        depth = np.full(self.first_branch[-1], _SPARE, dtype=np.int64)
        steps = self.n_scheme.distance_of_site[starts] // int(self.tessellation.cost_of_direction.min())
        np.maximum.at(depth, self.branch_of_end[branch], steps + _SPARE)
        if self.is_literal:
            depth[:] = depth.max()
        self.first_slot = np.append(1, 1 + np.cumsum(depth))
        self.branch_of_slot = np.append(-1, np.repeat(np.arange(depth.size), depth)).astype(np.int32)
        self.find_slots(starts)
        return np.asarray(region_of_end[branch // many], dtype=np.int64)

    def find_slots(self, sites: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return the slots of some sites, after `find_regions`."""
        from trihex.planners.kernels import slots as kernels

        kernels.find_slots(sites, *self.forest)
        return self.slot_of_site[sites]

    @property
    def forest(self) -> tuple[NDArray[Any], ...]:
        """What kernels need to find a slot."""
        offset = self.layout.offset_of_direction
        return self.directions, offset, self.branch_of_end, self.first_slot, self.branch_of_slot, self.slot_of_site


def _run(n_scheme: NScheme, rule: str, keeps_actions: bool, progress: Progress | None) -> Recording:
    """Return the recording of a rule, or of the best of some.

    What can no longer become the best is given up: greedy descent shows early how much waiting it costs.
    """
    check_choice("rule", rule, RULES, PlanError)
    if rule == "lanes":
        return _simulated(make_lanes(n_scheme).d_scheme, "aside", keeps_actions, progress)
    d_scheme = make_d_scheme(n_scheme)
    if rule != "best":
        return _simulated(d_scheme, rule, keeps_actions, progress)
    best = _simulated(d_scheme, "aside", keeps_actions, progress)
    steps = best.crowd.arrival.sum()
    other = run_greedy(n_scheme, keeps_actions, progress, best.total_time)
    best = min(best, other, key=lambda one: (not one.is_over, one.total_time))
    scenario = n_scheme.scenario
    if steps <= _FEW and scenario.area.free_count * scenario.destinations.size <= _SPARSE * steps:
        lanes = make_lanes(n_scheme, most_visits=_VISITS + int(steps) // 4)
        other = _simulated(lanes.d_scheme, "aside", keeps_actions, progress, best.total_time)
        best = min(best, other, key=lambda one: (not one.is_over, one.total_time))
    return best


def _simulated(
    d_scheme: DScheme, rule: str, keeps_actions: bool, progress: Progress | None, limit: float = float("inf")
) -> Recording:
    """Simulate until all have arrived, or the total time is sure to be `limit` or more."""
    from trihex.planners.kernels import fcost as kernels

    scenario = d_scheme.n_scheme.scenario
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    slots = Slots(d_scheme, is_literal=rule == "paper")
    crowd = make_crowd(d_scheme.n_scheme, slots.find_regions)
    recording = Recording(crowd, keeps_actions)
    aside = {"paper": kernels.STAY, "queue": kernels.WORTH, "aside": kernels.ALWAYS}[rule]
    counts = kernels.MEETINGS if rule == "paper" else kernels.QUEUE
    period = 1 if crowd.going <= _MANY else _PERIOD
    # At w_t robots would run from line to line: with w_t three moves, plans took up to 4.5 times as long as greedy's.
    price = price_of_waiting(scenario) if counts == kernels.QUEUE else scenario.waiting_cost
    rules = np.array([counts, aside, period, price, scenario.waiting_cost, *crowd.rules], dtype=np.int64)
    many = slots.first_slot[-1] + 1
    count = np.bincount(slots.slot_of_site[crowd.site_of_robot[1:]], minlength=many).astype(np.int32)
    tables = (
        *(slots.branch_of_end, slots.first_slot, slots.branch_of_slot, slots.slot_of_site),
        *(count, np.zeros(many, np.int32), np.zeros(slots.first_slot.size, np.int64), slots.first_slot.copy()),
        *(slots.first_branch, slots.first_end),
    )
    captain_of_region, came_from = np.zeros(slots.first_end.size, np.int32), np.zeros(crowd.robot.size, np.int32)

    def simulate(
        block: int,
        first_step: int,
        steps: int,
        regions: NDArray[np.int64],
        robot_of_row: NDArray[np.int32],
        action_of_row: NDArray[np.uint8],
    ) -> None:
        kernels.weigh(
            *(rules, layout.offset_of_direction, *tables_of(scenario)[:2], tessellation.cost_of_direction),
            *(block, first_step, steps),
            *(d_scheme.n_scheme.distance_of_site, slots.directions, scenario.moves),
            *(crowd.robot_at, crowd.passed, *crowd.entered),
            *tables,
            *(regions, crowd.first_of_region, crowd.count_of_region, captain_of_region),
            *(crowd.listed, crowd.site_of_robot, crowd.row_of_robot, crowd.asked, came_from),
            *(robot_of_row, action_of_row, crowd.arrival, recording.lost),
        )

    recording.run(simulate, progress, limit)
    return recording
