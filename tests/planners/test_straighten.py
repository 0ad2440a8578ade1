"""Straighter ways: never later, never dearer, safe, and as straight as an exhaustive search finds for a lone robot."""

from functools import cache

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings

import trihex as th
from tests.oracles.rules import Rules, judge
from tests.strategies import scenarios
from trihex.cli import main
from trihex.kernels.codes import WAIT
from trihex.planners import straighten
from trihex.plans import plan_from_lists, turning_of_robot


@settings(deadline=None, max_examples=40)
@given(scenario=scenarios())
def test_nobody_arrives_in_another_step_or_pays_more(scenario):
    for planner in ("greedy", "fcost", "astar"):
        plan = th.make_plan(scenario, planner)
        straight = straighten(plan)
        np.testing.assert_array_equal(straight.arrival_step_of_robot, plan.arrival_step_of_robot)
        assert (straight.time_of_robot <= plan.time_of_robot).all()
        assert th.audit_plan(straight).is_clean and not judge(straight)
        cheaper = straight.time_of_robot < plan.time_of_robot
        if not cheaper.any():
            assert turning_of_robot(straight).sum() <= turning_of_robot(plan).sum() + 1e-6
        assert straighten(straight) == straighten(straight)


@settings(deadline=None, max_examples=20)
@given(scenario=scenarios(most_robots=12))
def test_an_optimal_plan_stays_one(scenario):
    plan = th.make_plan(scenario, "optimal")
    straight = straighten(plan)
    assert straight.optimal == plan.optimal and straight.total_time <= plan.total_time
    if plan.optimal:
        assert straight.total_time == plan.total_time


def straightest(scenario, most, steps):
    """Return the least degrees that a lone robot turns on any way of so many steps that costs no more than `most`."""
    rules, tessellation = Rules(scenario), scenario.area.tessellation
    goals = set(rules.places(scenario.destinations))
    (start,) = rules.places(scenario.robots)

    def heading(cell, other):
        ax, ay = tessellation.centre_of_cell(*cell)
        bx, by = tessellation.centre_of_cell(*other)
        return round(float(np.degrees(np.arctan2(by - ay, bx - ax))), 6)

    @cache
    def least(cell, before, left, cost):
        if cost > most:
            return np.inf
        if cell in goals:
            return 0.0 if left == 0 else np.inf
        if left == 0:
            return np.inf
        best = least(cell, before, left - 1, cost + scenario.waiting_cost)
        for other, price in rules.neighbours(cell):
            after = heading(cell, other)
            turn = 0.0 if before is None else abs((after - before + 180) % 360 - 180)
            best = min(best, turn + least(other, after, left - 1, cost + price))
        return best

    return least(start, None, steps, 0)


@pytest.mark.parametrize("seed", range(9))
@pytest.mark.parametrize("name", ["hexagonal", "square", "triangular"])
def test_a_lone_robot_goes_as_straight_as_can_be(name, seed):
    rng = np.random.default_rng([seed, 4])
    area = th.Area(name, rng.random((5, 6)) < 0.2)
    free = np.flatnonzero(~area.barriers)
    start, end = rng.choice(free, size=2, replace=False)
    scenario = th.Scenario(area, [end], [start])
    plan = th.make_plan(scenario, "astar")
    if not plan.arrived.all():
        return
    turned = turning_of_robot(straighten(plan))[0]
    assert turned == pytest.approx(straightest(scenario, plan.total_time, plan.steps), abs=0.01)


def test_ways_give_way_to_each_other():
    """Two zigzags on squares become two straight lines, and the robot that stands in between still waits there."""
    area = th.Area(th.Tessellation("square", "edge"), np.zeros((4, 5)))
    names = area.tessellation.direction_names[0]
    east, south = names.index("E"), names.index("S")
    zigzag = [east, south, east, south, east, south, east]
    scenario = th.Scenario(area, [(4, 3), (4, 2)], [(0, 0), (1, 0)])
    plan = plan_from_lists(scenario, [[WAIT, *zigzag], [south, east, south, east, WAIT, east]])
    straight = straighten(plan)
    assert turning_of_robot(plan).tolist() == [540.0, 270.0]
    assert turning_of_robot(straight).tolist() == [90.0, 90.0]
    assert straight.time_of_robot.tolist() == plan.time_of_robot.tolist()
    assert th.audit_plan(straight).is_clean


def test_what_cannot_be_straightened_is_told():
    area = th.Area("square", np.zeros((2, 3)))
    scenario = th.Scenario(area, [(2, 0)], [(0, 0)])
    jumping = th.Plan(scenario, np.array([254], dtype=np.uint8), [0, 1], jumps=[[0, 2]])
    with pytest.raises(th.PlanError, match="plan must keep the rules to be straightened: a robot jumps"):
        straighten(jumping)
    with pytest.raises(th.PlanError, match="rounds must be a whole number from 0, not -1"):
        straighten(th.make_plan(scenario), rounds=-1)
    with pytest.raises(th.TooLargeError, match="reservations would take"):
        straighten(th.make_plan(scenario), memory_limit=1)


@pytest.mark.parametrize("rule", ["--clock=costs", "--following=forbid"])
def test_what_cannot_be_straightened_is_told_before_anything_is_planned(tmp_path, monkeypatch, rule):
    def never(*given, **more):
        raise AssertionError("planned in vain")

    monkeypatch.chdir(tmp_path)
    (tmp_path / "w.txt").write_text("a......\n.......\n......D\n.......\n")
    monkeypatch.setattr("trihex.planners.make_plan", never)
    monkeypatch.setattr("trihex.fields.make_n_scheme", never)
    done = CliRunner().invoke(main, ["plan", "w.txt", "--tessellation", "square", rule, "--straight"])
    assert done.exit_code == 2 and "plan must have moves of one step, and robots that may follow" in done.output
    assert len(done.output.strip().splitlines()) == 1


def test_the_command_straightens(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "w.txt").write_text("a......\n.......\n......D\n.......\n")
    runner = CliRunner()
    degrees = []
    for more in ([], ["--straight"]):
        done = runner.invoke(main, ["plan", "w.txt", "--planner", "astar", "--out", "p.npz", *more])
        assert done.exit_code == 0, done.output
        degrees.append(float(turning_of_robot(th.read_plan("p.npz"))[0]))
        assert f"a robot turns by {degrees[-1]:.0f} degrees in the mean" in done.output
    assert degrees[1] == 60.0 and degrees[0] >= 60.0
