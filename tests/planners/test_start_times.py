"""Start times: robots that stand in the way until they may begin to move, planned for by all and proven by flows."""

from itertools import product

import numpy as np
import pytest

import trihex as th
from tests.optimum.test_optimal import crowded_scenario
from tests.oracles.flow import least_total_time, most_arrivals
from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_random_doors, with_start_times
from tests.sweeps import swept
from trihex.bounds import arrivals_bound
from trihex.kernels.codes import WAIT
from trihex.optimum import Network, flow
from trihex.planners import make_plan, optimal

PLANNERS = ("greedy", "fcost", "astar")
TIMES = list(product(("steps", "costs"), ("allow", "forbid")))
ROW = th.Area("square", [[0, 0, 0, 0]])


def late_scenario(seed, time):
    scenario = with_time(random_scenario(seed, sides=(2, 8), waiting_costs=(None,)), *time)
    return with_start_times(scenario, seed, latest=40)


@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize("planner", PLANNERS)
def test_all_who_can_arrive_do_and_nobody_leaves_too_early(planner, time):
    for seed in range(240_000, 240_000 + swept(60, 8)):
        scenario = late_scenario(seed, time)
        n_scheme = th.make_n_scheme(scenario)
        plan = make_plan(scenario, planner, n_scheme=n_scheme)
        audit = th.audit_plan(plan)
        assert audit.is_clean, (seed, audit.conflicts[0])
        for robot, start_time in enumerate(scenario.start_times):
            actions = plan.actions[plan.first_action[robot] : plan.first_action[robot + 1]]
            assert (actions[:start_time] == WAIT).all()
        can_arrive = np.ones(scenario.robot_count, dtype=bool)
        can_arrive[n_scheme.unreachable_robots] = False
        assert np.array_equal(plan.arrived, can_arrive)
        assert plan.total_time >= th.make_lower_bound(n_scheme).value, seed
        earliest = arrivals_bound(scenario)
        assert (th.make_exits(plan).total <= earliest.curve(plan.steps)).all(), seed
        assert make_plan(scenario, planner, n_scheme=n_scheme, record="arrivals") == th.make_arrivals(plan)


@pytest.mark.parametrize("planner", [*PLANNERS, "optimal"])
def test_who_has_not_started_holds_up_those_behind_in_a_corridor(planner):
    scenario = th.Scenario(ROW, (3, 0), [(0, 0), (1, 0)], start_times=[0, 4])
    plan = make_plan(scenario, planner)
    assert plan.arrival_step_of_robot.tolist() == [7, 6]
    assert plan.time_of_robot.tolist() == [70, 60]
    assert th.make_lower_bound(th.make_n_scheme(scenario)).value == 30 + 60


@pytest.mark.parametrize("planner", ["astar", "optimal"])
def test_those_behind_go_round_where_that_is_sooner(planner):
    area = th.Area("square", [[0, 0, 0, 0], [0, 0, 0, 0]])
    scenario = th.Scenario(area, (3, 0), [(0, 0), (1, 0)], start_times=[0, 9])
    assert make_plan(scenario, planner).arrival_step_of_robot.tolist() == [3, 11]


def test_a_robot_on_a_destination_has_arrived_whenever_it_starts():
    scenario = th.Scenario(ROW, (3, 0), [(3, 0), (2, 0)], start_times=[5, 0])
    for planner in (*PLANNERS, "optimal"):
        assert make_plan(scenario, planner).arrival_step_of_robot.tolist() == [0, 1]


@pytest.mark.parametrize("way", ["singly", "at prices", "by slots"])
def test_the_optimum_is_that_of_or_tools(monkeypatch, way):
    if way == "singly":
        monkeypatch.setattr(flow, "_meet_seldom", lambda network, cells: True)
    else:
        monkeypatch.setattr(optimal, "make_flow_singly", lambda *arguments, **options: None)
    if way == "at prices":
        monkeypatch.setattr(Network, "has_equal_steps", property(lambda self: False))
    for seed in range(250_000, 250_000 + swept(100, 12)):
        scenario = with_start_times(crowded_scenario(seed), seed, latest=12)
        plan = make_plan(scenario, "optimal")
        assert th.audit_plan(plan).is_clean, seed
        assert plan.optimal, seed
        assert plan.total_time == least_total_time(scenario, plan.steps + 5), seed
        n_scheme = th.make_n_scheme(scenario)
        for bound in (th.distance_bound, th.slot_bound, th.cut_bound):
            assert bound(n_scheme).value <= plan.total_time, seed


