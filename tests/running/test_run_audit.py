"""Run audit: a run that is tampered with is found out, each kind of breach by its name."""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from trihex.kernels.codes import LATE
from trihex.running import ARRIVED, GOING, LEFT, Event, Occurrence, Trial, audit_run

EAST, SOUTH, WEST, NORTH = 1, 2, 3, 0
WAIT = 255


def run_of(scenario, rows, *occurrences, states=None, **changes):
    """Return a run in which robots do what `rows` say, a row for each step."""
    actions = np.array(rows, dtype=np.uint8).reshape(len(rows), -1)
    states = np.array([GOING] * actions.shape[1] if states is None else states, dtype=np.uint8)
    ended = np.where(states == ARRIVED, len(rows), -1)
    base = Trial(scenario).record()
    fields = dict(
        occurrences=occurrences, actions=actions, state_of_robot=states, ended=ended, touched=np.zeros((len(rows), 2))
    )
    return replace(base, **{**fields, **changes})


def kinds(run):
    return {conflict.kind for conflict in audit_run(run).conflicts} - {"arrival"}


def square(height, width, robots, destination=(0, 0), **rules):
    area = th.Area("square", np.zeros((height, width), dtype=bool))
    return th.Scenario(area, [destination], robots, **rules)


@pytest.mark.parametrize(
    ("robots", "rows", "kind"),
    [
        ([(1, 1), (3, 1)], [[EAST, WEST]], "cell"),
        ([(1, 1), (2, 1)], [[EAST, WAIT]], "cell"),
        ([(1, 1), (2, 1)], [[EAST, WEST]], "exchange"),
        ([(1, 1), (2, 1)], [[5, 6]], "crossing"),
        ([(1, 2)], [[SOUTH]], "barrier"),
    ],
)
def test_robots_that_meet_or_leave_the_area(robots, rows, kind):
    assert kinds(run_of(square(3, 5, robots), rows)) == {kind}


def test_robots_that_move_before_their_start_time():
    late = square(3, 5, [(2, 1), (4, 1)], start_times=[0, 2])
    assert kinds(run_of(late, [[WEST, WAIT], [WEST, WAIT], [WAIT, WEST]])) == set()
    (early,) = (c for c in audit_run(run_of(late, [[WEST, WAIT], [WEST, WEST]])).conflicts if c.kind == "start")
    assert str(early) == "step 2: robot 1 leaves (4, 1) before its start time, 2"


def test_a_barrier_counts_from_the_step_in_which_it_appears():
    scenario = square(3, 5, [(1, 1)])
    door = Occurrence(Event(2, "barrier", cell=(3, 1)), blocked=(8,))
    assert kinds(run_of(scenario, [[EAST], [EAST]], door)) == {"barrier"}
    assert kinds(run_of(scenario, [[WAIT], [EAST]], door)) == set()
    refused = Occurrence(Event(2, "barrier", cell=(3, 1)), refusal="no")
    assert kinds(run_of(scenario, [[EAST], [EAST]], refused)) == set()
    gone = Occurrence(Event(3, "clear", cell=(3, 1)), freed=(8,))
    assert kinds(run_of(scenario, [[EAST], [WAIT], [EAST]], door, gone)) == set()
    on_robot = Occurrence(Event(2, "barrier", cell=(2, 1)), blocked=(7,))
    assert kinds(run_of(scenario, [[EAST], [WAIT]], on_robot)) == {"barrier", "event"}


@pytest.mark.parametrize(("corners", "walls"), [("no-cut", 1), ("no-squeeze", 2)])
def test_corners_that_events_close(corners, walls):
    scenario = square(3, 5, [(1, 1)], corners=corners)
    door = Occurrence(Event(1, "barrier", cell=(2, 1)), blocked=(7, 11)[:walls])
    assert kinds(run_of(scenario, [[5]], door)) == {"corner"}
    assert kinds(run_of(scenario, [[5]])) == set()
    if walls == 2:
        assert kinds(run_of(scenario, [[5]], replace(door, blocked=(7,)))) == set()


def test_capacity_and_robots_that_go_on_or_vanish():
    scenario = square(3, 5, [(1, 0), (0, 1)], destination_capacity=1)
    both = run_of(scenario, [[WEST, NORTH]], states=[ARRIVED, ARRIVED])
    assert [str(c) for c in audit_run(both).conflicts] == [
        "step 1: robot 1 is one too many to enter destination (0, 0)"
    ]
    goes_on = run_of(scenario, [[WEST, WAIT], [EAST, WAIT]])
    assert "acts on after it has entered" in str(audit_run(goes_on).conflicts[0])
    vanishes = run_of(scenario, [[EAST, WAIT]], states=[ARRIVED, GOING])
    assert "is said to arrive, but is in (2, 0)" in str(audit_run(vanishes).conflicts[0])
    left = run_of(scenario, [[WAIT, WAIT]], states=[LEFT, GOING])
    assert kinds(left) == {"end"}


def test_who_could_arrive_must_and_who_is_late_must_stand():
    scenario = square(1, 5, [(2, 0)])
    left_behind = audit_run(run_of(scenario, [[WAIT]]))
    assert "ends in (2, 0), which is no destination, though it could reach one" in str(left_behind.conflicts[0])
    shut = Occurrence(Event(1, "barrier", cell=(1, 0)), blocked=(1,))
    assert audit_run(run_of(scenario, [[WAIT]], shut)).is_clean
    late = Occurrence(Event(1, "late", robot=0, steps=2))
    assert kinds(run_of(scenario, [[LATE], [EAST]], late)) == {"late"}
    assert kinds(run_of(scenario, [[LATE], [LATE], [EAST]], late)) == set()


def test_a_robot_must_not_join_where_one_stands():
    scenario = square(2, 5, [(2, 0)])
    trial = Trial(scenario, events=[Event(1, "join", cell=(3, 0))])
    run = trial.run()
    assert audit_run(run).is_clean
    event = Occurrence(Event(1, "join", cell=(2, 0)))
    moved = replace(run, robots=np.array([2, 2]), occurrences=(event,), actions=run.actions.copy())
    assert "event" in kinds(moved)
