"""Tracks as GeoJSON: a line for each robot."""

from __future__ import annotations

import json
import os

from trihex.files import new_file
from trihex.formats.tracks.tracks import Tracks


def write_geojson(tracks: Tracks, path: str | os.PathLike[str]) -> None:
    """Write a feature for each robot: a LineString of its places in metres, row by row; a Point if it has but one.

    Properties: kind `track`, robot, arrived, and times, the seconds of the places.
    """
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        file.write('{"type": "FeatureCollection", "features": [\n')
        for robot in range(tracks.robot_count):
            rows = tracks.rows_of(robot)
            places = [list(place) for place in zip(tracks.x[rows].tolist(), tracks.y[rows].tolist(), strict=True)]
            is_line = len(places) > 1
            feature = {
                "type": "Feature",
                "geometry": {
                    "type": "LineString" if is_line else "Point",
                    "coordinates": places if is_line else places[0],
                },
                "properties": {
                    "kind": "track",
                    "robot": robot,
                    "arrived": bool(tracks.arrived[robot]),
                    "times": tracks.seconds[rows].tolist(),
                },
            }
            file.write(json.dumps(feature) + (",\n" if robot + 1 < tracks.robot_count else "\n"))
        file.write("]}\n")
