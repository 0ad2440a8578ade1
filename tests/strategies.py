"""Random small scenarios over all tessellations and rules, each from one number."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
from hypothesis import strategies as st

import trihex as th
from trihex.areas import CORNERS, CROSSINGS
from trihex.areas.slowness import LONGEST_MOVE

SHAPES = [("triangular", "full"), ("triangular", "edge"), ("hexagonal", "full"), ("square", "full"), ("square", "edge")]


def random_scenario(seed, *, sides=(1, 8), most_filled=0.9, most_robots=1000, waiting_costs=(None, None, 0, 3, 15, 40)):
    """Return a scenario drawn from `seed`: any shape and rule, up to `most_filled` of the free cells with a robot."""
    rng = np.random.default_rng(seed)
    shape, neighbourhood = SHAPES[rng.integers(len(SHAPES))]
    tessellation = th.Tessellation(shape, neighbourhood, ("paper", "euclidean")[rng.integers(2)])
    barriers = rng.random(rng.integers(sides[0], sides[1] + 1, size=2)) < rng.choice([0, 0.15, 0.3, 0.45])
    barriers.flat[rng.integers(barriers.size)] = False
    area = th.Area(tessellation, barriers)
    free = np.flatnonzero(~barriers)
    destinations = rng.choice(free, size=min(free.size, rng.choice([1, 1, 2, 4])), replace=False)
    count = min(int(rng.random() * most_filled * free.size), most_robots)
    waiting_cost = waiting_costs[rng.integers(len(waiting_costs))]
    if waiting_cost is not None:
        waiting_cost = waiting_cost * tessellation.edge_cost // 10
    return th.Scenario(
        area,
        destinations,
        rng.choice(free, size=count, replace=False),
        waiting_cost=waiting_cost,
        crossing=CROSSINGS[rng.integers(2)],
        corners=CORNERS[rng.integers(3)],
        destination_capacity=(None, 1, 2)[rng.integers(3)],
        seed=seed,
    )


def with_random_doors(scenario):
    """Return the same scenario with a flow: some cells that are doors, exits among them, or a fractional capacity."""
    rng = np.random.default_rng(scenario.seed)
    free = np.flatnonzero(~scenario.area.barriers)
    flows = [Fraction(text) for text in ("1/2", "1/3", "2/7", "3/4", "4/5", "1", "5/3", "5/2")]
    cells = rng.permutation(free)[: rng.integers(1, 6)]
    cells = np.union1d(
        cells[: rng.integers(0, cells.size + 1)], rng.permutation(scenario.destinations)[: rng.integers(3)]
    )
    parts = np.array_split(rng.permutation(cells), rng.integers(1, 3))
    doors = [th.Door(part, flows[rng.integers(len(flows))]) for part in parts if part.size]
    capacity = scenario.destination_capacity
    if not doors or rng.random() < 0.3:
        capacity = flows[rng.integers(len(flows))]
    return replace(scenario, doors=doors, destination_capacity=capacity)


def with_start_times(scenario, seed, *, latest=20):
    """Return the scenario with start times drawn from `seed`, for about half of the robots, in all but a few cases."""
    rng = np.random.default_rng(seed)
    times = rng.integers(0, rng.choice([1, 3, latest + 1]), size=scenario.robot_count)
    return replace(scenario, start_times=times * (rng.random(times.size) < 0.6))


def with_slowness(scenario, seed, *, most=4):
    """Return the scenario with robots of some slowness drawn from `seed`, as far as moves may last."""
    rng = np.random.default_rng(seed)
    most = min(most, LONGEST_MOVE // int(scenario.duration_of_direction.max()))
    return replace(scenario, slowness=rng.integers(1, most + 1, size=scenario.robot_count))


def scenarios(**limits):
    """Hypothesis draws the number; what fails is shown as the scenario."""
    return st.integers(0, 2**32 - 1).map(lambda seed: random_scenario(seed, **limits))
