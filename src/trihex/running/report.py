"""Run report: the numbers of one run, beside what could be had with full knowledge of a world at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from trihex.areas import plain_flow, seconds_per_step
from trihex.bounds import LowerBound, make_lower_bound
from trihex.errors import check_type
from trihex.fields import make_n_scheme
from trihex.planners import make_plan
from trihex.plans import Plan, seconds_of_arrivals
from trihex.record import Record, counted, html_table
from trihex.running.audit import RunAudit, audit_run
from trihex.running.run import BROKEN, GOING, LEFT, Run


@dataclass(frozen=True, eq=False)
class RunReport(Record):
    """What a run cost, what the judge says, and what the same robots need if they know all and nothing happens.

    Parameters
    ----------
    run : Run
    audit : RunAudit
    reference : Plan
        Of the world as it was at the beginning, without events or delays.
    bound : LowerBound
        What no such plan can beat.
    seconds : tuple of float
        How long the work of each step took; empty if not known.
    step_seconds : float, optional
        How long a step lasts, in an area in metres.
    """

    run: Run
    audit: RunAudit
    reference: Plan
    bound: LowerBound
    seconds: tuple[float, ...] = ()
    step_seconds: float | None = None

    def in_words(self) -> str:
        """Return the words of the run, the price of what it did not know, and the conflicts."""
        price = "no price" if self.price is None else f"price {100 * self.price:.1f} %"
        return f"{self.run.in_words()}, {price}, {counted(self.audit.conflict_count, 'conflict')}"

    def _repr_html_(self) -> str:
        """Return the numbers as a table, for notebooks."""
        return html_table([self.as_dict()])

    @property
    def price(self) -> float | None:
        """How much longer the robots took than in the reference: total_time / total_time of the reference - 1.

        None where it has no meaning: not the same robots arrive in both.
        """
        own, other = self.run.arrived, self.reference.arrived
        if own.size != other.size or (own != other).any():
            return None
        return self.run.total_time / self.reference.total_time - 1 if self.reference.total_time else 0.0

    def as_dict(self) -> dict[str, Any]:
        """Return the numbers: plain ones, strings and None, ready for JSON."""
        run, scenario, area = self.run, self.run.scenario, self.run.scenario.area
        state, times = run.state_of_robot, 1000 * np.array(self.seconds or (np.nan,))
        accepted = sum(occurrence.is_accepted for occurrence in run.occurrences)
        milliseconds = {"median": float(np.median(times)), "worst": float(times.max())} if self.seconds else None
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
            "waiting_cost": int(scenario.waiting_cost),
            "planner": run.planner,
            "sense": None if run.sensor is None else float(run.sensor.radius),
            "line_of_sight": None if run.sensor is None else run.sensor.line_of_sight,
            "delays": run.delay,
            "seed": run.seed,
            "robots": int(run.robots.size),
            "arrived": int(np.count_nonzero(run.arrived)),
            "arrivals_of_exit": run.arrivals_of_exit,
            "cut_off": int(np.count_nonzero(state == GOING)),
            "left": int(np.count_nonzero(state == LEFT)),
            "broken": int(np.count_nonzero(state == BROKEN)),
            "events": accepted,
            "refused_events": len(run.occurrences) - accepted,
            "steps": run.steps,
            "total_time": run.total_time,
            "reference_time": self.reference.total_time,
            "reference_planner": self.reference.planner,
            "price": self.price,
            "lower_bound": self.bound.value,
            "lower_bound_name": self.bound.name,
            "conflicts": self.audit.conflict_count,
            **seconds_of_arrivals(run, self.step_seconds),
            "known": float(np.mean(run.known_since >= 0)),
            "repairs": int(run.touched[:, 0].sum()),
            "cells_touched": int(run.touched[:, 1].sum()),
            "milliseconds_a_step": milliseconds,
        }


def make_run_report(
    run: Run,
    *,
    reference: Plan | str = "fcost",
    seconds: Sequence[float] = (),
    speed: float = 1.0,
    turn_time: float = 0.0,
) -> RunReport:
    """Judge a run, plan the same with full knowledge, and put the numbers together.

    Parameters
    ----------
    run : Run
    reference : Plan or str
        What to compare with: a plan, or the planner that makes it.
    seconds : sequence of float
        How long the work of each step took, as `Trial.seconds` has it.
    speed, turn_time : float
        Of robots in an area in metres, as for `write_waypoints`; then the report tells seconds.

    Examples
    --------
    >>> from trihex import Area, Scenario
    >>> from trihex.running.trial import Trial
    >>> scenario = Scenario(Area("square", [[0, 0, 0], [0, 1, 0]]), destinations=[(2, 1)], robots=[(0, 1)])
    >>> report = make_run_report(Trial(scenario, sensor=0).run())
    >>> report.price, report.audit.is_clean
    (0.0, True)
    """
    check_type("run", run, Run)
    check_type("reference", reference, Plan, str)
    n_scheme = make_n_scheme(run.scenario)
    if isinstance(reference, str):
        reference = make_plan(run.scenario, reference, n_scheme=n_scheme)
    area = run.scenario.area
    lasts = seconds_per_step(area, speed, turn_time) if area.frame is not None else None
    return RunReport(run, audit_run(run), reference, make_lower_bound(n_scheme), tuple(seconds), lasts)
