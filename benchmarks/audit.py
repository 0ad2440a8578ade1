"""The audit beside the planner whose plan it judges, in nanoseconds for each robot and step."""

import argparse

import numpy as np

import trihex as th
from benchmarks.measure import cpu_seconds, machine


def main(options: list[str]) -> None:
    """Print a row for each tessellation and size."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks audit", description=__doc__)
    parser.add_argument("--sides", type=int, nargs="+", default=[512, 1024])
    parser.add_argument("--robots", type=int, default=50_000)
    parser.add_argument("--destinations", type=int, default=100)
    parser.add_argument("--planner", default="greedy")
    chosen = parser.parse_args(options)
    print(machine())
    print(f"{'tessellation':14}{'side':>6}{'robot-steps':>13}{'plan ns':>10}{'audit ns':>10}{'ratio':>7}")
    for tessellation in ("hexagonal", "triangular"):
        for side in chosen.sides:
            area = th.make_random_area(tessellation, side, side, density=0.2, seed=1)
            free = np.flatnonzero(~area.barriers)
            exits = np.random.default_rng(1).choice(free, chosen.destinations, replace=False)
            scenario = th.Scenario(area, exits, th.random_robots(area, chosen.robots, 1, avoid=exits))
            n_scheme = th.make_n_scheme(scenario)
            plan = th.make_plan(scenario, chosen.planner, n_scheme=n_scheme)
            seconds = cpu_seconds(
                {
                    "plan": lambda scenario=scenario, n_scheme=n_scheme: th.make_plan(
                        scenario, chosen.planner, n_scheme=n_scheme
                    ),
                    "audit": lambda plan=plan: th.audit_plan(plan),
                },
                repeats=3,
            )
            plan_ns, audit_ns = (seconds[name] / plan.actions.size * 1e9 for name in ("plan", "audit"))
            row = f"{tessellation:14}{side:6}{plan.actions.size:13}{plan_ns:10.1f}{audit_ns:10.1f}"
            print(f"{row}{audit_ns / plan_ns:7.2f}", flush=True)
