"""Unknown terrain: robots find their way through rooms they have never seen, and what that costs them."""

import sys
from pathlib import Path

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_rooms_area("hexagonal", 40, 46, room=7, doors=0.35, seed=4)
exits = [(3, 3)]
free = [(x, y) for y in range(24, 40) for x in range(26, 46) if not area.barriers[y, x]]
scenario = th.Scenario(area, exits, free[::6])
run = th.Trial(scenario, sensor=th.Sensor(area.tessellation, 3, line_of_sight=True)).run()
report = th.make_run_report(run)
print(f"{run.arrived.sum()} of {scenario.robot_count} robots arrive in {run.steps} steps")
print(f"total time {run.total_time}; with a map {report.reference.total_time}: {report.price:+.0%}")
th.picture_of_run(run, width=420).save(folder / "unknown_terrain.png")
th.write_run_animation(run, folder / "unknown_terrain.gif", width=360, max_frames=110, frames_per_second=12)
