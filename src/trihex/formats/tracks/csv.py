"""Waypoints: where each robot is to be at which second, as CSV with the header `robot,t,x,y,yaw`."""

from __future__ import annotations

import os

from trihex.files import new_file
from trihex.formats.tracks.tracks import Tracks

HEADER = "robot,t,x,y,yaw"
_ROWS_AT_ONCE = 50_000


def write_waypoints_csv(tracks: Tracks, path: str | os.PathLike[str]) -> None:
    """Write a row for each robot and step (move, by the clock "costs"): seconds, metres, radians, to six decimals.

    Between two rows a robot moves in a straight line at constant speed. With its last row it leaves the world, unless
    it cannot arrive: then it stays where it is, and its last row is that of the last step of the plan.
    """
    robot, seconds = tracks.robot, tracks.seconds
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        file.write(f"{HEADER}\n")
        for first in range(0, robot.size, _ROWS_AT_ONCE):
            rows = slice(first, first + _ROWS_AT_ONCE)
            columns = (robot[rows], seconds[rows], tracks.x[rows], tracks.y[rows], tracks.yaw[rows])
            file.writelines(
                f"{r},{t:.6f},{x:.6f},{y:.6f},{yaw:.6f}\n"
                for r, t, x, y, yaw in zip(*(column.tolist() for column in columns), strict=True)
            )
