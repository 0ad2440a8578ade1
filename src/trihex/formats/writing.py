"""Writing: from a record and a suffix to the module that writes that format."""

from __future__ import annotations

import os
from typing import Any

from trihex.areas import Area, Scenario
from trihex.areas.coverage import Progress
from trihex.files import suffix_of
from trihex.formats.areas.image import SUFFIXES as IMAGE_SUFFIXES, refuse_frame, write_image
from trihex.formats.areas.letters import write_letters
from trihex.formats.areas.movingai import write_movingai
from trihex.formats.plans.csv import write_plan_csv
from trihex.formats.plans.npz import write_plan_npz
from trihex.formats.starts.csv import write_starts as write_starts
from trihex.formats.starts.starts import read_starts as read_starts
from trihex.plans import Plan

AREA_SUFFIXES = (".map", ".txt", ".toml", *IMAGE_SUFFIXES)
PLAN_SUFFIXES = (".csv", ".npz", ".parquet", ".txt")
WAYPOINT_SUFFIXES = (".csv", ".yaml", ".json", ".geojson", ".sqlite")
SCENARIO_SUFFIXES = (".toml", ".txt")


def write_area(area: Area, path: str | os.PathLike[str]) -> None:
    """Write an area as ``.toml``, or its barriers alone as MovingAI ``.map``, letters ``.txt`` or an image.

    Raises
    ------
    FormatError
        If the area has a frame and the format is not ``.toml``.
    """
    suffix = suffix_of(path, AREA_SUFFIXES, "an area")
    if suffix == ".toml":
        from trihex.formats.scenarios.toml import write_area_toml

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
        from trihex.formats.scenarios.toml import write_scenario_toml

        write_scenario_toml(scenario, path, **planner)


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
        from trihex.formats.plans.parquet import write_plan_parquet

        write_plan_parquet(plan, path)
    else:
        from trihex.formats.plans.mapf import write_mapf

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
    from trihex.formats.tracks.tracks import make_tracks

    suffix = suffix_of(path, WAYPOINT_SUFFIXES, "waypoints")
    tracks = make_tracks(plan, speed)
    if suffix == ".csv":
        from trihex.formats.tracks.csv import write_waypoints_csv

        write_waypoints_csv(tracks, path)
    elif suffix == ".geojson":
        from trihex.formats.areas.geojson import write_geojson

        write_geojson(tracks, path)
    elif suffix == ".sqlite":
        from trihex.formats.tracks.jupedsim import write_jupedsim

        write_jupedsim(tracks, plan.scenario.area, path)
    else:
        from trihex.formats.tracks.nav_path import write_nav_path

        write_nav_path(tracks, path, is_json=suffix == ".json")
