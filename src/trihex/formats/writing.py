"""Writing: from a record and a suffix to the module that writes that format."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from trihex.areas import Area, Scenario
from trihex.areas.coverage import Progress
from trihex.errors import check_options, check_type
from trihex.formats.registry import WRITERS, function_at, writer_of
from trihex.plans import Motion, Plan

AREA_SUFFIXES = tuple(WRITERS["an area"])
SCENARIO_SUFFIXES = tuple(WRITERS["a scenario"])
PLAN_SUFFIXES = tuple(WRITERS["a plan"])
WAYPOINT_SUFFIXES = tuple(WRITERS["waypoints"])
DEPENDENCY_SUFFIXES = tuple(WRITERS["dependencies"])
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


def write_plan(plan: Motion, path: str | os.PathLike[str], *, progress: Progress | None = None) -> None:
    """Write a plan or a run as ``.csv``, ``.npz`` or ``.parquet``; as ``.txt`` for mapf-visualizer, on squares only.

    A run as ``.npz`` is what `write_run` writes. Its tables hold what happened, and cannot be read back as a plan.

    Parameters
    ----------
    plan : Plan or Run
    path : path
    progress : callable, optional
        Called with (done, total) while a CSV or npz is written.
    """
    check_type("plan", plan, Motion)
    write = writer_of("a plan", path)
    if not isinstance(plan, Plan) and Path(path).suffix.lower() == ".npz":
        write = function_at("runs.npz.write_run")
    write(plan, path, progress=progress)


def write_waypoints(
    plan: Motion,
    path: str | os.PathLike[str],
    *,
    speed: float = 1.0,
    turn_time: float = 0.0,
    frame_id: str = "map",
) -> None:
    """Write where each robot is at which second, in metres; no robot is faster than `speed` metres in a second.

    ``.csv`` has a row for each robot and step, ``.yaml`` and ``.json`` a nav_msgs/Path for each robot, ``.geojson`` a
    LineString for each robot; ``.sqlite`` is for JuPedSim and PedPy; ``.mcap``, a recording of ROS, for Foxglove, RViz.

    Parameters
    ----------
    plan : Plan or Run
        A run as it happened: robots that were late stand, those that joined later begin later.
    path : path
    speed : float
        Metres in a second.
    turn_time : float
        Seconds before each step in which all robots stand, and each may turn on the spot.
    frame_id : str
        The frame that a nav_msgs/Path names.

    Raises
    ------
    AreaError
        If the area has no frame.
    FormatError
        If the speed is not above 0, or a robot does what no robot can.
    """
    from trihex.formats.tracks.tracks import make_tracks

    check_type("plan", plan, Motion)

    write = writer_of("waypoints", path)
    write(make_tracks(plan, speed, turn_time=turn_time, frame_id=frame_id), path)


def write_dependencies(plan: Plan, path: str | os.PathLike[str], *, speed: float = 1.0) -> None:
    """Write the waypoints of all robots and who waits for whom, so that they can drive at any speed.

    ``.dependencies.json`` is described in docs/formats.md; ``.vda5050.json`` holds order messages of VDA 5050.

    Parameters
    ----------
    plan : Plan
        A safe one; best one in whose scenario following is forbidden.
    path : path
    speed : float
        Of the fastest robot, in metres in a second; in edge steps where the area has no frame.

    Raises
    ------
    PlanError
        If the plan is not safe.
    AreaError
        If the area has no frame, for VDA 5050.
    FormatError
        If the speed is not above 0, or for VDA 5050 if robots wait for each other in a ring.

    Examples
    --------
    >>> import json
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from trihex import Scenario, make_plan
    >>> area = Area("hexagonal", [[0, 0, 0]])
    >>> scenario = Scenario(area, destinations=(2, 0), robots=[(0, 0), (1, 0)], following="forbid")
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder, "plan.dependencies.json")
    ...     write_dependencies(make_plan(scenario), path)
    ...     json.loads(path.read_text())["dependencies"]
    [[0, 1, 1, 1]]
    """
    from trihex.formats.orders.course import make_course

    check_type("plan", plan, Plan)
    write = writer_of("dependencies", path)
    write(make_course(plan, speed), path)
