"""MCAP: a recording as ROS makes it, for Foxglove and RViz: the map, the costs, and the robots as they move."""

from __future__ import annotations

import os
from collections.abc import Iterator
from colorsys import hsv_to_rgb
from itertools import groupby, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import MissingExtraError
from trihex.fields import make_n_scheme
from trihex.files import new_file
from trihex.formats.tracks.nav_path import header_of, path_of_robot, pose_of
from trihex.formats.tracks.ros_messages import ADD, CYLINDER, DELETEALL, LINE_STRIP, definition_of
from trihex.formats.tracks.samples import Samples, make_samples
from trihex.formats.tracks.tracks import Tracks
from trihex.kernels.codes import NOT_REACHED

# As costmaps have it: 100 is occupied, 99 what touches it, -1 unknown.
_OCCUPIED, _FARTHEST, _UNKNOWN = 100, 98, -1
_GOLDEN = 0.618034  # of the colours, so that robots next in number look different


def write_mcap(tracks: Tracks, path: str | os.PathLike[str]) -> None:
    """Write topics ``/map``, ``/n_scheme``, ``/paths``, ``/robot_0/path`` ..., ``/robots/poses`` and ``/robots``.

    A message of ``/robots`` and ``/robots/poses`` for each step (tick) holds all robots that are in the world in it;
    one that is on its way is between two centres, in a straight line, and one that arrives is in its last. Time
    begins with 0. What is what: docs/metric.md.

    Raises
    ------
    MissingExtraError
        If mcap and mcap-ros2-support are not installed.
    """
    try:
        from mcap_ros2.writer import Writer
    except ImportError:
        raise MissingExtraError("MCAP needs mcap and mcap-ros2-support: pip install 'trihex[ros]'") from None
    with new_file(path) as part, open(part, "wb") as file, Writer(file) as writer:
        recording = _Recording(writer)
        _write_grids(recording, tracks)
        if tracks.robot_count:
            recording.write("/paths", "visualization_msgs/MarkerArray", 0.0, {"markers": _lines(tracks)})
        for robot in range(tracks.robot_count):
            recording.write(f"/robot_{robot}/path", "nav_msgs/Path", 0.0, path_of_robot(tracks, robot))
        for seconds, poses, markers in _moments(tracks):
            header = header_of(seconds, tracks.frame_id)
            recording.write("/robots/poses", "geometry_msgs/PoseArray", seconds, {"header": header, "poses": poses})
            recording.write("/robots", "visualization_msgs/MarkerArray", seconds, {"markers": markers})


class _Recording:
    """Messages on their way into a file."""

    def __init__(self, writer: Any) -> None:
        self.writer = writer
        self.schema_of_message: dict[str, Any] = {}

    def write(self, topic: str, message: str, seconds: float, content: dict[str, Any]) -> None:
        """Write a message, and what it is made of when it is the first of its kind."""
        if message not in self.schema_of_message:
            text = definition_of(message)
            schema = self.writer.register_msgdef(message.replace("/", "/msg/"), text)
            # The file says int8[]. The library would write such numbers one by one; bytes, which look alike, at once.
            schema.data = text.replace("\nint8[]", "\nuint8[]").encode()
            self.schema_of_message[message] = schema
        nanoseconds = round(seconds * 1e9)
        self.writer.write_message(topic, self.schema_of_message[message], content, nanoseconds, nanoseconds)


