"""Report: the numbers of one plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Claim, count_by_zone, plain_flow, seconds_per_step
from trihex.bounds import LowerBound, distance_bound, make_lower_bound
from trihex.errors import check_type
from trihex.fields import NScheme, make_n_scheme
from trihex.judging.audit import Audit, audit_plan
from trihex.judging.corners import count_corner_moves
from trihex.kernels.needs import use_of
from trihex.kernels.preparing import prepare
from trihex.plans import Plan, seconds_of_arrivals, turning_of_robot
from trihex.record import Record, counted, html_table

PARTS = ("read", "field", "plan", "audit")


@dataclass(frozen=True, eq=False)
class Report(Record):
    """What a plan costs, what any plan must cost, and what the judge says.

    Parameters
    ----------
    plan : Plan
    audit : Audit
        The judgement of `plan`.
    bound : LowerBound
        A total time that no plan can beat.
    unreachable_robots : int64 array
        Robots that cannot arrive, ascending.
    seconds : mapping
        How long parts of the work took, by the names of `PARTS`; what is not known is missing.
    step_seconds : float, optional
        How long a step lasts, in an area in metres.
    """

    plan: Plan
    audit: Audit
    bound: LowerBound
    unreachable_robots: NDArray[np.int64]
    seconds: Mapping[str, float] = field(default_factory=dict)
    step_seconds: float | None = None

    def in_words(self) -> str:
        """Return the words of the plan, the lower bound, the gap and the conflicts."""
        gap = "no gap" if self.gap is None else f"gap {100 * self.gap:.1f} %"
        bound = f"lower bound {self.lower_bound} ({self.lower_bound_name}), {gap}"
        return f"{self.plan.in_words()}, {bound}, {counted(self.audit.conflict_count, 'conflict')}"

    def _repr_html_(self) -> str:
        """Return the numbers as a table, for notebooks."""
        return html_table([self.as_dict()])

    @property
    def total_time(self) -> int:
        """Sum of t_r over the robots that arrive."""
        return self.plan.total_time

    @property
    def total_distance(self) -> int:
        """Sum of d_r over the robots that arrive."""
        return int(self.plan.distance_of_robot[self.plan.arrived].sum())

    @property
    def total_waiting(self) -> int:
        """Sum of w_r over the robots that arrive."""
        return int(self.plan.waiting_of_robot[self.plan.arrived].sum())

    @cached_property
    def waiting_before_start(self) -> int:
        """What of `total_waiting` robots waited until their start times."""
        plan = self.plan
        goes = plan.arrived & (plan.arrival_step_of_robot > 0)
        return int(plan.scenario.start_times[goes].sum()) * int(plan.scenario.waiting_cost)

    @property
    def longest_time(self) -> int:
        """The largest t_r among the robots that arrive."""
        return int(self.plan.time_of_robot[self.plan.arrived].max(initial=0))

    @cached_property
    def corner_moves(self) -> int:
        """Moves through a lattice vertex where a barrier or the border stands: those that corners="no-cut" forbids."""
        return count_corner_moves(self.plan)

    @cached_property
    def squeezing_moves(self) -> int:
        """Those of the corner moves with a barrier on either side, which corners="no-squeeze" forbids."""
        return count_corner_moves(self.plan, "no-squeeze") if self.corner_moves else 0

    @cached_property
    def turning(self) -> float:
        """By how many degrees a robot that arrives turns on its way, in the mean."""
        own = turning_of_robot(self.plan)[self.plan.arrived]
        return float(own.mean()) if own.size else 0.0

    @property
    def steps(self) -> int:
        """The step in which the last robot arrives."""
        return int(self.plan.arrival_step_of_robot.max(initial=0))

    @cached_property
    def arrived_count(self) -> int:
        """Number of robots that arrive."""
        return int(np.count_nonzero(self.plan.arrived))

    @cached_property
    def arrivals_of_exit(self) -> dict[str, int]:
        """How many robots arrive in each zone of the area, by its name."""
        plan = self.plan
        return count_by_zone(plan.scenario.exit_zones, plan.last_cell_of_robot[plan.arrived])

    @property
    def is_complete(self) -> bool:
        """Whether every robot that can arrive does."""
        return self.arrived_count == self.plan.scenario.robot_count - self.unreachable_robots.size

    @property
    def optimal(self) -> bool:
        """Whether it is proven that no plan takes less total time: by the planner, or because the bound is attained."""
        is_proven = self.plan.optimal or self.total_time <= self.bound.value
        return is_proven and self.is_complete and self.audit.is_clean

    @property
    def lower_bound(self) -> int:
        """Value of `bound`, or the total time itself where that is proven to be the least."""
        return self.total_time if self.optimal else self.bound.value

    @property
    def lower_bound_name(self) -> str:
        """Name of `bound`, or "optimum"."""
        return "optimum" if self.optimal else self.bound.name

    @property
    def gap(self) -> float | None:
        """How far the total time lies above the lower bound: total_time / lower_bound - 1.

        0 if both are 0, as where all robots start on destinations. None where it has no meaning: some robot does not
        arrive though it could, or the bound is 0 and the total time is not.
        """
        bound = self.lower_bound
        if not self.is_complete or (bound == 0 and self.total_time > 0):
            return None
        return self.total_time / bound - 1 if bound else 0.0

    def as_dict(self) -> dict[str, Any]:
        """Return the summary: plain numbers, strings and None, ready for JSON."""
        plan, scenario, area = self.plan, self.plan.scenario, self.plan.scenario.area
        return {
            "area": area.name,
            "tessellation": area.tessellation.name,
            "neighbourhood": area.tessellation.neighbourhood,
            "costs": area.tessellation.costs,
            "corners": scenario.corners,
            "crossing": scenario.crossing,
            "destination_capacity": plain_flow(scenario.destination_capacity),
            **({"doors": scenario.flows_in_words(self.step_seconds)} if scenario.doors else {}),
            "clock": scenario.clock,
            "following": scenario.following,
            "cells": area.cell_count,
            "free_cells": area.free_count,
            "robots": scenario.robot_count,
            "arrived": self.arrived_count,
            "unreachable": int(self.unreachable_robots.size),
            "arrivals_of_exit": self.arrivals_of_exit,
            "seed": scenario.seed,
            "planner": plan.planner,
            "waiting_cost": int(scenario.waiting_cost),
            "steps": self.steps,
            "total_time": self.total_time,
            "total_distance": self.total_distance,
            "total_waiting": self.total_waiting,
            **({"waiting_before_start": self.waiting_before_start} if scenario.has_start_times else {}),
            **({"slowness": int(scenario.slowness.max())} if scenario.has_slowness else {}),
            "longest_time": self.longest_time,
            "lower_bound": self.lower_bound,
            "lower_bound_name": self.lower_bound_name,
            "gap": self.gap,
            "optimal": self.optimal,
            "conflicts": self.audit.conflict_count,
            "corner_moves": self.corner_moves,
            "squeezing_moves": self.squeezing_moves,
            "turning": round(self.turning, 3),
            **seconds_of_arrivals(self.plan, self.step_seconds),
            "seconds": {part: self.seconds.get(part) for part in PARTS},
        }


def make_report(
    plan: Plan,
    *,
    n_scheme: NScheme | None = None,
    audit: Audit | None = None,
    lower_bound: LowerBound | None = None,
    seconds: Mapping[str, float] | None = None,
    speed: float = 1.0,
    turn_time: float = 0.0,
) -> Report:
    """Audit `plan`, bound it from below, and put its numbers together.

    Parameters
    ----------
    plan : Plan
    n_scheme, audit, lower_bound : optional
        Made here unless they are there already.
    seconds : mapping, optional
        How long the parts of the work took, by the names of `PARTS`.
    speed, turn_time : float
        Of robots in an area in metres, as for `write_waypoints`; then the report tells seconds.

    Examples
    --------
    >>> from trihex import Area, Scenario
    >>> from trihex.plans.plan import plan_from_lists
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0), (1, 0)])
    >>> report = make_report(plan_from_lists(scenario, [[1, 255, 1], [1]]))
    >>> report.total_time, report.lower_bound, round(report.gap, 3)
    (40, 30, 0.333)
    """
    check_type("plan", plan, Plan)
    check_type("n_scheme", n_scheme, NScheme, type(None))
    check_type("audit", audit, Audit, type(None))
    check_type("lower_bound", lower_bound, LowerBound, type(None))
    judge = use_of("audit", plan.scenario.is_stepwise)
    prepare(*(judge,) * (audit is None), *("bound",) * (lower_bound is None and not plan.optimal))
    n_scheme = make_n_scheme(plan.scenario) if n_scheme is None else n_scheme
    audit = audit_plan(plan) if audit is None else audit
    # Where the optimum is proven no bound is asked for, so a cheap one will do until that is known.
    cheap = distance_bound(n_scheme)
    lasts = seconds_per_step(plan.scenario.area, speed, turn_time) if plan.scenario.area.frame is not None else None
    report = Report(plan, audit, lower_bound or cheap, n_scheme.unreachable_robots, dict(seconds or {}), lasts)
    if lower_bound is None and not report.optimal and not isinstance(plan.scenario, Claim):
        report = replace(report, bound=make_lower_bound(n_scheme))
    return report
