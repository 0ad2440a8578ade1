"""Maps: options of commands that tell where robots lost time, where they crowded, and when they left by which exit."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import click

from trihex.cli.options import PATH, Command
from trihex.cli.outputs import check_outputs

CHART_SUFFIXES = (".png", ".svg", ".pdf")


class Maps(NamedTuple):
    """What is written."""

    waiting: Path | None
    density: Path | None
    arrivals: Path | None


def map_options(command: Command) -> Command:
    """Add them."""
    for option in (
        click.option(
            "--arrivals",
            type=PATH,
            metavar="FILE",
            help="How many have left by each exit and step, beside the most that can: .csv, .png, .svg or .pdf.",
        ),
        click.option("--density", type=PATH, metavar="FILE", help="Robots in each cell in the mean, drawn or .npy."),
        click.option("--waiting", type=PATH, metavar="FILE", help="Time lost in each cell, drawn or .npy in steps."),
    ):
        command = option(command)
    return command


def check_maps(maps: Maps) -> None:
    """Raise unless all can be written."""
    if not any(maps):
        return
    from trihex.pictures import PICTURE_SUFFIXES

    pictures = (*PICTURE_SUFFIXES, ".npy")
    chart = "a chart" if maps.arrivals is not None and maps.arrivals.suffix.lower() != ".csv" else "a table"
    check_outputs(
        (maps.waiting, pictures, "a map"),
        (maps.density, pictures, "a map"),
        (maps.arrivals, (".csv", *CHART_SUFFIXES), chart),
    )


def write_maps(motion: Any, maps: Maps, pace: dict[str, float]) -> None:
    """Write what is wanted of a plan or a run; `pace` has the speed of robots, if it is told."""
    from trihex.formats import write_field
    from trihex.plans import make_density_map, make_waiting_map

    speed: dict[str, Any] = {name: value for name, value in pace.items() if name == "speed"}
    if maps.waiting is not None:
        if maps.waiting.suffix.lower() == ".npy":
            write_field(make_waiting_map(motion), maps.waiting)
        else:
            from trihex.pictures import picture_of_waiting

            picture_of_waiting(motion, **speed).save(maps.waiting)
    if maps.density is not None:
        if maps.density.suffix.lower() == ".npy":
            write_field(make_density_map(motion), maps.density)
        else:
            from trihex.pictures import picture_of_density

            picture_of_density(motion).save(maps.density)
    if maps.arrivals is not None:
        _write_exits(motion, maps.arrivals, speed)


def _write_exits(motion: Any, path: Path, speed: dict[str, Any]) -> None:
    from trihex.areas import seconds_per_step
    from trihex.files import new_file
    from trihex.formats import write_values
    from trihex.planners import make_earliest_arrivals
    from trihex.plans import make_exits

    area = motion.scenario.area
    # Where ways or destinations open, or others join, robots may be earlier than in the world as it was.
    occurrences = [one for one in getattr(motion, "occurrences", ()) if one.is_accepted]
    is_easier = any(one.freed or one.opened or one.event.kind == "join" for one in occurrences)
    earliest = None if is_easier else make_earliest_arrivals(motion.scenario)
    if path.suffix.lower() != ".csv":
        from trihex.pictures import draw_exits

        ax = draw_exits(motion, earliest, **speed)
        with new_file(path) as part:
            ax.figure.savefig(part, format=path.suffix.lower()[1:])
        return
    exits = make_exits(motion)
    bound = {} if earliest is None else {f"most ({earliest.name})": earliest.curve(motion.steps).tolist()}
    seconds = None if area.frame is None else seconds_per_step(area, **speed)
    taken = {"step", "seconds", "arrived", *bound}
    names = [f"exit {name}" if name in taken else name for name in exits.names]
    rows: list[dict[str, Any]] = []
    for step in range(motion.steps + 1):
        when = {"step": step} if seconds is None else {"step": step, "seconds": round(step * seconds, 6)}
        by_exit = dict(zip(names, exits.arrived[:, step].tolist(), strict=True))
        most = {name: curve[step] for name, curve in bound.items()}
        rows.append({**when, "arrived": int(exits.total[step]), **most, **by_exit})
    write_values(rows, path)
