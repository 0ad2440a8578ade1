"""Unknown: a large crowd on a map that nobody has, beside the same with the map: total time, and time of a step.

The prices by what robots sense and by how often they are late are a study: examples/studies/unknown.toml.
"""

import argparse
from pathlib import Path

import numpy as np

import trihex as th
from benchmarks.measure import machine
from trihex.kernels.codes import NOT_REACHED
from trihex.running import Trial, make_run_report

DESTINATION = (118, 120)


def scenario_on(path: Path | None, tessellation: str, robots: int) -> th.Scenario:
    """Return robots at random where they can arrive, on the map or on rooms of its size."""
    area = th.read_area(path, tessellation) if path else th.make_rooms_area(tessellation, 256, 256, seed=1)
    exits = [DESTINATION] if not area.barriers[DESTINATION[::-1]] else [(DESTINATION[0] + 1, DESTINATION[1])]
    scenario = th.Scenario(area, exits)
    apart = np.flatnonzero(th.make_n_scheme(scenario).distance == NOT_REACHED)
    return scenario.with_robots(th.random_robots(area, robots, 1, avoid=np.union1d(apart, scenario.destinations)), 1)


def main(arguments: list[str]) -> None:
    """Print a row for each way to decide."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks unknown", description=__doc__)
    parser.add_argument("--map", type=Path, help="a map such as Berlin_1_256.map of the MovingAI benchmark")
    parser.add_argument("--tessellation", default="hexagonal")
    parser.add_argument("--robots", type=int, default=1000)
    parser.add_argument("--sense", type=float, default=5.0)
    options = parser.parse_args(arguments)
    print(machine())
    scenario = scenario_on(options.map, options.tessellation, options.robots)
    sensor = th.Sensor(scenario.area.tessellation, options.sense, line_of_sight=True)
    print(
        f"{'':28}{'steps':>6}{'total time':>12}{'price':>9}{'ms a step':>11}{'worst':>8}{'plans':>7}{'conflicts':>11}"
    )
    for words, more in (
        ("step by step", {}),
        ("replan", {"replan": True}),
        ("replan, 0.05 s a plan", {"replan": True, "budget": 0.05}),
    ):
        trial = Trial(scenario, sensor=sensor, **more)
        numbers = make_run_report(trial.run(), seconds=trial.seconds).as_dict()
        took, replanner = numbers["milliseconds_a_step"], trial.execution.replanner
        plans = replanner.plans if replanner else 0
        print(
            f"{words:28}{numbers['steps']:6}{numbers['total_time']:12}{100 * numbers['price']:+8.1f} %"
            f"{took['median']:10.2f}{took['worst']:9.0f}{plans:7}{numbers['conflicts']:11}",
            flush=True,
        )
