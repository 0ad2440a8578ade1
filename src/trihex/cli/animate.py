"""`trihex animate`: a plan as a movie, or as a page that plays it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trihex.cli.described import read_played
from trihex.cli.options import PATH, area_options, rule_options, wrong_use
from trihex.cli.outputs import check_outputs
from trihex.cli.progress import bar
from trihex.cli.types import Metres, Whole


@click.command("animate")
@click.argument("plan", type=PATH)
@click.argument("area", type=PATH, required=False)
@area_options
@rule_options
@click.option("--out", type=PATH, metavar="FILE", required=True, help="The movie, as .gif, .mp4 or .html.")
@click.option("--width", type=Whole(1), help="Pixels across the cells. [default: what suits the area]")
@click.option("--frames-per-second", type=Whole(1), default=20, show_default=True, help="At most 50.")
@click.option("--max-frames", type=Whole(2), default=240, show_default=True, help="A long plan is shown in as many.")
@click.option("--title", metavar="TEXT", help="Above the picture; '' leaves it out. [default: planner and area]")
@click.option("--show-clock/--no-clock", default=True, help="Whether to tell the step and how many have arrived.")
@click.option("--legend/--no-legend", default=True, help="Whether to explain the colours.")
@click.option("--speed", type=Metres(), default=1.0, help="Metres a second, for the clock. [default: 1.0]")
@click.option("--beside", type=PATH, metavar="PLAN", help="Pages: another one, played beside it on the same clock.")
def command(
    plan: Path,
    area: Path | None,
    out: Path,
    beside: Path | None,
    **options: Any,
) -> None:
    """Draw the robots of a plan or a run on their way, coloured by their sets.

    A page .html plays in any browser, offline, with pause, zoom and all numbers; the options of movies do not matter.

    PLAN is a plan or a run as .npz, which holds area and rules itself, or a plan as .csv, which needs AREA and the
    options that it was made with.
    """
    from trihex.pictures import MOVIE_SUFFIXES, write_animation
    from trihex.viewer import PAGE_SUFFIXES, write_page

    drawn = {
        name: options.pop(name) for name in ("width", "frames_per_second", "max_frames", "title", "legend", "speed")
    }
    drawn["clock"] = options.pop("show_clock")
    check_outputs((out, (*MOVIE_SUFFIXES, *PAGE_SUFFIXES), "a movie"))
    if beside is not None and out.suffix.lower() not in PAGE_SUFFIXES:
        raise wrong_use(f"--beside is for pages (.html); {out} shows one plan")
    shown = read_played(plan, area, options)
    if out.suffix.lower() in PAGE_SUFFIXES:
        write_page(shown, out, beside=None if beside is None else read_played(beside, area, options))
        click.echo(f"{out}: {shown.robots.size} robots, {shown.steps} {shown.scenario.step_word}s")
        return
    with bar("drawing", "frames") as progress:
        write_animation(shown, out, progress=progress, **drawn)
    click.echo(f"{out}: {shown.robots.size} robots, {shown.steps} {shown.scenario.step_word}s")
