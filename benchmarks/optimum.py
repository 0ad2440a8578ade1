"""Optimum: CPU seconds and memory of the planner `optimal`, and how often as long other libraries take.

With ``--maps FOLDER`` on MovingAI maps, else on generated areas of like size and kind; robots at random, a destination
that at least 70 % of the free cells reach, seeds 1, 2, 3. Seconds are those of `make_plan` but for the N-scheme, after
a warm-up; each case runs in a process of its own, whose peak memory is told. The rivals are in `benchmarks.rivals`.
"""

import argparse
import multiprocessing
import resource
from pathlib import Path
from time import process_time

import numpy as np

import trihex as th
from benchmarks.bounds import scenario_on
from benchmarks.measure import machine
from benchmarks.rivals import RIVALS, flow_of, most_by_maxflow

CASES = (
    ("hexagonal", "random-64-64-20", 1000),
    ("hexagonal", "ost003d", 1000),
    ("hexagonal", "Berlin_1_256", 1000),
    ("hexagonal", "Berlin_1_256", 3000),
    ("hexagonal", "Berlin_1_256", 10_000),
    ("hexagonal", "brc202d", 2000),
    ("triangular", "random-64-64-20", 500),
    ("triangular", "ost003d", 500),
    ("triangular", "Berlin_1_256", 1000),
)
# What stands in for a map: generator, side, options.
LIKE = {
    "random-64-64-20": ("random", 64, {"density": 0.2}),
    "ost003d": ("caves", 192, {}),
    "Berlin_1_256": ("random", 256, {"density": 0.2}),
    "brc202d": ("caves", 448, {}),
}
Case = tuple[str, str, int]


def area_of(maps: Path | None, tessellation: str, name: str) -> th.Area:
    """Return a map, or an area like it."""
    if maps is not None:
        return th.read_area(maps / f"{name}.map", tessellation)
    kind, side, options = LIKE[name]
    return th.GENERATORS[kind](tessellation, side, side, seed=1, **options)


def seconds_of(n_scheme: th.NScheme, **options: str) -> tuple[float, th.Plan]:
    """Return the CPU time of an optimal plan, and the plan."""
    begin = process_time()
    plan = th.make_plan(n_scheme.scenario, "optimal", n_scheme=n_scheme, **options)
    return process_time() - begin, plan


def warm_up() -> None:
    """Load all kernels: few robots are served one after another, crowds are not."""
    for tessellation in ("hexagonal", "triangular"):
        for robots in (20, 300):
            seconds_of(th.make_n_scheme(scenario_on(area_of(None, tessellation, "random-64-64-20"), robots, 1)))


def run_case(maps: Path | None, case: Case, seeds: list[int]) -> None:
    """Print a row for a case: seconds of each seed, median, memory."""
    tessellation, name, robots = case
    warm_up()
    area, seconds, totals = area_of(maps, tessellation, name), [], []
    for seed in seeds:
        took, plan = seconds_of(th.make_n_scheme(scenario_on(area, robots, seed)))
        seconds.append(took)
        totals.append(f"{plan.total_time}{'' if plan.optimal else ' (not proven)'}")
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    times = " ".join(f"{one:8.2f}" for one in seconds)
    print(
        f"{tessellation:13}{area.name:20}{robots:7}{times}{np.median(seconds):9.2f}{memory:8.2f}   {', '.join(totals)}",
        flush=True,
    )


def compare(maps: Path | None, tessellation: str, robots: int) -> None:
    """Print how many times as long the rivals take on the small map."""
    warm_up()
    area = area_of(maps, tessellation, "random-64-64-20")
    inside = scenario_on(area, robots, 1)
    unreachable = th.make_n_scheme(inside).unreachable_robots
    n_scheme = th.make_n_scheme(inside.with_robots(np.delete(inside.robots, unreachable)))
    count = n_scheme.scenario.robot_count
    seconds, plan = seconds_of(n_scheme)
    flow = flow_of(n_scheme, plan.steps)
    print(f"{tessellation} {area.name}, {count} robots, {plan.steps} steps, {len(flow.arcs)} arcs")
    for name, solve in RIVALS.items():
        theirs, total = solve(flow)
        assert total == plan.total_time
        print(
            f"    least total time: {name} {theirs:.1f} s, {theirs / seconds:.0f} times optimal's {seconds:.3f} s",
            flush=True,
        )
    seconds, plan = seconds_of(n_scheme, objective="steps")
    (none, fewer), (theirs, all_) = (most_by_maxflow(flow_of(n_scheme, plan.steps - less)) for less in (1, 0))
    assert fewer < all_ == count
    print(
        f"    fewest steps: PyMaxflow {none:.1f} s for {plan.steps - 1}, {theirs:.1f} s for {plan.steps}, "
        f"{(none + theirs) / seconds:.0f} times optimal's {seconds:.3f} s",
        flush=True,
    )


def main(options: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks optimum", description=__doc__)
    parser.add_argument("--maps", type=Path, help="folder of the MovingAI maps")
    parser.add_argument("--only", default="", help="only cases that contain this, such as 'hexagonal ost003d'")
    parser.add_argument("--seeds", nargs="*", type=int, default=[1, 2, 3])
    parser.add_argument("--rivals", nargs="*", type=int, default=[100, 300], help="robots beside other libraries")
    chosen = parser.parse_args(options)
    print(machine("ortools", "pylmcf", "PyMaxflow"))
    header = f"{'CPU seconds by seed':>{9 * len(chosen.seeds) - 1}}{'median':>9}{'GiB':>8}   optimum"
    print(f"{'tessellation':13}{'area':20}{'robots':>7}{header}")
    spawn = multiprocessing.get_context("spawn")
    jobs = [(run_case, (chosen.maps, case, chosen.seeds)) for case in CASES if chosen.only in " ".join(map(str, case))]
    for tessellation in ("hexagonal", "triangular"):
        jobs += [(compare, (chosen.maps, tessellation, robots)) for robots in chosen.rivals]
    for function, arguments in jobs:
        process = spawn.Process(target=function, args=arguments)
        process.start()
        process.join()
        if process.exitcode:
            raise SystemExit(f"{function.__name__}{arguments} ended with {process.exitcode}")
