"""Formats: one module a file format; here the way from a path to the right one.

What a file is, its content tells before its name; what is written, the suffix tells.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from trihex.area import Area
from trihex.coverage import Progress
from trihex.errors import FormatError
from trihex.formats.draft import Draft, draft_of
from trihex.formats.files import check_text, read_bytes, suffix_of
from trihex.formats.image import SUFFIXES as IMAGE_SUFFIXES
from trihex.formats.image import refuse_frame, write_image
from trihex.formats.letters import parse_letters, write_letters
from trihex.formats.movingai import parse_movingai, write_movingai
from trihex.formats.options import AreaOptions
from trihex.formats.plan_csv import read_plan_csv, write_plan_csv
from trihex.formats.plan_npz import read_plan_npz, write_plan_npz
from trihex.formats.recognise import NAME_OF_FORMAT, Format, format_of
from trihex.formats.starts import read_starts as read_starts
from trihex.formats.starts_csv import write_starts as write_starts
from trihex.frame import Frame
from trihex.plan import Plan
from trihex.scenario import Scenario
from trihex.tessellation import Tessellation

AREA_SUFFIXES = (".map", ".txt", ".toml", *IMAGE_SUFFIXES)
PLAN_SUFFIXES = (".csv", ".npz", ".parquet", ".txt")
WAYPOINT_SUFFIXES = (".csv", ".yaml", ".json", ".geojson", ".sqlite")
SCENARIO_SUFFIXES = (".toml", ".txt")


def read_draft(
    path: str | os.PathLike[str],
    tessellation: Tessellation | str | None = None,
    *,
    neighbourhood: str | None = None,
    costs: str | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Draft:
    """Return what a file says of a scenario: an area with or without destinations, robots and rules.

    Parameters
    ----------
    path : path
        MovingAI ``.map``, letters ``.txt``, ROS map ``.yaml``, image, ``.geojson``, ``.wkt``, scenario ``.toml`` or
        plan ``.npz``.
    tessellation : Tessellation or str, optional
        What the cells are; a name tells the shape alone. Default: what the file says, or hexagonal.
    neighbourhood, costs : str, optional
        What else the cells are. Default: as `tessellation` or the file says.
    progress : callable, optional
        Called with (rows covered, all rows).
    **options
        How areas are read, such as `cell_size` and `robot_radius` in metres; see `formats.options.AreaOptions`.

    Raises
    ------
    FormatError
        If the file is not what it claims to be.
    OSError
        If it cannot be read.
    """
    content = read_bytes(path)
    form = format_of(content, path)
    draft: Draft
    given = {name: value for name, value in options.items() if value is not None}
    if form in ("npz", "scenario") and given:
        raise FormatError(f"{path}: says itself how its area lies in the world; {', '.join(given)} cannot change it")
    if form == "npz":
        draft = draft_of(read_plan_npz(path, content).scenario)
    elif form == "scenario":
        from trihex.formats.scenario_toml import read_scenario_toml

        draft = read_scenario_toml(path, _read_area_draft, content)
    else:
        wanted = _wanted(Tessellation("hexagonal"), tessellation, neighbourhood, costs)
        return _parse_area(content, form, path, AreaOptions(wanted, **given), progress)
    own = draft.area.tessellation
    wanted = _wanted(own, tessellation, neighbourhood, costs)
    return draft if wanted == own else replace(draft, area=draft.area.with_tessellation(wanted))


def _wanted(
    own: Tessellation, tessellation: Tessellation | str | None, neighbourhood: str | None, costs: str | None
) -> Tessellation:
    """Return `own`, changed by what else is given."""
    base = tessellation if isinstance(tessellation, Tessellation) else own
    name = tessellation if isinstance(tessellation, str) else base.name
    return Tessellation(name, neighbourhood or base.neighbourhood, costs or base.costs)


def _read_area_draft(path: Path, options: AreaOptions) -> Draft:
    content = read_bytes(path)
    return _parse_area(content, format_of(content, path), path, options, None)


def _parse_area(
    content: bytes, form: Format, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None
) -> Draft:
    """Return the draft of an area; parsers of real places are imported where they are used."""
    if form == "ros":
        from trihex.formats.ros import parse_ros

        return parse_ros(content, path, options, progress)
    if form == "image":
        from trihex.formats.image import parse_image

        return parse_image(content, path, options, progress)
    if form == "geojson":
        from trihex.formats.geojson import parse_geojson

        return parse_geojson(content, path, options, progress)
    if form == "wkt":
        from trihex.formats.wkt import parse_wkt

        return parse_wkt(content, path, options, progress)
    if form not in ("movingai", "letters"):
        raise FormatError(f"{path}: must hold an area, not {NAME_OF_FORMAT[form]}")
    if options.robot_radius:
        raise FormatError(f"{path}: has one cell for each letter; robot_radius needs a place with walls in metres")
    text, tessellation = check_text(content, path), options.tessellation
    if form == "movingai":
        draft = Draft(Area(tessellation, parse_movingai(text, path), Path(path).stem))
    else:
        draft = parse_letters(text, path, tessellation)
    if options.cell_size is None:
        return draft
    return replace(draft, area=replace(draft.area, frame=Frame(options.cell_size)))


def read_area(
    path: str | os.PathLike[str],
    tessellation: Tessellation | str | None = None,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Area:
    """Return the area of a file, named after it; see `read_draft`."""
    return read_draft(path, tessellation, progress=progress, **options).area


def read_scenario(
    path: str | os.PathLike[str],
    tessellation: Tessellation | str | None = None,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Scenario:
    """Return the scenario of a file that names at least one destination; see `read_draft`.

    Raises
    ------
    ScenarioError
        If the file names no destination, or its parts do not fit.
    """
    return read_draft(path, tessellation, progress=progress, **options).complete()


def write_area(area: Area, path: str | os.PathLike[str]) -> None:
    """Write an area as ``.toml``, or its barriers alone as MovingAI ``.map``, letters ``.txt`` or an image.

    Raises
    ------
    FormatError
        If the area has a frame and the format is not ``.toml``.
    """
    suffix = suffix_of(path, AREA_SUFFIXES, "an area")
    if suffix == ".toml":
        from trihex.formats.scenario_toml import write_area_toml

        write_area_toml(area, path)
        return
    refuse_frame(area.frame, path)
    if suffix in IMAGE_SUFFIXES:
        write_image(area, path)
    elif suffix == ".map":
        write_movingai(area, path)
    else:
        write_letters(area, path)


def write_scenario(scenario: Scenario, path: str | os.PathLike[str], **planner: Any) -> None:
    """Write a scenario as ``.toml``, or as letters ``.txt`` if letters can carry it.

    Raises
    ------
    FormatError
        If letters cannot carry it.
    """
    if suffix_of(path, SCENARIO_SUFFIXES, "a scenario") == ".txt":
        write_letters(scenario, path)
    else:
        from trihex.formats.scenario_toml import write_scenario_toml

        write_scenario_toml(scenario, path, **planner)


def read_plan(
    path: str | os.PathLike[str], scenario: Scenario | None = None, *, progress: Progress | None = None
) -> Plan:
    """Return the plan of a ``.npz``, ``.csv`` or ``.parquet`` file.

    Parameters
    ----------
    path : path
    scenario : Scenario, optional
        For CSV and Parquet, which keep neither area nor rules: what the plan was made for. Its robots are not looked
        at. A plan in ``.npz`` brings its own.
    progress : callable, optional
        Called with (rows read, all rows) of a CSV.

    Raises
    ------
    FormatError
        If the file is not what it claims to be, or keeps no area and there is no scenario.
    OSError
        If it cannot be read.
    """
    content = read_bytes(path)
    form = format_of(content, path)
    if form == "npz":
        return read_plan_npz(path, content)
    if form not in ("plan", "parquet"):
        raise FormatError(f"{path}: must hold a plan (.npz, .csv or .parquet), not {NAME_OF_FORMAT[form]}")
    if scenario is None:
        raise FormatError(f"{path}: does not hold its area; name the area, destinations and rules as well")
    if form == "parquet":
        from trihex.formats.plan_parquet import read_plan_parquet

        return read_plan_parquet(path, scenario, content)
    return read_plan_csv(path, scenario, content, progress=progress)


def write_plan(plan: Plan, path: str | os.PathLike[str], *, progress: Progress | None = None) -> None:
    """Write a plan as ``.csv``, ``.npz`` or ``.parquet``; as ``.txt`` for mapf-visualizer, which knows only squares.

    Parameters
    ----------
    plan : Plan
    path : path
    progress : callable, optional
        Called with (done, total) while a CSV or npz is written.
    """
    suffix = suffix_of(path, PLAN_SUFFIXES, "a plan")
    if suffix == ".csv":
        write_plan_csv(plan, path, progress=progress)
    elif suffix == ".npz":
        write_plan_npz(plan, path, progress=progress)
    elif suffix == ".parquet":
        from trihex.formats.plan_parquet import write_plan_parquet

        write_plan_parquet(plan, path)
    else:
        from trihex.formats.mapf import write_mapf

        write_mapf(plan, path)


def write_waypoints(plan: Plan, path: str | os.PathLike[str], *, speed: float = 1.0) -> None:
    """Write where each robot is at which second, in metres; no robot is faster than `speed` metres in a second.

    ``.csv`` has a row for each robot and step, ``.yaml`` and ``.json`` a nav_msgs/Path for each robot, ``.geojson`` a
    LineString for each robot; ``.sqlite`` is for JuPedSim and PedPy.

    Raises
    ------
    AreaError
        If the area has no frame.
    FormatError
        If the speed is not above 0, or a robot does what no robot can.
    """
    from trihex.formats.tracks import make_tracks

    suffix = suffix_of(path, WAYPOINT_SUFFIXES, "waypoints")
    tracks = make_tracks(plan, speed)
    if suffix == ".csv":
        from trihex.formats.waypoints import write_waypoints_csv

        write_waypoints_csv(tracks, path)
    elif suffix == ".geojson":
        from trihex.formats.geojson import write_geojson

        write_geojson(tracks, path)
    elif suffix == ".sqlite":
        from trihex.formats.jupedsim import write_jupedsim

        write_jupedsim(tracks, plan.scenario.area, path)
    else:
        from trihex.formats.nav_path import write_nav_path

        write_nav_path(tracks, path, is_json=suffix == ".json")
