"""A judge in continuous space: discs that follow waypoints, what stands in the world, and no word of cells.

It reads nothing but the CSV `robot,t,x,y,yaw` and geometries in metres, and shares no code with trihex.
"""

import csv
from collections import defaultdict
from itertools import pairwise
from pathlib import Path

import numpy as np
import shapely
from scipy.spatial import cKDTree

# Waypoints are written to a micrometre in x and in y.
ROUNDING = 2e-6


def read_waypoints(path):
    """Return the rows (t, x, y) of each robot, in the order of the file."""
    rows = defaultdict(list)
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            rows[int(row["robot"])].append((float(row["t"]), float(row["x"]), float(row["y"])))
    return {robot: np.array(own) for robot, own in rows.items()}


def contacts_between_robots(tracks, radius):
    """Return (t, robot, robot, distance) for each pair of discs that overlap while both are in the world.

    Between two rows a robot moves in a straight line at constant speed. A robot is in the world from its first to its
    last row.
    """
    found = []
    times = np.unique(np.concatenate([own[:, 0] for own in tracks.values()]))
    if times.size == 1:
        times = np.repeat(times, 2)
    for begin, end in pairwise(times):
        present = [robot for robot, own in tracks.items() if own[0, 0] <= begin and own[-1, 0] >= begin]
        if len(present) < 2:
            continue
        # One that leaves at `begin` is still there at that instant: others meet it where they begin.
        until = np.array([end if tracks[robot][-1, 0] >= end else begin for robot in present])
        start, stop = (
            np.array(
                [
                    [np.interp(t, tracks[r][:, 0], tracks[r][:, axis]) for axis in (1, 2)]
                    for r, t in zip(present, at, strict=True)
                ]
            )
            for at in (np.full(len(present), begin), until)
        )
        reach = 2 * radius + np.hypot(*(stop - start).T).max()
        for one, other in cKDTree((start + stop) / 2).query_pairs(reach):
            gap, change = start[other] - start[one], (stop - start)[other] - (stop - start)[one]
            if min(until[one], until[other]) == begin:
                change = np.zeros(2)
            speed = change @ change
            moment = 0.0 if speed == 0 else min(1.0, max(0.0, -(gap @ change) / speed))
            distance = float(np.hypot(*(gap + moment * change)))
            if distance < 2 * (radius - ROUNDING):
                found.append((float(begin + moment * (end - begin)), present[one], present[other], distance))
    return found


def contacts_with_world(tracks, radius, occupied, inside=None):
    """Return (robot, geometry number) for each disc that touches what is occupied on its way; -1 for what lies outside.

    Parameters
    ----------
    tracks : dict
    radius : float
    occupied : array of geometries
    inside : polygon, optional
        What no disc may leave.
    """
    robots = list(tracks)
    ways = [shapely.LineString(own[:, 1:]) if len(own) > 1 else shapely.Point(own[0, 1:]) for own in tracks.values()]
    ways = np.array(ways)
    tree = shapely.STRtree(occupied)
    pairs = tree.query(ways, predicate="dwithin", distance=radius - ROUNDING).T.tolist()
    found = [(robots[way], thing) for way, thing in pairs]
    if inside is not None:
        room = shapely.distance(inside.exterior, ways)
        is_out = ~shapely.covers(inside, ways) | (room < radius - ROUNDING)
        found += [(robots[way], -1) for way in np.flatnonzero(is_out)]
    return found


def greatest_speed(tracks):
    """Return the greatest speed of any robot between two rows, in metres in a second."""
    speeds = [np.hypot(*np.diff(own[:, 1:], axis=0).T) / np.diff(own[:, 0]) for own in tracks.values() if len(own) > 1]
    return max((float(own.max()) for own in speeds if own.size), default=0.0)


def find_contacts(path, radius, occupied, inside=None):
    """Return all contacts in a file of waypoints: between robots and with the world."""
    tracks = read_waypoints(Path(path))
    if not tracks:
        return []
    return contacts_between_robots(tracks, radius) + contacts_with_world(tracks, radius, occupied, inside)


def boxes_of_pixels(is_occupied, resolution, origin=(0.0, 0.0), yaw=0.0):
    """Return the occupied pixels of a raster as polygons in the world, runs of a row joined; row 0 is the north.

    `origin` is the lower left corner of the raster, about which it is turned by `yaw`.
    """
    rows = is_occupied.shape[0]
    padded = np.pad(is_occupied.astype(np.int8), ((0, 0), (1, 1)))
    row, begin = np.nonzero(np.diff(padded, axis=1) == 1)
    _, end = np.nonzero(np.diff(padded, axis=1) == -1)
    corners = np.array([(begin, rows - row - 1), (end, rows - row - 1), (end, rows - row), (begin, rows - row)])
    x, y = corners[:, 0].T * resolution, corners[:, 1].T * resolution
    turned = np.stack([x * np.cos(yaw) - y * np.sin(yaw), x * np.sin(yaw) + y * np.cos(yaw)], axis=-1)
    return shapely.polygons(turned + np.array(origin))
