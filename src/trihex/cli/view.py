"""`trihex view`: the viewer in a browser."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import click

from trihex.cli.described import read_described, read_played
from trihex.cli.options import PATH, area_options, robot_options, rule_options, wrong_use
from trihex.cli.types import Names, Whole


@click.command("view")
@click.argument("file", type=PATH, required=False)
@click.argument("area", type=PATH, required=False)
@area_options
@rule_options
@robot_options
@click.option("--port", type=Whole(0), default=0, help="Port of the server. [default: a free one]")
@click.option("--no-browser", is_flag=True, help="Only tell the address.")
@click.option(
    "--export",
    type=PATH,
    metavar="FOLDER",
    help="Write the viewer with plans for any static host; start no server.",
)
@click.option(
    "--planners",
    type=Names("trihex.planners", "PLANNERS"),
    help="Which plans --export makes. [default: fcost,greedy; optimal, too, in the small]",
)
def command(file: Path | None, area: Path | None, port: int, no_browser: bool, **options: Any) -> None:
    """Open the viewer: paint, plan, play, compare and run live in a browser.

    FILE is an area, a scenario, a plan or a run; a plan as .csv or .parquet needs AREA as well. Without FILE there are
    some rooms to play with. Files are opened and saved in the folder in which the command was started, and below it.
    With --export it becomes a folder for any static host: plans to play and to compare, without a server.

    The server listens on this machine only, and answers only those who know the address that is told here.
    """
    from trihex.files import read_bytes
    from trihex.formats import FORMATS, format_of
    from trihex.viewer import open_viewer

    export, planners = options.pop("export"), options.pop("planners")
    if file is None and any(value not in (None, ()) for value in options.values()):
        raise wrong_use("options tell how FILE is read: name a FILE")
    if port > 65535:
        raise wrong_use(f"--port must be at most 65535, not {port}")
    record: Any = None
    if file is not None:
        is_plan = FORMATS[format_of(read_bytes(file), file)].holds == "plan"
        if area is not None and not is_plan:
            raise wrong_use(f"AREA belongs to a plan; {file} is none")
        record = read_played(file, area, options) if is_plan else read_described(file, options)
    if planners and export is None:
        raise wrong_use("--planners is for --export")
    if export is not None:
        return _export(record, export, planners)
    with suppress(KeyboardInterrupt):  # which does not come where who started the command ignores Ctrl-C
        open_viewer(record, port=port, browser=not no_browser, tell=_tell)
    click.echo("stopped")


def _export(record: Any, folder: Path, planners: tuple[str, ...] | None) -> None:
    from trihex.cli.progress import bar
    from trihex.viewer import write_site

    with bar("planning", "answers") as progress:
        written = write_site(record, folder, planners=planners, progress=progress)
    size = sum(path.stat().st_size for path in written)
    click.echo(f"{folder / 'index.html'}: {len(written)} files, {size / 1e6:.1f} MB, for any static host; to try it:")
    click.echo(f"  python -m http.server --directory {folder}")


def _tell(address: str) -> None:
    click.echo(f"The viewer is at {address}\nCtrl-C stops it.")
