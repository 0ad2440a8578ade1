"""`trihex study`: many runs as one table, by many processes or a cluster."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from time import monotonic
from typing import Any

import click

from trihex.cli.group import DONE, NO
from trihex.cli.options import PATH, wrong_use
from trihex.cli.progress import bar
from trihex.cli.types import Whole

_SECONDS_BETWEEN_LINES = 60


@click.command("study")
@click.argument("study", type=PATH)
@click.option(
    "--out", type=PATH, metavar="FILE", help="The table, .csv or .parquet. [default: the name of STUDY with .csv]"
)
@click.option("--jobs", type=Whole(1), help="How many processes work. [default: one for each core]")
@click.option("--scheduler", metavar="ADDRESS", help="Have the workers of a Dask scheduler work: tcp://HOST:PORT.")
def command(study: Path, out: Path | None, jobs: int | None, scheduler: str | None) -> int:
    """Do all runs of a study: a grid of areas, tessellations, rules, robots and planners, as one table.

    STUDY is a .toml file. Rows are kept as they come in a journal beside the table, FILE.journal; interrupted or
    killed, the same command goes on where it was. A run that fails is a row with its error. Columns that begin with
    seconds are CPU times; all others are the same whoever does the work in whatever order.

    Exit status 1: some runs failed, or made an unsafe plan.
    """
    if jobs and scheduler:
        raise wrong_use("--jobs and --scheduler exclude each other")
    out = study.with_suffix(".csv") if out is None else out
    try:
        with _progress() as progress:  # what is needed is imported under it, or nothing would be seen meanwhile
            outcome = _written(study, out, jobs, scheduler, progress)
    except (KeyboardInterrupt, SystemExit):
        from trihex.studies import journal_of

        if journal_of(out).exists():
            click.echo(f"trihex: what is done is kept in {journal_of(out)}; the same command goes on", err=True)
        raise
    amiss = [f", {count} {what}" for count, what in ((outcome.failed, "failed"), (outcome.unsafe, "unsafe")) if count]
    click.echo(f"{out}: {outcome.runs} runs{''.join(amiss)}")
    return NO if amiss else DONE


def _written(
    study: Path, out: Path, jobs: int | None, scheduler: str | None, progress: Callable[[int, int], None]
) -> Any:
    """Do the runs and write the table; return what became of them."""
    from trihex.files import check_output
    from trihex.studies import check_results, read_study, write_study

    check_results(out)
    check_output(out)
    runs = read_study(study)
    with _workers(scheduler) as executor:
        return write_study(runs, out, executor=executor, jobs=jobs, progress=progress)


def _workers(scheduler: str | None) -> Any:
    if scheduler is None:
        return nullcontext()
    from trihex.studies import connected

    return connected(scheduler)


@contextmanager
def _progress() -> Iterator[Callable[[int, int], None]]:
    """Yield what shows how far the runs are and how long the rest will take: a bar, or unwatched a line a minute."""
    if sys.stderr.isatty():
        with bar("running", "runs") as move:
            yield move
        return
    first, begin, last = -1, monotonic(), monotonic()

    def tell(done: int, total: int) -> None:
        nonlocal first, last
        first, now = done if first < 0 else first, monotonic()
        if now - last >= _SECONDS_BETWEEN_LINES and first < done < total:
            left = (now - begin) / (done - first) * (total - done)
            click.echo(f"trihex: {done} of {total} runs, about {_told(left)} left", err=True)
            last = now

    yield tell


def _told(seconds: float) -> str:
    """Return a duration as a person says it."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
