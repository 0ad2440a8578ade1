"""Clocks: how much sooner robots of one speed arrive where a move lasts as long as its way, and not as the longest.

``python -m benchmarks clocks`` plans for 24 scenarios of each tessellation, six on each of four kinds of areas, by the
clocks "steps" and "costs", and prints the seconds until robots arrive, on average and the last of them; cells are 1
metre apart, robots go 1 metre a second. With "forbid" nobody follows at once. ``--maps FOLDER`` adds one scenario for
each of its MovingAI maps; ``--robots`` says how many there are, at most half of the free cells.
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import trihex as th
from trihex.areas import GENERATORS

KINDS = ("random", "rooms", "caves", "warehouse")
SIDE, SEEDS = 48, 6


def seconds_of(scenario: th.Scenario) -> tuple[float, float]:
    """Return the mean and the last of the arrivals, in seconds, by the tick that waypoints have."""
    plan = th.make_plan(scenario, "fcost")
    assert th.audit_plan(plan).is_clean
    arrivals = plan.arrival_step_of_robot[plan.arrived] * scenario.area.tessellation.longest_tick
    return arrivals.mean(), arrivals.max()


def areas(name: str, maps: Path | None) -> Iterator[tuple[th.Area, int]]:
    """Yield areas of all kinds, and the maps, each with its seed."""
    tessellation = th.Tessellation(name, "full", "euclidean")
    for kind in KINDS:
        for seed in range(SEEDS):
            yield GENERATORS[kind](tessellation, SIDE, SIDE, seed=seed), seed
    for seed, path in enumerate(sorted(maps.glob("*.map")) if maps else ()):
        yield th.read_area(path, tessellation), seed


def scenario_on(area: th.Area, seed: int, count: int) -> th.Scenario:
    """Return a destination that half of the free cells reach at least, and robots that can reach it."""
    while True:
        goal, *robots = th.random_robots(area, min(4 * count, area.free_count // 2), seed=seed).tolist()
        lone = th.Scenario(area, np.array([goal]), np.array(robots))
        cut_off = set(th.make_n_scheme(lone).unreachable_robots.tolist())
        if len(cut_off) < len(robots) / 2:
            return lone.with_robots([robot for i, robot in enumerate(robots) if i not in cut_off][:count])
        seed += 1000


def main(options: list[str]) -> None:
    """Print a line for each tessellation and rule."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks clocks", description=__doc__)
    parser.add_argument("--maps", type=Path, help="a folder with MovingAI maps")
    parser.add_argument("--robots", type=int, default=150)
    chosen = parser.parse_args(options)
    for name in ("triangular", "square"):
        cases = [scenario_on(area, seed, chosen.robots) for area, seed in areas(name, chosen.maps)]
        for following in ("allow", "forbid"):
            rules = [{"clock": clock, "following": following} for clock in ("steps", "costs")]
            found = np.array([
                [seconds_of(th.Scenario(case.area, case.destinations, case.robots, **rule)) for rule in rules]
                for case in cases
            ])  # fmt: skip
            (mean, last), (mean_in_ticks, last_in_ticks) = found.mean(axis=0)
            ratio, last_ratio = (100 * (found[:, 1] / found[:, 0] - 1)).T
            sys.stdout.write(
                f"{name}, following {following}, {len(cases)} scenarios: mean arrival {mean:.1f} s by steps, "
                f"{mean_in_ticks:.1f} s by costs ({ratio.mean():+.1f} %, {ratio.min():+.1f} to {ratio.max():+.1f}); "
                f"last {last:.1f} s, {last_in_ticks:.1f} s ({last_ratio.mean():+.1f} %, {last_ratio.min():+.1f} to "
                f"{last_ratio.max():+.1f})\n"
            )
            sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
