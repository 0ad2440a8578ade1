"""Nav path: a `nav_msgs/Path` message for each robot, as YAML documents or as a JSON list."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from math import cos, sin
from typing import Any

from trihex.files import new_file
from trihex.formats.tracks.tracks import Tracks

# Names that YAML takes for nothing else; others are quoted.
_PLAIN = re.compile(r"(?!(?:true|false|yes|off|null)$)[a-z_]{3,}")


def write_nav_path_json(tracks: Tracks, path: str | os.PathLike[str]) -> None:
    """Write a list of messages, one for each robot, with a pose for each step, stamped from 0 on."""
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        for robot in range(tracks.robot_count):
            file.write("[\n" if robot == 0 else ",\n")
            file.write(json.dumps(path_of_robot(tracks, robot)))
        file.write("\n]\n" if tracks.robot_count else "[]\n")


def write_nav_path_yaml(tracks: Tracks, path: str | os.PathLike[str]) -> None:
    """Write a document with the message of each robot, with a pose for each step, stamped from 0 on."""
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        for robot in range(tracks.robot_count):
            file.write(f"---  # robot {robot}\n")
            file.writelines(_yaml_lines(path_of_robot(tracks, robot), ""))


def path_of_robot(tracks: Tracks, robot: int) -> dict[str, Any]:
    """Return the message of a robot with the fields of nav_msgs/Path."""
    rows = tracks.rows_of(robot)
    columns = (column[rows].tolist() for column in (tracks.seconds, tracks.x, tracks.y, tracks.yaw))
    poses = [
        {
            "header": header_of(seconds, tracks.frame_id),
            "pose": pose_of(x, y, yaw),
        }
        for seconds, x, y, yaw in zip(*columns, strict=True)
    ]
    return {"header": header_of(0.0, tracks.frame_id), "poses": poses}


def pose_of(x: float, y: float, yaw: float) -> dict[str, Any]:
    """Return a place and a heading with the fields of geometry_msgs/Pose."""
    return {
        "position": {"x": round(x, 6), "y": round(y, 6), "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": round(sin(yaw / 2), 9), "w": round(cos(yaw / 2), 9)},
    }


def header_of(seconds: float, frame_id: str) -> dict[str, Any]:
    """Return a time and a frame with the fields of std_msgs/Header."""
    whole, nanoseconds = divmod(round(seconds * 1e9), 10**9)
    return {"stamp": {"sec": whole, "nanosec": nanoseconds}, "frame_id": frame_id}


def _yaml_lines(value: dict[str, Any], indent: str) -> Iterator[str]:
    """Yield the lines of a YAML mapping of mappings, lists of mappings, numbers and words."""
    for key, inner in value.items():
        if isinstance(inner, dict):
            yield f"{indent}{key}:\n"
            yield from _yaml_lines(inner, indent + "  ")
        elif isinstance(inner, list):
            yield f"{indent}{key}:\n" if inner else f"{indent}{key}: []\n"
            for item in inner:
                first, *others = _yaml_lines(item, indent + "  ")
                yield f"{indent}- {first.lstrip()}"
                yield from others
        else:
            is_plain = not isinstance(inner, str) or _PLAIN.fullmatch(inner)
            yield f"{indent}{key}: {inner if is_plain else json.dumps(inner)}\n"
