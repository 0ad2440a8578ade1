"""One contract for all planners: they end, all who can arrive do, nobody collides, and the same plan comes again."""

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.planners import PLANNERS, make_plan, options_of, planner_named


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("seed", range(swept(40, 10)))
def test_contract(planner, seed):
    scenario = random_scenario(70_000 + seed, sides=(3, 8))
    n_scheme = th.make_n_scheme(scenario)
    told = []
    plan = make_plan(scenario, planner, n_scheme=n_scheme, progress=lambda *done: told.append(done))
    audit = th.audit_plan(plan)
    assert audit.is_clean, [str(conflict) for conflict in audit.conflicts]
    can_arrive = np.ones(scenario.robot_count, dtype=bool)
    can_arrive[n_scheme.unreachable_robots] = False
    assert np.array_equal(plan.arrived, can_arrive)
    assert not np.diff(plan.first_action)[~can_arrive].any()
    assert plan.total_time >= th.make_lower_bound(n_scheme).value
    assert plan.planner == planner
    assert all(0 <= done <= total for done, total in told)
    assert make_plan(scenario, planner) == plan


@pytest.mark.parametrize("planner", PLANNERS)
def test_without_robots_that_need_to_move_there_is_nothing_to_plan(planner):
    area = th.Area("hexagonal", [[0, 0, 1, 0]])
    for robots in ([], [(0, 0)], [(3, 0)]):
        plan = make_plan(th.Scenario(area, [(0, 0)], robots), planner)
        assert (plan.actions.size, plan.total_time) == (0, 0)


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("waiting_cost", [0, 1, 13, 10**6])
def test_waiting_may_cost_nothing_or_a_fortune(planner, waiting_cost):
    area = th.Area("triangular", np.zeros((4, 6), bool))
    robots = [c for c in range(24) if c not in (0, 13)]
    scenario = th.Scenario(area, [(0, 0)], robots, waiting_cost=waiting_cost, destination_capacity=1)
    plan = make_plan(scenario, planner)
    assert th.audit_plan(plan).is_clean
    assert plan.arrived.all()


@pytest.mark.parametrize("planner", PLANNERS)
def test_one_robot_takes_a_shortest_path(planner):
    area = th.make_random_area("triangular", 20, 20, density=0.2, seed=4)
    n_scheme = th.make_n_scheme(th.Scenario(area, [int(np.flatnonzero(~area.barriers)[7])]))
    cells = np.flatnonzero(n_scheme.distance.reshape(-1) < 2**31 - 1)
    for cell in cells[::23]:
        plan = make_plan(n_scheme.scenario.with_robots([int(cell)]), planner)
        assert plan.time_of_robot[0] == n_scheme.distance_of_cell([cell])[0]


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("seed", range(6))
def test_arrivals_are_those_of_the_plan(planner, seed):
    scenario = random_scenario(75_000 + seed, sides=(3, 9))
    plan, arrivals = make_plan(scenario, planner), make_plan(scenario, planner, record="arrivals")
    assert arrivals == th.make_arrivals(plan)
    assert np.array_equal(arrivals.arrived, plan.arrived)
    assert np.array_equal(arrivals.time_of_robot[plan.arrived], plan.time_of_robot[plan.arrived])
    assert (arrivals.steps, arrivals.total_time, arrivals.planner) == (plan.steps, plan.total_time, planner)


def test_arrivals_are_as_many_as_robots():
    scenario = th.Scenario(th.Area("square", [[0, 0]]), [(0, 0)], [(1, 0)])
    with pytest.raises(th.PlanError, match="time_of_robot must have an entry for each of 1 robots"):
        th.Arrivals(scenario, [1], [10, 20])


def test_names_and_options_are_checked():
    scenario = th.Scenario(th.Area("square", [[0, 0]]), [(0, 0)], [(1, 0)])
    with pytest.raises(th.PlanError, match=r"planner must be one of .*, not 'gredy'; did you mean 'greedy'"):
        make_plan(scenario, "gredy")
    with pytest.raises(th.PlanError, match="option of planner 'fcost' must be one of rule, rounds, not 'rules'"):
        make_plan(scenario, "fcost", rules="paper")
    with pytest.raises(th.PlanError, match="rule must be one of best, paper, queue, aside, lanes, not 'papers'"):
        make_plan(scenario, "fcost", rule="papers")
    with pytest.raises(th.PlanError, match="record must be one of plan, arrivals, not 'times'"):
        make_plan(scenario, record="times")
    with pytest.raises(th.PlanError, match="n_scheme must be that of the scenario"):
        make_plan(scenario, "greedy", n_scheme=th.make_n_scheme(scenario.with_robots([])))
    assert all(planner_named(name).__doc__ for name in PLANNERS)
    assert options_of("fcost") == {"rule": "best", "rounds": None}


def test_what_cannot_be_planned_is_told_before_anything_is_compiled(monkeypatch):
    monkeypatch.setattr("trihex.planners.registry.prepare", lambda *uses: pytest.fail(f"compiles {uses}"))
    scenario = th.Scenario(th.Area("square", [[0, 0]]), [(0, 0)], [(1, 0)], clock="costs")
    with pytest.raises(th.PlanError, match="planner 'optimal' needs moves that last equally long, not 5 and 7 ticks"):
        make_plan(scenario, "optimal")
