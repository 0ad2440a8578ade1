"""Slowness: robots whose moves last some times as long, planned for from tick to tick and judged as they own cells."""

from itertools import product

import numpy as np
import pytest

import trihex as th
from tests.oracles.owners import judge
from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_random_doors, with_slowness, with_start_times
from tests.sweeps import swept
from trihex.bounds import arrivals_bound
from trihex.planners import make_plan

PLANNERS = ("greedy", "fcost")
TIMES = list(product(("steps", "costs"), ("allow", "forbid")))
ROW = th.Area("square", [[0, 0, 0, 0]])


def slow_scenario(seed, time):
    scenario = with_time(random_scenario(seed, sides=(2, 8), waiting_costs=(None,)), *time)
    if seed % 3 == 1:
        scenario = with_start_times(scenario, seed)
    if seed % 3 == 2:
        scenario = with_random_doors(scenario)
    return with_slowness(scenario, seed, most=5)


@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize("planner", PLANNERS)
def test_all_who_can_arrive_do_and_nobody_comes_too_near(planner, time):
    for seed in range(300_000, 300_000 + swept(60, 6)):
        scenario = slow_scenario(seed, time)
        n_scheme = th.make_n_scheme(scenario)
        plan = make_plan(scenario, planner, n_scheme=n_scheme)
        audit = th.audit_plan(plan)
        assert audit.is_clean, (seed, audit.conflicts[0])
        assert judge(plan) == [], seed
        can_arrive = np.ones(scenario.robot_count, dtype=bool)
        can_arrive[n_scheme.unreachable_robots] = False
        assert np.array_equal(plan.arrived, can_arrive)
        assert plan.total_time >= th.make_lower_bound(n_scheme).value, seed
        assert (th.make_exits(plan).total <= arrivals_bound(scenario).curve(plan.steps)).all(), seed
        assert make_plan(scenario, planner, n_scheme=n_scheme, record="arrivals") == th.make_arrivals(plan), seed
