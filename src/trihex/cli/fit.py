"""`trihex fit`: which cells fit which robots in a place."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trihex.cli.described import read_described
from trihex.cli.group import DONE, NO
from trihex.cli.options import PATH, area_options, destination_option, wrong_use
from trihex.cli.outputs import check_outputs, tell_written
from trihex.cli.progress import bar
from trihex.cli.types import Name

if TYPE_CHECKING:
    from trihex.areas import Fit, Tessellation


@click.command("fit")
@click.argument("area", type=PATH)
@area_options
@destination_option
@click.option(
    "--clock",
    type=Name("trihex.areas.tessellation", "CLOCKS"),
    help="Whether moves last a step each, or as long as they cost. [default: both, where cells depend on it]",
)
@click.option("--picture", type=PATH, metavar="FILE", help="All of them drawn beside each other, as .png.")
def command(area: Path, picture: Path | None, **options: Any) -> int:
    """Tell for all kinds of cells how small they can be for robots of a radius, and what these then find in a place.

    AREA is a place in metres: a ROS map, an image with --resolution, GeoJSON, WKT or DXF. With --robot-radius cells are
    as small as robots allow, with --cell-size robots as large as cells allow; with neither, and a destination, robots
    are the largest that reach it. The grid is shifted and turned so that most connects, unless --align corner is given.

    The greatest radius is that at which half of the free cells still reach a destination. Where following is forbidden,
    a robot enters a cell only when the one before it has left it for good; then smaller cells do.

    Exit status 1: robots find no free cell, whatever the cells.
    """
    from trihex.areas import kinds_to_fit, make_fits

    check_outputs((picture, (".png",), "a picture"))
    goals = options.pop("destination")
    if any(isinstance(number, int) for place in goals for number in place):
        raise wrong_use("--destination must be in metres, X,Ym: which cell lies where depends on what fits")
    radius, size, align = options["robot_radius"], options["cell_size"], options["align"] or "best"
    kinds = _tessellations(options)
    fits = []
    with bar("fitting", "kinds") as progress:
        for fit in make_fits(lambda *how: _laid(area, goals, options, *how), kinds, radius, size, align):
            fits.append(fit)
            progress(len(fits), len(kinds_to_fit(kinds)))
    if radius is None and size is None and not any(fit.free_count for fit in fits):
        raise wrong_use("no robot reaches a destination: add --robot-radius R, --cell-size S or --destination X,Ym")
    click.echo("\n".join(fit_lines(fits)))
    if picture:
        from trihex.files import new_file
        from trihex.pictures import write_fits

        with new_file(picture) as part:
            write_fits(fits, part)
        tell_written(picture)
    return DONE if any(fit.free_count for fit in fits) else NO


def _tessellations(options: dict[str, Any]) -> list[Tessellation]:
    """Return all tessellations, or those that options name."""
    from trihex.areas import CLOCKS, NEIGHBOURHOODS, TESSELLATIONS, Tessellation

    names = TESSELLATIONS if options["tessellation"] is None else (options["tessellation"],)
    reaches = NEIGHBOURHOODS if options["neighbourhood"] is None else (options["neighbourhood"],)
    clocks = CLOCKS if options["clock"] is None else (options["clock"],)
    costs = options["costs"] or "paper"
    kinds = [Tessellation(name, reach, costs, clock) for name in names for reach in reaches for clock in clocks]
    # Hexagons have no neighbours but those across edges.
    return [kind for kind in kinds if kind.name != "hexagonal" or kind.neighbourhood == reaches[0]]


def _laid(path: Path, goals: Sequence[tuple[float, float]], options: dict[str, Any], *how: Any) -> tuple[Any, Any]:
    """Return the area that covers the place in a file and the cells of destinations, or None and why it cannot be."""
    from trihex.errors import AreaError, TooLargeError
    from trihex.formats import NoRoomError

    tessellation, size, radius, align = how
    given = {"tessellation": tessellation, "neighbourhood": None, "costs": None, "clock": None, "align": align}
    try:
        draft = read_described(path, {**options, **given, "cell_size": size, "robot_radius": radius})
        if draft.area.ground is None:
            raise wrong_use(f"{path} is no place in metres: fit takes a ROS map, an image, GeoJSON, WKT or DXF")
        cells = [int(draft.area.metres_to_cell(*goal)) for goal in goals]
    except (AreaError, TooLargeError, NoRoomError) as error:
        return None, str(error)
    return draft.area, cells or (() if draft.destinations is None else draft.destinations)


def fit_lines(fits: Sequence[Fit]) -> list[str]:
    """Return what fits as a table, and below it why some cannot be."""
    from trihex.cli.texts import table_lines

    header = (
        "cells",
        "neighbours",
        "following",
        "clock",
        "cell size",
        "radius",
        "free",
        "connected",
        "reach",
        "greatest",
        "grid",
    )
    rows = [_row(fit) for fit in fits]
    notes = [
        f"{row[0]}, {row[1]} neighbours, following {row[2]}{_by_clock(fit)}: {fit.why}"
        for row, fit in zip(rows, fits, strict=True)
        if fit.why
    ]
    return [*table_lines(header, rows, left=4), *notes]


def _by_clock(fit: Fit) -> str:
    return f", clock {fit.clocks[0]}" if len(fit.clocks) == 1 else ""


def _row(fit: Fit) -> list[str]:
    clock = fit.clocks[0] if len(fit.clocks) == 1 else "any"
    kind = [fit.tessellation.name, str(fit.tessellation.direction_count), fit.following, clock]
    sizes = [f"{fit.cell_size:g} m" if fit.cell_size else "-", f"{fit.robot_radius:g} m" if fit.robot_radius else "-"]
    reach, greatest = fit.reaching_share, fit.greatest_radius
    shares = [
        "-" if fit.area is None else str(fit.free_count),
        "-" if fit.area is None else f"{100 * fit.connected_share:.1f} %",
        "-" if reach is None else f"{100 * reach:.1f} %",
        "-" if greatest is None else f"{greatest:g} m",
    ]
    return [*kind, *sizes, *shares, _grid(fit)]


def _grid(fit: Fit) -> str:
    """Return where the north-west corner of the grid is and how it is turned."""
    if fit.area is None:
        return "-"
    frame = fit.area.metres
    turn = degrees(frame.yaw - fit.area.ground.yaw) if fit.area.ground else 0.0
    return f"({frame.origin[0]:.4g}, {frame.origin[1]:.4g})" + (f", {turn:.4g} degrees" if turn else "")
