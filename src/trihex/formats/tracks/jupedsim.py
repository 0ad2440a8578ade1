"""JuPedSim: trajectories as an sqlite file of version 2, which JuPedSim's viewer and PedPy read."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator
from hashlib import sha256

import numpy as np

from trihex.areas import Area, import_shapely
from trihex.errors import FormatError
from trihex.files import new_file
from trihex.formats.tracks.tracks import Tracks

# By this share of the cell size cells are drawn larger, so that those that touch in a vertex hang together.
_SEAM = 1e-3
_SCHEMA = """
CREATE TABLE trajectory_data (
    frame INTEGER NOT NULL, id INTEGER NOT NULL,
    pos_x REAL NOT NULL, pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL
);
CREATE TABLE metadata (key TEXT NOT NULL UNIQUE, value TEXT NOT NULL);
CREATE TABLE geometry (hash INTEGER NOT NULL, wkt TEXT NOT NULL);
CREATE TABLE frame_data (frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);
CREATE INDEX frame_id_idx ON trajectory_data(frame, id);
"""


def write_jupedsim(tracks: Tracks, path: str | os.PathLike[str]) -> None:
    """Write a frame for each step (tick), with all robots that are in the world in it, and free cells as geometry.

    A robot that is on its way is between two centres, in a straight line. It is in the last frame when it arrives.
    The geometry is all free ground that is connected with a robot.

    Raises
    ------
    FormatError
        If there is no robot.
    MissingExtraError
        If shapely is not installed.
    """
    if tracks.robot_count == 0:
        raise FormatError(f"{path}: trajectories need at least one robot")
    wkt = _walkable(tracks.area, tracks)
    frames = int(tracks.step.max()) + 1
    ground = int.from_bytes(sha256(wkt.encode()).digest()[:8], signed=True)
    rows = _rows_of_frames(tracks)
    with new_file(path) as part:
        connection = sqlite3.connect(part, isolation_level=None)
        try:
            connection.executescript("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF;" + _SCHEMA + "BEGIN;")
            meta = [
                ("version", "2"),
                ("fps", repr(1 / tracks.seconds_per_step)),
                *(
                    (f"{axis}{limit}", repr(float(getattr(np, limit)(getattr(tracks, axis)))))
                    for axis in "xy"
                    for limit in ("min", "max")
                ),
            ]
            connection.executemany("INSERT INTO metadata VALUES (?, ?)", meta)
            connection.execute("INSERT INTO geometry VALUES (?, ?)", (ground, wkt))
            connection.executemany("INSERT INTO frame_data VALUES (?, ?)", ((frame, ground) for frame in range(frames)))
            connection.executemany("INSERT INTO trajectory_data VALUES (?, ?, ?, ?, ?, ?)", rows)
            connection.execute("COMMIT")
        finally:
            connection.close()


def _rows_of_frames(tracks: Tracks) -> Iterator[tuple[float, ...]]:
    """Yield frame, robot, place and heading, frame by frame."""
    frames = tracks.frames()
    columns = (frames.step, frames.robot, frames.x, frames.y, np.cos(frames.yaw), np.sin(frames.yaw))
    yield from zip(*(column.tolist() for column in columns), strict=True)


def _walkable(area: Area, tracks: Tracks) -> str:
    """Return the free ground on which robots stand as WKT, polygons with holes in metres."""
    shapely = import_shapely()
    cells = np.flatnonzero(~area.barriers.reshape(-1))
    corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(cells))
    centre = corners.mean(axis=1, keepdims=True)
    corners = centre + (corners - centre) * (1 + _SEAM)
    ground = shapely.union_all(
        shapely.polygons(np.stack(area.metres.point_to_metres(corners[..., 0], corners[..., 1]), axis=-1))
    )
    parts = shapely.get_parts(ground)
    starts = shapely.multipoints(np.stack([tracks.x, tracks.y], axis=-1)[tracks.first_row[:-1]])
    parts = parts[shapely.intersects(parts, starts)]
    return str(shapely.to_wkt(parts[0] if parts.size == 1 else shapely.multipolygons(parts), rounding_precision=6))
