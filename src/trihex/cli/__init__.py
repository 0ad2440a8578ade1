"""Command line: what `trihex` does in a shell; one module a command, and the only part that prints."""

from __future__ import annotations

import click

from trihex import __version__
from trihex.cli.group import Commands

# The module of each command under trihex.cli, in the order of the help, and what it says there. To add a command, write
# a module that defines `command`, and add a line here.
COMMANDS = {
    "demo": "All planners on the three tessellations: a table, pictures and an animation.",
    "plan": "Plan collision-free paths for all robots.",
    "run": "Let robots run through a world that changes, is unknown, or makes them late.",
    "field": "Compute the N-scheme and the D-scheme.",
    "compare": "Compare planners: total time, gap, steps, seconds.",
    "study": "Do many runs as one table, by many processes or a cluster.",
    "check": "Tell whether a plan is safe.",
    "prices": "Tell what each wall and each door costs.",
    "score": "Tell how far a recorded crowd is from the best possible.",
    "animate": "Draw the robots of a plan on their way.",
    "view": "Open the viewer: paint, plan, play, compare and run live in a browser.",
    "fit": "Tell which cells fit which robots in a place.",
    "show": "Tell what an area is like.",
    "generate": "Make an area: random, rooms, maze, caves or warehouse.",
    "convert": "Write a plan, an area or a scenario in another format.",
    "warmup": "Compile everything beforehand.",
}


@click.group(
    "trihex",
    cls=Commands,
    summary_of_command=COMMANDS,
    package="trihex.cli",
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
