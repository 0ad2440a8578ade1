"""Earliest arrivals: the most that can have arrived after each step, beside maximum flows and all planners."""

import numpy as np
import pytest
from hypothesis import given, settings

import trihex as th
from tests.oracles.flow import most_arrivals
from tests.strategies import random_scenario, scenarios
from trihex.bounds import arrivals_bound


def checked(scenario):
    """Check exact curve <= bound, and all planners below both; return the exact one."""
    exact, bound = th.make_earliest_arrivals(scenario), th.make_earliest_arrivals(scenario, most_exact=0)
    assert exact.name == "optimum" and bound.name == ("cut" if scenario.robot_count else "optimum")
    assert exact.steps.size == bound.steps.size and (bound.steps <= exact.steps).all()
    for planner in ("greedy", "fcost", "astar"):
        plan = th.make_plan(scenario, planner)
        assert (th.make_exits(plan).total <= exact.curve(plan.steps)).all()
        assert (th.make_exits(plan).total <= bound.curve(plan.steps)).all()
    return exact


@settings(deadline=None, max_examples=25)
@given(scenario=scenarios())
def test_no_plan_has_more_arrivals_after_any_step(scenario):
    checked(scenario)


@pytest.mark.parametrize("seed", range(12))
def test_the_curve_is_the_maximum_flow_of_each_step(seed):
    scenario = random_scenario(seed, sides=(2, 6), most_robots=12)
    exact = checked(scenario)
    there = int(np.isin(scenario.robots, scenario.destinations).sum())
    for step in range(1, int(exact.steps.max(initial=0)) + 1):
        assert exact.curve(step)[step] == there + most_arrivals(scenario, step)


def test_a_narrow_door_bounds_the_arrivals():
    """Behind one door of one cell, two steps from the exit, one robot a step comes out."""
    rows = ["....#...", "........", "....#..."]
    area = th.Area("square", [[letter == "#" for letter in row] for row in rows])
    robots = [(x, y) for y in range(3) for x in range(4)]
    bound = arrivals_bound(th.Scenario(area, [(6, y) for y in range(3)], robots))
    assert bound.steps.tolist() == [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]
