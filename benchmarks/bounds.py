"""Lower bounds: each as a share of the proven optimum, and what it costs.

With ``--maps FOLDER`` on MovingAI maps, else on generated areas; robots at random, destinations that at least 70 % of
the free cells reach, seeds 1, 2, 3.
"""

import argparse
import time
from pathlib import Path

import numpy as np

import trihex as th
from benchmarks.measure import machine
from trihex.errors import TooLargeError
from trihex.kernels.codes import NOT_REACHED

MAPS = {"den312d": (500,), "room-64-64-8": (500,), "ost003d": (1000,), "Berlin_1_256": (1000, 3000)}
BOUNDS = {"distance": th.distance_bound, "slot": th.slot_bound, "cut": th.cut_bound}


def areas(maps: Path | None, tessellation: str) -> list[tuple[th.Area, int]]:
    """Return the areas with their numbers of robots."""
    if maps is None:
        made = (
            th.make_rooms_area(tessellation, 64, 64, seed=1),
            th.make_caves_area(tessellation, 64, 64, seed=1),
            th.make_random_area(tessellation, 64, 64, density=0.2, seed=1),
        )
        return [(area, 300) for area in made]
    read = {name: th.read_area(maps / f"{name}.map", tessellation) for name in MAPS}
    return [(read[name], count) for name, counts in MAPS.items() for count in counts]


def scenario_on(area: th.Area, robots: int, seed: int) -> th.Scenario:
    """Return `robots` at random and a destination that most free cells reach."""
    free = np.flatnonzero(~area.barriers)
    rng = np.random.default_rng(seed)
    while True:
        scenario = th.Scenario(area, [int(rng.choice(free))])
        reached = th.make_n_scheme(scenario).distance != NOT_REACHED
        if np.count_nonzero(reached) >= 0.7 * free.size:
            return scenario.with_robots(th.random_robots(area, robots, seed, avoid=scenario.destinations), seed)


def main(options: list[str]) -> None:
    """Print a row for each scenario."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks bounds", description=__doc__)
    parser.add_argument("--maps", type=Path, help="folder of the MovingAI maps")
    parser.add_argument("--tessellation", default="hexagonal")
    chosen = parser.parse_args(options)
    print(machine())
    print(
        f"{'area':20}{'robots':>7}{'seed':>5}{'optimum':>12}",
        *(f"{name:>9}" for name in BOUNDS),
        " seconds of the last",
    )
    for area, count in areas(chosen.maps, chosen.tessellation):
        for seed in (1, 2, 3):
            n_scheme = th.make_n_scheme(scenario_on(area, count, seed))
            try:
                plan = th.make_plan(n_scheme.scenario, "optimal", n_scheme=n_scheme)
            except TooLargeError as refusal:
                print(f"{area.name:20}{count:7}{seed:5}  {refusal}")
                continue
            shares = []
            for bound in BOUNDS.values():
                begin = time.process_time()
                shares.append(bound(n_scheme).value / plan.total_time)
                seconds = time.process_time() - begin
            cells = "".join(f"{share:10.4f}" for share in shares)
            print(f"{area.name:20}{count:7}{seed:5}{plan.total_time:12}{cells}{seconds:8.3f}", flush=True)
