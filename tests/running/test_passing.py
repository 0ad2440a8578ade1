"""Passing order: late robots postpone a plan, but never collide or wait for each other for ever."""

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.plans import plan_from_lists
from trihex.running import audit_run, make_passing_order

NORTH, EAST, SOUTH, WEST, NORTH_EAST, SOUTH_EAST = range(6)
WAIT = 255


def plan_of(robots, actions, *, height=2, width=4, destination=(3, 1), **rules):
    area = th.Area("square", np.zeros((height, width), dtype=bool))
    return plan_from_lists(th.Scenario(area, [destination], robots, **rules), actions)


def moves(follower, late=()):
    return [int(action) for action in follower.step(late)]


def test_a_robot_enters_a_cell_only_when_the_one_before_it_leaves():
    follower = make_passing_order(plan_of([(0, 1), (1, 1)], [[EAST] * 3, [EAST] * 2])).follow()
    assert moves(follower, late=[1]) == [WAIT, WAIT]
    assert moves(follower, late=[0]) == [WAIT, EAST]
    assert moves(follower, late=[0]) == [WAIT, EAST]
    assert [moves(follower) for _ in range(3)] == [[EAST, WAIT]] * 3
    assert follower.is_over


def test_robots_in_a_ring_turn_together_or_not_at_all():
    ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
    actions = [[EAST, SOUTH, EAST, EAST], [SOUTH, EAST, EAST], [WEST], [NORTH]]
    follower = make_passing_order(plan_of(ring, actions)).follow()
    assert moves(follower, late=[3]) == [WAIT] * 4
    assert moves(follower) == [EAST, SOUTH, WEST, NORTH]


def test_crossing_moves_keep_their_order_unless_crossing_is_allowed():
    robots, actions = [(0, 1), (1, 1)], [[NORTH_EAST, EAST, SOUTH_EAST], [WAIT, 7, EAST, EAST, SOUTH_EAST]]
    forbidden = make_passing_order(plan_of(robots, actions)).follow()
    assert moves(forbidden, late=[0]) == [WAIT, WAIT]
    assert moves(forbidden) == [NORTH_EAST, WAIT]
    assert moves(forbidden) == [EAST, 7]
    allowed = make_passing_order(plan_of(robots, actions, crossing="allow")).follow()
    assert moves(allowed, late=[0]) == [WAIT, 7]


def test_destinations_take_robots_in_order_and_only_as_many_as_they_can():
    robots, actions = [(2, 1), (2, 0)], [[EAST], [WAIT, SOUTH_EAST]]
    follower = make_passing_order(plan_of(robots, actions, destination_capacity=1)).follow()
    assert moves(follower, late=[0]) == [WAIT, WAIT]
    assert moves(follower) == [EAST, WAIT]
    assert moves(follower) == [WAIT, SOUTH_EAST]
    free = make_passing_order(plan_of(robots, actions)).follow()
    assert moves(free, late=[0]) == [WAIT, SOUTH_EAST]


def test_waits_that_nobody_needs_are_left_out():
    order = make_passing_order(plan_of([(0, 1)], [[EAST, WAIT, WAIT, EAST, WAIT, EAST]]))
    run = order.run()
    assert run.steps == 3 and run.total_time == 30 and order.plan.total_time == 60


def test_delayed_plans_stay_safe_and_all_arrive_who_do_in_the_plan():
    for seed in range(swept(60, 12)):
        scenario = random_scenario(seed, sides=(3, 14))
        plan = th.make_plan(scenario, ("greedy", "fcost")[seed % 2])
        order = make_passing_order(plan)
        punctual = order.run()
        assert (punctual.ended <= plan.arrival_step_of_robot).all() and audit_run(punctual).is_clean, seed
        late = order.run(delay=(0.05, 0.1, 0.3)[seed % 3], seed=seed, most_steps=5000)
        assert audit_run(late).is_clean and np.array_equal(late.arrived, plan.arrived), seed
        assert late.distance_of_robot.tolist() == plan.distance_of_robot.tolist(), seed


def test_unsafe_plans_and_delays_without_end_are_refused():
    for robots, actions, why in (
        ([(0, 1), (1, 1)], [[EAST], [WAIT]], "share a cell"),
        ([(0, 1), (1, 1)], [[EAST], [WEST]], "exchange cells"),
        ([(0, 1), (1, 1)], [[NORTH_EAST], [7]], "pass one lattice vertex"),
    ):
        with pytest.raises(th.PlanError, match=f"needs a safe one; in step 1 robots {why}"):
            make_passing_order(plan_of(robots, actions))
    both = plan_of([(2, 1), (2, 0)], [[EAST], [SOUTH_EAST]], destination_capacity=1)
    with pytest.raises(th.PlanError, match="are more than 1 to enter a destination"):
        make_passing_order(both)
    with pytest.raises(th.PlanError, match="delay must be a number from 0 to below 1, not 1"):
        make_passing_order(plan_of([(0, 1)], [[EAST]])).run(delay=1)


def test_nobody_moves_before_its_start_time():
    scenario = th.Scenario(th.Area("square", [[0, 0, 0, 0]]), [(3, 0)], [(0, 0), (1, 0)], start_times=[2, 5])
    run = make_passing_order(th.make_plan(scenario)).run(delay=0.3, seed=1)
    assert th.audit_run(run).is_clean and run.arrived.all()
    assert (run.actions[:2, 0] > 250).all() and (run.actions[:5, 1] > 250).all()
    replanned = th.Trial(scenario, "astar").run()
    assert th.audit_run(replanned).is_clean and replanned.arrived.all()
