"""Writing: from a record and a suffix to the module that writes that format."""

from __future__ import annotations

import os
from typing import Any

from trihex.areas import Area, Scenario
from trihex.areas.coverage import Progress
from trihex.errors import check_options, check_type
from trihex.formats.registry import WRITERS, writer_of
from trihex.plans import Plan

AREA_SUFFIXES = tuple(WRITERS["an area"])
SCENARIO_SUFFIXES = tuple(WRITERS["a scenario"])
PLAN_SUFFIXES = tuple(WRITERS["a plan"])
WAYPOINT_SUFFIXES = tuple(WRITERS["waypoints"])
LAYER_SUFFIXES = tuple(WRITERS["layers"])


def write_area(area: Area, path: str | os.PathLike[str]) -> None:
    """Write an area as ``.toml``, or its barriers alone as MovingAI ``.map``, letters ``.txt`` or an image.

    Raises
    ------
    FormatError
        If the area has a frame and the format is not ``.toml``.
    """
    check_type("area", area, Area)
    writer_of("an area", path)(area, path)


def write_scenario(scenario: Scenario, path: str | os.PathLike[str], **planner: Any) -> None:
    """Write a scenario as ``.toml``, or as letters ``.txt`` if letters can carry it.

    Raises
    ------
    FormatError
        If letters cannot carry it.
    """
    check_options("write_scenario", planner, ("planner", "planner_options", "outputs"))
    check_type("scenario", scenario, Scenario)
    writer_of("a scenario", path)(scenario, path, **planner)


def write_plan(plan: Plan, path: str | os.PathLike[str], *, progress: Progress | None = None) -> None:
    """Write a plan as ``.csv``, ``.npz`` or ``.parquet``; as ``.txt`` for mapf-visualizer, which knows only squares.

    Parameters
    ----------
    plan : Plan
    path : path
    progress : callable, optional
        Called with (done, total) while a CSV or npz is written.
    """
    check_type("plan", plan, Plan)
    writer_of("a plan", path)(plan, path, progress=progress)


def write_waypoints(plan: Plan, path: str | os.PathLike[str], *, speed: float = 1.0) -> None:
    """Write where each robot is at which second, in metres; no robot is faster than `speed` metres in a second.

    ``.csv`` has a row for each robot and step, ``.yaml`` and ``.json`` a nav_msgs/Path for each robot, ``.geojson`` a
    LineString for each robot; ``.sqlite`` is for JuPedSim and PedPy; ``.mcap``, a recording of ROS, for Foxglove, RViz.

    Raises
    ------
    AreaError
        If the area has no frame.
    FormatError
        If the speed is not above 0, or a robot does what no robot can.
    """
    from trihex.formats.tracks.tracks import make_tracks

    check_type("plan", plan, Plan)

    write = writer_of("waypoints", path)
    write(make_tracks(plan, speed), path)
