"""`trihex field`: distances and directions to the destinations, without any robots."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import click

from trihex.cli.described import complete, read_described
from trihex.cli.options import PATH, area_options, gathered, rule_options, wrong_use
from trihex.cli.outputs import check_outputs, tell_written
from trihex.cli.progress import bar
from trihex.cli.tiles import Tiling, make_tiles
from trihex.cli.types import Whole


class Outputs(NamedTuple):
    """What is written and drawn."""

    out: Path | None
    directions: Path | None
    picture: Path | None
    directions_picture: Path | None
    generations: Path | None


@click.command("field")
@click.argument("area", type=PATH)
@area_options
@rule_options
@click.option("--out", type=PATH, metavar="FILE", help="The N-scheme as .npy, int32 [y, x], or .tmj for Tiled.")
@click.option(
    "--directions",
    type=PATH,
    metavar="FILE",
    help="The D-scheme as .npy, uint16 [y, x], or .tmj for Tiled.",
)
@click.option("--picture", type=PATH, metavar="FILE", help="The N-scheme drawn, as .png, .svg or .pdf.")
@click.option("--directions-picture", type=PATH, metavar="FILE", help="The D-scheme drawn, as .png, .svg or .pdf.")
@click.option("--generations", type=PATH, metavar="DIR", help="A picture of every generation of the automaton.")
@click.option("--tile", type=Whole(2), help="Areas in .npy or .zarr: cells along a tile, even. [default: 2048]")
@click.option("--jobs", type=Whole(1), help="Areas in .npy or .zarr: processes that settle tiles. [default: 1]")
@click.option("--scheduler", metavar="ADDRESS", help="Areas in .npy or .zarr: the Dask scheduler to settle tiles on.")
@gathered("outputs", Outputs)
@gathered("tiling", Tiling)
def command(area: Path, outputs: Outputs, tiling: Tiling, **options: Any) -> None:
    """Compute the N-scheme and the D-scheme.

    The N-scheme holds for each cell the least cost to a destination, 2147483647 where none can be reached. The D-scheme
    holds the directions that attain it: bit k is set where direction k of the tessellation is one of the best.

    An area larger than memory is an array in .npy or .zarr, [y, x], not 0 at barriers. Its N-scheme is found tile by
    tile, into --out alone (.npy or .zarr); interrupted at any moment, the same command goes on.
    """
    if area.suffix.lower() in (".npy", ".zarr"):
        if any(outputs._replace(out=None)):
            raise wrong_use(f"directions and pictures need an area in memory, not one in {area.suffix}")
        make_tiles(area, outputs.out, tiling, options)
        return
    if given := [name for name, value in tiling._asdict().items() if value]:
        raise wrong_use(f"--{given[0]} is for areas in .npy or .zarr")
    from trihex.fields import make_n_scheme

    _check_outputs(outputs)
    drawn = ("picture",) if outputs.picture or outputs.directions_picture else ()
    directed = ("d_scheme",) if outputs.directions or outputs.directions_picture else ("n_scheme",)
    scenario = complete(read_described(area, options), *directed, *drawn, needs_robots=False)
    n_scheme = make_n_scheme(scenario)
    _write(n_scheme, outputs, area)
    _tell(n_scheme)
    tell_written(outputs.out, outputs.directions, outputs.picture, outputs.directions_picture)
    if outputs.generations:
        click.echo(f"{_draw_generations(n_scheme, outputs.generations)} generations in {outputs.generations}")


def _check_outputs(outputs: Outputs) -> None:
    from trihex.formats import LAYER_SUFFIXES
    from trihex.pictures import PICTURE_SUFFIXES

    check_outputs(
        (outputs.out, (".npy", *LAYER_SUFFIXES), "an N-scheme"),
        (outputs.directions, (".npy", *LAYER_SUFFIXES), "a D-scheme"),
        (outputs.picture, PICTURE_SUFFIXES, "a picture"),
        (outputs.directions_picture, PICTURE_SUFFIXES, "a picture"),
    )


def _write(n_scheme: Any, outputs: Outputs, area: Path) -> None:
    """Write and draw the N-scheme and the D-scheme."""
    from trihex.fields import make_d_scheme
    from trihex.pictures import picture_of_d_scheme, picture_of_n_scheme

    if outputs.out:
        _write_field(n_scheme, n_scheme.distance, outputs.out, area)
    if outputs.picture:
        picture_of_n_scheme(n_scheme).save(outputs.picture)
    if not (outputs.directions or outputs.directions_picture):
        return
    d_scheme = make_d_scheme(n_scheme)
    if outputs.directions:
        _write_field(d_scheme, d_scheme.directions, outputs.directions, area)
    if outputs.directions_picture:
        picture_of_d_scheme(d_scheme).save(outputs.directions_picture)


def _write_field(scheme: Any, values: Any, path: Path, area: Path) -> None:
    """Write an array, or layers for Tiled that lie as in the map from which the area was read."""
    from trihex.formats import LAYER_SUFFIXES, write_field, write_tiled

    if path.suffix.lower() in LAYER_SUFFIXES:
        write_tiled(scheme, path, like=area)
    else:
        write_field(values, path)


def _tell(n_scheme: Any) -> None:
    """Print how much of the area reaches a destination, and how far it is."""
    from trihex.kernels.codes import NOT_REACHED

    area, reached = n_scheme.scenario.area, int((n_scheme.distance != NOT_REACHED).sum())
    click.echo(
        f"{area.name}: {reached} of {area.free_count} free cells reach a destination, "
        f"the farthest at cost {n_scheme.farthest}"
    )


def _draw_generations(n_scheme: Any, folder: Path) -> int:
    """Draw each generation, all in the colours of the N-scheme; return how many there are."""
    from trihex.fields import distance_generations
    from trihex.pictures import picture_of_generation

    scenario, far, count = n_scheme.scenario, n_scheme.farthest, 0
    folder.mkdir(parents=True, exist_ok=True)
    with bar("drawing", "generations") as progress:
        for states in distance_generations(scenario):
            title = f"{scenario.area.name}, generation {count}"
            drawn = picture_of_generation(scenario, states, count, far=far, title=title)
            drawn.save(folder / f"generation-{count:04d}.png")
            count += 1
            progress(count, count)
    return count
