"""Mended plans: never later, never dearer, safe, and in the end without a window that a cheaper way leads through."""

from collections import Counter
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import trihex as th
from tests.oracles.rules import Rules, judge
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.kernels.codes import WAIT
from trihex.planners import fcost as planner
from trihex.planners.mending import _AHEAD, _EVERY, mend
from trihex.planners.registry import uses_of


def crowd(shape="triangular", **rules):
    """Return a crowd that queues before one destination."""
    area = th.make_random_area(shape, 20, 20, density=0.15, seed=2)
    n_scheme = th.make_n_scheme(th.Scenario(area, [(10, 10)]))
    cells = np.flatnonzero(n_scheme.distance.reshape(-1) < 2**31 - 1)
    robots = np.random.default_rng(1).choice(cells[cells != 10 * 20 + 10], 80, replace=False)
    return th.Scenario(area, [(10, 10)], robots, **rules)


class Others:
    """What all robots but one do, from cell to cell, as pairs (x, y)."""

    def __init__(self, plan, rules, robot):
        self.at, self.moves, self.vertices, self.entries = set(), set(), set(), Counter()
        self.goals = set(rules.places(plan.scenario.destinations))
        for other in range(plan.scenario.robot_count):
            way = rules.places(plan.cells_of_robot(other))
            for step, (start, end) in enumerate(pairwise(way), 1):
                if other == robot:
                    continue
                if end in self.goals:
                    self.entries[end, step] += 1
                else:
                    self.at.add((end, step))
                if start != end:
                    self.moves.add((start, end, step))
                    self.vertices.add((rules.vertex(start, end), step))

    def lets(self, start, end, step, rules):
        """Whether a robot may go from one cell to another in a step, or stay."""
        scenario = rules.scenario
        if end in self.goals:
            if scenario.destination_capacity and self.entries[end, step] >= scenario.destination_capacity:
                return False
        elif (end, step) in self.at or (end, start, step) in self.moves:
            return False
        vertex = None if start == end else rules.vertex(start, end)
        return vertex is None or scenario.crossing == "allow" or (vertex, step) not in self.vertices


def cheapest(rules, neighbours, others, start, begin, steps, end):
    """Return what the cheapest walk of so many steps to `end` costs, or one of at most so many to a destination."""
    reached, arrived = {start: 0}, np.inf
    for step in range(begin + 1, begin + steps + 1):
        ahead = {}
        for cell, paid in reached.items():
            for other, cost in [*neighbours(cell), (cell, rules.scenario.waiting_cost)]:
                if not others.lets(cell, other, step, rules):
                    continue
                if other not in others.goals:
                    ahead[other] = min(ahead.get(other, np.inf), paid + cost)
                elif end is None:
                    arrived = min(arrived, paid + cost)
        reached = ahead
    return arrived if end is None else reached[end]


@pytest.mark.parametrize("seed", range(swept(100, 8)))
def test_in_the_end_no_window_has_a_cheaper_way(seed):
    scenario = random_scenario(40_000 + seed, sides=(3, 7), most_robots=12)
    n_scheme = th.make_n_scheme(scenario)
    plan = th.make_plan(scenario, "greedy")
    while (better := mend(plan, n_scheme, 1)).total_time < plan.total_time:
        plan = better
    assert better == plan
    rules = Rules(scenario)
    neighbours = cache(lambda cell: list(rules.neighbours(cell)))
    cost_of = {**dict(enumerate(scenario.area.tessellation.cost_of_direction.tolist())), WAIT: scenario.waiting_cost}
    for robot in np.flatnonzero(np.diff(plan.first_action)).tolist():
        others, way = Others(plan, rules, robot), rules.places(plan.cells_of_robot(robot))
        actions = plan.actions[plan.first_action[robot] : plan.first_action[robot + 1]]
        for begin in range(-robot % _EVERY, actions.size, _EVERY):
            own = actions[begin : begin + _AHEAD].tolist()
            end = way[begin + len(own)]
            least = cheapest(
                rules, neighbours, others, way[begin], begin, len(own), None if end in others.goals else end
            )
            assert least == sum(cost_of[action] for action in own), (robot, begin)


