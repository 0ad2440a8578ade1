"""Robots that cannot arrive are named, stay where they are, and hinder nobody."""

import sys
from pathlib import Path

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_random_area("hexagonal", 14, 20, density=0.4, seed=38)
destination = [(10, 7)]
scenario = th.Scenario(area, destination, th.random_robots(area, 30, seed=1, avoid=destination))
n_scheme = th.make_n_scheme(scenario)
stuck = n_scheme.unreachable_robots
print(f"{stuck.size} of {scenario.robot_count} robots cannot arrive:")
for robot in stuck:
    print(f"  robot {robot} on {area.name_of_cell(int(scenario.robots[robot]))}")
plan = th.make_plan(scenario, n_scheme=n_scheme)
print(f"the other {plan.arrived.sum()} arrive")
th.picture_of_plan(plan, width=460).save(folder / "unreachable.png")
