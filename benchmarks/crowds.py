"""What `fcost` is worth beside `greedy`, on 60 scenarios: robots all around, on one side, and behind two doors.

python -m benchmarks crowds
"""

import numpy as np

import trihex as th

SIDE = 48


def make_crowd(kind: str, tessellation: str, robots: int, seed: int) -> th.Scenario:
    """Return robots all around a destination in the middle, all to the west of it, or behind a wall with two doors."""
    random = np.random.default_rng(seed)
    barriers = random.random((SIDE, SIDE)) < 0.1
    x = np.arange(SIDE * SIDE).reshape(SIDE, SIDE) % SIDE
    destination = (SIDE // 2, SIDE // 2)
    side = x >= 0
    if kind == "one side":
        side = x < SIDE // 2
    if kind == "two doors":
        barriers[:, SIDE * 2 // 3] = True
        barriers[[SIDE // 4, SIDE * 3 // 4], SIDE * 2 // 3] = False
        destination, side = (SIDE - 6, SIDE // 2), x < SIDE * 2 // 3
    barriers[destination[1], destination[0]] = False
    scenario = th.Scenario(th.Area(tessellation, barriers), [destination], seed=seed)
    is_start = side & (th.make_n_scheme(scenario).distance < 2**31 - 1)
    is_start[destination[1], destination[0]] = False
    starts = np.flatnonzero(is_start)
    return scenario.with_robots(random.choice(starts, min(robots, starts.size), replace=False), seed)


def main(options: list[str]) -> None:
    print(f"{'crowd':<10} {'tessellation':<12} {'robots':>6} {'fcost / greedy: mean, least, most':>36}")
    for kind in ("uniform", "one side", "two doors"):
        for tessellation in ("hexagonal", "triangular"):
            for robots in (200, 1000):
                ratios = []
                for seed in range(5):
                    scenario = make_crowd(kind, tessellation, robots, seed)
                    totals = [th.make_plan(scenario, planner).total_time for planner in ("fcost", "greedy")]
                    ratios.append(totals[0] / totals[1])
                figures = f"{np.mean(ratios):10.3f}, {min(ratios):.3f}, {max(ratios):.3f}"
                print(f"{kind:<10} {tessellation:<12} {robots:>6} {figures:>36}", flush=True)
