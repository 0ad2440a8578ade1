"""What `fcost` gains where robots share many exits: gaps to the optimum, and CPU seconds, on large random areas.

python -m benchmarks exits; `--seeds 1 2` for more of them, `--largest` for 1024 x 1024 cells with 50 destinations and
20 000 robots as well. Where the optimum would take too much memory the bound stands in its place.
"""

import argparse
from dataclasses import dataclass
from unittest.mock import patch

import trihex as th
from benchmarks.measure import cpu_seconds, machine
from trihex.errors import TooLargeError


@dataclass(frozen=True)
class Case:
    """A random area with many destinations."""

    side: int
    destinations: int
    robots: int


CASES, LARGEST = (Case(512, 20, 5000),), (Case(1024, 50, 20_000),)


def make_scenario(case: Case, tessellation: str, density: float, seed: int) -> th.Scenario:
    """Return robots and destinations at random."""
    area = th.make_random_area(tessellation, case.side, case.side, density=density, seed=seed)
    goals = th.random_robots(area, case.destinations, seed=seed + 100)
    return th.Scenario(area, goals, th.random_robots(area, case.robots, seed=seed + 200, avoid=goals))


def print_row(case: Case, tessellation: str, density: float, seed: int) -> None:
    scenario = make_scenario(case, tessellation, density, seed)
    n_scheme = th.make_n_scheme(scenario)
    try:
        least, name = th.make_plan(scenario, "optimal", n_scheme=n_scheme).total_time, "optimum"
    except TooLargeError:
        bound = th.make_lower_bound(n_scheme)
        least, name = bound.value, bound.name
    totals = {}

    def plan(is_shared: bool) -> None:
        with patch("trihex.planners.fcost._MOST_DESTINATIONS", 1000 * is_shared):
            totals[is_shared] = th.make_plan(scenario, "fcost", n_scheme=n_scheme).total_time

    seconds = cpu_seconds({"shared": lambda: plan(True), "alone": lambda: plan(False)}, 3)
    gaps = [100 * (totals[is_shared] / least - 1) for is_shared in (False, True)]
    print(
        f"{tessellation:12}{case.side:>6}{density:>9}{seed:>6}{least:>12} {name:9}{gaps[0]:>14.1f}{gaps[1]:>8.1f}"
        f"{seconds['alone']:>10.2f}{seconds['shared']:>8.2f}",
        flush=True,
    )


def main(options: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks exits", description=__doc__)
    parser.add_argument("--seeds", nargs="*", type=int, default=[1])
    parser.add_argument("--densities", nargs="*", type=float, default=[0.1, 0.2])
    parser.add_argument("--largest", action="store_true")
    chosen = parser.parse_args(options)
    print(machine())
    print("                                                            gap, %: exits        CPU s: exits")
    print("tessellation  side  density  seed       least of           alone  shared     alone  shared")
    for case in CASES + LARGEST * chosen.largest:
        for tessellation in ("hexagonal", "triangular"):
            for density in chosen.densities:
                for seed in chosen.seeds:
                    print_row(case, tessellation, density, seed)