def _write_grids(recording: _Recording, tracks: Tracks) -> None:
    """Write the map, and the N-scheme as costs."""
    area, samples = tracks.area, make_samples(tracks.area)
    n_scheme = make_n_scheme(tracks.scenario.with_robots(()))
    barriers, distance = area.barriers.reshape(-1), n_scheme.distance.reshape(-1)
    occupancy = np.where(barriers, _OCCUPIED, 0)
    share = distance / max(1, n_scheme.farthest)
    costs = np.round(_FARTHEST * np.minimum(share, 1))
    costs[distance == NOT_REACHED] = _UNKNOWN
    costs[barriers] = _OCCUPIED
    for topic, of_cell, depth in (("/map", occupancy, 0.0), ("/n_scheme", costs, -0.01)):
        grid = _grid(samples, of_cell, area.metres.yaw, depth)
        grid["header"] = header_of(0.0, tracks.frame_id)
        recording.write(topic, "nav_msgs/OccupancyGrid", 0.0, grid)
    tessellation = area.tessellation
    words = {
        "tessellation": tessellation.name,
        "neighbourhood": tessellation.neighbourhood,
        "costs": tessellation.costs,
        "cell_size": repr(area.metres.cell_size),
        "farthest": str(n_scheme.farthest),
        "seconds_per_step": repr(tracks.seconds_per_step),
    }
    recording.writer.add_metadata("trihex", words)


def _grid(samples: Samples, of_cell: NDArray[Any], yaw: float, depth: float) -> dict[str, Any]:
    """Return the message of a grid with a number for each cell, without its header."""
    data = np.append(of_cell, _UNKNOWN).astype(np.int8)[samples.cells]  # -1, outside, is the last
    rows, columns = samples.cells.shape
    pose = pose_of(*samples.origin, yaw)
    pose["position"]["z"] = depth
    info = {"resolution": samples.resolution, "width": columns, "height": rows, "origin": pose}
    return {"info": info, "data": data.tobytes()}


def _lines(tracks: Tracks) -> list[dict[str, Any]]:
    """Return a line for the path of each robot."""
    width = 0.04 * tracks.area.metres.cell_size
    lines = []
    for robot in range(tracks.robot_count):
        rows = tracks.rows_of(robot)
        places = zip(tracks.x[rows].tolist(), tracks.y[rows].tolist(), strict=True)
        points = [{"x": x, "y": y, "z": 0.0} for (x, y), _ in groupby(places)]
        points += points * (len(points) == 1)  # a line of one point is refused by RViz
        header = header_of(0.0, tracks.frame_id)
        marker = _marker(robot, header, LINE_STRIP, pose_of(0.0, 0.0, 0.0), {"x": width, "y": 0.0, "z": 0.0})
        lines.append({**marker, "points": points})
    return lines


def _moments(tracks: Tracks) -> Iterator[tuple[float, list[dict[str, Any]], list[dict[str, Any]]]]:
    """Yield the time, the poses and the markers of each step; the first marker wipes off those of the last."""
    frames = tracks.frames()
    first = np.flatnonzero(np.diff(frames.step, prepend=-1)).tolist()
    radius = tracks.area.metres.robot_radius or tracks.area.metres.cell_size / 4
    size = {"x": 2 * radius, "y": 2 * radius, "z": radius}
    for begin, end in pairwise([*first, frames.step.size]):
        seconds = int(frames.step[begin]) * tracks.seconds_per_step
        columns = (column[begin:end].tolist() for column in (frames.x, frames.y, frames.yaw))
        poses = [pose_of(x, y, yaw) for x, y, yaw in zip(*columns, strict=True)]
        robots = frames.robot[begin:end].tolist()
        header = header_of(seconds, tracks.frame_id)
        discs = [_marker(robot, header, CYLINDER, pose, size) for robot, pose in zip(robots, poses, strict=True)]
        wipe = {"header": header, "action": DELETEALL}
        yield seconds, poses, [wipe, *discs]


def _marker(
    robot: int, header: dict[str, Any], kind: int, pose: dict[str, Any], size: dict[str, float]
) -> dict[str, Any]:
    """Return a marker of a robot, in its colour."""
    red, green, blue = hsv_to_rgb(robot * _GOLDEN % 1, 0.75, 0.9)
    return {
        "header": header,
        "ns": "robots",
        "id": robot,
        "type": kind,
        "action": ADD,
        "pose": pose,
        "scale": size,
        "color": {"r": red, "g": green, "b": blue, "a": 1.0},
    }
