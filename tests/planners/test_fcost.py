"""The paper's planner: what each rule is worth, and that all of them end."""

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.planners import make_plan


@pytest.mark.parametrize("rule", ["paper", "queue", "aside", "lanes"])
@pytest.mark.parametrize("seed", range(swept(60, 10)))
def test_each_rule_ends_and_keeps_the_rules(rule, seed):
    scenario = random_scenario(80_000 + seed, sides=(3, 10))
    plan = make_plan(scenario, "fcost", rule=rule)
    assert th.audit_plan(plan).is_clean
    assert not plan.arrived[th.make_n_scheme(scenario).unreachable_robots].any()
    assert plan.arrived.sum() == scenario.robot_count - th.make_n_scheme(scenario).unreachable_robots.size


@pytest.mark.parametrize("seed", range(swept(40, 10)))
def test_the_best_of_the_rules_is_never_worse_than_greedy(seed):
    scenario = random_scenario(90_000 + seed, sides=(3, 10))
    rules = ("best", "aside", "lanes")
    totals = {rule: make_plan(scenario, "fcost", rule=rule, rounds=0).total_time for rule in rules}
    greedy = make_plan(scenario, "greedy").total_time
    assert totals["best"] <= min(greedy, totals["aside"])
    if scenario.destinations.size == 1:
        assert totals["best"] == min(greedy, totals["lanes"], totals["aside"])
    assert make_plan(scenario, "fcost").total_time <= totals["best"]


def test_a_crowd_on_one_side_spreads_round_the_destination():
    """By distance alone all robots enter by the three western gates; the eastern ones are worth the way round."""
    area = th.Area("hexagonal", np.zeros((21, 21), bool))
    scenario = th.Scenario(area, [(12, 10)], [(x, y) for y in range(4, 17) for x in range(10)])
    fcost, greedy = make_plan(scenario, "fcost"), make_plan(scenario, "greedy")
    assert fcost.total_time < 0.85 * greedy.total_time
    last_steps = {int(plan.steps) for plan in (fcost, greedy)}
    assert max(last_steps) == greedy.steps


@pytest.mark.parametrize("rule", ["queue", "aside"])
@pytest.mark.parametrize("tessellation", ["hexagonal", "triangular"])
def test_crowds_that_dislike_waiting_do_not_run_from_line_to_line(tessellation, rule):
    """With w_t three moves, robots that weighed lines at w_t took four times as long as by greedy descent."""
    area = th.make_random_area(tessellation, 64, 64, density=0.1, seed=3)
    exits = [(63, y) for y in (8, 24, 40, 56) if not area.barriers[y, 63]]
    robots = th.random_robots(area, 500, seed=1, avoid=exits)
    scenario = th.Scenario(area, exits, robots, waiting_cost=30)
    plan, greedy = make_plan(scenario, "fcost", rule=rule), make_plan(scenario, "greedy")
    assert plan.total_time < greedy.total_time
    assert plan.arrival_step_of_robot.sum() < greedy.arrival_step_of_robot.sum()
