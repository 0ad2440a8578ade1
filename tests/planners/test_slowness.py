"""Slowness: robots whose moves last some times as long, planned for from tick to tick and judged as they own cells."""

from itertools import product

import numpy as np
import pytest

import trihex as th
from tests.oracles.owners import judge
from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_random_doors, with_slowness, with_start_times
from tests.sweeps import swept
from trihex.bounds import arrivals_bound, queue_bound
from trihex.planners import make_plan
from trihex.plans import make_dependencies, make_playback

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


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_move_lasts_and_costs_so_many_times_as_much(planner):
    plan = make_plan(th.Scenario(ROW, (3, 0), [(0, 0), (1, 0)], slowness=[1, 4]), planner)
    # Robot 1 owns (1, 0) until step 2, and (2, 0) until step 6; robot 0 owns each from half a step after it sets out.
    assert plan.arrival_step_of_robot.tolist() == [8, 8] and plan.ticks_of_robot(0).tolist()[-3:] == [6, 7, 8]
    assert plan.time_of_robot.tolist() == [80, 80] and plan.distance_of_robot.tolist() == [30, 80]
    assert plan.ticks_of_robot(1).tolist() == [0, 4, 8]
    assert th.make_lower_bound(th.make_n_scheme(plan.scenario)).value == 30 + 80
    playback = make_playback(plan, th.make_n_scheme(plan.scenario))
    assert playback.spent[-1] == playback.least_total[-1] == plan.total_time
    assert (np.diff(playback.least_total) >= 0).all() and playback.least_total[0] == 110


def test_robots_of_several_regions_share_vertices_and_keep_apart():
    for seed in range(320_000, 320_000 + swept(20, 2)):
        rng = np.random.default_rng(seed)
        area = th.Area(("square", "triangular")[seed % 2], rng.random((20, 150)) < 0.15)
        free = rng.permutation(np.flatnonzero(~area.barriers.reshape(-1)))
        scenario = th.Scenario(area, free[:5], free[5:300], clock=("steps", "costs")[seed // 2 % 2])
        plan = make_plan(with_slowness(scenario, seed, most=30), PLANNERS[seed % 2])
        assert th.audit_plan(plan).is_clean, (seed, th.audit_plan(plan).conflicts[0])


SLOW = th.Scenario(ROW, (3, 0), [(0, 0), (1, 0)], slowness=[1, 2])


@pytest.mark.parametrize(
    ("work", "message"),
    [
        (lambda plan: make_plan(SLOW, "astar"), "planner 'astar' needs robots that are all as fast"),
        (lambda plan: make_plan(SLOW, "optimal"), "planner 'optimal' needs robots that are all as fast"),
        (lambda plan: make_plan(SLOW, "fcost", rule="paper"), "rule must not be 'paper' where robots have slowness"),
        (th.make_certificate, "a certificate needs robots that are all as fast"),
        (th.make_prices, "a price needs robots that are all as fast"),
        (th.straighten, "to straighten a plan one needs robots that are all as fast"),
        (make_dependencies, "an order of who waits for whom needs robots that are all as fast"),
        (th.make_passing_order, "an order of passing needs robots that are all as fast"),
        (lambda plan: th.Execution(SLOW), "an execution needs robots that are all as fast"),
        (lambda plan: th.Trial(SLOW), "an execution needs robots that are all as fast"),
        (lambda plan: th.slot_bound(th.make_n_scheme(SLOW)), "the slot bound needs robots that are all as fast"),
        (lambda plan: th.cut_bound(th.make_n_scheme(SLOW)), "the cut bound needs robots that are all as fast"),
        (lambda plan: queue_bound(th.make_n_scheme(SLOW)), "the queue bound needs robots that are all as fast"),
    ],
)
def test_what_knows_no_slowness_says_so(work, message):
    with pytest.raises(th.PlanError, match=message):
        work(make_plan(SLOW))
