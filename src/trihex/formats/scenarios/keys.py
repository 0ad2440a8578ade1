"""Scenario schema: the keys that a scenario file may have."""

from __future__ import annotations

from pathlib import PurePath
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field

from trihex.areas import (
    ALIGNS,
    CLOCKS,
    CORNERS,
    COSTS,
    CROSSINGS,
    FOLLOWINGS,
    NEIGHBOURHOODS,
    TESSELLATIONS,
)
from trihex.errors import is_whole
from trihex.formats.areas.options import UNKNOWNS
from trihex.formats.schema import LARGEST, Cells, Count, Flow, Number, Points, Table, Whole, choice, distribution


class FrameTable(Table):
    """[area.frame]: where the area lies in the world, in metres."""

    cell_size: Annotated[Number, Field(gt=0)]
    origin: Annotated[list[Number], Field(min_length=2, max_length=2)] = Field(default_factory=lambda: [0.0, 0.0])
    yaw: Number = 0.0
    robot_radius: Annotated[Number, Field(ge=0)] = 0.0


class AreaTable(Table):
    """[area]: where the barriers come from, and how they are read."""

    one_of = ("path", "rows", "!")
    path: str | None = None
    rows: list[str] | None = None
    name: str | None = None
    tessellation: Annotated[str, choice("it", TESSELLATIONS)] = "hexagonal"
    neighbourhood: Annotated[str, choice("it", NEIGHBOURHOODS)] = "full"
    costs: Annotated[str, choice("it", COSTS)] = "paper"
    frame: FrameTable | None = None
    zones: dict[str, Cells] = Field(default_factory=dict)
    # How the file at `path` is read; see `formats.options.AreaOptions`.
    cell_size: Annotated[Number, Field(gt=0)] | None = None
    robot_radius: Annotated[Number, Field(ge=0)] | None = None
    clearance: Annotated[Number, Field(ge=0)] | None = None
    unknown: Annotated[str, choice("it", UNKNOWNS)] | None = None
    threshold: Annotated[Number, Field(ge=0, le=1)] | None = None
    invert: bool | None = None
    resolution: Annotated[Number, Field(gt=0)] | None = None
    align: Annotated[str, choice("it", ALIGNS)] | None = None
    walls: str | None = None
    exits: str | None = None
    rooms: str | None = None
    unit: str | None = None
    wall_thickness: Annotated[Number, Field(ge=0)] | None = None


class RulesTable(Table):
    """[rules]: what robots may do."""

    waiting_cost: Whole | None = None
    crossing: Annotated[str, choice("it", CROSSINGS)] | None = None
    corners: Annotated[str, choice("it", CORNERS)] | None = None
    destination_capacity: Flow | None = None
    clock: Annotated[str, choice("it", CLOCKS)] | None = None
    following: Annotated[str, choice("it", FOLLOWINGS)] | None = None


class DoorTable(Table):
    """[[doors]]: cells that only so many robots enter in a step, those of a zone or others."""

    one_of = ("zone", "cells", "!")
    zone: str | None = None
    cells: Cells | None = None
    capacity: Flow


def _start_times(value: object) -> object:
    """Return start times, or a distribution of them."""
    if isinstance(value, str):
        return distribution(value)
    if isinstance(value, list) and all(is_whole(one) and 0 <= one <= LARGEST for one in value):
        return np.array(value, dtype=np.int64)
    raise ValueError(f"must be a list of whole numbers of steps, or a distribution in quotes, not {value!r:.60}")


class RobotsTable(Table):
    """[robots]: given, from a file, or drawn."""

    one_of = ("cells", "metres", "file", "random")
    cells: Cells | None = None
    metres: Points | None = None
    file: str | None = None
    random: Whole | None = None
    seed: Whole | None = None
    # Steps of each, or what draws them, in seconds in an area with a frame.
    start_times: Annotated[Any, AfterValidator(_start_times)] = None
    slowness: list[Count] | None = None


class PlannerTable(Table):
    """[planner]: its name in the registry, and its options."""

    name: str | None = None
    options: dict[str, Any] = Field(default_factory=dict)


def _beside(value: str) -> str:
    """Return the path of an output; a scenario from somewhere must not write to anywhere."""
    if not value or "\0" in value or PurePath(value).is_absolute() or ".." in PurePath(value).parts:
        raise ValueError(f"must be a path beside the scenario or below it, not {value!r:.60}")
    return value


_Output = Annotated[str, AfterValidator(_beside)]


# Those of [outputs] that are paths.
OUTPUT_PATHS = ("plan", "summary", "picture", "waypoints", "certificate")


class OutputsTable(Table):
    """[outputs]: what `trihex plan` writes, unless its options say otherwise."""

    plan: _Output | None = None
    summary: _Output | None = None
    picture: _Output | None = None
    waypoints: _Output | None = None
    certificate: _Output | None = None
    speed: Annotated[Number, Field(gt=0)] | None = None
    turn_time: Annotated[Number, Field(ge=0)] | None = None
    frame_id: str | None = None


class ScenarioTable(Table):
    """The whole file."""

    one_of = ("destinations", "destinations_in_metres")
    area: AreaTable
    destinations: Cells | None = None
    destinations_in_metres: Points | None = None
    rules: RulesTable = RulesTable()
    doors: list[DoorTable] = Field(default_factory=list)
    robots: RobotsTable = RobotsTable()
    planner: PlannerTable = PlannerTable()
    outputs: OutputsTable = OutputsTable()
