"""Planners where doors have a flow: all who can arrive do, nobody comes while a door is shut, and doors are used."""

from fractions import Fraction

import numpy as np
import pytest

import trihex as th
from tests.judging.test_doors import TIMES
from tests.oracles.rules import judge
from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_random_doors, with_start_times
from tests.sweeps import swept
from trihex.planners import make_plan


@pytest.mark.parametrize("planner", ["greedy", "fcost", "astar"])
def test_all_arrive_by_the_rules(planner):
    for seed in range(swept(120, 24)):
        scenario = with_time(with_random_doors(random_scenario(seed, sides=(2, 6))), *TIMES[seed % 4])
        if seed % 3 == 0:
            scenario = with_start_times(scenario, seed)
        n_scheme = th.make_n_scheme(scenario)
        plan = make_plan(scenario, planner, n_scheme=n_scheme)
        assert th.audit_plan(plan).is_clean, seed
        can_arrive = np.ones(scenario.robot_count, dtype=bool)
        can_arrive[n_scheme.unreachable_robots] = False
        assert np.array_equal(plan.arrived, can_arrive), seed
        assert plan.total_time >= th.make_lower_bound(n_scheme).value, seed
        assert make_plan(scenario, planner) == plan
        if scenario.is_stepwise:
            assert judge(plan) == []


@pytest.mark.parametrize("planner", ["fcost", "astar", "optimal"])
@pytest.mark.parametrize("flow", ["1/2", "4/5", "8/5", "12/5"])
def test_a_wide_exit_lets_out_as_many_as_it_may(planner, flow):
    """N(t) rises by the flow: the cells of the exit take turns, and somebody stands before each when it is its turn."""
    area = th.Area("hexagonal", np.zeros((16, 30), bool))
    exits = [(29, y) for y in range(6, 10)]
    robots = th.random_robots(area, 120, seed=3, avoid=[y * 30 + x for y in range(16) for x in range(18, 30)])
    plan = make_plan(th.Scenario(area, exits, robots, destination_capacity=1, doors=[(exits, flow)]), planner)
    assert th.audit_plan(plan).is_clean
    steps = np.sort(plan.arrival_step_of_robot)[20:]
    slope = (steps.size - 1) / (steps[-1] - steps[0])
    assert float(Fraction(flow)) * 0.95 <= slope <= float(Fraction(flow)) * 1.04  # a robot more or less


def test_the_rule_of_the_paper_knows_no_doors():
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [0], [2], destination_capacity=0.5)
    with pytest.raises(th.PlanError, match="rule must not be 'paper' where doors have a flow"):
        make_plan(scenario, "fcost", rule="paper")
    plan = make_plan(scenario, "fcost")
    for make in (th.make_dependencies, th.make_passing_order):
        with pytest.raises(th.PlanError, match="doors must have no flow"):
            make(plan)
