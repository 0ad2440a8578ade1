"""Options that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar

import click

from trihex.cli.types import Flow, FlowOf, Metres, Name, Place, Seconds, Share, Whole

Command = TypeVar("Command", bound=Callable[..., Any])
PATH = click.Path(path_type=Path)


# What `rule_options` adds, and what `formats.options.AreaOptions` takes besides the tessellation.
RULES = ("waiting_cost", "crossing", "corners", "destination_capacity", "clock", "following", "destination", "capacity")
# What tells how a place in metres, or an image of one, is read.
PLACE = (
    *("cell_size", "robot_radius", "clearance", "unknown", "threshold", "invert", "resolution", "align"),
    *("walls", "exits", "rooms", "unit", "wall_thickness"),
)


def area_options(command: Command) -> Command:
    """Add what tells how the area of a file is read."""
    for option in (
        click.option("--wall-thickness", type=Metres(), help="DXF: of lines that are walls, in metres. [default: 0]"),
        click.option(
            "--unit",
            type=Name("trihex.formats.areas.cad", "UNITS"),
            help="DXF: of lengths. [default: that of the file]",
        ),
        click.option("--rooms", metavar="LAYERS", help="DXF: layers of what is free. [default: *room*]"),
        click.option("--exits", metavar="LAYERS", help="DXF: layers of exits. [default: *exit*]"),
        click.option(
            "--walls", metavar="LAYERS", help="DXF: layers of walls, as A-WALL*,COLUMNS. [default: *wall*, or all]"
        ),
        click.option("--resolution", type=Metres(), help="Images: metres for each pixel."),
        click.option("--invert", is_flag=True, default=None, help="Images: dark pixels are free."),
        click.option(
            "--threshold", type=Share(), help="Images: brightness from which on a pixel is free. [default: 0.5]"
        ),
        click.option(
            "--unknown",
            type=Name("trihex.formats.areas.options", "UNKNOWNS"),
            help="ROS maps: what unknown ground is. [default: barrier]",
        ),
        click.option(
            "--align",
            type=Name("trihex.areas", "ALIGNS"),
            help="In metres: how the grid lies, from the corner or so that most connects. [default: corner]",
        ),
        click.option("--clearance", type=Metres(), help="In metres: how far robots keep beyond touching. [default: 0]"),
        click.option("--robot-radius", type=Metres(), help="In metres: robots touch neither walls nor each other."),
        click.option("--cell-size", type=Metres(), help="Edge step in metres. [default: the least for --robot-radius]"),
        click.option(
            "--costs", type=Name("trihex.areas.tessellation", "COSTS"), help="Costs of moves. [default: paper]"
        ),
        click.option(
            "--neighbourhood",
            type=Name("trihex.areas.tessellation", "NEIGHBOURHOODS"),
            help="All neighbours, or only those that share an edge. [default: full]",
        ),
        click.option(
            "--tessellation",
            type=Name("trihex.areas.tessellation", "TESSELLATIONS"),
            help="Shape of the cells. [default: hexagonal]",
        ),
    ):
        command = option(command)
    return command


def rule_options(command: Command) -> Command:
    """Add destinations and the rules of movement."""
    for option in (
        click.option(
            "--destination-capacity",
            type=Flow(),
            help="Robots that may enter one destination in one step, as 1 or 0.5, or in metres a second, as 1.6/s. "
            "[default: any number; 1 in metres]",
        ),
        click.option(
            "--capacity",
            type=FlowOf(),
            multiple=True,
            help="How many robots may enter an exit or a door, a zone by its name or a cell, as north=1.6/s or "
            "3,4=0.5; may be repeated.",
        ),
        click.option(
            "--crossing",
            type=Name("trihex.areas.scenario", "CROSSINGS"),
            help="Whether two robots may pass one lattice vertex in one step. [default: forbid]",
        ),
        click.option(
            "--corners",
            type=Name("trihex.areas.scenario", "CORNERS"),
            help="When a robot may pass a vertex beside barriers. [default: allow]",
        ),
        click.option(
            "--following",
            type=Name("trihex.areas.scenario", "FOLLOWINGS"),
            help="Whether a robot may enter a cell while another is still leaving it. [default: allow]",
        ),
        click.option(
            "--clock",
            type=Name("trihex.areas.tessellation", "CLOCKS"),
            help="Whether moves last a step each, or as long as they cost, in ticks. [default: steps]",
        ),
        click.option("--waiting-cost", type=Whole(0), help="Cost of waiting one step. [default: that of an edge]"),
        destination_option,
    ):
        command = option(command)
    return command


def destination_option(command: Command) -> Command:
    """Add destinations."""
    return click.option(
        "--destination",
        type=Place("X,Y"),
        multiple=True,
        help="A destination: a cell, or a point in metres as in 3.2,-1m; may be repeated.",
    )(command)


def robot_options(command: Command) -> Command:
    """Add the robots."""
    for option in (
        click.option("--seed", type=Whole(0), help="What draws the robots. [default: 0]"),
        click.option(
            "--start-times",
            metavar="LAW:NUMBERS",
            help="When they begin to move, drawn: constant:T, uniform:A,B, normal:MEAN,SD or lognormal:MEAN,SD, in "
            "seconds in places in metres, else in steps. [default: all at once]",
        ),
        click.option(
            "--starts",
            type=PATH,
            metavar="FILE",
            help="CSV of their cells, header x,y, or places, header x_metres,y_metres, and perhaps when they begin to "
            "move, start, and how fast they are, speed or slowness; or a MovingAI .scen.",
        ),
        click.option(
            "--robots", type=Whole(0), help="How many robots to draw at random, or to take from --starts, the first."
        ),
    ):
        command = option(command)
    return command


def waypoint_options(command: Command) -> Command:
    """Add how robots move along waypoints; what is not said is None."""
    for option in (
        click.option("--frame-id", metavar="NAME", help="What ROS calls the frame of .yaml and .json. [default: map]"),
        click.option(
            "--turn-time",
            type=Seconds(),
            help="Seconds in which all stand before each step, so that they can turn on the spot. [default: 0]",
        ),
        click.option("--speed", type=Metres(), help="Of the robots, in metres a second. [default: 1.0]"),
    ):
        command = option(command)
    return command


def of_waypoints(options: dict[str, Any]) -> dict[str, Any]:
    """Return, and take out, those of the options that tell how waypoints are written."""
    own = {name: options.pop(name, None) for name in ("speed", "turn_time", "frame_id")}
    return {name: value for name, value in own.items() if value is not None}


def gathered(name: str, noun: Callable[..., Any]) -> Callable[[Command], Command]:
    """Hand the options that are fields of `noun`, a NamedTuple, on to the command as one record called `name`."""
    fields: tuple[str, ...] = noun._fields  # type: ignore[attr-defined]

    def gather(command: Command) -> Command:
        @wraps(command)
        def with_record(**given: Any) -> Any:
            record = noun(**{field: given.pop(field) for field in fields})
            return command(**{name: record}, **given)

        return with_record  # type: ignore[return-value]

    return gather


def wrong_use(message: str) -> click.UsageError:
    """Return the error for the command that runs."""
    return click.UsageError(message, click.get_current_context())
