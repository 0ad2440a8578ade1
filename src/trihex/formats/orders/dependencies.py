"""Dependencies: the waypoints of all robots and who waits for whom as JSON, for whoever lets robots drive."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from trihex.files import new_file
from trihex.formats.orders.course import Course

FORMAT = "trihex plan with dependencies"
_ROWS_AT_ONCE = 50_000


def write_dependencies_json(course: Course, path: str | os.PathLike[str]) -> None:
    """Write a line of JSON for each robot and dependency; numbers have six decimals."""
    dependencies = course.dependencies
    head = ",\n".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in _head(course).items())
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        file.write(f'{{\n{head},\n"robots": [')
        for robot, line in enumerate(_lines_of_robots(course)):
            file.write(f"{',' if robot else ''}\n{line}")
        file.write('\n],\n"dependencies": [')
        for first in range(0, len(dependencies.waits), _ROWS_AT_ONCE):
            rows = dependencies.waits[first : first + _ROWS_AT_ONCE].tolist()
            file.write(",\n" if first else "\n")
            file.write(",\n".join(map(str, rows)))
        file.write("\n]\n}\n")


def _head(course: Course) -> dict[str, Any]:
    """Return what is said of all robots."""
    dependencies, scenario = course.dependencies, course.dependencies.plan.scenario
    tessellation, frame = scenario.area.tessellation, scenario.area.frame
    return {
        "format": FORMAT,
        "version": 1,
        "area": scenario.area.name,
        "tessellation": tessellation.name,
        "neighbourhood": tessellation.neighbourhood,
        "unit": "metres" if course.has_metres else "edge steps",
        "robot_radius": None if frame is None else frame.robot_radius,
        "speed": course.speed,
        "seconds_per_step": round(course.seconds_per_step, 6),
        "following": scenario.following,
        "sentence": dependencies.sentence,
        "rings": [ring.tolist() for ring in dependencies.rings],
    }


def _lines_of_robots(course: Course) -> Iterator[str]:
    """Yield each robot as JSON."""
    dependencies, plan = course.dependencies, course.dependencies.plan
    cell_x, cell_y = plan.scenario.area.cell_to_xy(dependencies.cell_of_waypoint)
    # Minus zero is zero.
    places = [np.round(column, 6) + 0.0 for column in (course.x, course.y, course.yaw, course.earliest)]
    for robot, arrives in enumerate(plan.arrived.tolist()):
        own = slice(course.rows_of(robot).start, course.rows_of(robot).stop)
        columns = (column[own].tolist() for column in (cell_x, cell_y, *places))
        waypoints = ", ".join(
            f'{{"cell": [{i}, {j}], "x": {x}, "y": {y}, "yaw": {yaw}, "earliest": {earliest}}}'
            for i, j, x, y, yaw, earliest in zip(*columns, strict=True)
        )
        yield f'{{"arrives": {json.dumps(arrives)}, "waypoints": [{waypoints}]}}'
