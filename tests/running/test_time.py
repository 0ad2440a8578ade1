"""Runs where moves last as long as they cost, or nobody follows before a cell is left."""

from dataclasses import replace
from hashlib import sha256
from itertools import product

import numpy as np
import pytest

import trihex as th
from tests.oracles.run_owners import breaches
from tests.running.random_runs import random_trial
from tests.sweeps import swept
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.plans import plan_from_lists
from trihex.running import ARRIVED, BROKEN, GOING, LEFT, Event, Execution, Trial, audit_run, resume_trial

EAST = 1
TIMES = list(product(("steps", "costs"), ("allow", "forbid")))
SHARES = 4


def row(cells, robots, time=("costs", "allow"), destination=None, **rules):
    """Return a corridor of squares with the destination at its east end; a move lasts 5 ticks by the clock of costs."""
    area = th.Area("square", np.zeros((1, cells), dtype=bool))
    goal = cells - 1 if destination is None else destination
    return th.Scenario(area, [(goal, 0)], robots, clock=time[0], following=time[1], **rules)


def steps(execution, count, late=()):
    """Return the actions of each robot, a list for each step."""
    return [execution.step(late).action_of_robot.tolist() for _ in range(count)]


def test_runs_in_steps_are_what_they_were_before_there_was_a_clock():
    """The digest was made by the code before that."""
    digest = sha256()
    for seed in range(40):
        run = random_trial(seed).run()
        names = "robots joined ended state_of_robot actions known_since cut_off_since touched"
        for name in names.split():
            digest.update(np.ascontiguousarray(getattr(run, name)).tobytes())
        digest.update(repr([(one.event, one.refusal, one.changes) for one in run.occurrences]).encode())
    assert digest.hexdigest()[:16] == "2abf034db224bad6"


@pytest.mark.parametrize("share", range(SHARES))
@pytest.mark.parametrize("time", TIMES[1:])
def test_every_run_ends_safely_and_leaves_nobody_behind(share, time):
    for seed in range(share, swept(100, 40), SHARES):
        run = random_trial(seed, time, has_start_times=seed % 3 == 0).run(most_steps=20_000)
        assert run.steps < 20_000, seed
        audit = audit_run(run)
        assert audit.is_clean, (seed, [str(conflict) for conflict in audit.conflicts])
        assert breaches(run) == [], seed
        still_going = np.flatnonzero(run.state_of_robot == GOING)
        assert np.array_equal(np.flatnonzero(run.cut_off_since >= 0), still_going), seed
        if time[0] == "costs":  # t_r is how long a robot has been on its way
            assert np.array_equal(run.time_of_robot[run.arrived], (run.ended - run.joined)[run.arrived]), seed


def test_robots_that_are_entering_the_last_destination_end_their_move_though_it_closes():
    """There is nothing to be planned for anybody then."""
    run = random_trial(220, ("costs", "allow"), sides=(3, 10)).run()
    assert audit_run(run).is_clean
    assert breaches(run) == []


def test_a_robot_may_join_where_another_begins_to_come_at_once():
    """Who joins goes on in the same tick, and the other one follows it."""
    run = random_trial(291, ("costs", "allow"), sides=(3, 10)).run()
    assert [(one.event.kind, one.event.step, one.is_accepted) for one in run.occurrences[:1]] == [("join", 1, True)]
    assert audit_run(run).conflicts == ()
    assert breaches(run) == []


@pytest.mark.parametrize("time", TIMES[1:])
def test_a_run_that_stops_between_centres_goes_on_as_if_it_had_not(time, tmp_path):
    for seed in range(1, swept(60, 12)):
        if seed % 5 == 0:  # it follows plans, and makes a new one after a stop
            continue
        run, again = random_trial(seed, time).run(), random_trial(seed, time)
        stopped = again.run(most_steps=3 + seed)
        th.write_run(stopped, tmp_path / "run.npz")
        assert th.read_run(tmp_path / "run.npz") == stopped
        events = [occurrence.event for occurrence in run.occurrences][len(stopped.occurrences) :]
        resumed = resume_trial(stopped, events, aside=again.execution.aside)
        assert resumed.run() == run == again.run(), seed


@pytest.mark.parametrize("time", TIMES[1:])
def test_an_execution_goes_on_from_a_state_between_centres(time):
    for seed in range(10):
        scenario = random_trial(seed, time).scenario
        execution = Execution(scenario)
        steps(execution, 3 + seed)
        state = execution.state()
        rest = steps(execution, 25)
        for other in (Execution(scenario), execution):
            other.restore(state)
            assert steps(other, 25) == rest, seed


