"""Reports: the numbers of plans made by hand."""

import json
from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from trihex.kernels.codes import WAIT
from trihex.plans import plan_from_lists

ROW = th.Area("square", [[0, 0, 0, 0, 0, 1, 0]], "row")
N, E, S, W = range(4)  # the edge directions of squares
# Robot 0 waits once behind robot 1, robot 2 stands on the destination, robot 3 is walled in.
SCENARIO = th.Scenario(ROW, [(4, 0)], [(1, 0), (2, 0), (4, 0), (6, 0)], seed=5)
PLAN = plan_from_lists(SCENARIO, [[WAIT, E, E, E], [E, E], [], []], planner="hand")


def test_the_summary_says_it_all():
    report = th.make_report(PLAN, seconds={"plan": 0.25})
    assert report.as_dict() == {
        "area": "row",
        "tessellation": "square",
        "neighbourhood": "full",
        "costs": "paper",
        "corners": "allow",
        "crossing": "forbid",
        "clock": "steps",
        "following": "allow",
        "destination_capacity": None,
        "cells": 7,
        "free_cells": 6,
        "robots": 4,
        "arrived": 3,
        "unreachable": 1,
        "arrivals_of_exit": {},
        "seed": 5,
        "planner": "hand",
        "waiting_cost": 10,
        "steps": 4,
        "total_time": 60,
        "total_distance": 50,
        "total_waiting": 10,
        "longest_time": 40,
        "lower_bound": 50,
        "lower_bound_name": "distance",
        "gap": pytest.approx(0.2),
        "optimal": False,
        "conflicts": 0,
        "corner_moves": 0,
        "squeezing_moves": 0,
        "turning": 0.0,
        "step_seconds": None,
        "last_arrival_seconds": None,
        "mean_arrival_seconds": None,
        "seconds": {"read": None, "field": None, "plan": 0.25, "audit": None},
    }
    assert report.unreachable_robots.tolist() == [3]
    assert json.loads(json.dumps(report.as_dict())) == report.as_dict()


def test_in_metres_it_tells_seconds_and_turns():
    """Two moves east, one south-east: 45 degrees; a step takes sqrt(2) x 0.5 metres at 0.25 a second, and 1 to turn."""
    area = th.Area("square", np.zeros((3, 4)), frame=th.Frame(0.5))
    names = area.tessellation.direction_names[0]
    east, south_east = names.index("E"), names.index("SE")
    scenario = th.Scenario(area, [(3, 1)], [(0, 0), (2, 0)])
    plan = plan_from_lists(scenario, [[WAIT, east, WAIT, east, south_east], [south_east]])
    numbers = th.make_report(plan, speed=0.25, turn_time=1.0).as_dict()
    step = 0.5 * 2**0.5 / 0.25 + 1
    assert numbers["step_seconds"] == pytest.approx(step)
    assert numbers["last_arrival_seconds"] == pytest.approx(5 * step, abs=1e-5)
    assert numbers["mean_arrival_seconds"] == pytest.approx(3 * step, abs=1e-5)
    assert numbers["turning"] == 22.5


def test_a_proven_plan_is_its_own_bound():
    report = th.make_report(plan_from_lists(SCENARIO, [[E, E, E], [E, E], [], []], optimal=True))
    assert (report.optimal, report.lower_bound, report.lower_bound_name, report.gap) == (True, 50, "optimum", 0)


def test_a_plan_that_attains_the_bound_is_proven_too():
    report = th.make_report(plan_from_lists(SCENARIO, [[E, E, E], [E, E], [], []]))
    assert (report.optimal, report.lower_bound_name, report.gap) == (True, "optimum", 0)


@pytest.mark.parametrize("actions", [[[E, E, E], [], [], []], [[E, E, E], [E, E], [E], []]])
def test_nothing_is_proven_by_a_plan_that_is_incomplete_or_unsafe(actions):
    report = th.make_report(plan_from_lists(SCENARIO, actions, optimal=True))
    assert (report.optimal, report.lower_bound_name) == (False, "distance")
    assert report.audit.conflict_count > 0


def test_there_is_no_gap_if_someone_who_could_does_not_arrive():
    report = th.make_report(plan_from_lists(SCENARIO, [[], [E, E], [], []]))
    assert (report.arrived_count, report.is_complete, report.gap) == (2, False, None)


def test_gap_where_nobody_has_to_move():
    scenario = th.Scenario(ROW, [(4, 0)], [(4, 0), (6, 0)])
    assert th.make_report(plan_from_lists(scenario, [[], []])).gap == 0
    free_waits = th.Scenario(ROW, [(4, 0)], [(4, 0)], waiting_cost=0)
    assert th.make_report(plan_from_lists(free_waits, [[]])).gap == 0


def test_what_is_at_hand_is_not_made_again():
    bound, audit = th.LowerBound("mine", 30), th.audit_plan(PLAN)
    report = th.make_report(PLAN, n_scheme=th.make_n_scheme(SCENARIO), audit=audit, lower_bound=bound)
    assert report.audit is audit
    assert (report.lower_bound, report.lower_bound_name, report.gap) == (30, "mine", 1.0)


def test_no_gap_above_a_bound_of_nothing():
    assert th.make_report(PLAN, lower_bound=th.LowerBound("nothing", 0)).gap is None


@pytest.mark.parametrize("seed", range(30))
def test_moves_past_corners_are_those_that_the_judge_forbids_under_the_stricter_rules(seed):
    plan = th.make_plan(replace(random_scenario(81_000 + seed, sides=(3, 9)), corners="allow"), "greedy")
    report = th.make_report(plan)
    counts = []
    for corners in ("no-cut", "no-squeeze"):
        law = replace(plan.scenario, corners=corners)
        audit = th.audit_plan(th.Plan(law, plan.actions, plan.first_action), limit=100_000)
        counts.append(sum(conflict.kind == "corner" for conflict in audit.conflicts))
    assert [report.corner_moves, report.squeezing_moves] == counts


def test_moves_past_corners_are_counted_by_hand():
    #  . # b     a squeezes between two barriers, b passes one, c goes straight
    #  # . .
    #  c . a
    area = th.Area("square", [[0, 1, 0], [1, 0, 0], [0, 0, 0]])
    scenario = th.Scenario(area, [(0, 0), (1, 1)], [(2, 2), (2, 0), (0, 2)])
    north_west, south_west = 7, 6
    plan = plan_from_lists(scenario, [[W, N], [south_west], [E, N]])
    assert th.make_report(plan).corner_moves == 1
    squeezing = th.Scenario(area, [(0, 0)], [(1, 1)])
    report = th.make_report(plan_from_lists(squeezing, [[north_west]]))
    assert (report.corner_moves, report.squeezing_moves) == (1, 1)
    astray = th.make_report(plan_from_lists(squeezing, [[N] * 50]))  # onto a barrier and out of the area
    assert (astray.corner_moves, astray.squeezing_moves) == (0, 0)