def test_the_earliest_arrivals_are_maximum_flows():
    for seed in range(260_000, 260_000 + swept(40, 6)):
        scenario = with_start_times(crowded_scenario(seed), seed, latest=12)
        exact, bound = th.make_earliest_arrivals(scenario), arrivals_bound(scenario)
        assert exact.steps.size == bound.steps.size and (bound.steps <= exact.steps).all()
        there = int(np.isin(scenario.robots, scenario.destinations).sum())
        for step in range(1, int(exact.steps.max(initial=0)) + 1, 3):
            assert exact.curve(step)[step] == there + most_arrivals(scenario, step), seed


def test_straighter_ways_begin_no_sooner():
    changed = 0
    for seed in range(270_000, 270_000 + swept(100, 20)):
        plan = make_plan(late_scenario(seed, TIMES[0]), "fcost")
        straight = th.straighten(plan)
        assert th.audit_plan(straight).is_clean, seed
        assert np.array_equal(straight.arrival_step_of_robot, plan.arrival_step_of_robot)
        assert straight.total_time <= plan.total_time
        changed += straight != plan
    assert changed > swept(10, 2)


def test_prices_of_walls_and_chokes_are_those_of_plans_that_begin_as_late():
    area = th.Area("hexagonal", [[0, 1, 0, 0], [0, 1, 0, 1], [0, 0, 0, 0]])
    scenario = th.Scenario(area, (3, 0), [(0, 0), (0, 1), (1, 2)], start_times=[0, 3, 5])
    best = make_plan(scenario, "optimal").total_time
    prices = th.make_prices(make_plan(scenario, "optimal"), kinds=("barrier", "choke"))
    for kind, cell, price, robots in zip(prices.kind, prices.cell, prices.price, prices.robots, strict=True):
        barriers = area.barriers.copy()
        barriers.flat[cell] ^= True
        kept = scenario.robots != cell
        changed = th.Scenario(
            th.Area("hexagonal", barriers), (3, 0), scenario.robots[kept], start_times=scenario.start_times[kept]
        )
        plan = make_plan(changed, "optimal")
        assert robots == np.count_nonzero(plan.arrived) - 3
        assert robots or price == (best - plan.total_time if kind == "barrier" else plan.total_time - best)
    assert prices.price.max() > 0


@pytest.mark.parametrize("seed", range(290_000, 290_000 + swept(40, 6)))
def test_doors_with_a_flow_and_start_times_go_together(seed):
    scenario = with_start_times(with_random_doors(crowded_scenario(seed)), seed, latest=12)
    best = make_plan(scenario, "optimal")
    assert th.audit_plan(best).is_clean
    assert best.total_time == least_total_time(scenario, best.steps + 5)
    for planner in PLANNERS:
        plan = make_plan(scenario, planner)
        assert th.audit_plan(plan).is_clean
        assert plan.total_time >= best.total_time >= th.make_lower_bound(th.make_n_scheme(scenario)).value


def test_what_cannot_know_start_times_says_so():
    scenario = th.Scenario(ROW, (3, 0), [(0, 0)], start_times=2)
    with pytest.raises(th.PlanError, match="rule must not be 'paper' where there are start_times"):
        make_plan(scenario, "fcost", rule="paper")
    hexagons = th.Scenario(th.Area("hexagonal", [[0, 0]]), (1, 0), [(0, 0)], start_times=2)
    with pytest.raises(th.PlanError, match="a certificate needs robots that may all begin at once"):
        th.make_certificate(make_plan(hexagons, "optimal"))
