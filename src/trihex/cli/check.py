"""`trihex check`: the judge's word on a plan in a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trihex.cli.described import read_played
from trihex.cli.group import DONE, NO
from trihex.cli.options import PATH, area_options, of_waypoints, rule_options
from trihex.cli.outputs import check_outputs, tell_written
from trihex.cli.progress import bar
from trihex.cli.types import Metres, Seconds, Whole


@click.command("check")
@click.argument("plan", type=PATH)
@click.argument("area", type=PATH, required=False)
@area_options
@rule_options
@click.option("--limit", type=Whole(0), default=10, show_default=True, help="How many conflicts to list.")
@click.option("--speed", type=Metres(), help="Of the robots, in metres a second, for flows a second. [default: 1.0]")
@click.option("--turn-time", type=Seconds(), help="Seconds in which robots turn before each step. [default: 0]")
@click.option("--summary", type=PATH, metavar="FILE", help="The report as JSON; - writes it to the standard output.")
def command(plan: Path, area: Path | None, limit: int, summary: Path | None, **options: Any) -> int:
    """Tell whether a plan or a run is safe.

    PLAN is .npz, which holds area and rules itself, or .csv, which needs AREA and the options that it was made with.
    Rules that are named here come before those of the file. A run is judged in the world of each step.

    Exit status 1: the plan is unsafe.
    """
    from trihex.cli.texts import conflict_lines, corner_lines, verdict
    from trihex.judging import audit_plan, count_corner_moves
    from trihex.running import Run

    check_outputs((summary, (), "a summary"))
    pace = of_waypoints(options)
    judged: Any = read_played(plan, area, options, for_judge=True, pace=pace)
    if isinstance(judged, Run):
        return _check_run(plan, judged, limit, summary, pace)
    with bar("judging", "actions") as progress:
        audit = audit_plan(judged, limit=limit, progress=progress)
    if summary:
        _summarise(judged, audit, summary, pace)
    if str(summary) != "-":
        robots, arrived = judged.scenario.robot_count, int(judged.arrived.sum())
        time = f"{judged.steps} {judged.scenario.step_word}s"
        click.echo(f"{plan}: {arrived} of {robots} robots arrive in {time}; {verdict(audit)}")
        counts = (count_corner_moves(judged, rule) for rule in ("no-cut", "no-squeeze"))
        for line in corner_lines(judged, *counts):
            click.echo(line)
        tell_written(summary)
    if audit.is_clean:
        return DONE
    click.echo("\n".join(conflict_lines(audit, limit)), err=str(summary) == "-")
    if judged.jumps.size and plan.suffix.lower() != ".npz":
        _tell_likeness(plan, judged.scenario)
    return NO


def _check_run(path: Path, run: Any, limit: int, summary: Path | None, pace: dict[str, Any]) -> int:
    from trihex.cli.outputs import write_text
    from trihex.cli.texts import conflict_lines, verdict
    from trihex.formats import report_text
    from trihex.running import audit_run, make_run_report

    audit = audit_run(run, limit)
    if summary:
        write_text(report_text(make_run_report(run, **pace)), summary)
    if str(summary) != "-":
        arrived = int(run.arrived.sum())
        click.echo(f"{path}: {arrived} of {run.robots.size} robots arrived in {run.steps} steps; {verdict(audit)}")
        tell_written(summary)
    if not audit.is_clean:
        click.echo("\n".join(conflict_lines(audit, limit)), err=str(summary) == "-")
    return DONE if audit.is_clean else NO


def _tell_likeness(plan: Path, scenario: Any) -> None:
    """Tell which tessellation a plan seems to be for in which robots jump."""
    from trihex.files import read_bytes
    from trihex.formats import likeness_of

    if looks := likeness_of(read_bytes(plan), plan, scenario):
        click.echo(f"trihex: {plan}{looks}", err=True)


def _summarise(plan: Any, audit: Any, summary: Path, pace: dict[str, Any]) -> None:
    from trihex.formats import report_text, write_report
    from trihex.judging import make_report

    report = make_report(plan, audit=audit, **pace)
    if str(summary) == "-":
        click.echo(report_text(report), nl=False)
    else:
        write_report(report, summary)
