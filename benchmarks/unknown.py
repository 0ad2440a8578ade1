"""Unknown: the price of not knowing the world, by what robots sense, and the price of being late, by how often.

200 robots all over areas of 64 x 64, or 20 together as far from the destination as can be, and nothing known at the
start. The price is the total time over that
of the same planner with full knowledge and no delay, minus 1: the mean over seeds, and the worst of all.
"""

import argparse
import time

import numpy as np

import trihex as th
from trihex.passing import make_passing_order
from trihex.run_audit import audit_run
from trihex.schemes import NOT_REACHED
from trihex.trial import Trial

TESSELLATIONS = ("triangular", "hexagonal", "square")
AREAS = {
    "random": th.make_random_area,
    "rooms": th.make_rooms_area,
    "caves": th.make_caves_area,
    "maze": th.make_maze_area,
    "warehouse": th.make_warehouse_area,
}
RADII = (0, 1, 2, 3, 5, 8, 12)
DELAYS = (0.05, 0.1, 0.2, 0.3)


def make_scenario(kind: str, tessellation: str, robots: int, seed: int, together: bool = False) -> th.Scenario:
    """Return robots that can all arrive, at a destination near the middle; all over the area, or at its far end."""
    area = AREAS[kind](tessellation, 64, 64, seed=seed)
    free = np.flatnonzero(~area.barriers)
    exits = free[[np.argmin(np.abs(free - (area.cell_count + area.width) // 2))]]
    distance = th.make_n_scheme(th.Scenario(area, exits)).distance.reshape(-1)
    reached = np.setdiff1d(np.flatnonzero(distance != NOT_REACHED), exits)
    if together:
        return th.Scenario(area, exits, reached[np.argsort(-distance[reached], kind="stable")[:robots]])
    starts = np.random.default_rng(seed).choice(reached, size=min(robots, reached.size // 3), replace=False)
    return th.Scenario(area, exits, starts)


def judged(run: th.Run) -> int:
    """Return the total time of a run, after the judge has seen it."""
    if not (audit_run(run).is_clean and run.arrived.all()):
        raise AssertionError("not all arrive, or somebody collides")
    return run.total_time


def table(name: str, columns: list[str], prices: dict[tuple[str, str], list[list[float]]]) -> None:
    print(f"\n{name:<24}" + "".join(f"{column:>16}" for column in columns))
    for (kind, tessellation), rows in prices.items():
        mean, worst = np.mean(rows, axis=0), np.max(rows, axis=0)
        cells = "".join(f"{f'{100 * m:+.1f} ({100 * w:+.0f})':>16}" for m, w in zip(mean, worst, strict=True))
        print(f"{kind:<12}{tessellation:<12}{cells}", flush=True)
    every = np.concatenate([np.array(rows) for rows in prices.values()])
    print(f"{'all':<24}" + "".join(f"{100 * m:>+15.1f} " for m in every.mean(axis=0)), flush=True)


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks unknown")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--robots", type=int, default=200)
    parser.add_argument("--planner", default="fcost")
    options = parser.parse_args(arguments)
    fog, few, late, ordered = {}, {}, {}, {}
    start = time.process_time()
    for kind in AREAS:
        for tessellation in TESSELLATIONS:
            rows: tuple[list[list[float]], ...] = ([], [], [], [])
            for seed in range(options.seeds):
                scenario = make_scenario(kind, tessellation, options.robots, seed)
                known = judged(Trial(scenario, options.planner).run())
                plan = th.make_plan(scenario, options.planner)
                order = make_passing_order(plan)
                rows[0].append([judged(Trial(scenario, options.planner, sensor=r).run()) / known - 1 for r in RADII])
                group = make_scenario(kind, tessellation, options.robots // 10, seed, together=True)
                best = judged(Trial(group, options.planner).run())
                rows[3].append([judged(Trial(group, options.planner, sensor=r).run()) / best - 1 for r in RADII])
                trials = [Trial(scenario, options.planner, delay=d, seed=seed) for d in DELAYS]
                rows[1].append([judged(trial.run()) / known - 1 for trial in trials])
                runs = [order.run(delay=d, seed=seed) for d in DELAYS]
                rows[2].append([judged(run) / plan.total_time - 1 for run in runs])
            for prices, own in zip((fog, late, ordered, few), rows, strict=True):
                prices[kind, tessellation] = own
    table("not knowing, sensing", [f"{radius} cells" for radius in RADII], fog)
    table("the same, 20 together", [f"{radius} cells" for radius in RADII], few)
    table("late, step by step", [f"{100 * delay:g} %" for delay in DELAYS], late)
    table("late, in plan's order", [f"{100 * delay:g} %" for delay in DELAYS], ordered)
    print(f"\nprice in %, mean (worst); {time.process_time() - start:.0f} CPU seconds")
