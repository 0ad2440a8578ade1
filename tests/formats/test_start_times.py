"""Start times in files: scenarios, plans, runs and CSV of starts keep them; what has none is as it was."""

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario, with_start_times
from trihex.areas import Frame
from trihex.formats import draft_of, read_draft, read_start_times, read_starts, write_scenario, write_starts

AREA = th.Area("hexagonal", [[0] * 5] * 3)
LATE = th.Scenario(AREA, (4, 1), [(0, 0), (2, 1)], start_times=[0, 3])
ONCE = th.Scenario(AREA, (4, 1), [(0, 0), (2, 1)])
TOML = 'destinations = [[0, 0]]\n[area]\nrows = ["......", "......"]\n[robots]\n'


def test_scenarios_plans_and_runs_keep_them(tmp_path):
    for seed in range(280_000, 280_012):
        scenario = with_start_times(random_scenario(seed), seed)
        write_scenario(scenario, tmp_path / "s.toml")
        assert np.array_equal(th.read_scenario(tmp_path / "s.toml").start_times, scenario.start_times)
        plan = th.make_plan(scenario)
        th.write_plan(plan, tmp_path / "p.npz")
        assert th.read_plan(tmp_path / "p.npz") == plan
        assert draft_of(scenario).complete() == scenario
    run = th.Trial(LATE).run()
    th.write_run(run, tmp_path / "r.npz")
    assert th.read_run(tmp_path / "r.npz").scenario == LATE


def test_files_of_those_who_begin_at_once_say_nothing_of_it(tmp_path):
    for scenario, has in ((ONCE, False), (LATE, True)):
        write_scenario(scenario, tmp_path / "s.toml")
        assert ("start_times" in (tmp_path / "s.toml").read_text()) == has
        th.write_plan(th.make_plan(scenario), tmp_path / "p.npz")
        with np.load(tmp_path / "p.npz") as entries:
            assert ("start_times" in entries) == has


def test_plans_as_tables_take_them_from_the_scenario_if_its_robots_are_theirs(tmp_path):
    th.write_plan(th.make_plan(ONCE), tmp_path / "p.csv")
    early = th.audit_plan(th.read_plan(tmp_path / "p.csv", LATE))
    assert [str(one) for one in early.conflicts] == ["step 1: robot 1 leaves (2, 1) before its start time, 3"]
    others = LATE.with_robots([(1, 1)])
    assert th.audit_plan(th.read_plan(tmp_path / "p.csv", others)).is_clean


def test_a_column_of_starts_is_in_seconds_in_metres_and_else_in_steps(tmp_path):
    framed = th.Area("hexagonal", [[0] * 5] * 3, frame=Frame(cell_size=0.5))
    for area, want in ((AREA, [0, 3, 2]), (framed, [0, 6, 3])):
        path = tmp_path / "a.csv"
        path.write_text("x,y,start\n0,0,0\n3,1,3\n2,1,1.5\r\n")
        assert read_starts(path, area).tolist() == [0, 8, 7] and read_start_times(path).tolist() == [0, 3, 1.5]
        (tmp_path / "a.toml").write_text(TOML + 'file = "a.csv"')
        write_starts(area, read_starts(path, area), tmp_path / "b.csv", start_times=read_start_times(path))
        assert (tmp_path / "b.csv").read_text() == "x,y,start\n0,0,0\n3,1,3\n2,1,1.5\n"
        assert th.areas.start_times_of(area, read_start_times(path)).tolist() == want
    assert th.read_scenario(tmp_path / "a.toml").start_times.tolist() == [0, 3, 2]
    (tmp_path / "c.csv").write_text("x_metres,y_metres,start\n0.6,-0.6,4\n")
    assert read_starts(tmp_path / "c.csv", framed).size == 1 and read_start_times(tmp_path / "c.csv").tolist() == [4]
    (tmp_path / "d.csv").write_text("x,y\n0,0\n")
    assert read_start_times(tmp_path / "d.csv") is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y,start\n0,0,1\n1,0,-2\n", "line 3: start must be a number from 0, not '-2'"),
        ("x,y,start\n0,0,soon\n", "line 2: start must be a number from 0, not 'soon'"),
        ("x,y,start\n0,0,inf\n", "line 2: start must be a number from 0, not 'inf'"),
        ("x,y,start\n0,0\n", r"line 2: there must be 3 columns \(x,y,start\), not 2"),
        ("x,y,start\n0,0,1\n\n2,0,1\n", r"line 3: there must be 3 columns \(x,y,start\), not 1"),
    ],
)
def test_bad_columns_name_the_line(tmp_path, text, message):
    path = tmp_path / "a.csv"
    path.write_text(text)
    for read in (read_start_times, lambda path: read_starts(path, AREA)):
        if read is read_start_times or "columns" in message:
            with pytest.raises(th.FormatError, match=message):
                read(path)


def test_scenario_files_list_steps_or_draw_seconds(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text(TOML + "random = 4\nseed = 2\nstart_times = [0, 1, 2, 3]")
    assert th.read_scenario(path).start_times.tolist() == [0, 1, 2, 3]
    path.write_text(TOML + 'random = 4\nseed = 2\nstart_times = "uniform:5,9"')
    scenario = th.read_scenario(path)
    assert np.array_equal(scenario.start_times, th.random_start_times(scenario.area, 4, "uniform:5,9", 2))
    path.write_text(TOML.replace("[robots]", "[area.frame]\ncell_size = 0.5\n[robots]") + "random = 4\nseed = 2\n")
    path.write_text(path.read_text() + 'start_times = "constant:3"\n[outputs]\nspeed = 2.0\n')
    assert th.read_scenario(path).start_times.tolist() == [12] * 4


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("[0, -1]", "robots.start_times: must be a list of whole numbers of steps, or a distribution in quotes, not"),
        ("[0.5]", "robots.start_times: must be a list of whole numbers of steps"),
        ("3", "robots.start_times: must be a list of whole numbers of steps"),
        ('"late"', "robots.start_times: must be drawn as one of constant:time, .*, not 'late'"),
    ],
)
def test_bad_values_in_scenario_files(tmp_path, value, message):
    path = tmp_path / "s.toml"
    path.write_text(f"{TOML}random = 2\nstart_times = {value}")
    with pytest.raises(th.FormatError, match=message):
        read_draft(path)
    path.write_text(f"{TOML}random = 2\nstart_times = [1]")
    with pytest.raises(th.ScenarioError, match="start_times must be one for each of 2 robots, not 1"):
        th.read_scenario(path)


def test_letters_cannot_carry_them():
    from trihex.formats.areas.letters import lost_in_letters

    assert lost_in_letters(LATE) == ["start times"] and lost_in_letters(ONCE) == []
