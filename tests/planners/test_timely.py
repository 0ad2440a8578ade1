"""Planners where moves last as long as they cost, or nobody follows before a cell is left: all arrive, all is owned."""

from itertools import product

import numpy as np
import pytest

import trihex as th
from tests.oracles.timed import with_time
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.planners import make_plan

PLANNERS = ("greedy", "fcost", "astar")
TIMES = list(product(("steps", "costs"), ("allow", "forbid")))


def in_time(seed, time):
    return with_time(random_scenario(seed, sides=(2, 9), waiting_costs=(None,)), *time)


@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("seed", range(swept(60, 8)))
def test_all_who_can_arrive_do_and_the_judge_finds_nothing(planner, time, seed):
    scenario = in_time(171_000 + seed, time)
    n_scheme = th.make_n_scheme(scenario)
    plan = make_plan(scenario, planner, n_scheme=n_scheme)
    audit = th.audit_plan(plan)
    assert audit.is_clean, [str(conflict) for conflict in audit.conflicts]
    can_arrive = np.ones(scenario.robot_count, dtype=bool)
    can_arrive[n_scheme.unreachable_robots] = False
    assert np.array_equal(plan.arrived, can_arrive)
    assert plan.total_time >= th.make_lower_bound(n_scheme).value
    if scenario.clock == "costs":  # t_r is the tick of arrival
        assert np.array_equal(plan.time_of_robot[plan.arrived], plan.arrival_step_of_robot[plan.arrived])
    assert make_plan(scenario, planner, n_scheme=n_scheme) == plan
    assert make_plan(scenario, planner, n_scheme=n_scheme, record="arrivals") == th.make_arrivals(plan)


@pytest.mark.parametrize("rule", ["queue", "aside", "lanes"])
@pytest.mark.parametrize("seed", range(swept(40, 6)))
def test_all_rules_of_fcost_end_in_time(rule, seed):
    scenario = in_time(172_000 + seed, TIMES[1 + seed % 3])
    plan = make_plan(scenario, "fcost", rule=rule)
    assert th.audit_plan(plan).is_clean
    can_arrive = th.make_n_scheme(scenario).distance_of_cell(scenario.robots) < 2**31 - 1
    assert np.array_equal(plan.arrived, can_arrive)


def test_meetings_are_counted_in_steps_only():
    scenario = th.Scenario(th.Area("square", [[0, 0]]), [(0, 0)], [(1, 0)], clock="costs")
    with pytest.raises(th.PlanError, match="rule must not be 'paper' where clock is 'costs' and following 'allow'"):
        make_plan(scenario, "fcost", rule="paper")


@pytest.mark.parametrize("planner", PLANNERS)
def test_robots_in_a_row_keep_their_headway(planner):
    """By hand: a corridor of squares, the destination at its end; each robot is a headway behind the one before."""
    area = th.Area(th.Tessellation("square", "full"), [[0, 0, 0, 0, 0]])
    times = {}
    for clock, following in TIMES:
        scenario = th.Scenario(area, [(0, 0)], [(1, 0), (2, 0), (3, 0)], clock=clock, following=following)
        times[clock, following] = make_plan(scenario, planner).arrival_step_of_robot.tolist()
    assert times == {
        ("steps", "allow"): [1, 2, 3],
        ("steps", "forbid"): [1, 3, 5],
        ("costs", "allow"): [5, 10, 15],
        ("costs", "forbid"): [5, 15, 25],
    }


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_slow_move_holds_up_a_quick_one_for_half_of_the_difference(planner):
    """The first robot leaves by a move of 7 ticks, the second would follow by one of 5: it has to wait for a tick."""
    area = th.Area("square", [[0, 1, 1], [1, 0, 0]])
    scenario = th.Scenario(area, [(0, 0)], [(1, 1), (2, 1)], clock="costs")
    assert make_plan(scenario, planner).arrival_step_of_robot.tolist() == [7, 14]
    one_door = th.Scenario(area, [(0, 0)], [(1, 1), (2, 1)], clock="costs", following="forbid")
    assert make_plan(one_door, planner).arrival_step_of_robot.tolist() == [7, 19]


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_destination_takes_as_many_at_a_time_as_its_capacity(planner):
    area = th.Area(th.Tessellation("square", "edge"), [[0, 0, 0]])
    for following, capacity, last in (("allow", 1, 2), ("forbid", 1, 2), ("forbid", 2, 1), ("allow", None, 1)):
        scenario = th.Scenario(
            area, [(1, 0)], [(0, 0), (2, 0)], destination_capacity=capacity, clock="costs", following=following
        )
        assert make_plan(scenario, planner).steps == last, (following, capacity)


def test_a_line_of_sleepers_costs_no_look():
    """Crowds that fill an area to the last cell but one still end, whoever sleeps behind whom."""
    for name, time in product(("triangular", "hexagonal", "square"), TIMES[1:]):
        area = th.Area(name, np.zeros((9, 12), bool))
        scenario = th.Scenario(area, [(0, 0)], range(1, 108), clock=time[0], following=time[1])
        for planner in ("greedy", "fcost"):
            plan = make_plan(scenario, planner)
            assert plan.arrived.all() and th.audit_plan(plan).is_clean
