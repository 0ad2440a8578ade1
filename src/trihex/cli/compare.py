"""`trihex compare`: planners side by side on the same robots, on one tessellation or several."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trihex.cli.described import complete, read_described
from trihex.cli.group import DONE, NO
from trihex.cli.options import PATH, area_options, robot_options, rule_options, wrong_use
from trihex.cli.outputs import check_outputs, tell_written
from trihex.cli.progress import bar
from trihex.cli.types import Names, Planners
from trihex.errors import AreaError, ScenarioError

if TYPE_CHECKING:
    from trihex.areas import Scenario


@click.command("compare")
@click.argument("area", type=PATH)
@area_options
@rule_options
@robot_options
@click.option(
    "--planners",
    type=Planners("trihex.planners", "PLANNERS"),
    help="Which planners; options follow as in fcost:rule=paper. [default: greedy,fcost; optimal, too, in the small]",
)
@click.option(
    "--tessellations",
    type=Names("trihex.areas.tessellation", "TESSELLATIONS"),
    help="On which tessellations. [default: that of --tessellation, or all]",
)
@click.option("--out", type=PATH, metavar="FILE", help="The table as .csv, with all its columns.")
@click.option(
    "--picture", type=PATH, metavar="FILE", help="The gaps as bars, .png, .svg or .pdf (needs the extra plot)."
)
def command(
    area: Path,
    planners: tuple[str, ...] | None,
    tessellations: tuple[str, ...] | None,
    out: Path | None,
    picture: Path | None,
    **options: Any,
) -> int:
    """Compare planners: total time, gap to the optimum or to a lower bound, steps, seconds.

    All plan the same robots; where a place in metres is covered by cells of each shape anew, as many, drawn by the
    same seed. A gap marked <= is measured against a lower bound, because the optimum is not known; the
    true gap is at most that. The optimum is looked for unasked up to 2 million robots x free cells.

    Exit status 1: some robots cannot arrive, or a plan is unsafe.
    """
    from trihex.formats import write_values
    from trihex.planners import planner_from
    from trihex.studies import make_comparison

    check_outputs((out, (".csv",), "a table"), (picture, (".png", ".svg", ".pdf"), "a chart"))
    names = tessellations or ((options["tessellation"],) if options["tessellation"] else ())
    uses = (*(planner_from(label)[0] for label in planners or ("greedy", "fcost")), "audit", "bound")
    with bar("planning", "plans") as progress:
        scenarios = _scenarios(area, names, uses, options)
        comparison = make_comparison(scenarios, planners or _default_planners(scenarios), progress=progress)
    rows = comparison.rows()
    if out:
        write_values(rows, out)
    if picture:
        _draw(rows, picture)
    status = _told(comparison, rows)
    tell_written(out, picture)
    return status


def _default_planners(scenarios: list[Scenario]) -> tuple[str, ...]:
    """Return the planners that take seconds: where robots x free cells are few, that of the optimum, too."""
    is_small = all(scenario.robot_count * scenario.area.free_count <= 2_000_000 for scenario in scenarios)
    return ("greedy", "fcost", "optimal") if is_small else ("greedy", "fcost")


def _scenarios(path: Path, names: tuple[str, ...], uses: tuple[str, ...], options: dict[str, Any]) -> list[Scenario]:
    """Return the scenario on each of the tessellations, or on all that fit if none is named.

    Barriers of cells are read as cells of another shape; a place in metres is covered anew by each.
    """
    from trihex.areas import TESSELLATIONS
    from trihex.files import read_bytes
    from trihex.formats import FORMATS, format_of
    from trihex.studies import on_tessellations

    is_in_metres = options["cell_size"] is not None or options["robot_radius"] is not None
    if not is_in_metres or FORMATS[format_of(read_bytes(path), path)].is_of_letters:
        scenario = complete(read_described(path, options), *uses)
        own = () if scenario.area.frame is None else (scenario.area.tessellation.name,)
        return on_tessellations(scenario, names or own or TESSELLATIONS)
    scenarios = []
    for name in names or TESSELLATIONS:
        try:
            scenarios.append(complete(read_described(path, {**options, "tessellation": name}), *uses))
        except (AreaError, ScenarioError) as error:
            if names:
                raise
            click.echo(f"trihex: {name} is left out: {error}", err=True)
    if not scenarios:
        raise wrong_use("no tessellation fits; see above")
    return scenarios


def _draw(rows: list[dict[str, Any]], path: Path) -> None:
    from trihex.files import new_file
    from trihex.pictures import draw_comparison

    ax = draw_comparison(rows)
    with new_file(path) as part:
        ax.figure.savefig(part)


def _told(comparison: Any, rows: list[dict[str, Any]]) -> int:
    """Print the table, tell what is amiss, and return the exit status."""
    from trihex.cli.texts import comparison_lines, stranded_line

    click.echo("\n".join(comparison_lines(rows)))
    status = DONE
    for entry in comparison.entries:
        if entry.report and not entry.report.audit.is_clean:
            status = NO
    reports = {id(entry.scenario): entry.report for entry in comparison.entries if entry.report}
    for report in reports.values():
        if report.unreachable_robots.size:
            status = NO
            line = stranded_line(report.plan.scenario, report.unreachable_robots.tolist())
            click.echo(f"trihex: {report.plan.scenario.area.tessellation.name}: {line}", err=True)
    return status
