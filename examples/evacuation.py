"""An evacuation: several exits, who takes which, how long the queues are, and what no plan can beat."""

import sys
from pathlib import Path

import numpy as np

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_rooms_area("hexagonal", 26, 35, room=8, doors=0.8, seed=2)
exits = [(0, 4), (34, 13), (13, 25)]
scenario = th.Scenario(area, exits, th.random_robots(area, 150, seed=5, avoid=exits), destination_capacity=1)
plan = th.make_plan(scenario)
report = th.make_report(plan)
for x, y in exits:
    count = np.count_nonzero(plan.last_cell_of_robot == area.xy_to_cell(x, y))
    print(f"exit ({x}, {y}): {count} persons")
arrivals = np.sort(plan.arrival_step_of_robot)
print(f"half are out after {arrivals[75]} steps, all after {report.steps}")
print(f"waiting: {report.total_waiting / report.total_time:.0%} of the total time; gap at most {report.gap:.1%}")
title = "150 persons, three exits"
th.write_animation(plan, folder / "evacuation.gif", width=340, max_frames=60, title=title)
