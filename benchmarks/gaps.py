"""Gaps: how far plans of each planner are above the proven optimum, over 40 scenarios.

Eight areas, each with robots all over hexagons (seeds 1 and 2), on one side of hexagons, all over triangles, and on one
side of triangles. With ``--maps FOLDER`` on MovingAI maps, else on generated areas. Seconds are CPU seconds; the last
columns hold the gap of each planner in %. The rows are Markdown.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path
from time import process_time

import numpy as np

import trihex as th
from benchmarks.measure import machine
from trihex.kernels.codes import NOT_REACHED

# Robots on hexagons and on triangles.
ROBOTS = {
    "random-32-32-20": (200, 200),
    "random-64-64-20": (300, 200),
    "room-64-64-8": (200, 200),
    "maze-32-32-2": (200, 200),
    "den312d": (200, 200),
    "ost003d": (300, 200),
    "warehouse-10-20-10-2-1": (300, 200),
    "Berlin_1_256": (300, 200),
}
KINDS = (
    ("hexagonal", "all over", 1),
    ("hexagonal", "all over", 2),
    ("hexagonal", "one side", 1),
    ("triangular", "all over", 1),
    ("triangular", "one side", 1),
)
PLANNERS = {
    "greedy": ("greedy", {}),
    "fcost, paper": ("fcost", {"rule": "paper"}),
    "fcost": ("fcost", {}),
    "astar": ("astar", {}),
}


def areas(maps: Path | None, tessellation: str) -> Iterator[tuple[th.Area, int]]:
    """Yield the areas with their numbers of robots."""
    if maps is None:
        for name in ("random", "rooms", "maze", "caves"):
            for size in (24, 32):
                yield th.GENERATORS[name](tessellation, size, size, seed=size), size * size // 16
        return
    for name, counts in ROBOTS.items():
        yield th.read_area(maps / f"{name}.map", tessellation), counts[tessellation == "triangular"]


def make_scenario(area: th.Area, robots: int, kind: str, seed: int) -> th.Scenario:
    """Return a destination that at least 70 % of the free cells reach, and robots that reach it."""
    free = np.flatnonzero(~area.barriers)
    rng = np.random.default_rng(seed)
    while True:
        scenario = th.Scenario(area, [int(rng.choice(free))])
        reached = np.flatnonzero(th.make_n_scheme(scenario).distance.reshape(-1) != NOT_REACHED)
        if reached.size >= 0.7 * free.size:
            break
    goal = int(scenario.destinations[0])
    cells = reached[reached != goal]
    if kind == "one side":  # of its column, where there are more
        is_left = cells % area.width < goal % area.width
        cells = cells[is_left == (2 * np.count_nonzero(is_left) > cells.size)]
    return scenario.with_robots(rng.choice(cells, robots, replace=False), seed)


def measured(n_scheme: th.NScheme, planner: str, options: dict[str, str]) -> tuple[th.Plan, float]:
    """Return a plan and the CPU time it took."""
    begin = process_time()
    plan = th.make_plan(n_scheme.scenario, planner, n_scheme=n_scheme, **options)
    return plan, process_time() - begin


def main(options: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks gaps", description=__doc__)
    parser.add_argument("--maps", type=Path, help="folder of the MovingAI maps")
    parser.add_argument("--only", nargs="*", default=[""], help="only areas whose names begin with one of these")
    chosen = parser.parse_args(options)
    print(machine(), "", sep="\n")
    names = ("area", "tessellation", "robots", "seed", "optimum", "s optimal", "s fcost", *PLANNERS)
    print(f"| {' | '.join(names)} |", "|---" * len(names) + "|", sep="\n", flush=True)
    small = th.make_n_scheme(
        make_scenario(th.make_random_area("hexagonal", 8, 8, density=0.1, seed=1), 4, "all over", 1)
    )
    for how in [("optimal", {}), *PLANNERS.values()]:
        measured(small, *how)  # kernels are loaded
    gaps, shares = [], []
    for number in range(len(ROBOTS)):
        for tessellation, kind, seed in KINDS:
            area, robots = list(areas(chosen.maps, tessellation))[number]
            if not area.name.startswith(tuple(chosen.only)):
                continue
            n_scheme = th.make_n_scheme(make_scenario(area, robots, kind, seed))
            best, seconds = measured(n_scheme, "optimal", {})
            plans = {name: measured(n_scheme, *how) for name, how in PLANNERS.items()}
            gaps.append([100 * (plan.total_time / best.total_time - 1) for plan, _ in plans.values()])
            shares.append(plans["fcost"][1] / seconds)
            mark = "" if best.optimal else " (bound)"
            row = (area.name, tessellation, f"{robots} {kind}", seed, f"{best.total_time}{mark}", f"{seconds:.2f}")
            row += (f"{plans['fcost'][1]:.3f}", *(f"{gap:.1f}" for gap in gaps[-1]))
            print(f"| {' | '.join(map(str, row))} |", flush=True)
    for name, function in (("mean", np.mean), ("median", np.median), ("worst", np.max)):
        cells = " | ".join(f"{value:.1f}" for value in function(gaps, axis=0))
        print(f"| **{name}** | | | | | | {'' if name == 'worst' else f'{function(shares):.3f} of optimal'} | {cells} |")
