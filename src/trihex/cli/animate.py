"""`trihex animate`: a plan as a movie, or as a page that plays it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trihex.cli.options import PATH, area_options, read_judged, rule_options
from trihex.cli.outputs import check_outputs
from trihex.cli.progress import bar
from trihex.cli.types import Whole


@click.command("animate")
@click.argument("plan", type=PATH)
@click.argument("area", type=PATH, required=False)
@area_options
@rule_options
@click.option("--out", type=PATH, metavar="FILE", required=True, help="The movie, as .gif, .mp4 or .html.")
@click.option("--width", type=Whole(1), help="Pixels across the cells. [default: what suits the area]")
@click.option("--frames-per-second", type=Whole(1), default=20, show_default=True, help="At most 50.")
@click.option("--max-frames", type=Whole(2), default=240, show_default=True, help="A long plan is shown in as many.")
def command(
    plan: Path,
    area: Path | None,
    out: Path,
    width: int | None,
    frames_per_second: int,
    max_frames: int,
    **options: Any,
) -> None:
    """Draw the robots of a plan on their way, coloured by their sets.

    A page .html plays in any browser, offline, with pause, zoom and all numbers; the options of movies do not matter.

    PLAN is .npz, which holds area and rules itself, or .csv, which needs AREA and the options that it was made with.
    """
    from trihex.movie import SUFFIXES, write_animation
    from trihex.viewer.page import SUFFIXES as PAGE_SUFFIXES
    from trihex.viewer.page import write_page

    check_outputs((out, (*SUFFIXES, *PAGE_SUFFIXES), "a movie"))
    shown = read_judged(plan, area, options)
    if out.suffix.lower() in PAGE_SUFFIXES:
        write_page(shown, out)
        click.echo(f"{out}: {shown.scenario.robot_count} robots, {shown.steps} steps")
        return
    with bar("drawing", "frames") as progress:
        write_animation(
            shown, out, width=width, frames_per_second=frames_per_second, max_frames=max_frames, progress=progress
        )
    click.echo(f"{out}: {shown.scenario.robot_count} robots, {shown.steps} steps")
