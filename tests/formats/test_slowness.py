"""Slowness in files: scenarios, plans and starts keep it; tables of plans take it from their scenario."""

import numpy as np
import pandas
import pytest

import trihex as th
from tests.strategies import random_scenario, with_slowness
from trihex.areas import Frame
from trihex.errors import FormatError
from trihex.formats import Draft, draft_of, read_slowness, read_starts, write_scenario, write_starts
from trihex.viewer.document import document_of, draft_of_document

AREA = th.Area("hexagonal", [[0] * 5] * 3)
SLOW = th.Scenario(AREA, (4, 1), [(0, 0), (2, 1)], slowness=[1, 3])
TOML = 'destinations = [[0, 0]]\n[area]\nrows = ["......", "......"]\n[robots]\n'


def test_scenarios_and_plans_keep_it(tmp_path):
    for seed in range(310_000, 310_008):
        scenario = with_slowness(random_scenario(seed), seed)
        write_scenario(scenario, tmp_path / "s.toml")
        assert np.array_equal(th.read_scenario(tmp_path / "s.toml").slowness, scenario.slowness)
        plan = th.make_plan(scenario, "greedy")
        th.write_plan(plan, tmp_path / "p.npz")
        assert th.read_plan(tmp_path / "p.npz") == plan
        assert draft_of(scenario).complete() == scenario


def test_letters_cannot_carry_it():
    from trihex.formats.areas.letters import lost_in_letters

    assert lost_in_letters(SLOW) == ["slowness"]


def test_the_page_hands_it_on():
    header, arrays = document_of(draft_of(SLOW))
    assert header["slowness"] == [[7, 3]]
    assert draft_of_document(header, arrays).complete() == SLOW


def test_tables_take_it_from_the_scenario_if_its_robots_are_theirs(tmp_path):
    plan = th.make_plan(SLOW)
    for name in ("p.csv", "p.parquet"):
        th.write_plan(plan, tmp_path / name)
        assert np.array_equal(th.read_plan(tmp_path / name, SLOW).actions, plan.actions)
        assert th.audit_plan(th.read_plan(tmp_path / name, SLOW)).is_clean
    own = pandas.read_csv(tmp_path / "p.csv").query("robot == 1")
    assert own["step"].tolist() == [0, 3, 6] and own["time"].tolist() == [0, 30, 60]
    with pytest.raises(FormatError, match="robot 1 lacks step 1; here is step 3"):
        th.read_plan(tmp_path / "p.csv", SLOW.with_robots(SLOW.robots))
    slower = th.Scenario(AREA, (4, 1), [(0, 0), (2, 1)], slowness=[1, 2])
    with pytest.raises(
        FormatError, match=r"step must rise by 2, .* not by 3; .* another clock, other costs or slowness"
    ):
        th.read_plan(tmp_path / "p.csv", slower)


def test_a_column_of_starts_is_slowness_or_speed(tmp_path):
    path = tmp_path / "a.csv"
    for head, values, want in (
        ("x,y,slowness", (1, 3), [1, 3]),
        ("x,y,start,slowness", ("4,1", "0,2"), [1, 2]),
        ("x,y,speed", (1.4, 0.5), [1, 3]),
        ("x,y,start,speed", ("4,0.5", "0,1.4"), [3, 1]),
    ):
        path.write_text(f"{head}\n0,0,{values[0]}\n3,1,{values[1]}\r\n")
        assert read_starts(path, AREA).tolist() == [0, 8]
        robots, told = read_starts(path, AREA), read_slowness(path)
        assert Draft(AREA, np.array([4]), robots, slowness=told).complete().slowness.tolist() == want
        (tmp_path / "a.toml").write_text(TOML + 'file = "a.csv"')
        assert th.read_scenario(tmp_path / "a.toml").slowness.tolist() == want
        write_starts(AREA, robots, tmp_path / "b.csv", start_times=th.read_start_times(path), slowness=told)
        assert (tmp_path / "b.csv").read_text() == path.read_text().replace("\r", "")
    path.write_text("x,y\n0,0\n")
    assert read_slowness(path) is None


def test_in_metres_the_speed_told_is_that_of_slowness_one():
    hall = th.Area("hexagonal", [[0] * 5] * 3, frame=Frame(cell_size=0.5))
    draft = Draft(hall, np.array([4]), np.array([0, 1]), slowness=np.array([1.5, 1.0]))
    assert draft.paced().outputs == {"speed": 1.5}
    finer = Draft(hall, np.array([4]), np.array([0, 1]), slowness=np.array([1.5, 1.0]), outputs={"speed": 3.0})
    assert finer.paced().outputs == {"speed": 3.0}
    scenarios = draft.paced().complete(), finer.paced().complete()
    assert [scenario.slowness.tolist() for scenario in scenarios] == [[1, 2], [2, 3]]
    assert [scenario.following for scenario in scenarios] == ["forbid", "forbid"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y,slowness\n0,0,1\n1,0,0\n", "line 3: slowness must be a whole number from 1, not '0'"),
        ("x,y,slowness\n0,0,1.5\n", "line 2: slowness must be a whole number from 1, not '1.5'"),
        ("x,y,speed\n0,0,nan\n", "line 2: speed must be a number above 0, not 'nan'"),
        ("x,y,speed\n0,0,fast\n", "line 2: speed must be a number above 0, not 'fast'"),
        ("x,y,slowness\n0,0\n", r"line 2: there must be 3 columns \(x,y,slowness\), not 2"),
        ("x,y,slowness,speed\n0,0,1,1\n", "x,y"),
    ],
)
def test_what_is_wrong_with_the_column_is_told(tmp_path, text, message):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(FormatError, match=message):
        Draft(AREA, robots=read_starts(tmp_path / "a.csv", AREA), slowness=read_slowness(tmp_path / "a.csv"))
