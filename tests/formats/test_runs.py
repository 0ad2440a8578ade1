"""Runs and events as files: what is written is read, what is damaged is refused in one line."""

import numpy as np
import pytest

import trihex as th
from tests.running.random_runs import random_events, random_trial
from tests.strategies import random_scenario
from trihex.areas import Frame
from trihex.running import Event, resume_trial


def test_runs_come_back_whole_and_with_the_same_bytes(tmp_path):
    for seed in range(20):
        run = random_trial(seed).run()
        th.write_run(run, tmp_path / "one.npz")
        th.write_run(run, tmp_path / "two.npz")
        assert th.read_run(tmp_path / "one.npz") == run, seed
        assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()


def test_a_run_from_a_file_goes_on_as_if_it_had_never_stopped(tmp_path):
    whole = random_trial(7).run()
    stopped = random_trial(7).run(most_steps=5)
    assert stopped.steps == 5 < whole.steps
    th.write_run(stopped, tmp_path / "run.npz")
    events = [occurrence.event for occurrence in whole.occurrences][len(stopped.occurrences) :]
    run = th.read_run(tmp_path / "run.npz")
    assert resume_trial(run, events, aside=random_trial(7).execution.aside).run() == whole


def test_damaged_runs_are_refused(tmp_path):
    area = th.Area("square", np.zeros((2, 5), dtype=bool))
    run = th.Trial(th.Scenario(area, [(4, 0)], [(0, 0)]), events=[Event(2, "barrier", cell=(3, 1))]).run()
    path = tmp_path / "run.npz"

    def damaged(**changes):
        th.write_run(run, path)
        with np.load(path) as file:
            arrays = dict(file)
        np.savez(path, **{**arrays, **changes})
        with pytest.raises(th.TrihexError) as caught:
            th.read_run(path)
        assert "\n" not in str(caught.value)
        return str(caught.value)

    assert "version must be 1" in damaged(version=2)
    assert "leaves the area at step 1" in damaged(run_actions=np.full_like(run.actions, 3))
    assert "actions must be directions" in damaged(run_actions=np.full_like(run.actions, 9))
    assert "every robot must have" in damaged(joined=np.zeros(2, dtype=np.int64))
    assert "states be 0..3" in damaged(states=np.array([7], dtype=np.uint8))
    assert "the first robots must be those" in damaged(starts=np.array([1]))
    assert "no event of kind 40" in damaged(events=np.array([[2, 40, 3, 1, 0, 0, 0, 0]]))
    assert "changes must name an event" in damaged(changes=np.array([[0, 0, 99]]))
    assert "do not fit each other" in damaged(refusals=np.array([10, 10], dtype=np.uint8))
    assert "a number for each cell" in damaged(known_since=np.zeros((1, 1), dtype=np.int32))
    th.write_run(run, path)
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(th.FormatError, match=r"no whole \.npz file"):
        th.read_run(path)
    th.write_plan(th.make_plan(run.scenario), path)
    with pytest.raises(th.FormatError, match="a run must have the entry"):
        th.read_run(path)