@pytest.mark.parametrize("planner", ["greedy", "fcost"])
def test_robots_in_a_row_keep_their_headway(planner):
    arrivals = {}
    for time in TIMES:
        run = Trial(row(5, [(3, 0), (2, 0), (1, 0)], time), planner).run()
        arrivals[time] = run.ended.tolist()
        assert run.time_of_robot.tolist() == [10 * t if time[0] == "steps" else t for t in run.ended.tolist()]
    assert arrivals == {
        ("steps", "allow"): [1, 2, 3],
        ("steps", "forbid"): [1, 3, 5],
        ("costs", "allow"): [5, 10, 15],
        ("costs", "forbid"): [5, 15, 25],
    }


def test_only_robots_at_a_centre_are_late():
    execution = Execution(row(4, [(1, 0)]))
    assert steps(execution, 1, late=[0]) == [[WAIT]]
    assert steps(execution, 5, late=[]) == [[EAST]] + [[UNDERWAY]] * 4
    assert steps(execution, 1) == [[EAST]]
    assert steps(execution, 4, late=[0]) == [[UNDERWAY]] * 4 and execution.is_over
    events = [Event(1, "late", robot=0, steps=2), Event(4, "late", robot=0, steps=6)]
    run = Trial(row(4, [(1, 0)]), events=events).run()
    assert run.actions[:, 0].tolist() == [LATE] * 2 + [EAST] + [UNDERWAY] * 4 + [LATE] * 2 + [EAST] + [UNDERWAY] * 4
    assert audit_run(run).is_clean and breaches(run) == []


@pytest.mark.parametrize(("following", "after_three"), [("allow", [1]), ("forbid", [0, 1])])
def test_no_barrier_and_no_robot_comes_into_a_cell_that_a_robot_owns(following, after_three):
    execution = Execution(row(4, [(0, 0)], ("costs", following)))
    for done, owned in ((2, [0, 1]), (1, after_three)):
        steps(execution, done)
        for cell in (0, 1):
            other = Execution(execution.scenario)
            other.restore(execution.state())
            verb = "leaves" if cell == 0 else "enters"
            if cell in owned:
                with pytest.raises(th.ExecutionError, match=rf"robot 0 {verb} \({cell}, 0\)"):
                    other.observe(blocked=[cell])
                with pytest.raises(th.ExecutionError, match=rf"on an empty cell; robot 0 {verb} \({cell}, 0\)"):
                    other.join(cell)
            else:
                assert other.join(cell) == 1
    event = Event(3, "barrier", cell=(0, 0))
    assert Trial(row(4, [(0, 0)]), events=[event]).run().occurrences[0].refusal == "robot 0 leaves (0, 0)"


@pytest.mark.parametrize(("following", "blocked"), [("allow", [1]), ("forbid", [0, 1])])
def test_who_breaks_down_under_way_blocks_what_it_enters_and_where_nobody_follows_what_it_leaves(following, blocked):
    run = Trial(row(5, [(0, 0)], ("costs", following)), events=[Event(3, "break", robot=0)]).run()
    assert list(run.occurrences[0].blocked) == blocked and run.state_of_robot.tolist() == [BROKEN]
    assert audit_run(run).is_clean


def test_who_enters_a_destination_does_not_break_down_but_can_leave():
    execution = Execution(row(3, [(1, 0), (0, 0)], ("costs", "forbid"), destination_capacity=1))
    steps(execution, 2)
    with pytest.raises(th.ExecutionError, match=r"robot 0 cannot break down while it enters the destination \(2, 0\)"):
        execution.break_down(0)
    execution.leave(0)
    assert execution.state_of_robot.tolist() == [LEFT, GOING]
    assert steps(execution, 6)[::5] == [[WAIT, EAST]] * 2  # neither the cell nor the destination is anybody's any more


def test_a_destination_that_closes_takes_in_who_enters_it_and_nobody_else_until_then():
    for following in ("allow", "forbid"):
        events = [Event(3, "move", cell=(2, 0), to=(4, 0))]
        run = Trial(row(5, [(1, 0), (0, 0)], ("costs", following), 2), events=events).run()
        assert run.state_of_robot.tolist() == [ARRIVED, ARRIVED] and run.ended[0] == 5
        assert audit_run(run).is_clean and breaches(run) == []
    barred = Trial(row(5, [(1, 0)], destination=2), events=[events[0], Event(4, "barrier", cell=(2, 0))]).run()
    assert barred.occurrences[1].refusal == "robot 0 enters (2, 0)" and barred.ended.tolist() == [5]


def test_a_destination_that_opens_takes_in_who_is_on_the_way_into_that_cell():
    run = Trial(row(5, [(1, 0)]), events=[Event(3, "open", cell=(2, 0))]).run()
    assert run.ended.tolist() == [5] and audit_run(run).is_clean and breaches(run) == []


