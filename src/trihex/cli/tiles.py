"""Tiles: what `trihex field` does with an area that may be larger than memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import click

from trihex.cli.options import wrong_use
from trihex.cli.progress import bar


class Tiling(NamedTuple):
    """How large the tiles are, and who settles them; None where nothing is said."""

    tile: int | None
    jobs: int | None
    scheduler: str | None


def make_tiles(area: Path, out: Path | None, tiling: Tiling, options: dict[str, Any]) -> None:
    """Compute the N-scheme of the array `area` into the file `out`, and say so."""
    from trihex.areas import Tessellation
    from trihex.fields import TILE_SIDE as SIDE, make_tiled_field

    if out is None:
        raise wrong_use(f"{area} is settled tile by tile into a file: add --out FILE")
    if tiling.jobs and tiling.scheduler:
        raise wrong_use("--jobs and --scheduler exclude each other")
    places = options["destination"]
    if not places:
        raise wrong_use("there is no destination: add --destination X,Y")
    if not all(isinstance(place[0], int) for place in places):
        raise wrong_use(f"--destination must be a cell X,Y: {area} is not measured in metres")
    kind = Tessellation(
        options["tessellation"] or "hexagonal",
        options["neighbourhood"] or "full",
        options["costs"] or "paper",
        options["clock"] or "steps",
    )
    with _executor(tiling) as (executor, workers), bar("settling", "tiles") as progress:
        field = make_tiled_field(
            area,
            places,
            out,
            kind,
            corners=options["corners"] or "allow",
            side=tiling.tile or SIDE,
            executor=executor,
            workers=workers,
            progress=progress,
        )
    height, width = field.shape
    click.echo(f"{area.name}: {width} x {height} cells in {field.tile_count} tiles, {field.visit_count} visits; {out}")


@contextmanager
def _executor(tiling: Tiling) -> Iterator[tuple[Any, int]]:
    """Yield where tiles are settled, and how many at once."""
    _, jobs, scheduler = tiling
    if scheduler:
        from trihex.studies import connected

        with connected(scheduler) as cluster:
            # Two for each thread, so that none waits for the next tile; a tile woken again is no repetition.
            workers = 2 * sum(cluster.client.nthreads().values())
            yield cluster.client.get_executor(pure=False), workers
    elif jobs and jobs > 1:
        from concurrent.futures import ProcessPoolExecutor
        from multiprocessing import get_context

        with ProcessPoolExecutor(jobs, get_context("spawn")) as pool:
            yield pool, jobs
    else:
        yield None, 1
