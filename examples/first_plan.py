"""From an area to a plan, its numbers and its picture: 60 robots leave a cave."""

import sys
from pathlib import Path

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_caves_area("hexagonal", 24, 36, seed=4)
exits = [(18, 12)]
scenario = th.Scenario(area, exits, robots=th.random_robots(area, 60, seed=1, avoid=exits))
plan = th.make_plan(scenario)
report = th.make_report(plan)
print(f"{report.arrived_count} robots arrive in {report.steps} steps, conflicts: {report.audit.conflict_count}")
print(f"total time {report.total_time}, no plan takes less than {report.lower_bound}: gap at most {report.gap:.1%}")
th.picture_of_plan(plan, width=460).save(folder / "first_plan.png")
