"""Scenario files: what is written is read again, and every mistake is told at once."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from tests.formats.strategies import FRAMES, NAMES, scenarios
from trihex import (
    Area,
    FormatError,
    Scenario,
    ScenarioError,
    Tessellation,
    random_robots,
    read_scenario,
    write_scenario,
)
from trihex.formats import read_draft, read_starts, write_starts


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scenarios")


@settings(deadline=None, max_examples=50)
@given(scenario=scenarios(), name=NAMES, frame=st.none() | FRAMES)
def test_toml_round_trip(folder, scenario, name, frame):
    scenario = replace(scenario, area=replace(scenario.area, name=name or "world", frame=frame))
    path = folder / "world.toml"
    write_scenario(scenario, path)
    assert read_scenario(path) == scenario


def test_planner_and_its_options_are_kept(tmp_path):
    scenario = Scenario(Area("square", [[0, 0]]), [(0, 0)])
    write_scenario(scenario, tmp_path / "w.toml", planner="fcost", planner_options={"estimate": "paper", "rounds": 3})
    draft = read_draft(tmp_path / "w.toml")
    assert (draft.planner, draft.planner_options) == ("fcost", {"estimate": "paper", "rounds": 3})


def test_a_scenario_of_other_files(tmp_path):
    """Paths are relative to the file; the letters bring a destination."""
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "yard.txt").write_text("D.B\na..\n")
    (tmp_path / "starts.csv").write_text("x,y\n2,1\n1,0\n")
    path = tmp_path / "s.toml"
    path.write_text(
        '[area]\npath = "maps/yard.txt"\ntessellation = "square"\ncosts = "euclidean"\n'
        '[robots]\nfile = "starts.csv"\n[rules]\ncorners = "no-cut"\n'
    )
    scenario = read_scenario(path)
    assert scenario.area == Area(Tessellation("square", costs="euclidean"), [[0, 0, 1], [0, 0, 0]], "yard")
    assert scenario.destinations.tolist() == [0]
    assert scenario.robots.tolist() == [5, 1]
    assert (scenario.waiting_cost, scenario.corners) == (1000, "no-cut")
    assert read_scenario(path, "triangular").area.tessellation == Tessellation("triangular", costs="euclidean")


def test_robots_of_the_file_come_before_those_of_the_letters(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('destinations = [[1, 0]]\n[area]\nrows = ["D.", "a."]\n[robots]\ncells = []\n')
    scenario = read_scenario(path)
    assert scenario.destinations.tolist() == [1]
    assert scenario.robot_count == 0


def test_random_robots_stand_beside_the_destinations(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('destinations = [[1, 0]]\n[area]\nrows = ["....", "...."]\n[robots]\nrandom = 7\nseed = 3\n')
    scenario = read_scenario(path)
    assert scenario.robots.tolist() == random_robots(scenario.area, 7, 3, avoid=[(1, 0)]).tolist()
    assert scenario.seed == 3
    path.write_text(path.read_text().replace("7", "8"))
    with pytest.raises(ScenarioError, match="at most the number of free cells, 7, not 8"):
        read_scenario(path)


ALL_WRONG = """
destinations = [[1, 2, 3], ["a", 4]]
colour = "red"
planner = "fcost"
[area]
rows = ["..", ".."]
path = "x.map"
tesselation = "hexagonal"
neighbourhood = "edgy"
costs = 3
[rules]
waiting_cost = -3
crossing = "forbit"
destination_capacity = 0
[robots]
cells = [[0, 0]]
random = 1.5
"""
MISTAKES = """
area.neighbourhood: must be one of full, edge, not 'edgy'; did you mean 'edge'?
area.costs: must be text in quotes, not 3
area.tesselation: there is no such key; did you mean 'tessellation'?
destinations.0: must have at most 2 items, not [1, 2, 3]
destinations.1.0: must be a whole number, not 'a'
rules.waiting_cost: must be greater than or equal to 0, not -3
rules.crossing: must be one of forbid, allow, not 'forbit'; did you mean 'forbid'?
rules.destination_capacity: must be a number of robots above 0: a step, such as 2, 0.5 or 1/3, or in metres a second, \
such as 1.6/s; not 0
robots.random: must be a whole number, not 1.5
planner: must be a table, not 'fcost'
colour: there is no such key; keys are area, destinations, destinations_in_metres, rules, doors, robots, planner, \
outputs
area: must have only one of path, rows, not path and rows
robots: must have only one of cells, metres, file, random, not cells and random
"""


def test_all_mistakes_at_once(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text(ALL_WRONG)
    with pytest.raises(FormatError) as error:
        read_draft(path)
    assert str(error.value).splitlines() == [f"{path}: {mistake}" for mistake in MISTAKES.strip().splitlines()]


def test_all_mistakes_of_a_well_formed_file(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('destinations = [[5, 5]]\n[area]\nrows = ["..", ".."]\n[robots]\nfile = "none.csv"\n')
    with pytest.raises(FormatError) as error:
        read_draft(path)
    assert str(error.value).splitlines() == [
        f"{path}: destinations: cell (5, 5) lies outside the area: x is 0..1, y is 0..1",
        f"{path}: robots.file: No such file or directory: {tmp_path / 'none.csv'}",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a = [", "is no TOML"),
        ("a = " + "[" * 5000, "is nested too deeply"),
        ("a = " + "9" * 5000, "is no TOML"),
        ("[rules]", "area: is missing"),
        ("[area]", "area: must have one of path, rows"),
        ('[area]\nrows = ["..", "."]', "area.rows: ragged rows: row 1 has 1 letters"),
        ("[area]\nrows = []", "area.rows: ragged rows: row 0"),
        ('[area]\npath = "."', "area: Is a directory"),
        ('[area]\nrows = [".."]\n[robots]\ncells = [[1000000000000, 0]]', "must be less than or equal to 1073741824"),
    ],
)
def test_bad_toml(tmp_path, text, message):
    path = tmp_path / "s.toml"
    path.write_text(text)
    with pytest.raises(FormatError, match=message):
        read_draft(path)


@settings(deadline=None, max_examples=50)
@given(height=st.integers(1, 40), width=st.integers(1, 40), count=st.integers(0, 1600), seed=st.integers(0, 99))
def test_starts_round_trip(folder, height, width, count, seed):
    area = Area("square", np.zeros((height, width)))
    robots = np.random.default_rng(seed).permutation(height * width)[:count]
    write_starts(area, robots, folder / "starts.csv")
    assert read_starts(folder / "starts.csv", area).tolist() == robots.tolist()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x;y\n1;2\n", "line 1: the header must be 'x,y', not 'x;y'"),
        ("x,y\n1\n", r"line 2: there must be 2 columns \(x,y\), not 1"),
        ("x,y\n1,1\n1,b\n", "line 3: y must be a whole number of at most 18 digits, not 'b'"),
        ("x,y\n1,3\n", r"line 2: cell \(1, 3\) lies outside the area: x is 0..2, y is 0..1"),
    ],
)
def test_bad_starts_name_the_line(tmp_path, text, message):
    path = tmp_path / "starts.csv"
    path.write_text(text)
    with pytest.raises(FormatError, match=message):
        read_starts(path, Area("square", np.zeros((2, 3))))


def test_starts_may_be_none(tmp_path):
    path = tmp_path / "starts.csv"
    path.write_text("x,y\n")
    assert read_starts(path, Area("square", [[0]])).tolist() == []


def test_robots_are_drawn_where_they_can_arrive(tmp_path):
    path = tmp_path / "s.toml"
    text = 'destinations = [[0, 0]]\n[area]\nrows = ["....B....."]\n[robots]\nrandom = 3\n'
    path.write_text(text)
    assert sorted(read_scenario(path).robots) == [1, 2, 3]
    path.write_text(text.replace("random = 3", "random = 8"))
    assert sorted(read_scenario(path).robots) == [1, 2, 3, 5, 6, 7, 8, 9]
