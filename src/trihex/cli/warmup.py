"""`trihex warmup`: compile everything beforehand, for containers, classrooms and robots."""

from __future__ import annotations

import click

from trihex.cli.types import Name


@click.command("warmup")
@click.option("--planner", type=Name("trihex.planners", "PLANNERS"), help="Only what its plans need. [default: all]")
def command(planner: str | None) -> None:
    """Compile all that trihex runs, and keep it on disk, so that no later command waits for it.

    It is kept in the folder of the package, or, where that cannot be written, in that of the user's cache;
    NUMBA_CACHE_DIR names another, which may be shared by machines of one kind.
    """
    from trihex.errors import TrihexError
    from trihex.fields import every_field_kernels
    from trihex.kernels.marks import can_keep, is_marked
    from trihex.kernels.needs import KERNELS_OF, Kernels, kernels_of
    from trihex.kernels.preparing import prepare

    if not can_keep():
        raise TrihexError("there is no folder in which compiled kernels can be kept: set NUMBA_CACHE_DIR to one")
    judges = ("audit", "timely audit", "bound")
    names = [use for use in KERNELS_OF if not planner or planner in use.replace("_", " ").split() or use in judges]
    uses: list[str | Kernels] = [*names, *every_field_kernels()]
    missing = sum(not is_marked(kernels) for kernels in kernels_of(uses))
    prepare(*uses)
    click.echo(f"{len(kernels_of(uses))} parts are ready, {missing} of them compiled now")
