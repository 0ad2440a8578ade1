"""Dependencies: who waits for whom in plans for 10 000 robots, before and after implied ones are dropped.

``python -m benchmarks dependencies`` plans by `fcost` for three destinations on 200 x 200 cells, a tenth of them
barriers, and prints a row of the table in docs/formats.md for each kind of cells and rule.
"""

import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import trihex as th
from benchmarks.measure import cpu_seconds, machine

SIDE, ROBOTS = 200, 10_000
KINDS = (("hexagonal", "steps"), ("triangular", "costs"))


def plan_for(name: str, clock: str, following: str) -> th.Plan:
    """Return the plan that is measured."""
    area = th.make_random_area(th.Tessellation(name, clock=clock), SIDE, SIDE, density=0.1, seed=1)
    free = np.flatnonzero(~area.barriers.reshape(-1))
    goals = free[[free.size // 7, free.size // 2, -free.size // 5]]
    robots = th.random_robots(area, ROBOTS, seed=1, avoid=goals)
    return th.make_plan(th.Scenario(area, goals, robots, destination_capacity=1, following=following), "fcost")


def main(options: list[str]) -> None:
    """Print the rows; there are no options."""
    assert not options
    sys.stdout.write(f"{machine()}\n")
    for name, clock in KINDS:
        for following in ("forbid", "allow"):
            plan = plan_for(name, clock, following)
            found = th.make_dependencies(plan)
            steps, written = int(plan.last_step_of_robot.sum()), len(found.waits)
            arrays = (found.first_waypoint, found.cell_of_waypoint, found.step_of_waypoint, found.waits)
            with TemporaryDirectory() as folder:
                path = Path(folder, "plan.dependencies.json")
                make, write = partial(th.make_dependencies, plan), partial(th.write_dependencies, plan, path)
                seconds = cpu_seconds({"make": make, "write": write}, 1, warm_up=False)
                size = path.stat().st_size / 1e6
            moves = found.cell_of_waypoint.size - ROBOTS
            sys.stdout.write(
                f"| {name}, {clock}, {following} | {moves} | {written + found.implied} | {written} | "
                f"{written / moves:.2f}, {written / steps:.3f} | {len(found.rings)} | {seconds['make']:.1f}, "
                f"{seconds['write']:.1f} | {sum(array.nbytes for array in arrays) / 1e6:.0f}, {size:.0f} |\n"
            )
            sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
