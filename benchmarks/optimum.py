"""Optimum: CPU seconds and memory of the planner `optimal`, and how often as long OR-tools takes.

With ``--maps FOLDER`` on MovingAI maps, else on generated areas of like size and kind; robots at random, a destination
that at least 70 % of the free cells reach, seeds 1, 2, 3. Seconds are those of `make_plan` but for the N-scheme, after
a warm-up; each case runs in a process of its own, whose peak memory is told. OR-tools gets the same graph as arrays,
and the step of the last arrival for nothing; only what it takes to solve is counted.
"""

import argparse
import multiprocessing
import resource
from pathlib import Path
from time import process_time

import numpy as np
from numpy.typing import NDArray

import trihex as th
from benchmarks.bounds import scenario_on
from benchmarks.measure import machine
from trihex.optimum import make_network

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


def seconds_of(n_scheme: th.NScheme) -> tuple[float, th.Plan]:
    """Return the CPU time of an optimal plan, and the plan."""
    begin = process_time()
    plan = th.make_plan(n_scheme.scenario, "optimal", n_scheme=n_scheme)
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


def arcs_of(n_scheme: th.NScheme, steps: int) -> tuple[NDArray[np.int64], int]:
    """Return arcs (tail, head, capacity, cost) of the graph of cells and steps up to `steps`, and nodes in a layer.

    Node i of layer u is entered at 2 (u * nodes + i) + 1 and left at one more; 0 is where all robots end up.
    """
    network = make_network(n_scheme)
    robots, size = n_scheme.scenario.robot_count, network.node_count
    tail, place = np.nonzero(network.out_arcs[:, :, 0])
    _, reduced, _, _, head, rows = network.out_arcs[tail, place].T.astype(np.int64)
    cost = reduced + network.value[tail] - network.value[head]
    goals = np.arange(network.first_destination, size)
    parts = []
    for layer in range(steps + 1):
        own = np.flatnonzero(network.hops[: network.first_destination] <= layer)
        enter = 2 * (layer * size + own) + 1
        parts.append(np.stack([enter, enter + 1, *np.broadcast_arrays(1, np.zeros_like(own))], axis=1))
        is_open = (network.hops[tail] <= layer) & (layer + rows <= steps)
        leave, into = 2 * (layer * size + tail) + 2, 2 * ((layer + rows) * size + head) + 1
        parts.append(np.stack(np.broadcast_arrays(leave, into, 1, cost), axis=1)[is_open])
        ends = 2 * (layer * size + goals) + 1
        parts.append(np.stack(np.broadcast_arrays(ends, 0, robots, 0), axis=1))
    return np.concatenate(parts), size


def or_tools(n_scheme: th.NScheme, steps: int) -> tuple[float, int, int]:
    """Return CPU seconds, least total time and arcs."""
    from ortools.graph.python.min_cost_flow import SimpleMinCostFlow

    network = make_network(n_scheme)
    arcs, size = arcs_of(n_scheme, steps)
    cells = network.node_of_site[n_scheme.scenario.area.layout.cell_to_site(n_scheme.scenario.robots)]
    starts = 2 * (network.hops[cells].astype(np.int64) * size + cells) + 1
    flow = SimpleMinCostFlow()
    flow.add_arcs_with_capacity_and_unit_cost(*(np.ascontiguousarray(column) for column in arcs.T))
    flow.set_nodes_supplies(np.append(starts, 0), np.append(np.ones_like(starts), -starts.size))
    begin = process_time()
    assert flow.solve() == flow.OPTIMAL
    return process_time() - begin, flow.optimal_cost() * network.unit, len(arcs)


def compare(maps: Path | None, tessellation: str, robots: int) -> None:
    """Print how many times as long OR-tools takes on the small map."""
    warm_up()
    area = area_of(maps, tessellation, "random-64-64-20")
    inside = scenario_on(area, robots, 1)
    unreachable = th.make_n_scheme(inside).unreachable_robots
    n_scheme = th.make_n_scheme(inside.with_robots(np.delete(inside.robots, unreachable)))
    seconds, plan = seconds_of(n_scheme)
    theirs, total, arcs = or_tools(n_scheme, plan.steps)
    assert total == plan.total_time
    print(
        f"{tessellation} {area.name}, {n_scheme.scenario.robot_count} robots, {plan.steps} steps, {arcs} arcs, optimum "
        f"{total}: OR-tools {theirs:.1f} s, {theirs / seconds:.0f} times optimal's {seconds:.3f} s",
        flush=True,
    )


def main(options: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks optimum", description=__doc__)
    parser.add_argument("--maps", type=Path, help="folder of the MovingAI maps")
    parser.add_argument("--only", default="", help="only cases that contain this, such as 'hexagonal ost003d'")
    parser.add_argument("--seeds", nargs="*", type=int, default=[1, 2, 3])
    parser.add_argument("--or-tools", nargs="*", type=int, default=[300], help="robots beside OR-tools")
    chosen = parser.parse_args(options)
    print(machine("ortools"))
    header = f"{'CPU seconds by seed':>{9 * len(chosen.seeds) - 1}}{'median':>9}{'GiB':>8}   optimum"
    print(f"{'tessellation':13}{'area':20}{'robots':>7}{header}")
    spawn = multiprocessing.get_context("spawn")
    jobs = [(run_case, (chosen.maps, case, chosen.seeds)) for case in CASES if chosen.only in " ".join(map(str, case))]
    for tessellation in ("hexagonal", "triangular"):
        jobs += [(compare, (chosen.maps, tessellation, robots)) for robots in chosen.or_tools]
    for function, arguments in jobs:
        process = spawn.Process(target=function, args=arguments)
        process.start()
        process.join()
        if process.exitcode:
            raise SystemExit(f"{function.__name__}{arguments} ended with {process.exitcode}")