@pytest.mark.parametrize("seed", range(swept(200, 20)))
def test_nobody_arrives_later_or_pays_more(seed):
    scenario = random_scenario(50_000 + seed, sides=(3, 10))
    n_scheme = th.make_n_scheme(scenario)
    for name in ("greedy", "fcost", "astar"):
        plan = th.make_plan(scenario, name)
        for rounds in (1, 3):
            mended = mend(plan, n_scheme, rounds)
            assert (mended.arrival_step_of_robot <= plan.arrival_step_of_robot).all()
            assert (mended.time_of_robot <= plan.time_of_robot).all()
            assert np.array_equal(mended.arrived, plan.arrived)
            assert th.audit_plan(mended).is_clean and not judge(mended)


def test_of_a_crowd_on_triangles_a_good_part_of_what_it_loses_is_saved():
    scenario = crowd()
    distances = int(th.make_n_scheme(scenario).distance_of_cell(scenario.robots).sum())
    lost = {rounds: th.make_plan(scenario, rounds=rounds).total_time - distances for rounds in (0, 1, 8)}
    assert th.make_plan(scenario) == th.make_plan(scenario, rounds=1)
    assert lost[8] < lost[1] < 0.85 * lost[0]
    arrivals = [th.make_plan(scenario, rounds=rounds).arrival_step_of_robot.sum() for rounds in (0, 1)]
    assert arrivals[1] < arrivals[0]


@pytest.mark.parametrize("rounds", [None, 0, 2])
@pytest.mark.parametrize("rule", ["best", "aside"])
def test_arrivals_are_those_of_the_plan(rounds, rule):
    options = {"rule": rule, "rounds": rounds}
    plan = th.make_plan(crowd(), **options)
    assert th.make_plan(crowd(), record="arrivals", **options) == th.make_arrivals(plan)


def test_where_nothing_is_said_robots_look_ahead_if_steps_differ_in_cost_and_are_not_too_many(monkeypatch):
    hexagons, waiting = crowd("hexagonal"), crowd("hexagonal", waiting_cost=7)
    assert th.make_plan(hexagons) == th.make_plan(hexagons, rounds=0) != th.make_plan(hexagons, rounds=1)
    assert th.make_plan(waiting) == th.make_plan(waiting, rounds=1) != th.make_plan(waiting, rounds=0)
    assert th.make_plan(crowd(), rule="lanes") == th.make_plan(crowd(), rule="lanes", rounds=0)
    for most in (30, 500):  # fewer than all ways take, and than the robots then need
        monkeypatch.setattr(planner, "_MOST_ACTIONS", most)
        assert th.make_plan(crowd()) == th.make_plan(crowd(), rounds=0)
        assert th.make_plan(crowd(), record="arrivals") == th.make_arrivals(th.make_plan(crowd(), rounds=0))


def test_progress_is_told_of_each_round():
    ends = []
    for rounds in (0, 3):
        told = []
        th.make_plan(crowd(), rounds=rounds, progress=lambda *done, told=told: told.append(done))
        ends.append(told.count((80, 80)))
    assert ends[1] == ends[0] + 3


@pytest.mark.parametrize("rule", [{"clock": "costs"}, {"following": "forbid"}, {"start_times": [3] * 80}])
def test_where_windows_do_not_know_a_rule_nobody_looks_ahead(rule):
    scenario = crowd()
    if "clock" in rule:
        area = th.Area(th.Tessellation("triangular", clock="costs"), scenario.area.barriers)
        scenario = th.Scenario(area, scenario.destinations, scenario.robots)
    else:
        scenario = crowd(**rule)
    assert th.make_plan(scenario) == th.make_plan(scenario, rounds=0)
    for record in ("plan", "arrivals"):
        with pytest.raises(th.PlanError, match="rounds must be 0, not 2, where moves last, nobody follows at once"):
            th.make_plan(scenario, rounds=2, record=record)


def test_rounds_are_a_number():
    with pytest.raises(th.PlanError, match="rounds must be a whole number from 0, not -1"):
        th.make_plan(crowd(), rounds=-1)
    with pytest.raises(th.PlanError, match=r"rounds must be .*, not 'many'"):
        th.make_plan(crowd(), rounds="many", record="arrivals")


def test_what_does_not_fit_into_memory_is_refused(monkeypatch):
    monkeypatch.setattr("trihex.planners.mending.available_memory", lambda: 1000)
    with pytest.raises(th.TooLargeError, match=r"to look ahead would take 0.0 GiB, .* free; choose rounds=0"):
        th.make_plan(crowd())


def test_the_kernels_are_prepared_where_robots_look_ahead():
    assert uses_of("fcost", crowd()) == ["fcost", "fcost_mending"]
    assert uses_of("fcost", crowd("hexagonal")) == ["fcost"]
    assert uses_of("fcost", crowd(following="forbid")) == ["timely fcost"]