def test_a_run_from_before_there_were_zones_is_read(tmp_path):
    area = th.Area("square", np.zeros((2, 5), dtype=bool))
    events = [Event(2, "barrier", cell=(3, 1)), Event(3, "clear", cell=(3, 1))]
    run = th.Trial(th.Scenario(area, [(4, 0)], [(0, 0)]), events=events).run()
    th.write_run(run, tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz") as file:
        arrays = {name: own for name, own in file.items() if name not in ("zones_of_events", "metres_of_events")}
    assert not {"zone_names", "zone_cells"} & set(arrays)
    np.savez(tmp_path / "run.npz", **arrays)
    assert th.read_run(tmp_path / "run.npz") == run


def test_events_come_back_from_csv(tmp_path):
    rng = np.random.default_rng(3)
    events = tuple(random_events(rng, random_scenario(3, sides=(5, 9)), 60))
    th.write_events(events, tmp_path / "events.csv")
    assert th.read_events(tmp_path / "events.csv") == events


def test_events_as_people_write_them(tmp_path):
    path = tmp_path / "events.csv"
    path.write_text("event, step, x, y\nbarrier, 5, 3, 4\n\n clear ,9,3,4\n")
    assert th.read_events(path) == (Event(5, "barrier", (3, 4)), Event(9, "clear", (3, 4)))
    path = tmp_path / "events.toml"
    path.write_text(
        '[[event]]\nstep = 2\nevent = "move"\ncell = [1, 2]\nto = [3, 4]\n'
        '[[event]]\nstep = 3\nevent = "late"\nrobot = 0\nsteps = 4\n'
    )
    assert th.read_events(path) == (Event(2, "move", (1, 2), (3, 4)), Event(3, "late", robot=0, steps=4))
    door = Event(20, "close", zone='the "north" door, left')
    path.write_text("[[event]]\nstep = 20\nevent = 'close'\nzone = 'the \"north\" door, left'\n")
    assert th.read_events(path) == (door,)
    path = tmp_path / "events.csv"
    path.write_text('step,event,zone\n20,close,"the ""north"" door, left"\n')
    assert th.read_events(path) == (door,)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("step,event,z\n", "line 1: a column must be one of"),
        ("step,x,y\n", "line 1: the header must have step or second, and event, and each column once"),
        ("step,event\n1\n", "line 2: there must be 2 columns, not 1"),
        ("step,event,x,y\n1,barier,1,2\n", "line 2: event must be one of .* did you mean 'barrier'"),
        ("step,event,x,y\none,barrier,1,2\n", "line 2: step must be a whole number, not 'one'"),
        ("step,event,x,y\n1,barrier,1,\n", "line 2: x and y must come together"),
        ("step,event,x,y\n1,leave,1,2\n", "line 2: event 'leave' at step 1 takes robot"),
        ("step,event,x,y\n,barrier,1,2\n", "line 2: step is missing"),
        ("step,event,zone\n1,close,\x7f\n", "line 2: event 'close' at step 1: name of a zone must be a line"),
        ("step,event,zone\n1,close," + 200_000 * "x", "is no CSV: field larger than field limit"),
        ("step,second,event,x,y\n,,barrier,1,2\n", "line 2: step or second is missing"),
        ("step,second,event,x,y\n1,1.0,barrier,1,2\n", "line 2: there must be only one of step and second"),
        ("second,event,x,y\nsoon,barrier,1,2\n", "line 2: second must be a number, not 'soon'"),
        ("second,event,x,y\n20,barrier,1,2\n", "line 2: second needs an area in metres, .* in place of 20"),
        ("step,event,x,y\n0,barrier,1,2\n", "line 2: step of an event must be a whole number from 1"),
    ],
)
def test_wrong_csv_is_refused_with_its_line(tmp_path, text, why):
    path = tmp_path / "events.csv"
    path.write_text(text)
    with pytest.raises(th.FormatError, match=why):
        th.read_events(path)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('[[event]]\nstep = 1\nevent = "jon"\n', "event.0.event: .*did you mean 'join'"),
        ("[[events]]\nstep = 1\n", "events: there is no such key; did you mean 'event'"),
        ('[[event]]\nstep = 1\nevent = "join"\ncell = [1]\n', "event.0.cell"),
        ('[[event]]\nevent = "join"\ncell = [1, 2]\n', "event.0: must have one of step, second"),
        ('[[event]]\nstep = 1\nsecond = 1\nevent = "join"\n', "event.0: must have only one of step, second"),
        ('[[event]]\nsecond = 2.5\nevent = "join"\ncell = [1, 2]\n', "event.0: second needs an area in metres"),
        ('[[event]]\nstep = 1\nevent = "join"\n', "event.0: event 'join' at step 1 takes cell"),
    ],
)
def test_wrong_toml_is_refused_with_its_key(tmp_path, text, why):
    path = tmp_path / "events.toml"
    path.write_text(text)
    with pytest.raises(th.FormatError, match=why):
        th.read_events(path)


def test_of_many_mistakes_twenty_are_told_and_the_others_counted(tmp_path):
    (tmp_path / "events.toml").write_text('[[event]]\nstep = 1\nevent = "jon"\n' * 33)
    with pytest.raises(th.FormatError) as caught:
        th.read_events(tmp_path / "events.toml")
    lines = str(caught.value).splitlines()
    assert len(lines) == 21 and "event.19.event" in lines[19] and lines[20].endswith("and 13 more mistakes")


def test_seconds_are_the_first_step_that_begins_then_or_later(tmp_path):
    area = th.Area("square", np.zeros((3, 3), dtype=bool), frame=Frame(0.3))  # a step lasts 0.3 * sqrt(2) seconds
    lasts = 0.3 * 2**0.5
    seconds = [0, 0.001, lasts, lasts + 0.001, 20]
    steps = [1, 2, 2, 3, 49]  # step 48 begins at 19.94, step 49 at 20.36
    rows = "".join(f"{second!r},close,1,1\n" for second in seconds)
    (tmp_path / "e.csv").write_text(f"second,event,x,y\n{rows}")
    assert [event.step for event in th.read_events(tmp_path / "e.csv", area)] == steps
    (tmp_path / "e.csv").write_text("second,step,event,x,y\n20,,open,1,1\n,20,close,1,1\n")
    assert [event.step for event in th.read_events(tmp_path / "e.csv", area, speed=0.5, turn_time=0.4)] == [18, 20]
    (tmp_path / "e.toml").write_text('[[event]]\nsecond = 20\nevent = "close"\ncell = [1, 1]\n')
    assert th.read_events(tmp_path / "e.toml", area) == (Event(49, "close", (1, 1)),)
    edges = th.Area(th.Tessellation("square", "edge"), np.zeros((3, 3), dtype=bool), frame=Frame(0.3))
    for number in range(1, 2000):  # the beginning of a step, however it is rounded, is that step
        (tmp_path / "e.csv").write_text(f"second,event,x,y\n{number * 3 / 10!r},close,1,1\n")
        assert th.read_events(tmp_path / "e.csv", edges)[0].step == number + 1
    for second in (-1, "nan", 1e9):
        (tmp_path / "e.csv").write_text(f"second,event,x,y\n{second},close,1,1\n")
        with pytest.raises(th.FormatError, match="line 2: second must be from 0 to 424264, not"):
            th.read_events(tmp_path / "e.csv", area)
    with pytest.raises(th.TrihexError, match="area must be an Area"):
        th.read_events(tmp_path / "e.csv", "area")


def test_events_of_another_kind_of_file(tmp_path):
    with pytest.raises(th.FormatError, match=r"suffix of events must be one of \.csv, \.toml"):
        th.read_events(tmp_path / "events.json")
