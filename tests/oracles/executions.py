"""Plans written with their dependencies, and robots of `examples/executor.py` that execute them at random paces.

``python -m tests.oracles.executions`` prints a table of docs/metric.md; it exits with 1 if there is a contact, if
robots do not arrive, or if a dependency could be left out.
"""

import argparse
import json
import random
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from examples.executor import Execution, random_pace

import trihex as th
from tests.oracles.closest import closest
from tests.oracles.continuous import ROUNDING
from tests.oracles.wanderers import wandering_plan
from tests.strategies import SHAPES
from trihex.areas.clearance import least_distance

FOREVER = 1e7  # seconds


def crowded_plan(shape, seed, following="forbid"):
    """Return a plan for 5 to 200 robots of the greatest radius, on cells of a metre, by planners and clocks in turn."""
    rng = np.random.default_rng(seed)
    name, neighbourhood = shape
    tessellation = th.Tessellation(name, neighbourhood, "euclidean", ("steps", "costs")[seed % 2])
    robots = round(5 * 40 ** rng.random())
    side = round((robots * rng.uniform(2, 4)) ** 0.5) + 2
    barriers = rng.random((side, side)) < 0.15
    radius = least_distance(tessellation, following=following) / 2
    area = th.Area(tessellation, barriers, frame=th.Frame(1.0, robot_radius=radius))
    free = np.flatnonzero(~barriers)
    scenario = th.Scenario(
        area,
        rng.choice(free, size=min(1 + robots // 20, 4), replace=False),
        rng.choice(free, size=min(robots, free.size // 2), replace=False),
        following=following,
    )
    plan = wandering_plan(scenario, seed) if seed % 4 == 3 and robots <= 40 else None
    return plan or th.make_plan(scenario, ("fcost", "greedy")[seed // 2 % 2])


def written(plan):
    """Return the file of a plan, as any program reads it."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "plan.dependencies.json")
        th.write_dependencies(plan, path)
        return json.loads(path.read_text())


def paces(seed):
    """Return a random pace: mostly few stops, now and then fifty on each way, or none."""
    rng = random.Random(seed)
    return random_pace(rng, slowest=0.1, stops=50 if seed % 40 == 7 else seed % 4, longest=50.0)


def holding(dependency, share):
    """Return a pace of full speed, but `robot` stops long before it leaves, and `other` ever so long on its way."""
    robot_to, other_to = tuple(dependency[:2]), tuple(dependency[2:])

    def pace(robot, waypoint, seconds):
        if (robot, waypoint) == other_to:
            return 0.0, [(share * seconds + 1e-9, share), (FOREVER, share), ((1 - share) * seconds + 1e-9, 1.0)]
        return FOREVER / 2 if (robot, waypoint) == robot_to else 0.0, [(seconds, 1.0)]

    return pace


def is_contact(plan, tracks):
    """Whether two robots overlap at any time."""
    return closest(tracks)[0] < 2 * (plan["robot_radius"] - ROUNDING)


def without(plan, number):
    """Return a plan without one of its dependencies."""
    return plan | {"dependencies": plan["dependencies"][:number] + plan["dependencies"][number + 1 :]}


def what_breaks(plan, number):
    """Return what happens once a dependency is taken out, at worst: "contact", "vertex" or "" for nothing.

    Not all moves that may not pass a lattice vertex at a time come as near as a contact: some run side by side.
    """
    dependency, less = plan["dependencies"][number], without(plan, number)
    shares = (0.0, 1 / 3, 0.5, 2 / 3, 0.99)  # where it stands, where ways cross, just before the destination
    executions = [Execution(less, holding(dependency, share)).run() for share in shares]
    if any(is_contact(plan, execution.tracks) for execution in executions):
        return "contact"
    robot, waypoint, other, reached = dependency
    meets_late = executions[2].times[robot][waypoint] < FOREVER < executions[2].times[other][reached]
    tessellation = th.Tessellation(plan["tessellation"], plan["neighbourhood"])
    cells = [
        plan["robots"][r]["waypoints"][i]["cell"]
        for r, to in ((robot, waypoint), (other, reached))
        for i in (to - 1, to)
    ]
    corners = [
        {tuple(corner) for corner in np.round(tessellation.polygon_of_cell(*cell), 6).tolist()} for cell in cells
    ]
    return "vertex" if meets_late and set.intersection(*corners) else ""


class Tally:
    """What came of the executions of some plans."""

    def __init__(self):
        self.plans = self.robots = self.moves = self.executions = self.contacts = self.stuck = 0
        self.taken_out = self.contacts_without = self.vertices_without = self.contacts_by_chance = self.dependencies = 0
        self.nearest = np.inf

    def execute(self, plan, seeds):
        """Execute a plan at random paces."""
        self.plans += 1
        self.robots += len(plan["robots"])
        self.moves += sum(len(robot["waypoints"]) - 1 for robot in plan["robots"])
        self.dependencies += len(plan["dependencies"])
        for seed in seeds:
            execution = Execution(plan, paces(seed)).run()
            self.executions += 1
            self.stuck += any(map(execution.is_stuck, range(len(execution.at))))
            self.nearest = min(self.nearest, closest(execution.tracks)[0])
            self.contacts += is_contact(plan, execution.tracks)

    def take_out(self, plan, seed):
        """Take out a random dependency, and look whether that shows."""
        if not plan["dependencies"]:
            return
        number = random.Random(seed).randrange(len(plan["dependencies"]))
        self.taken_out += 1
        broken = what_breaks(plan, number)
        self.contacts_without += broken == "contact"
        self.vertices_without += broken == "vertex"
        self.contacts_by_chance += is_contact(plan, Execution(without(plan, number), paces(seed)).run().tracks)


def tally_of(shape, plans, executions):
    """Return what came of so many executions of each of so many plans."""
    tally = Tally()
    for seed in range(plans):
        plan = written(crowded_plan(shape, seed))
        tally.execute(plan, range(seed * executions, (seed + 1) * executions))
        tally.take_out(plan, seed)
    return tally


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.oracles.executions", description=__doc__)
    parser.add_argument("--plans", type=int, default=100, help="for each kind of cells")
    parser.add_argument("--executions", type=int, default=20, help="of each plan")
    options = parser.parse_args()
    bad = 0
    print(
        "| cells | plans | robots | moves | dependencies | executions | contacts | stuck | nearest | rule | taken out |"
    )
    print("|" + "---|" * 11)
    for shape in SHAPES:
        tally = tally_of(shape, options.plans, options.executions)
        bad += tally.contacts + tally.stuck + tally.taken_out - tally.contacts_without - tally.vertices_without
        tessellation = th.Tessellation(*shape, "euclidean")
        least = least_distance(tessellation, following="forbid")
        cells = f"{shape[0]}, {tessellation.direction_count} | {tally.plans} | {tally.robots} | {tally.moves}"
        found = f"{tally.contacts_without} + {tally.vertices_without} of {tally.taken_out}"
        found += f", {tally.contacts_by_chance} by chance"
        counts = f"{tally.dependencies} | {tally.executions} | {tally.contacts} | {tally.stuck}"
        print(f"| {cells} | {counts} | {tally.nearest:.4f} | {least:.4f} | {found} |", flush=True)
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