def test_robots_are_put_at_centres_where_nobody_else_is():
    execution = Execution(row(6, [(0, 0), (3, 0)]))
    steps(execution, 2)
    for cell, owner in ((4, "enters"), (3, "leaves")):
        assert owner in execution.fleet.words_of_owner(cell)
        with pytest.raises(th.ExecutionError, match="distinct free cells"):
            execution.place({0: cell})
    execution.place({1: (3, 0)})
    assert execution.is_under_way.tolist() == [True, False] and execution.fleet.words_of_owner(4) == ""
    assert steps(execution, 1) == [[UNDERWAY, EAST]]


@pytest.mark.parametrize("planner", ["greedy", "fcost", "astar"])
@pytest.mark.parametrize("time", TIMES[1:])
def test_delayed_plans_stay_safe_and_all_arrive_who_do_in_the_plan(planner, time):
    for seed in range(swept(40, 8)):
        plan = th.make_plan(random_trial(seed, time).scenario, planner)
        order = th.make_passing_order(plan)
        for delay in (0.0, 0.1, 0.4):
            run = order.run(delay=delay, seed=seed, most_steps=50_000)
            assert audit_run(run).is_clean and breaches(run) == [], seed
            assert np.array_equal(run.arrived, plan.arrived), seed
            assert run.distance_of_robot.tolist() == plan.distance_of_robot.tolist(), seed


def test_nobody_follows_one_that_could_still_be_late():
    """One leaves by a short move; who follows by a long one begins a tick earlier in the plan, but waits here."""
    area = th.Area("square", np.zeros((2, 2), dtype=bool))
    scenario = th.Scenario(area, [(0, 0)], [(1, 0), (0, 1)], clock="costs")
    plan = plan_from_lists(scenario, [[WAIT, 3], [4, 3]])
    assert th.audit_plan(plan).is_clean
    follower = th.make_passing_order(plan).follow()
    assert [follower.step([0]).tolist() for _ in range(3)] == [[WAIT] * 2] * 3
    assert follower.step().tolist() == [3, 4]


def test_rings_of_moves_that_last_differently_are_refused():
    """Three cells around a vertex turn by a long move and two short ones, all of one middle."""
    area = th.Area("square", np.zeros((3, 3), dtype=bool))
    ring = [(0, 0), (1, 0), (0, 1)]
    scenario = th.Scenario(area, [(2, 2)], ring, clock="costs")
    alike = plan_from_lists(scenario.with_robots([(0, 0), (1, 0), (1, 1), (0, 1)]), [[1], [2], [3], [0]])
    assert th.make_passing_order(alike).follow().step().tolist() == [1, 2, 3, 0]
    differ = plan_from_lists(scenario, [[WAIT, 1], [6], [WAIT, 0]])
    with pytest.raises(th.PlanError, match="robots in a ring make moves that last differently"):
        th.make_passing_order(differ)


def test_plans_are_made_anew_where_moves_last():
    scenario = random_trial(3, ("costs", "allow")).scenario
    execution = Execution(scenario, replan=True)
    steps(execution, 3)
    free = np.flatnonzero(~scenario.area.barriers.reshape(-1))
    taken = [execution.cells_owned, scenario.destinations]
    execution.observe(blocked=np.setdiff1d(free, np.concatenate([own.reshape(-1) for own in taken]))[:1])
    while not execution.is_over:
        execution.step()
    assert execution.replanner.plans == 2


def kinds(run, **changes):
    return {conflict.kind for conflict in audit_run(replace(run, **changes)).conflicts}


def test_the_judge_finds_what_is_tampered_with():
    run = Trial(row(5, [(1, 0), (0, 0)])).run()
    assert audit_run(run).is_clean and breaches(run) == []
    early = run.actions.copy()
    early[4:, 1] = np.append(run.actions[5:, 1], WAIT)  # the second robot begins its second move a tick too soon
    assert kinds(run, actions=early) >= {"time"} and breaches(replace(run, actions=early))
    forbids = replace(run.scenario, following="forbid")
    assert kinds(run, scenario=forbids) == {"cell"} and breaches(replace(run, scenario=forbids))
    vanishes = run.ended - [0, 5]
    assert "arrival" in kinds(run, ended=vanishes)
    late = replace(run.scenario, destination_capacity=1)
    assert kinds(run, scenario=late) == set()
    behind = Trial(row(3, [(1, 0), (0, 0)], ("costs", "forbid"))).run()
    assert kinds(behind) == set() and kinds(behind, state_of_robot=np.array([ARRIVED, LEFT])) == {"end", "arrival"}


def test_a_table_has_a_row_for_each_action_at_the_tick_at_which_it_ends(tmp_path):
    run = Trial(row(4, [(1, 0)]), events=[Event(1, "late", robot=0, steps=1)]).run()
    th.write_plan(run, tmp_path / "run.csv")
    assert (tmp_path / "run.csv").read_text().splitlines()[1:] == [
        "0,0,1,0,start,0",
        "0,1,1,0,late,1",
        "0,6,2,0,E,6",
        "0,11,3,0,E,11",
    ]
