"""Contacts in many random scenarios on ROS maps: ``python -m tests.oracles.contacts MAP.yaml ... --robots 100``.

For each map, tessellation and seed: the map becomes cells, robots and exits are drawn, a planner plans, the waypoints
are written, and the judge of `tests.oracles.continuous` moves discs along them. It prints the rows of the table in
docs/metric.md, and exits with 1 if there is a contact.
"""

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import shapely
from PIL import Image

import trihex as th
from tests.oracles.continuous import boxes_of_pixels, find_contacts
from trihex.areas import FOLLOWINGS, make_regions
from trihex.areas.clearance import least_cell_size
from trihex.formats.areas.ros import parse_yaml

KINDS = {
    "hexagonal": th.Tessellation("hexagonal"),
    "triangular, 12": th.Tessellation("triangular"),
    "triangular, 3": th.Tessellation("triangular", "edge"),
    "square, 8": th.Tessellation("square"),
    "square, 4": th.Tessellation("square", "edge"),
}


def read_world(path):
    """Return the ground of a map that is not known to be free as polygons, and all of the map as one."""
    entries = parse_yaml(path.read_text(), path)
    grey = np.asarray(Image.open(path.parent / entries["image"]).convert("L")).astype(float)
    share = grey / 255 if entries.get("negate", "0") == "1" else (255 - grey) / 255
    west, south, yaw = (float(value) for value in entries["origin"])
    place = float(entries["resolution"]), (west, south), yaw
    occupied = boxes_of_pixels(share >= float(entries.get("free_thresh", 0.196)), *place)
    return occupied, shapely.convex_hull(shapely.union_all(boxes_of_pixels(np.ones(grey.shape, dtype=bool), *place)))


def contacts_on(path, tessellation, options):
    """Return area, cell size and radius that fit, robots planned and contacts found, over all seeds."""
    occupied, room = read_world(path)
    radius = options.robot_radius
    least = least_cell_size(tessellation, radius, options.following)
    size = max(options.cell_size, float(np.ceil(least * 100)) / 100)
    area = th.read_area(path, tessellation, cell_size=size, robot_radius=radius)
    wholes = make_regions(area)
    robots, contacts = 0, []
    if wholes.size_of_region.max(initial=0) < 6:  # no room for two exits and a robot
        return area, size, radius, robots, contacts
    largest = np.flatnonzero(wholes.region_of_cell.reshape(-1) == np.argmax(wholes.size_of_region))
    for seed in range(options.seeds):
        exits = np.random.default_rng(seed).choice(largest, size=2, replace=False)
        starts = np.setdiff1d(largest, exits)
        starts = np.random.default_rng(1000 + seed).choice(starts, min(options.robots, starts.size // 3), replace=False)
        plan = th.make_plan(th.Scenario(area, exits, starts, following=options.following), options.planner)
        assert plan.arrived.all()
        with TemporaryDirectory() as folder:
            th.write_waypoints(plan, Path(folder, "w.csv"), speed=0.5)
            contacts += find_contacts(Path(folder, "w.csv"), radius, occupied, room)
        robots += plan.scenario.robot_count
    return area, size, radius, robots, contacts


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.oracles.contacts", description=__doc__)
    parser.add_argument("maps", nargs="+", type=Path)
    parser.add_argument("--robots", type=int, default=100, help="at most a third of the free cells")
    parser.add_argument("--cell-size", type=float, default=0.5, help="or the least that the radius allows")
    parser.add_argument("--robot-radius", type=float, default=0.15)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--planner", default="fcost")
    parser.add_argument("--following", choices=FOLLOWINGS, default="allow")
    options = parser.parse_args()
    found = 0
    print("| map | cells | cell_size, R | free cells | robots | contacts |\n|---|---|---|---|---|---|")
    for path in options.maps:
        for name, tessellation in KINDS.items():
            area, size, radius, robots, contacts = contacts_on(path, tessellation, options)
            found += len(contacts)
            many = f"{options.seeds} x {robots // options.seeds}"
            print(
                f"| {path.stem} | {name} | {size:g}, {radius:g} | {area.free_count} | {many} | {len(contacts)} |",
                flush=True,
            )
    sys.exit(found > 0)


if __name__ == "__main__":
    main()
