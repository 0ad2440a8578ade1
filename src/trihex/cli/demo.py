"""`trihex demo`: a cave, its robots, and what all planners make of it on the three tessellations."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from trihex.cli.group import DONE, NO
from trihex.cli.options import PATH
from trihex.cli.progress import bar

if TYPE_CHECKING:
    from trihex.areas import Scenario
    from trihex.studies import Comparison

Progress = Callable[[str, int, int], None]
# Which plan is drawn, if the planner is there.
SHOWN_PLANNER, SHOWN_TESSELLATION = "fcost", "hexagonal"


class Demo(NamedTuple):
    """What the demo did: the comparison, and the files that it wrote."""

    comparison: Comparison
    files: tuple[Path, ...]


def make_demo_scenario() -> Scenario:
    """Make the scenario of the demo: a cave that 240 robots leave by two exits.

    Examples
    --------
    >>> scenario = make_demo_scenario()
    >>> scenario.robot_count, scenario.destinations.size, scenario.area.free_count
    (240, 2, 1716)
    """
    from dataclasses import replace

    from trihex.areas import Scenario, make_caves_area, random_robots

    area = replace(make_caves_area("hexagonal", 40, 64, density=0.44, seed=15), name="cave")
    exits = area.xy_to_cell([0, 63], [20, 24])
    return Scenario(area, exits, random_robots(area, 240, seed=1, avoid=exits), seed=1)


def run_demo(folder: Path, planners: Iterable[str] | None = None, *, progress: Progress | None = None) -> Demo:
    """Compare planners on the three tessellations, and write a table, pictures and a movie into `folder`.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    planners : iterable of str, optional
        Default: all.
    progress : callable, optional
        Called with (what is done, done, total).
    """
    from trihex.areas import TESSELLATIONS
    from trihex.fields import make_n_scheme
    from trihex.formats import write_values
    from trihex.pictures import picture_of_n_scheme, picture_of_plan, write_animation
    from trihex.planners import PLANNERS
    from trihex.studies import make_comparison, on_tessellations

    def tell(what: str) -> Callable[[int, int], None]:
        return lambda done, total: progress(what, done, total) if progress else None

    folder.mkdir(parents=True, exist_ok=True)
    scenarios = on_tessellations(make_demo_scenario(), TESSELLATIONS)
    comparison = make_comparison(scenarios, planners or tuple(PLANNERS), progress=tell("planning"))
    files = [folder / "table.csv"]
    write_values(comparison.rows(), files[0])
    reports = {(entry.planner, entry.scenario.area.tessellation.name): entry.report for entry in comparison.entries}
    planner = SHOWN_PLANNER if (SHOWN_PLANNER, SHOWN_TESSELLATION) in reports else comparison.entries[0].planner
    for name in TESSELLATIONS:
        if report := reports[planner, name]:
            files.append(folder / f"plan-{name}.png")
            picture_of_plan(report.plan).save(files[-1])
    if report := reports[planner, SHOWN_TESSELLATION]:
        files += [folder / "n-scheme.png", folder / "plan.gif"]
        picture_of_n_scheme(make_n_scheme(report.plan.scenario)).save(files[-2])
        write_animation(report.plan, files[-1], progress=tell("drawing"))
    return Demo(comparison, tuple(files))


@click.command("demo")
@click.option("--out", type=PATH, metavar="DIR", default="demo", show_default=True, help="Where files are written.")
def command(out: Path) -> int:
    """Plan with every planner on the three tessellations; print a table, leave pictures and an animation."""
    from trihex.cli.texts import comparison_lines

    with bar("planning and drawing", "parts") as progress:
        demo = run_demo(out, progress=lambda _, done, total: progress(done, total))
    scenario = demo.comparison.entries[0].scenario
    click.echo(f"{scenario.robot_count} robots leave a {scenario.area.name} of {scenario.area.free_count} free cells")
    lines = comparison_lines(demo.comparison.rows())
    click.echo("\n".join(lines))
    if any("<=" in line for line in lines):
        click.echo("a gap marked <= is measured against a lower bound, the true gap is at most that")
    click.echo("written: " + ", ".join(str(path) for path in demo.files))
    is_clean = all(entry.report is None or entry.report.audit.is_clean for entry in demo.comparison.entries)
    return DONE if is_clean else NO
