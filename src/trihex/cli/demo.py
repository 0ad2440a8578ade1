"""`trihex demo`: all planners on the three tessellations, to see at a glance what there is."""

from __future__ import annotations

from pathlib import Path

import click

from trihex.cli.group import DONE, NO
from trihex.cli.options import PATH
from trihex.cli.progress import bar


@click.command("demo")
@click.option("--out", type=PATH, metavar="DIR", default="demo", show_default=True, help="Where files are written.")
def command(out: Path) -> int:
    """Plan with every planner on the three tessellations; print a table, leave pictures and an animation."""
    from trihex.cli.texts import comparison_lines
    from trihex.demo import run_demo

    with bar("planning and drawing", "parts") as progress:
        demo = run_demo(out, progress=lambda _, done, total: progress(done, total))
    scenario = demo.comparison.entries[0].scenario
    click.echo(f"{scenario.robot_count} robots leave a {scenario.area.name} of {scenario.area.free_count} free cells")
    click.echo("\n".join(comparison_lines(demo.comparison.rows())))
    click.echo("a gap marked <= is measured against a lower bound, the true gap is at most that; see")
    click.echo("\n".join(f"  {path}" for path in demo.files))
    is_clean = all(entry.report is None or entry.report.audit.is_clean for entry in demo.comparison.entries)
    return DONE if is_clean else NO
