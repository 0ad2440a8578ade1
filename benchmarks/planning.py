"""Planning: nanoseconds per robot and step, beside mesa and w9-pathfinding, and how they grow in the robots.

Ours is all of `make_plan` but the N-scheme, from the D-scheme to the record; a robot-step is one step of one robot
until it arrives, waits included. mesa: agents of a model on its hexagonal grid that look around and step to an empty
neighbouring cell, which is less work than planning. w9-pathfinding: its cooperative A*, with a goal of its own for each
agent, because it knows no shared ones.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np

import trihex as th
from benchmarks.measure import cpu_seconds, exponent, machine

TESSELLATIONS = ("hexagonal", "triangular")
PLANNERS = ("greedy", "fcost")


def make_scenario(tessellation: str, size: int, robots: int, destinations: int, seed: int = 1) -> th.Scenario:
    """Return robots and destinations at random on a random area with 20 % barriers."""
    area = th.make_random_area(tessellation, size, size, density=0.2, seed=seed)
    ends = np.random.default_rng(seed).choice(np.flatnonzero(~area.barriers), destinations, replace=False)
    return th.Scenario(area, ends, th.random_robots(area, robots, seed, avoid=ends))


def nanoseconds(scenario: th.Scenario, repeats: int, planners: tuple[str, ...] = PLANNERS) -> dict[str, float]:
    """Return CPU nanoseconds per robot-step of each planner."""
    n_scheme = th.make_n_scheme(scenario)
    _ = scenario.moves
    makers = {name: lambda name=name: th.make_plan(scenario, name, n_scheme=n_scheme) for name in planners}
    seconds = cpu_seconds(makers, repeats)
    return {name: 1e9 * seconds[name] / makers[name]().actions.size for name in planners}


def mesa_nanoseconds(size: int, agents: int, steps: int) -> float:
    """Return CPU nanoseconds per agent and step on mesa's hexagonal grid."""
    from random import Random

    from mesa.discrete_space import CellAgent, HexGrid
    from mesa.model import Model

    class Walker(CellAgent):
        def step(self) -> None:
            empty = [cell for cell in self.cell.neighborhood if cell.is_empty]
            if empty:
                self.cell = empty[0]

    model = Model()
    grid = HexGrid((size, size), torus=False, capacity=1, random=Random(1))
    cells = Random(2).sample(list(grid.all_cells), agents)
    for cell in cells:
        Walker(model).cell = cell
    begin = time.process_time()
    for _ in range(steps):
        model.agents.do("step")
    return 1e9 * (time.process_time() - begin) / (agents * steps)


def w9_nanoseconds(size: int, agents: int) -> float:
    """Return CPU nanoseconds per agent and step of w9-pathfinding's cooperative A* on its hexagonal grid."""
    from w9_pathfinding.envs import HexGrid
    from w9_pathfinding.mapf import HCAStar

    area = th.make_random_area("hexagonal", size, size, density=0.2, seed=1)
    reached = np.flatnonzero(th.make_n_scheme(th.Scenario(area, [_middle(area)])).distance < 2**31 - 1)
    places = np.random.default_rng(1).choice(reached, 2 * agents, replace=False)
    grid = HexGrid(np.where(area.barriers, -1.0, 1.0).tolist())
    finder = HCAStar(grid)
    starts = [(int(cell % size), int(cell // size)) for cell in places[:agents]]
    goals = [(int(cell % size), int(cell // size)) for cell in places[agents:]]
    begin = time.process_time()
    paths = finder.mapf(starts, goals)
    return 1e9 * (time.process_time() - begin) / max(1, sum(len(path) - 1 for path in paths))


def _middle(area: th.Area) -> int:
    free = np.flatnonzero(~area.barriers)
    return int(free[np.argmin(np.abs(free - area.cell_count // 2 - area.width // 2))])


def compare(name: str, measure: Callable[[], float], ours: dict[str, float]) -> None:
    """Print how many times as long another library takes."""
    try:
        theirs = measure()
    except ImportError as missing:
        print(f"{name}: not installed ({missing.name})")
        return
    ratios = ", ".join(f"{theirs / value:.0f} times {planner}" for planner, value in ours.items())
    print(f"{name}: {theirs:.0f} ns per robot-step, {ratios}", flush=True)


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks planning")
    parser.add_argument("--size", type=int, default=2048)
    parser.add_argument("--destinations", type=int, default=200)
    parser.add_argument("--robots", nargs="*", type=int, default=[25_000, 50_000, 100_000, 200_000, 400_000])
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args(arguments)
    print(machine("mesa", "w9-pathfinding"))
    print(f"CPU nanoseconds per robot-step, {options.destinations} destinations, {options.size} x {options.size} cells")
    print(f"{'tessellation':<12} {'robots':>8}" + "".join(f"{name:>9}" for name in PLANNERS))
    for tessellation in TESSELLATIONS:
        rows = []
        for robots in options.robots:
            scenario = make_scenario(tessellation, options.size, robots, options.destinations)
            rows.append(nanoseconds(scenario, options.repeats))
            print(
                f"{tessellation:<12} {robots:>8}" + "".join(f"{rows[-1][name]:>9.1f}" for name in PLANNERS), flush=True
            )
        if len(rows) > 1:
            grown = (f"{name} n^{1 + exponent(options.robots, [row[name] for row in rows]):.2f}" for name in PLANNERS)
            print(f"{tessellation:<12} time of a step of n robots grows as {', '.join(grown)}")
    small = nanoseconds(make_scenario("hexagonal", 128, 500, 4), options.repeats)
    print("500 robots on 128 x 128 hexagons: " + ", ".join(f"{name} {value:.0f} ns" for name, value in small.items()))
    compare("mesa HexGrid, 500 agents", lambda: mesa_nanoseconds(128, 500, 20), small)
    compare("w9-pathfinding HCA*, 40 agents on 64 x 64", lambda: w9_nanoseconds(64, 40), small)
