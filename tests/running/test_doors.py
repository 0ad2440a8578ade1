"""Runs where doors have a flow: all arrive, whatever is late or shut; the judge of runs; what cannot be followed."""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from tests.judging.test_doors import TIMES
from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_random_doors
from tests.sweeps import swept
from trihex.running import Event, Execution, Trial, audit_run


@pytest.mark.parametrize("planner", ["greedy", "fcost"])
def test_all_arrive_by_the_rules(planner):
    for seed in range(swept(100, 20)):
        scenario = random_scenario(seed, sides=(2, 6), waiting_costs=(None,))
        scenario = with_time(with_random_doors(scenario), *TIMES[seed % 4])
        run = Trial(scenario, planner=planner, sensor=2 if seed % 2 else None, delay=0.1 * (seed % 3), seed=seed).run()
        assert audit_run(run).is_clean, seed
        can_arrive = np.ones(scenario.robot_count, dtype=bool)
        can_arrive[th.make_n_scheme(scenario).unreachable_robots] = False
        assert np.array_equal(run.arrived, can_arrive), seed


@pytest.mark.parametrize("time", TIMES)
def test_the_judge_of_runs_tells_who_came_while_a_door_was_shut(time):
    area = th.Area("square", [[0, 0, 0, 0, 0]])
    scenario = with_time(th.Scenario(area, [(4, 0)], [(0, 0), (1, 0)]), *time)
    run = Trial(scenario, planner="greedy").run()
    assert audit_run(run).is_clean
    late = audit_run(replace(run, scenario=replace(scenario, doors=[((3, 0), "1/50")])))
    assert [conflict.kind for conflict in late.conflicts] == ["capacity"] * 2
    assert "enters the door" in late.conflicts[0].text


@pytest.mark.parametrize(("planner", "options"), [("optimal", {}), ("fcost", {"replan": True})])
def test_plans_are_not_followed_where_doors_have_a_flow(planner, options):
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [0], [2], destination_capacity=0.5)
    with pytest.raises(th.ExecutionError, match="planner must be greedy or fcost, without replan, where doors have"):
        Execution(scenario, planner, **options)


def test_a_door_may_be_blocked_and_an_exit_closed_meanwhile():
    """What is left of a door keeps its turns; a cell that was a destination stays a door."""
    area = th.Area("square", np.zeros((3, 9), bool), zones=[th.Zone("east", [8, 17, 26])])
    doors = [([4, 13, 22], 1), ([8, 17, 26], "1/2")]
    scenario = th.Scenario(area, [8, 17, 26], [1, 2, 3, 10, 11, 12], doors=doors)
    events = [Event(1, "barrier", cell=(4, 0)), Event(4, "close", cell=(8, 1)), Event(9, "clear", cell=(4, 0))]
    for planner in ("greedy", "fcost"):
        run = Trial(scenario, planner=planner, events=events).run()
        assert audit_run(run).is_clean and run.arrived.all()
        assert all(one.is_accepted for one in run.occurrences)
        last = run.arrival_step_of_robot.max()
        assert last >= 6 * 3  # with one exit closed two thirds of the flow are left


def test_robots_that_do_not_know_the_walls_keep_the_turns_of_doors():
    """Nobody can enter the second cell of the exit, which has walls around it; so the first one lets in all."""
    area = th.Area("square", [[0, 0, 0, 0, 0, 0, 1], [1, 1, 1, 1, 1, 0, 0], [0, 0, 0, 0, 1, 1, 1]])
    exits = [12, 13]
    scenario = th.Scenario(area, exits, [0, 1, 2, 3], corners="no-cut", doors=[(exits, "1/2")])
    assert scenario.schedule.cells.tolist() == [12]
    for planner in ("greedy", "fcost"):
        run = Trial(scenario, sensor=1, planner=planner).run()
        assert audit_run(run).is_clean and run.arrived.all()
        assert np.diff(np.sort(run.arrival_step_of_robot)).tolist() == [2, 2, 2]
