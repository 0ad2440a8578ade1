"""Clocks: how much sooner robots of one speed arrive where a move lasts as long as its way, and not as the longest.

``python -m benchmarks clocks`` plans for 24 scenarios of each tessellation, six on each of four kinds of areas, by the
clocks "steps" and "costs", and prints the seconds until robots arrive, on average and the last of them; cells are 1
metre apart, robots go 1 metre a second. With "forbid" nobody follows at once.
"""

import sys

import numpy as np

import trihex as th
from trihex.areas import GENERATORS

KINDS = ("random", "rooms", "caves", "warehouse")
SIDE, ROBOTS, SEEDS = 48, 150, 6


def seconds_of(scenario):
    """Return the mean and the last of the arrivals, in seconds, by the tick that waypoints have."""
    plan = th.make_plan(scenario, "fcost")
    assert th.audit_plan(plan).is_clean
    arrivals = plan.arrival_step_of_robot[plan.arrived] * scenario.area.tessellation.longest_tick
    return arrivals.mean(), arrivals.max()


def scenarios(name):
    """Yield areas of all kinds with a destination, and robots that can reach it."""
    for kind in KINDS:
        for seed in range(SEEDS):
            area = GENERATORS[kind](th.Tessellation(name, "full", "euclidean"), SIDE, SIDE, seed=seed)
            goal, *robots = th.random_robots(area, min(4 * ROBOTS, area.free_count // 2), seed=seed).tolist()
            lone = th.Scenario(area, np.array([goal]), np.array(robots))
            cut_off = set(th.make_n_scheme(lone).unreachable_robots.tolist())
            yield area, goal, [robot for number, robot in enumerate(robots) if number not in cut_off][:ROBOTS]


def main(options: list[str]) -> None:
    """Print a line for each tessellation and rule; there are no options."""
    assert not options
    for name in ("triangular", "square"):
        cases = list(scenarios(name))
        for following in ("allow", "forbid"):
            found = []
            for area, goal, robots in cases:
                lone = [
                    th.Scenario(area, np.array([goal]), robots, clock=clock, following=following)
                    for clock in ("steps", "costs")
                ]
                found.append([seconds_of(scenario) for scenario in lone])
            (mean, last), (mean_in_ticks, last_in_ticks) = np.mean(found, axis=0)
            ratio = np.array(found)[:, 1] / np.array(found)[:, 0]
            sys.stdout.write(
                f"{name}, following {following}, {len(cases)} scenarios: mean arrival {mean:.1f} s by steps, "
                f"{mean_in_ticks:.1f} s by costs ({100 * (ratio[:, 0].mean() - 1):+.1f} %); last {last:.1f} s, "
                f"{last_in_ticks:.1f} s ({100 * (ratio[:, 1].mean() - 1):+.1f} %)\n"
            )
            sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
