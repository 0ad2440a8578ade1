"""`trihex generate`: areas from nothing but a seed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trihex.cli.options import PATH, wrong_use
from trihex.cli.outputs import check_outputs
from trihex.cli.types import Name, Pair, Share, Whole


@click.command("generate")
@click.argument("kind", type=Name("trihex.areas.generators", "GENERATORS"))
@click.option("--size", type=Pair("WIDTH,HEIGHT"), required=True, help="Width and height in cells.")
@click.option(
    "--tessellation",
    type=Name("trihex.areas.tessellation", "TESSELLATIONS"),
    default="hexagonal",
    help="What shape of cells the area is made for. [default: hexagonal]",
)
@click.option("--seed", type=Whole(0), default=0, show_default=True, help="The same seed makes the same area.")
@click.option("--density", type=Share(), help="random, caves: share of barriers.")
@click.option("--rounds", type=Whole(0), help="caves: how often the walls are smoothed.")
@click.option("--room", type=Whole(1), help="rooms: cells along a side.")
@click.option("--doors", type=Share(), help="rooms: share of the spare walls that have a door.")
@click.option("--shelf-length", type=Whole(1), help="warehouse: cells from west to east.")
@click.option("--shelf-depth", type=Whole(1), help="warehouse: cells from north to south.")
@click.option("--aisle", type=Whole(1), help="warehouse: cells between shelves.")
@click.option("--missing", type=Share(), help="warehouse: share of the shelves left out.")
@click.option("--out", type=PATH, metavar="AREA", required=True, help="The area, as .map or .txt.")
@click.option("--picture", type=PATH, metavar="FILE", help="The area drawn, as .png, .svg or .pdf.")
def command(
    kind: str,
    size: tuple[int, int],
    tessellation: str,
    seed: int,
    out: Path,
    picture: Path | None,
    **options: Any,
) -> None:
    """Make an area: random, rooms, maze, caves or warehouse.

    The file does not keep the tessellation; name it again where the area is used.
    """
    from inspect import signature

    from trihex.areas import GENERATORS
    from trihex.formats import AREA_SUFFIXES, write_area
    from trihex.pictures import PICTURE_SUFFIXES, picture_of_area

    check_outputs((out, AREA_SUFFIXES, "an area"), (picture, PICTURE_SUFFIXES, "a picture"))
    given = {name: value for name, value in options.items() if value is not None}
    known = signature(GENERATORS[kind]).parameters
    for name in given:
        if name not in known:
            owners = [other for other, maker in GENERATORS.items() if name in signature(maker).parameters]
            raise wrong_use(f"--{name.replace('_', '-')} belongs to {' and '.join(owners)}, not to {kind}")
    width, height = size
    area = GENERATORS[kind](tessellation, height, width, seed=seed, **given)
    write_area(area, out)
    if picture:
        picture_of_area(area).save(picture)
    share = 100 * area.free_count / area.cell_count
    click.echo(f"{out}: {width} x {height} cells, {area.free_count} free ({share:.1f} %)")
