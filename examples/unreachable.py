"""Robots that cannot arrive are named, stay where they are, and hinder nobody."""

import sys
from pathlib import Path

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_random_area("hexagonal", 18, 26, density=0.42, seed=7)
destination = [(13, 9)]
scenario = th.Scenario(area, destination, th.random_robots(area, 40, seed=1, avoid=destination))
n_scheme = th.make_n_scheme(scenario)
stuck = n_scheme.unreachable_robots
print(f"{stuck.size} of {scenario.robot_count} robots cannot arrive, among them:")
for robot in stuck[:3]:
    print(f"  robot {robot} on {area.name_of_cell(int(scenario.robots[robot]))}")
plan = th.make_plan(scenario, n_scheme=n_scheme)
print(f"the other {plan.arrived.sum()} arrive")
th.picture_of_plan(plan, width=420).save(folder / "unreachable.png")
