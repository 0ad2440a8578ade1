"""Comparison: several planners on several scenarios, each plan measured against the best that is known."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np

from trihex.areas import Area, Scenario, Tessellation
from trihex.bounds import LowerBound, make_lower_bound
from trihex.errors import TooLargeError, check_many, check_type
from trihex.fields import field_kernels, make_n_scheme
from trihex.judging import Report, audit_plan, make_report
from trihex.kernels.needs import use_of
from trihex.kernels.preparing import prepare
from trihex.planners import make_plan, planner_from, uses_of
from trihex.record import Record, counted, html_table

Wanted = tuple[str, dict[str, Any]]  # a planner and its options


@dataclass(frozen=True, eq=False)
class Entry(Record):
    """One planner on one scenario.

    Parameters
    ----------
    scenario : Scenario
    planner : str
        As it was asked for, with its options.
    report : Report or None
        None if the planner refused.
    refusal : str
        Why it did.
    """

    scenario: Scenario
    planner: str
    report: Report | None
    refusal: str = ""


@dataclass(frozen=True, eq=False)
class Comparison(Record):
    """What several planners make of several scenarios.

    Parameters
    ----------
    entries : tuple of Entry
        Scenario by scenario, planners in the order asked for.
    """

    entries: tuple[Entry, ...]

    def in_words(self) -> str:
        """Return how many scenarios and plans there are, and by which planners."""
        scenarios = len({id(entry.scenario) for entry in self.entries})
        planners = ", ".join(dict.fromkeys(entry.planner for entry in self.entries))
        return f"{counted(scenarios, 'scenario')}, {counted(len(self.entries), 'plan')} by {planners or 'nobody'}"

    def _repr_html_(self) -> str:
        """Return the rows as a table, for notebooks."""
        return html_table(self.rows())

    def _reference(self, scenario: Scenario) -> LowerBound:
        """Return the best lower bound; its name is "optimum" if some plan attains it, proven by a planner or not."""
        reports = [entry.report for entry in self.entries if entry.report and entry.scenario is scenario]
        best = max(reports, key=lambda report: (report.lower_bound, report.optimal))
        return LowerBound(best.lower_bound_name, best.lower_bound)

    def rows(self) -> list[dict[str, Any]]:
        """Return one flat row of plain values for each entry.

        Its keys: `area`, `tessellation`, `neighbourhood`, `robots`, `arrived`, `planner`, `total_time`; `reference`,
        the least total time that any plan of the scenario can have, as far as known, and its `reference_name`; `gap`,
        which is total_time / reference - 1, or None if that has no meaning; `is_proven`, whether the reference is the
        optimum (a planner has proven it, or some plan attains a lower bound); `steps`, `longest_time`, `conflicts`;
        `seconds`, of planning alone; `refusal`, why there is no plan, in which case the values are None.
        """
        return [self._row(entry) for entry in self.entries]

    def _row(self, entry: Entry) -> dict[str, Any]:
        area, report = entry.scenario.area, entry.report
        row: dict[str, Any] = {
            "area": area.name,
            "tessellation": area.tessellation.name,
            "neighbourhood": area.tessellation.neighbourhood,
            "robots": entry.scenario.robot_count,
            "planner": entry.planner,
            "refusal": entry.refusal,
        }
        values = ("arrived", "total_time", "reference", "reference_name", "gap", "is_proven", "steps", "longest_time")
        if report is None:
            return {**row, **dict.fromkeys((*values, "conflicts", "seconds"))}
        reference = self._reference(entry.scenario)
        measured = replace(report, bound=reference)
        return {
            **row,
            "arrived": report.arrived_count,
            "total_time": report.total_time,
            "reference": reference.value,
            "reference_name": reference.name,
            "gap": measured.gap,
            "is_proven": reference.name == "optimum",
            "steps": report.steps,
            "longest_time": report.longest_time,
            "conflicts": report.audit.conflict_count,
            "seconds": report.seconds.get("plan"),
        }


def make_comparison(
    scenarios: Iterable[Scenario],
    planners: Iterable[str] | Mapping[str, Mapping[str, Any]],
    *,
    progress: Callable[[int, int], None] | None = None,
    clock: Callable[[], float] = perf_counter,
) -> Comparison:
    """Plan every scenario with every planner, and judge and bound all plans.

    Parameters
    ----------
    scenarios : iterable of Scenario
        To compare tessellations, the same robots on several: see `on_tessellations`.
    planners : names of planners, or mapping from names to their options
        A name may hold options itself, as in ``fcost:rule=paper``; each entry bears the name as it is given.
    progress : callable, optional
        Called with (plans made, plans to make).
    clock : callable
        Tells the seconds. Each planner is tried on one robot first, so that loading it is not counted.

    Raises
    ------
    PlanError
        If a planner or an option does not exist. A planner that refuses a scenario as too large is noted in its entry.

    Examples
    --------
    >>> from trihex import Area
    >>> scenario = Scenario(Area("square", [[0, 0, 0, 0]]), destinations=[(3, 0)], robots=[(0, 0), (1, 0)])
    >>> [(row["planner"], row["gap"], row["is_proven"]) for row in make_comparison([scenario], ["greedy"]).rows()]
    [('greedy', 0.0, True)]
    """
    check_many("scenarios", scenarios, Scenario, "a list of scenarios")
    if isinstance(planners, str):
        planners = [planners]
    check_many("planners", planners, str, "names of planners, or a mapping from names to their options")
    scenarios = list(scenarios)
    for number, scenario in enumerate(scenarios):
        check_type(f"scenarios[{number}]", scenario, Scenario)
    wanted: dict[str, Wanted] = {}
    for label in planners:
        name, options = planner_from(label)
        wanted[label] = (name, {**options, **(planners[label] if isinstance(planners, Mapping) else {})})
        _try(*wanted[label])
    shapes = {field_kernels(scenario.area.tessellation, scenario.corners) for scenario in scenarios}
    needed = (use for scenario in scenarios for name, _ in wanted.values() for use in uses_of(name, scenario))
    judges = {use_of("audit", scenario.is_stepwise) for scenario in scenarios}
    prepare(*needed, *judges, "bound", *shapes)
    entries: list[Entry] = []
    for scenario in scenarios:
        entries += _entries(scenario, wanted, clock, progress, (len(entries), len(scenarios) * len(wanted)))
    return Comparison(tuple(entries))


def on_tessellations(scenario: Scenario, names: Iterable[str]) -> list[Scenario]:
    """Return `scenario` with its cells, barriers, robots, costs and rules on each of the tessellations named."""
    check_type("scenario", scenario, Scenario)
    check_many("names", names, Scenario, "a list of names of tessellations")
    area = scenario.area
    shapes = [replace(area.tessellation, name=name) for name in names]
    return [replace(scenario, area=area.with_tessellation(shape)) for shape in shapes]


def _try(planner: str, options: dict[str, Any]) -> None:
    """Raise PlanError now, not after other planners have worked, if an option has a value that it cannot have."""
    area = Area(Tessellation("hexagonal"), np.zeros((1, 2), dtype=bool))
    with suppress(TooLargeError):
        make_plan(Scenario(area, np.array([0]), np.array([1])), planner, **options)


def _entries(
    scenario: Scenario,
    wanted: dict[str, Wanted],
    clock: Callable[[], float],
    progress: Callable[[int, int], None] | None,
    done_of: tuple[int, int],
) -> Iterable[Entry]:
    n_scheme = make_n_scheme(scenario)
    bound = make_lower_bound(n_scheme)
    one_robot = scenario.with_robots(scenario.robots[:1])
    for count, (label, (planner, options)) in enumerate(wanted.items()):
        try:
            make_plan(one_robot, planner, **options)
            begin = clock()
            plan = make_plan(scenario, planner, n_scheme=n_scheme, **options)
            seconds = {"plan": clock() - begin}
        except TooLargeError as refusal:
            yield Entry(scenario, label, None, str(refusal))
        else:
            report = make_report(plan, n_scheme=n_scheme, audit=audit_plan(plan), lower_bound=bound, seconds=seconds)
            yield Entry(scenario, label, report)
        if progress is not None:
            progress(done_of[0] + count + 1, done_of[1])
