"""Bounds where doors have a flow: never above the optimum, and as good as it where a queue stands before a door."""

from itertools import product

import numpy as np
import pytest

import trihex as th
from tests.oracles.gaps import crowded_scenario
from tests.oracles.timed import solve_timed, with_time
from tests.strategies import random_scenario, with_random_doors, with_start_times
from tests.sweeps import swept
from trihex.bounds import queue_bound
from trihex.planners import make_plan


def values(scenario):
    n_scheme = th.make_n_scheme(scenario)
    bounds = (th.distance_bound, th.slot_bound, th.cut_bound, queue_bound, th.make_lower_bound)
    return [bound(n_scheme).value for bound in bounds]


def test_bounds_are_below_the_optimum():
    gaps = []
    for seed in range(swept(150, 40)):
        scenario = with_random_doors(random_scenario(seed, sides=(2, 8), most_robots=40))
        scenario = with_start_times(scenario, seed) if seed % 3 == 0 else scenario
        plan = make_plan(scenario, "optimal")
        assert max(values(scenario)) <= plan.total_time, seed
        if plan.optimal and plan.total_time:
            gaps.append(plan.total_time / max(1, *values(scenario)) - 1)
    assert np.mean(gaps) < 0.1


@pytest.mark.parametrize("time", [("costs", "allow"), ("costs", "forbid"), ("steps", "forbid")])
def test_bounds_are_below_the_integer_program_and_planners_above(time):
    for seed in range(swept(30, 3)):
        scenario = with_time(with_random_doors(crowded_scenario(1000 + seed, sides=(2, 5), most_robots=6)), *time)
        least = solve_timed(scenario)[2]
        assert max(values(scenario)) <= least, seed
        for planner in ("greedy", "fcost", "astar"):
            assert make_plan(scenario, planner).total_time >= least, (seed, planner)


@pytest.mark.parametrize(("flow", "where"), list(product(["1/2", "4/5", "1/3"], ["exit", "passage"])))
def test_a_queue_before_a_door_is_bounded_by_its_flow(flow, where):
    barriers = np.zeros((9, 13), dtype=bool)
    barriers[:, 8] = True
    barriers[4, 8] = False
    area = th.Area("square", barriers)
    robots = th.random_robots(area, 40, seed=1, avoid=np.flatnonzero(np.arange(9 * 13) % 13 > 6))
    door = (12, 4) if where == "exit" else (8, 4)
    scenario = th.Scenario(area, [(12, 4)], robots, destination_capacity=1, doors=[(door, flow)])
    plan = make_plan(scenario, "optimal")
    bound = th.make_lower_bound(th.make_n_scheme(scenario)).value
    assert 0.99 * plan.total_time <= bound <= plan.total_time
