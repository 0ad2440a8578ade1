"""Command line: what `trihex` does in a shell; one module a command, and the only part that prints."""

from __future__ import annotations

import click

from trihex import __version__
from trihex.cli import animate, check, compare, convert, demo, field, generate, plan, show
from trihex.cli.group import Commands


@click.group(
    "trihex",
    cls=Commands,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)
@click.version_option(__version__, prog_name="trihex", message="%(prog)s %(version)s")
@click.pass_context
def main(context: click.Context) -> None:
    """Collision-free paths for many robots with a common goal, on triangles, hexagons and squares.

    Exit status: 0 done; 1 the answer is no (an unsafe plan, robots that cannot arrive); 2 wrong use or bad input.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


for module in (demo, plan, field, compare, check, animate, show, generate, convert):
    main.add_command(module.command)
