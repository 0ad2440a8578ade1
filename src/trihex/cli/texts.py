"""Texts: reports and tables as a person reads them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from trihex.areas import Scenario
    from trihex.judging import Audit, Report
    from trihex.plans import Plan
    from trihex.running import RunAudit

_MOST_ROBOTS = 100


def report_lines(report: Report) -> list[str]:
    """Return the report in a few lines."""
    plan, scenario, numbers = report.plan, report.plan.scenario, report.as_dict()
    area, tessellation = scenario.area, scenario.area.tessellation
    gap = "none" if report.gap is None else f"{100 * report.gap:.2f} %"
    seconds = ", ".join(f"{part} {took:.2f} s" for part, took in report.seconds.items())
    before = f", {report.waiting_before_start} of it before they may start" if scenario.has_start_times else ""
    return [
        f"{area.name or 'area'}: {area.width} x {area.height} cells, {area.free_count} free; {tessellation.name}, "
        f"{tessellation.neighbourhood} neighbourhood, costs {tessellation.costs}",
        f"{plan.planner or 'plan'}: {report.arrived_count} of {scenario.robot_count} robots arrive, "
        f"the last in {scenario.step_word} {report.steps}",
        f"total time {report.total_time} ({report.total_distance} moving, {report.total_waiting} waiting{before}), "
        f"lower bound {report.lower_bound} ({report.lower_bound_name}), gap {gap}",
        *slowness_lines(scenario),
        *exit_lines(report.arrivals_of_exit, report.arrived_count),
        *door_lines(numbers),
        *([seconds_line(numbers, scenario.step_word)] if numbers["last_arrival_seconds"] is not None else []),
        verdict(report.audit),
        *corner_lines(report.plan, report.corner_moves, report.squeezing_moves),
        f"a robot turns by {numbers['turning']:.0f} degrees in the mean",
        *([seconds] if seconds else []),
    ]


def slowness_lines(scenario: Scenario) -> list[str]:
    """Return a line that says how slow robots are, or none where all are as fast."""
    own = scenario.slowness
    words = "moves of slower robots last"
    return [f"{words} up to {own.max()} times as long, {own.mean():.3g} in the mean"] if scenario.has_slowness else []


def exit_lines(arrivals: Mapping[str, int], arrived: int) -> list[str]:
    """Return a line that says how many robots arrive at each exit, or none where no exit has a name."""
    if not arrivals:
        return []
    elsewhere = arrived - sum(arrivals.values())
    named = [f"{name} {count}" for name, count in arrivals.items()] + [f"elsewhere {elsewhere}"] * (elsewhere > 0)
    return [f"exits: {', '.join(named)}"]


def door_lines(numbers: Mapping[str, Any]) -> list[str]:
    """Return a line that says how many robots each door lets in, or none where there are none."""
    if "doors" not in numbers:
        return []
    return [f"doors: {', '.join(f'{name} {flow}' for name, flow in numbers['doors'].items())}"]


def seconds_line(numbers: Mapping[str, Any], step_word: str = "step") -> str:
    """Return when robots arrive in an area in metres, in a line."""
    last, mean, step = (numbers[f"{name}_seconds"] for name in ("last_arrival", "mean_arrival", "step"))
    lasts = f"a {step_word} lasts {step:.3g} s"
    return f"the last arrives after {last:.1f} s, a robot in the mean after {mean:.1f} s; {lasts}"


def corner_lines(plan: Plan, count: int, between: int) -> list[str]:
    """Return a line that says how many moves pass the corner of a barrier and what forbids it, or none."""
    if not count:
        return []
    area = plan.scenario.area
    place = "a barrier" if area.free_count < area.cell_count else "the border"
    moves = "1 move passes" if count == 1 else f"{count} moves pass"
    squeezing = f", {between} of them between two" if between else ""
    return [f"{moves} the corner of {place}{squeezing}; --corners no-cut forbids it"]


def verdict(audit: Audit | RunAudit) -> str:
    """Return what the judge found, in a line."""
    if audit.is_clean:
        return "safe: no conflicts"
    return f"unsafe: {audit.conflict_count} conflict{'s' * (audit.conflict_count != 1)}"


def conflict_lines(audit: Audit | RunAudit, limit: int) -> list[str]:
    """Return the first conflicts, a line each, and how many more there are."""
    lines = [str(conflict) for conflict in audit.conflicts[:limit]]
    more = audit.conflict_count - len(lines)
    return [*lines, f"and {more} more"] if more else lines


def stranded_line(scenario: Scenario, robots: Sequence[int]) -> str:
    """Return which robots cannot arrive, and where they stand."""
    named = [f"{robot} at {scenario.area.name_of_cell(int(scenario.robots[robot]))}" for robot in robots[:_MOST_ROBOTS]]
    more = f", and {len(robots) - len(named)} more" if len(robots) > len(named) else ""
    return f"{len(robots)} of {scenario.robot_count} robots cannot reach a destination: {', '.join(named)}{more}"


def comparison_lines(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the rows of a comparison as a table, and below it what refused and what is unsafe."""
    header = ("tessellation", "planner", "total time", "lower bound", "gap", "steps", "seconds", "bound by")
    shown, notes = [], []
    for row in rows:
        own = f"{row['planner']} on {row['tessellation']}"
        if row["refusal"]:
            notes.append(f"{own} refused: {row['refusal']}")
        if row["conflicts"]:
            notes.append(f"{own} is unsafe: {row['conflicts']} conflicts")
        values = [_shown(row[key]) for key in ("total_time", "reference")]
        seconds = "-" if row["seconds"] is None else f"{row['seconds']:.2f}"
        shown.append(
            [
                row["tessellation"],
                row["planner"],
                *values,
                _gap(row),
                _shown(row["steps"]),
                seconds,
                _shown(row["reference_name"]),
            ]
        )
    return [*table_lines(header, shown, left=2), *notes]


def _gap(row: Mapping[str, Any]) -> str:
    """Return the gap, marked where it is measured against a bound that the optimum may lie above."""
    if row["gap"] is None:
        return "-"
    return f"{'' if row['is_proven'] else '<= '}{100 * row['gap']:.2f} %"


def _shown(value: Any) -> str:
    return "-" if value is None else str(value)


def table_lines(header: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> list[str]:
    """Return a table in columns, the first `left` of them flush left and the others flush right."""
    cells = [list(header), *(list(row) for row in rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(header))]
    lines = []
    for row in cells:
        shown = [text.ljust(width) for text, width in zip(row[:left], widths, strict=False)]
        shown += [text.rjust(width) for text, width in zip(row[left:], widths[left:], strict=True)]
        lines.append("  ".join(shown).rstrip())
    return [lines[0], "-" * len(lines[0]), *lines[1:]]
