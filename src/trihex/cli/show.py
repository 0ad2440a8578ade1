"""`trihex show`: what an area is like, before anything is planned."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trihex.cli.described import read_described
from trihex.cli.options import PATH, area_options, wrong_use
from trihex.cli.types import Whole

if TYPE_CHECKING:
    from trihex.areas import Area

_MOST_REGIONS = 5


@click.command("show")
@click.argument("area", type=PATH)
@area_options
@click.option(
    "--layers", is_flag=True, help="DXF: list the layers, what they are taken for and what is not understood."
)
@click.option("--columns", type=Whole(1), default=72, show_default=True, help="Width of the drawing in letters.")
def command(area: Path, layers: bool, columns: int, **options: Any) -> None:
    """Tell size, free share and connected parts of an area, and draw it.

    In the drawing, D is a destination and o a robot of the file; of the cells that another letter stands for, none
    (.), less than half (:), half and more (+) or all (#) are barriers. Small areas, by default of up to 72 x 48
    cells, have a letter for each cell.
    """
    from trihex.pictures import preview_lines

    if layers:
        click.echo("\n".join(_layers(area, options)))
        return
    draft = read_described(area, options)
    click.echo("\n".join(_told(draft.area)))
    for name, cells in (("destinations", draft.destinations), ("robots", draft.robots)):
        if cells is not None:
            click.echo(f"{name}: {len(cells)}")
    rows = max(1, columns // 3)
    click.echo("\n".join(preview_lines(draft.area, draft.destinations, draft.robots, columns=columns, rows=rows)))


def _layers(path: Path, options: dict[str, Any]) -> list[str]:
    """Return the layers of a DXF file as a table."""
    from trihex.cli.texts import table_lines
    from trihex.files import read_bytes
    from trihex.formats import AreaOptions, format_of, read_layers

    if format_of(read_bytes(path), path) != "dxf":
        raise wrong_use(f"--layers lists those of a DXF file, which {path} is not")
    given = {name: options[name] for name in ("walls", "exits", "rooms", "unit")}
    rows = read_layers(path, AreaOptions("hexagonal", **given))  # type: ignore[arg-type]
    if not rows:
        return [f"{path}: draws nothing"]
    return table_lines(list(rows[0]), [[str(value) for value in row.values()] for row in rows], left=2)


def _told(area: Area) -> list[str]:
    from trihex.areas import make_regions

    tessellation, sizes = area.tessellation, make_regions(area).size_of_region.tolist()
    share = 100 * area.free_count / area.cell_count
    lines = [
        f"{area.name or 'area'}: {area.width} x {area.height} cells, {tessellation.name}, {tessellation.neighbourhood} "
        f"neighbourhood; {area.free_count} free ({share:.1f} %)"
    ]
    if (frame := area.frame) is not None:
        east, south = (frame.cell_size * length for length in tessellation.extent(area.height, area.width))
        lines.append(
            f"{east:.6g} x {south:.6g} metres, cell size {frame.cell_size:g}, robot radius {frame.robot_radius:g}; "
            f"north-west corner at ({frame.origin[0]:.6g}, {frame.origin[1]:.6g}), yaw {frame.yaw:g}"
        )
    shown = ", ".join(str(size) for size in sizes[:_MOST_REGIONS]) + (", ..." if len(sizes) > _MOST_REGIONS else "")
    regions = f"{len(sizes)} connected part{'s' * (len(sizes) != 1)}"
    return [*lines, f"{regions}, of {shown} cells" if sizes else "no cell is free"]
