"""Metres and seconds: an area with a frame, robots with a radius, waypoints that they can follow."""

import sys
from pathlib import Path

import numpy as np

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
barriers = np.zeros((14, 20), dtype=bool)
barriers[3:11, 6:8] = barriers[3:11, 12:14] = True
area = th.Area("hexagonal", barriers, "hall", th.Frame(cell_size=0.5, origin=(-4.0, 3.5), robot_radius=0.12))
exits = area.metres_to_cell([4.0], [0.0])
scenario = th.Scenario(area, exits, th.random_robots(area, 14, seed=2, avoid=exits))
plan = th.make_plan(scenario)
th.write_waypoints(plan, folder / "waypoints.csv", speed=0.5)
lines = (folder / "waypoints.csv").read_text().splitlines()
print(*lines[:4], sep="\n")
last = max(float(line.split(",")[1]) for line in lines[1:])
print(f"{len(lines) - 1} waypoints; the last robot arrives after {last:.0f} s")
th.picture_of_plan(plan, width=460).save(folder / "metres.png")
