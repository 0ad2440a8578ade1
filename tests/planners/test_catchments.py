"""Robots share the exits: nobody waits long at one while another is free."""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.fields import PricedField, make_d_scheme
from trihex.kernels.codes import NOT_REACHED
from trihex.planners import make_plan
from trihex.planners.catchments import Catchments, exits_of
from trihex.planners.fcost import _simulated


def crowd_at_one_exit(tessellation, robots=480):
    """Two destinations far apart, and all robots on the side of one of them."""
    area = th.Area(tessellation, np.zeros((30, 70), dtype=bool))
    cells = [(x, y) for y in range(30) for x in range(4, 34) if (x, y) != (14, 15)]
    starts = np.random.default_rng(1).permutation(len(cells))[:robots]
    return th.Scenario(area, [(14, 15), (40, 15)], [cells[i] for i in starts])


def catchments_of(scenario):
    d_scheme = make_d_scheme(th.make_n_scheme(scenario))
    return Catchments(d_scheme, _simulated(d_scheme, "aside", False, None).crowd)


def test_destinations_that_are_near_each_other_are_one_exit():
    area = th.Area("square", np.zeros((20, 60), dtype=bool))
    exits = [(2, 2), (5, 2), (8, 5), (30, 2), (30, 6), (31, 9), (50, 19)]
    exit = exits_of(th.Scenario(area, exits))
    place = dict(
        zip(map(tuple, np.transpose(area.cell_to_xy(th.Scenario(area, exits).destinations))), exit, strict=True)
    )
    assert [place[exit] for exit in exits] == [0, 0, 0, 1, 2, 2, 3]


@pytest.mark.parametrize("tessellation", ["hexagonal", "triangular", "square"])
def test_robots_go_to_the_farther_exit_where_the_nearer_one_is_crowded(tessellation):
    scenario = crowd_at_one_exit(tessellation)
    n_scheme = th.make_n_scheme(scenario)
    best = make_plan(scenario, "fcost", n_scheme=n_scheme)
    others = [make_plan(scenario, "fcost", n_scheme=n_scheme, rule=rule).total_time for rule in ("aside", "lanes")]
    assert th.audit_plan(best).is_clean
    assert best.total_time < 0.97 * min(others)
    last = [best.arrival_step_of_robot[best.last_cell_of_robot == goal].max() for goal in scenario.destinations]
    assert max(last) < 1.5 * min(last)


def test_only_what_is_crowded_has_a_price():
    crowded = catchments_of(crowd_at_one_exit("hexagonal")).find_prices()
    assert crowded[0] > 0
    assert crowded[1] == 0
    assert not catchments_of(crowd_at_one_exit("hexagonal", robots=8)).find_prices().any()


def test_in_large_crowds_some_are_asked_for_all(monkeypatch):
    scenario = crowd_at_one_exit("hexagonal")
    asked = {}
    for most in (480, 240, 60, 20):
        monkeypatch.setattr("trihex.planners.catchments._MOST_ASKED", most)
        asked[most] = make_plan(scenario, "fcost").total_time, catchments_of(scenario).find_prices()[0]
    for most, (total, price) in asked.items():
        assert total < 1.05 * asked[480][0], most
        assert 0 < price < 2 * asked[480][1], most
    assert asked[480][0] < 0.97 * make_plan(scenario, "fcost", rule="aside").total_time


@pytest.mark.parametrize("limit", ["_MANY_STEPS", "_SPARSER"])
def test_exits_get_no_prices_where_that_would_take_long(limit, monkeypatch):
    scenario = crowd_at_one_exit("hexagonal")
    shared = make_plan(scenario, "fcost").total_time
    monkeypatch.setattr(f"trihex.planners.fcost.{limit}", 0)
    assert make_plan(scenario, "fcost").total_time > shared


@pytest.mark.parametrize("seed", range(swept(40, 10)))
def test_plans_keep_the_rules_and_are_never_worse(seed, monkeypatch):
    """Every scenario with more than one exit is tried, whether it is worth it or not."""
    monkeypatch.setattr("trihex.planners.fcost._WORTH", 0.0)
    monkeypatch.setattr("trihex.planners.catchments._MOST_ASKED", (10, 10_000)[seed % 2])
    scenario = random_scenario(160_000 + seed, sides=(8, 16), waiting_costs=(None, 3, 15))
    n_scheme = th.make_n_scheme(scenario)
    plan = make_plan(scenario, "fcost", n_scheme=n_scheme)
    assert th.audit_plan(plan).is_clean
    assert plan.arrived.sum() == scenario.robot_count - n_scheme.unreachable_robots.size
    aside = make_plan(scenario, "fcost", n_scheme=n_scheme, rule="aside")
    greedy = make_plan(scenario, "greedy", n_scheme=n_scheme)
    assert plan.total_time <= min(aside.total_time, greedy.total_time)


@pytest.mark.parametrize("tessellation", ["hexagonal", "triangular", "square"])
@pytest.mark.parametrize("seed", range(swept(20, 2)))
def test_each_lane_keeps_to_the_cells_that_lead_to_its_exit(tessellation, seed):
    """Where a lattice vertex belonged to lanes of two catchments, the search for a lane did not end."""
    area = th.make_random_area(tessellation, 30, 40, density=0.15, seed=seed)
    goals = th.random_robots(area, 6, seed=seed)
    scenario = th.Scenario(area, goals, th.random_robots(area, 400, seed=seed, avoid=goals))
    lanes, paid = catchments_of(scenario).make_lanes(1 << 30)
    prices = catchments_of(scenario).find_prices()
    field = PricedField(scenario, th.make_n_scheme(scenario).distance_of_site != NOT_REACHED)
    _, directions = field.directions(prices)
    exit = dict(zip(field.goals.tolist(), exits_of(scenario).tolist(), strict=True))

    def exit_from(site):
        while site not in exit:
            bits = int(directions[site])
            site += int(area.layout.offset_of_direction[site & 1, (bits & -bits).bit_length() - 1])
        return exit[site]

    assert len(lanes.ways) > exits_of(scenario).max()
    for way in lanes.ways:
        assert len({exit_from(int(site)) for site in area.layout.cell_to_site(way)}) == 1
    price_of_exit = dict(zip(exits_of(scenario).tolist(), prices.tolist(), strict=True))
    reached = th.make_n_scheme(scenario).distance_of_cell(scenario.robots) < NOT_REACHED
    starts = area.layout.cell_to_site(scenario.robots[reached])
    assert paid == sum(price_of_exit[exit_from(int(site))] for site in starts)


def test_the_same_crowd_is_shared_in_the_same_way_again():
    scenario = crowd_at_one_exit("triangular")
    plans = [make_plan(scenario, "fcost") for _ in range(2)]
    assert np.array_equal(plans[0].actions, plans[1].actions)


def test_who_may_begin_late_is_no_queue(monkeypatch):
    """Arrivals tell how much an exit lets in only where all begin at once."""
    asked = []
    monkeypatch.setattr(
        "trihex.planners.fcost.Catchments", lambda *nouns: asked.append(nouns) or catchments_of(scenario)
    )
    scenario = crowd_at_one_exit("hexagonal")
    make_plan(scenario, "fcost")
    assert len(asked) == 1
    make_plan(replace(scenario, start_times=np.arange(scenario.robot_count) % 7), "fcost")
    assert len(asked) == 1
