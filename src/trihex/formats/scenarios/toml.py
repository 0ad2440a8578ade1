"""Scenario as TOML: one file that names area, tessellation, rules, destinations, robots and planner."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import fields, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Frame, Scenario, Tessellation, Zone, cells_from, is_door_of_zone
from trihex.errors import FormatError, ScenarioError, TrihexError
from trihex.files import new_file
from trihex.formats.areas.letters import draft_of_letters
from trihex.formats.areas.options import AreaOptions
from trihex.formats.draft import Draft
from trihex.formats.scenarios.keys import OUTPUT_PATHS, ScenarioTable
from trihex.formats.schema import check_document
from trihex.formats.starts.starts import read_slowness, read_start_times, read_starts
from trihex.formats.text import Text
from trihex.formats.toml import complaint, parse_toml

Result = TypeVar("Result")


def parse_scenario_toml(
    text: Text, path: str | os.PathLike[str], read_area_draft: Callable[[Path, AreaOptions], Draft]
) -> Draft:
    """Return the draft that a file describes.

    Parameters
    ----------
    text : Text
    path : path
        Other files are named relative to this one.
    read_area_draft : function
        Reads the file that ``area.path`` names.

    Raises
    ------
    FormatError
        With a line for each mistake: path of the key, rule, value, near name.
    """
    table, mistakes = check_document(ScenarioTable, parse_toml(text, path))
    if table is not None and not mistakes:
        draft = _draft_of(table, Path(path), read_area_draft, mistakes)
        if draft is not None and not mistakes:
            return draft
    raise complaint(path, mistakes)


def _draft_of(
    table: ScenarioTable,
    path: Path,
    read_area_draft: Callable[[Path, AreaOptions], Draft],
    mistakes: list[str],
) -> Draft | None:
    """Return what the table describes; add to `mistakes` what cannot be had."""

    def attempt(key: str, work: Callable[[], Result]) -> Result | None:
        try:
            return work()
        except (TrihexError, OSError) as error:
            text = f"{error.strerror}: {error.filename!s:.200}" if isinstance(error, OSError) else str(error)
            mistakes.append(f"{key}: {text.removeprefix('cells: ')}")
            return None

    draft = attempt("area", lambda: _area_draft(table, path, read_area_draft))
    if draft is None:
        return None
    area, robots = draft.area, table.robots

    def cells(places: list[list[int]] | None) -> NDArray[np.int64] | None:
        return None if places is None else cells_from(area, places, "cells", ScenarioError)

    def metres(places: list[list[float]] | None) -> NDArray[np.int64] | None:
        table = np.array(places, dtype=np.float64).reshape(-1, 2)
        return None if places is None else area.metres_to_cell(table[:, 0], table[:, 1])

    destinations = attempt("destinations", lambda: cells(table.destinations))
    if table.destinations_in_metres is not None:
        destinations = attempt("destinations_in_metres", lambda: metres(table.destinations_in_metres))
    own_times = own_slowness = None
    starts = attempt("robots.cells", lambda: cells(robots.cells))
    if robots.metres is not None:
        starts = attempt("robots.metres", lambda: metres(robots.metres))
    if (file := robots.file) is not None:
        starts = attempt("robots.file", lambda: read_starts(path.parent / file, area))
        if starts is not None:
            own_times = attempt("robots.file", lambda: read_start_times(path.parent / file))
            own_slowness = attempt("robots.file", lambda: read_slowness(path.parent / file))
    doors = attempt("doors", lambda: [(door.zone or door.cells, door.capacity) for door in table.doors])
    has_robots = starts is not None or robots.random is not None
    return Draft(
        area,
        draft.destinations if destinations is None else destinations,
        starts if has_robots else draft.robots,
        robots.random,
        robots.seed,
        **table.rules.model_dump(),
        planner=table.planner.name,
        planner_options=table.planner.options,
        outputs=_outputs(table, path),
        start_times=own_times if robots.start_times is None else robots.start_times,
        slowness=own_slowness if robots.slowness is None else np.array(robots.slowness, dtype=np.int64),
        doors=(*draft.doors, *(doors or ())),
    ).paced()


def _outputs(table: ScenarioTable, path: Path) -> dict[str, Any]:
    """Return the outputs by name, with paths beside the scenario."""
    given = {name: value for name, value in table.outputs.model_dump().items() if value is not None}
    return {name: path.parent / value if name in OUTPUT_PATHS else value for name, value in given.items()}


def _area_draft(whole: ScenarioTable, path: Path, read_area_draft: Callable[[Path, AreaOptions], Draft]) -> Draft:
    table = whole.area
    tessellation = Tessellation(table.tessellation, table.neighbourhood, table.costs)
    names = (own.name for own in fields(AreaOptions) if own.name not in ("tessellation", "following", "clock"))
    options = {name: value for name in names if (value := getattr(table, name)) is not None}
    if table.path is not None:
        # The least cells for robots depend on them.
        options |= {"following": whole.rules.following or "allow", "clock": whole.rules.clock}
        draft = read_area_draft(path.parent / table.path, AreaOptions(tessellation, **options))
    elif options:
        raise ScenarioError(f"{min(options)} tells how the file at area.path is read; rows take a table area.frame")
    else:
        draft = draft_of_letters("\n".join(table.rows or []).encode(), "area.rows", tessellation)
    name = table.name or (draft.area.name if table.path is not None else path.stem)
    frame = draft.area.frame
    if frame is not None and table.frame is not None:
        raise ScenarioError("frame is known already from the file at area.path and its cell_size")
    if table.frame is not None:
        x, y = table.frame.origin
        frame = Frame(table.frame.cell_size, (x, y), table.frame.yaw, table.frame.robot_radius)
    area = replace(draft.area, tessellation=tessellation, name=name, frame=frame)
    zones = [Zone(name, cells_from(area, cells, f"zones.{name}", ScenarioError)) for name, cells in table.zones.items()]
    return replace(draft, area=replace(area, zones=(*area.zones, *zones)))


def write_scenario_toml(
    scenario: Scenario,
    path: str | os.PathLike[str],
    planner: str = "",
    planner_options: dict[str, Any] | None = None,
    outputs: dict[str, Any] | None = None,
) -> None:
    """Write a scenario with all that is needed to plan it again: rows of the area, cells of robots and destinations.

    `outputs` are paths by name, and how waypoints are written; paths that do not lie beside the scenario or below it
    are left out.
    """
    area = scenario.area
    lines = [
        f"destinations = {_cells(area, scenario.destinations)}",
        "",
        *_area_lines(area),
        "",
        "[rules]",
        f"waiting_cost = {scenario.waiting_cost}" if scenario.clock == "steps" else "",  # else it is 1 a tick
        f"crossing = {_text(scenario.crossing)}",
        f"corners = {_text(scenario.corners)}",
        f"destination_capacity = {_flow(scenario.destination_capacity)}" if scenario.destination_capacity else "",
        f"clock = {_text(scenario.clock)}" if scenario.clock != "steps" else "",
        f"following = {_text(scenario.following)}" if scenario.following != "allow" else "",
        *_door_lines(scenario),
        "",
        "[robots]",
        f"cells = {_cells(area, scenario.robots)}",
        f"start_times = {scenario.start_times.tolist()}" if scenario.has_start_times else "",
        f"slowness = {scenario.slowness.tolist()}" if scenario.has_slowness else "",
        f"seed = {scenario.seed}" if scenario.seed is not None else "",
    ]
    if planner:
        lines += ["", "[planner]", f"name = {_text(planner)}"]
        if planner_options:
            pairs = ", ".join(f"{_text(key)} = {json.dumps(value)}" for key, value in planner_options.items())
            lines.append(f"options = {{ {pairs} }}")
    lines += _output_lines(outputs or {}, Path(path))
    _write(lines, path)


def write_area_toml(area: Area, path: str | os.PathLike[str]) -> None:
    """Write an area as a scenario file that names no destinations and no robots."""
    _write(_area_lines(area), path)


def _write(lines: list[str], path: str | os.PathLike[str]) -> None:
    """Write lines; of empty ones only those before a table."""
    kept = [line for line, after in zip(lines, [*lines[1:], "end"], strict=True) if line or after.startswith("[")]
    with new_file(path) as part:
        part.write_text("\n".join([*kept, ""]), encoding="utf-8")


def _area_lines(area: Area) -> list[str]:
    rows = ["".join("B" if barrier else "." for barrier in row) for row in area.barriers.tolist()]
    return [
        "[area]",
        f"name = {_text(area.name)}" if area.name else "",
        f"tessellation = {_text(area.tessellation.name)}",
        f"neighbourhood = {_text(area.tessellation.neighbourhood)}",
        f"costs = {_text(area.tessellation.costs)}",
        "rows = [",
        *(f"  {_text(row)}," for row in rows),
        "]",
        *_frame_lines(area),
        *_zone_lines(area),
    ]


def _output_lines(outputs: dict[str, Any], path: Path) -> list[str]:
    lines = []
    for name, value in outputs.items():
        if name not in OUTPUT_PATHS:
            lines.append(f"{name} = {_text(value) if isinstance(value, str) else repr(float(value))}")
            continue
        beside = os.path.relpath(value, path.parent)
        if not beside.isprintable():
            raise FormatError(f"{path}: the path of the {name} must be printable UTF-8, not {beside!a:.200}")
        if Path(beside).parts[0] != "..":
            lines.append(f"{name} = {_text(beside)}")
    return ["", "[outputs]", *lines] if lines else []


def _frame_lines(area: Area) -> list[str]:
    if (frame := area.frame) is None:
        return []
    return [
        "",
        "[area.frame]",
        f"cell_size = {frame.cell_size!r}",
        f"origin = {list(frame.origin)!r}",
        f"yaw = {frame.yaw!r}",
        f"robot_radius = {frame.robot_radius!r}",
    ]


def _zone_lines(area: Area) -> list[str]:
    if not area.zones:
        return []
    return ["", "[area.zones]", *(f"{_text(zone.name)} = {_cells(area, zone.cells)}" for zone in area.zones)]


def _door_lines(scenario: Scenario) -> list[str]:
    lines = []
    for door in scenario.doors:
        where = f"cells = {_cells(scenario.area, door.cells)}"
        if is_door_of_zone(scenario.area, door):
            where = f"zone = {_text(door.name)}"
        lines += ["", "[[doors]]", where, f"capacity = {_flow(door.flow)}"]
    return lines


def _flow(flow: int | Fraction) -> str:
    """Return a flow in robots a step: a whole number, or a fraction as text."""
    numerator, denominator = flow.as_integer_ratio()
    return str(numerator) if denominator == 1 else _text(f"{numerator}/{denominator}")


def _cells(area: Area, cells: NDArray[np.int64]) -> str:
    x, y = area.cell_to_xy(cells)
    return json.dumps(np.stack([x, y], axis=1).tolist())


def _text(value: str) -> str:
    """Return a TOML string: JSON's escapes are TOML's, but for DEL."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
