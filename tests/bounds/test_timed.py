"""Bounds where moves last or nobody follows at once: never above the integer program, which no planner beats."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import trihex as th
from tests.bounds.test_bounds import EDGES, values, world
from tests.oracles.gaps import TIMES, crowded_scenario
from tests.oracles.timed import plan_of_deeds, solve_timed, with_time
from tests.strategies import with_start_times
from tests.sweeps import swept
from trihex.bounds import bounds
from trihex.bounds.demand import make_demand
from trihex.bounds.rhythm import entry_headways, queue_up
from trihex.planners import make_plan

METRES = th.Tessellation("triangular", costs="euclidean")


@pytest.mark.parametrize("share", range(5))
def test_the_integer_program_on_half_ticks_finds_the_optimum_of_steps(share):
    for seed in range(share, swept(100, 15), 5):
        scenario = crowded_scenario(seed, sides=(2, 6))
        plan = make_plan(scenario, "optimal")
        _, relaxed, least, _ = solve_timed(scenario)
        assert relaxed <= least + 1e-6
        assert least == plan.total_time if plan.optimal else least <= plan.total_time, seed


@pytest.mark.parametrize(("time", "share"), list(product(TIMES, range(3))))
def test_bounds_below_the_optimum_and_planners_above(time, share):
    for seed in range(share, swept(75, 9), 3):
        scenario = with_time(crowded_scenario(1000 + seed, sides=(2, 5), most_robots=8), *time)
        if seed % 2:
            scenario = with_start_times(scenario, seed, latest=8)
        _, relaxed, least, _ = solve_timed(scenario)
        assert relaxed <= least + 1e-6
        n_scheme = th.make_n_scheme(scenario)
        door = th.queue_bound(n_scheme).value
        assert max(*values(scenario), door) <= least, seed
        best = max(*values(scenario), door if scenario.destinations.size > 1 else 0)
        assert th.make_lower_bound(n_scheme).value == best
        for planner in ("greedy", "fcost"):
            assert make_plan(scenario, planner).total_time >= least, (seed, planner)


@pytest.mark.parametrize("time", TIMES)
def test_an_optimum_is_a_plan_that_takes_as_long(time):
    for seed in range(swept(40, 6)):
        scenario = with_time(crowded_scenario(3000 + seed, sides=(2, 5), most_robots=6), *time)
        program, _, least, deeds = solve_timed(scenario)
        plan = plan_of_deeds(scenario, program, deeds)
        assert plan.total_time == least
        assert th.audit_plan(plan).is_clean, seed
        assert np.array_equal(plan.arrived, th.make_n_scheme(scenario).distance_of_cell(scenario.robots) < 2**31 - 1)


@pytest.mark.parametrize("shape", [("hexagonal", "full"), ("square", "edge"), ("triangular", "edge")])
def test_a_clock_brings_nothing_where_all_moves_are_alike(shape):
    """Theorem 2: not even moves that begin at half ticks. (A capacity counts robots by the half tick: none here.)"""
    for seed in range(swept(40, 4)):
        drawn = crowded_scenario(4000 + seed, sides=(3, 5), most_robots=8)
        drawn = replace(drawn, area=th.Area(th.Tessellation(*shape), drawn.area.barriers), destination_capacity=None)
        steps, clock = (with_time(drawn, clock, "allow") for clock in ("steps", "costs"))
        least = make_plan(steps, "optimal").total_time // steps.waiting_cost
        assert solve_timed(clock)[2] == solve_timed(clock, finer=2)[2] == least, seed
        plan = make_plan(clock, "optimal")
        assert plan.optimal and plan.total_time == least
        assert values(clock) == [value // steps.waiting_cost for value in values(steps)]


def test_half_ticks_matter_where_moves_are_counted_as_they_enter():
    """Why theorem 2 asks for no capacity: a robot fills a place for half a tick, so that two a tick would get in."""
    scenario = with_time(world("rDr", "hexagonal", destination_capacity=1), "costs", "allow")
    assert (solve_timed(scenario)[2], solve_timed(scenario, finer=2)[2]) == (3, 2.5)


@pytest.mark.parametrize(
    ("drawing", "shape", "rules", "time", "least"),
    [
        ("Drrrr", "square", {}, ("costs", "allow"), 5 + 10 + 15 + 20),
        ("Drrrr", "square", {}, ("costs", "forbid"), 5 + 15 + 25 + 35),
        ("Drrrr", EDGES, {}, ("steps", "forbid"), 10 * (1 + 3 + 5 + 7)),
        ("rrr#... rrr..D. rrr#...", EDGES, {}, ("costs", "allow"), sum(range(3, 12))),
        ("rrr#... rrr..D. rrr#...", EDGES, {}, ("costs", "forbid"), sum(range(3, 20, 2))),
        # Four at once, all by the same vertex or edge: the vertex is passed every 7 ticks, whatever the rule.
        ("#r D#", "square", {}, ("costs", "forbid"), 7),
        # A place of D is filled from half of a move on (2.5 ticks), or for all of it.
        ("#r# rDr #r#", "square", dict(destination_capacity=1), ("costs", "allow"), 5 + 8 + 11 + 14),
        ("#r# rDr #r#", "square", dict(destination_capacity=1), ("costs", "forbid"), 5 + 10 + 15 + 20),
        ("#r# rDr #r#", "square", dict(destination_capacity=2), ("costs", "forbid"), 5 + 5 + 10 + 10),
    ],
)
def test_worlds_that_fit_in_the_head(drawing, shape, rules, time, least):
    scenario = with_time(world(drawing, shape, **rules), *time)
    assert solve_timed(scenario)[2] == least
    assert max(values(scenario)) == least


def test_gates_are_measured_in_ticks():
    """Ways of few long moves and of many short ones: the field in ticks, as the planners use it."""
    scenario = th.Scenario(
        th.make_random_area(METRES, 12, 12, density=0.2, seed=3), [(0, 0)], clock="costs", following="forbid"
    )
    scenario = scenario.with_robots(th.random_robots(scenario.area, 40, 1, avoid=[0]))
    distance, slot, cut = values(scenario)
    assert distance < slot <= cut <= make_plan(scenario, "greedy").total_time


@settings(max_examples=swept(300, 50), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_no_passages_are_sooner_than_the_rhythm(seed):
    rng = np.random.default_rng(seed)
    headways = rng.integers(1, 11, size=rng.integers(1, 5))
    soonest = rng.integers(0, 12, size=rng.integers(1, 25))
    free_from = np.zeros(headways.size, dtype=np.int64)
    passed = []
    for tick in rng.permutation(soonest) if rng.random() < 0.5 else np.sort(soonest):
        at = int(rng.integers(headways.size)) if rng.random() < 0.3 else int(np.argmin(free_from))
        passed.append(max(tick, free_from[at]))
        free_from[at] = passed[-1] + headways[at]
    delayed = np.sort(soonest)
    queue_up(delayed, headways)
    assert (delayed <= np.sort(passed)).all()
    assert (delayed >= np.sort(soonest)).all()


@pytest.mark.parametrize("time", TIMES[1:])
def test_a_bound_that_is_cut_short_is_still_a_bound(time):
    for seed in range(swept(30, 5)):
        scenario = with_time(crowded_scenario(5000 + seed, sides=(3, 5), most_robots=8), *time)
        least = solve_timed(scenario)[2]
        for limit, value in [("_MOST_LOOKS", 3), ("_MOST_SLOTS", 40), ("_MOST_VISITS", 4 * scenario.area.free_count)]:
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(bounds, limit, value)
                assert max(values(scenario)) <= least, (seed, limit)


@pytest.mark.parametrize(
    ("shape", "rules", "words"),
    [
        ("square", dict(clock="costs"), "not 5 and 7 ticks as by clock='costs' here"),
        (METRES, dict(clock="costs"), "not 4, 7 and 8 ticks as by clock='costs' here"),
        ("hexagonal", dict(following="forbid"), "following='allow', not 'forbid'"),
        ("hexagonal", dict(following="forbid", waiting_cost=0), "following='allow', not 'forbid'"),
    ],
)
def test_the_optimum_is_not_promised_where_there_is_no_flow(shape, rules, words):
    scenario = world("D.r ..r", shape, **rules)
    with pytest.raises(
        th.PlanError, match=f"planner 'optimal' needs .*{words}, which is no pure flow; the lower bound"
    ):
        make_plan(scenario, "optimal")


def test_who_comes_through_a_vertex_needs_the_cell_before_it():
    """On squares one cell leads to D through each vertex: nobody may follow into it, though the vertex is free soon."""
    robots = [(x, y) for x in range(5) for y in range(5) if (x, y) != (2, 2)]
    scenario = th.Scenario(th.Area("square", np.zeros((5, 5), bool)), [(2, 2)], robots, following="forbid")
    slots = np.sort(np.concatenate([np.full(8, 1), np.full(8, 3), np.full(8, 5)]))  # 8 ways in every second step
    demand = make_demand(th.make_n_scheme(scenario))
    soonest = np.sort(demand.steps)
    queue_up(soonest, entry_headways(demand.nodes))
    assert soonest.tolist() == slots.tolist()
