"""Plans in files: what is written is read again, and what no robot can do is kept for the judge."""

import csv
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from tests.formats.strategies import FRAMES, NAMES, walks
from trihex import (
    Area,
    FormatError,
    Plan,
    Scenario,
    ScenarioError,
    Tessellation,
    read_plan,
    read_scenario,
    write_plan,
    write_scenario,
)
from trihex.areas import Claim, Frame
from trihex.formats.plans.npz import write_plan_npz
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans import plan_from_lists

HEADER = "robot,step,x,y,action,time"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("plans")


@settings(deadline=None, max_examples=50)
@given(plan=walks(), name=NAMES, frame=st.none() | FRAMES)
def test_npz_round_trip(folder, plan, name, frame):
    area = replace(plan.scenario.area, name=name.rstrip("\0"), frame=frame)  # numpy drops NULs at the end
    plan = replace(plan, scenario=replace(plan.scenario, area=area), planner=name.rstrip("\0"))
    path = folder / "plan.npz"
    write_plan(plan, path)
    assert read_plan(path) == plan
    before = path.read_bytes()
    write_plan(plan, path)
    assert path.read_bytes() == before


@settings(deadline=None, max_examples=25)
@given(plan=walks())
def test_a_plan_goes_from_each_format_to_each_other(folder, plan):
    """The command `convert` is no more than reading and writing."""
    suffixes = ("csv", "npz", "parquet")
    for one, other in ((one, other) for one in suffixes for other in suffixes):
        write_plan(plan, folder / f"one.{one}")
        write_plan(read_plan(folder / f"one.{one}", plan.scenario), folder / f"other.{other}")
        again = read_plan(folder / f"other.{other}", plan.scenario)
        assert np.array_equal(again.scenario.robots, plan.scenario.robots)
        assert np.array_equal(again.actions, plan.actions)
        assert np.array_equal(again.first_action, plan.first_action)


def test_a_frame_with_a_radius_is_kept(tmp_path):
    area = Area(Tessellation("hexagonal"), np.zeros((1, 3)), "hall", Frame(0.7, (1, 2), 0.5, 0.15))
    plan = plan_from_lists(Scenario(area, [(2, 0)], [(0, 0)]), [[2, 1]])
    write_plan(plan, tmp_path / "p.npz")
    assert read_plan(tmp_path / "p.npz") == plan
    write_scenario(plan.scenario, tmp_path / "s.toml")
    assert read_scenario(tmp_path / "s.toml") == plan.scenario


@settings(deadline=None, max_examples=50)
@given(plan=walks())
def test_csv_round_trip(folder, plan):
    path = folder / "plan.csv"
    write_plan(plan, path)
    again = read_plan(path, plan.scenario.with_robots([]))
    assert np.array_equal(again.scenario.robots, plan.scenario.robots)
    assert np.array_equal(again.actions, plan.actions)
    assert np.array_equal(again.first_action, plan.first_action)
    assert again.jumps.size == 0


@settings(deadline=None, max_examples=50)
@given(plan=walks())
def test_csv_says_what_the_plan_does(folder, plan):
    """The rows of a slow writer that follows the tables of the tessellation."""
    path = folder / "plan.csv"
    write_plan(plan, path)
    with open(path, newline="") as file:
        assert list(csv.reader(file)) == [HEADER.split(","), *slow_rows(plan)]


def slow_rows(plan: Plan):
    scenario, area = plan.scenario, plan.scenario.area
    for robot, cell in enumerate(scenario.robots.tolist()):
        y, x = divmod(cell, area.width)
        time = step = 0
        yield [str(v) for v in (robot, 0, x, y, "start", 0)]
        for action in plan.actions[slice(*plan.first_action[robot : robot + 2])].tolist():
            name = "wait"
            time += scenario.waiting_cost
            step += 1
            if action != WAIT:
                side = int(area.tessellation.orientation_of_cell(x, y))
                dx, dy = area.tessellation.step_of_direction[side, action].tolist()
                name = area.tessellation.direction_names[side][action]
                x, y, time = (
                    x + dx,
                    y + dy,
                    time - scenario.waiting_cost + int(area.tessellation.cost_of_direction[action]),
                )
                step = time if scenario.clock == "costs" else step
            yield [str(v) for v in (robot, step, x, y, name, time)]


def test_rows_in_any_order(tmp_path):
    path = tmp_path / "p.csv"
    path.write_text(f"{HEADER}\n1,1,1,1,E,10\n0,0,0,0,start,0\n1,0,0,1,start,0\n0,1,0,0,wait,10\n0,2,1,0,E,20\r\n\n")
    plan = read_plan(path, Scenario(Area("square", np.zeros((2, 2))), [(1, 0), (1, 1)]))
    assert plan.scenario.robots.tolist() == [0, 2]
    assert plan.actions.tolist() == [WAIT, 1, 1]
    assert plan.first_action.tolist() == [0, 2, 3]


def test_a_move_that_is_none_becomes_a_jump(tmp_path):
    """Too far, not where the word says, and a word of the other orientation."""
    path = tmp_path / "p.csv"
    scenario = Scenario(Area("triangular", np.zeros((4, 8))), [(7, 3)])
    rows = ["0,0,0,0,start,0", "0,1,7,0,EE,14", "0,2,6,0,E,24", "0,3,6,1,S,34", "0,4,6,1,wait,44", "0,5,6,2,NNE,58"]
    path.write_text("\n".join([HEADER, *rows]))
    plan = read_plan(path, scenario)
    assert plan.actions.tolist() == [JUMP, JUMP, 2, WAIT, JUMP]
    assert plan.jumps.tolist() == [[0, 7], [1, 6], [4, 22]]
    again = tmp_path / "again.csv"
    write_plan(plan, again)
    assert "0,1,7,0,jump,0\n" in again.read_text()
    assert read_plan(again, scenario) == plan
    write_plan(plan, tmp_path / "again.npz")
    assert read_plan(tmp_path / "again.npz") == plan


def test_jumps_and_names_of_the_other_orientation_in_ticks(tmp_path):
    """What no robot can do lasts as long as its word says in the file, and a tick in the plan."""
    path = tmp_path / "p.csv"
    scenario = Scenario(Area("triangular", np.zeros((4, 8))), [(7, 3)], clock="costs")
    rows = ["0,0,0,0,start,0", "0,7,7,0,EE,7", "0,8,6,0,jump,7", "0,15,6,2,NNE,7", "0,20,7,2,E,12", "0,21,7,2,wait,13"]
    path.write_text("\n".join([HEADER, *rows]))
    plan = read_plan(path, scenario)
    assert plan.actions.tolist() == [JUMP, JUMP, JUMP, 0, WAIT]
    assert plan.last_step_of_robot.tolist() == [1 + 1 + 1 + 5 + 1]
    again = tmp_path / "again.csv"
    write_plan(plan, again)
    assert [row.split(",")[1] for row in again.read_text().splitlines()[1:]] == ["0", "1", "2", "3", "8", "9"]
    assert read_plan(again, scenario) == plan


STEPS_AND_TICKS = [
    ("costs", ["0,1,1,0,E,5"], "line 3: step must rise by 5, as long as the action lasts, not by 1; .* another clock"),
    ("costs", ["0,5,1,0,E,5", "0,10,1,0,wait,6"], "line 4: step must rise by 1, as long as .*, not by 5"),
    ("costs", ["0,5,1,0,E,10"], "line 3: time must rise by 5 for 'E', not by 10"),
    ("steps", ["0,5,1,0,E,5"], "line 3: robot 0 lacks step 1; here is step 5, as by clock costs"),
]


@pytest.mark.parametrize(("clock", "rows", "message"), STEPS_AND_TICKS)
def test_a_plan_by_another_clock_is_told(tmp_path, clock, rows, message):
    path = tmp_path / "p.csv"
    path.write_text("\n".join([HEADER, "0,0,0,0,start,0", *rows]))
    with pytest.raises(FormatError, match=message):
        read_plan(path, Scenario(Area("square", np.zeros((2, 3))), [(2, 0)], clock=clock))


@pytest.mark.parametrize(("clock", "following"), [("steps", "allow"), ("costs", "forbid"), ("steps", "forbid")])
def test_files_hold_the_rules_that_came_later_only_where_they_are_not_usual(tmp_path, clock, following):
    area = Area("square", np.zeros((2, 3)), "s")
    plan = plan_from_lists(Scenario(area, [(2, 0)], [(0, 0)], clock=clock, following=following), [[1, WAIT, 1]])
    write_plan(plan, tmp_path / "p.npz")
    write_scenario(plan.scenario, tmp_path / "s.toml")
    with np.load(tmp_path / "p.npz") as file:
        assert ("clock" in file.files, "following" in file.files) == (clock == "costs", following == "forbid")
        assert "zone_cells" not in file.files  # files from before there were zones are read
    text = (tmp_path / "s.toml").read_text()
    assert ("clock =" in text, "following =" in text) == (clock == "costs", following == "forbid")
    assert read_plan(tmp_path / "p.npz") == plan
    assert read_scenario(tmp_path / "s.toml") == plan.scenario
    assert read_plan(tmp_path / "p.npz").steps == (11 if clock == "costs" else 3)


BAD_CSV = {
    "robot,step,x,y,time\n": "line 1: the header must be 'robot,step,x,y,action,time'",
    f"{HEADER}\n0,0,0,0,start\n": "line 2: there must be 6 columns .*, not 5",
    f"{HEADER}\n0,0,0,0,start,0,1\n": "line 2: there must be 6 columns .*, not 7",
    f"{HEADER}\n0,0,0,0,start,0\n\n0,1,0,0,wait,10\n": "line 3: the line is empty",
    f"{HEADER}\n0,0,0.5,0,start,0\n": "line 2: x must be a whole number of at most 18 digits, not '0.5'",
    f"{HEADER}\n0,0,,0,start,0\n": "line 2: x must be a whole number of at most 18 digits, not ''",
    f"{HEADER}\n0,0,{10**30},0,start,0\n": "line 2: x must be a whole number of at most 18 digits",
    f"{HEADER}\n0,0,0,0,start,0\n0,1,0,0,wat,10\n": "line 3: action must be .*, not 'wat'; did you mean 'wait'",
    f"{HEADER}\n0,0,0,0,start,0\n0,1,9,0,E,10\n": r"line 3: cell \(9, 0\) lies outside the area: x is 0..2",
    f"{HEADER}\n0,0,0,0,start,0\n0,1,-1,0,W,10\n": r"line 3: cell \(-1, 0\) lies outside",
    f"{HEADER}\n0,0,0,0,start,0\n0,2,1,0,E,10\n": "line 3: robot 0 lacks step 1; here is step 2",
    f"{HEADER}\n0,0,0,0,start,0\n0,0,0,0,start,0\n": "line 3: robot 0 has step 0 twice",
    f"{HEADER}\n0,0,0,0,start,0\n2,0,1,0,start,0\n": "line 3: .* robot 1 must come next, not 2",
    f"{HEADER}\n-1,0,0,0,start,0\n": "line 2: .* robot 0 must come next, not -1",
    f"{HEADER}\n0,1,0,0,start,0\n": "line 2: robot 0 must begin with step 0, not 1",
    f"{HEADER}\n0,0,0,0,wait,0\n": "line 2: action must be 'start' at step 0, and only there, not 'wait'",
    f"{HEADER}\n0,0,0,0,start,0\n0,1,0,0,start,0\n": "line 3: action must be 'start' at step 0, and only there",
    f"{HEADER}\n0,0,0,0,start,5\n": "line 2: time must be 0 at step 0, not 5",
    f"{HEADER}\n0,0,0,0,start,0\n0,1,1,0,E,1000\n": "line 3: time must rise by 10 for 'E', not by 1000",
    f"{HEADER}\n0,0,0,0,start,0\n0,1,0,0,wait,3\n": "line 3: time must rise by 10 for 'wait', not by 3",
}


@pytest.mark.parametrize("text", BAD_CSV)
def test_bad_csv_names_the_line(tmp_path, text):
    path = tmp_path / "p.csv"
    path.write_text(text)
    with pytest.raises(FormatError, match=f"p.csv: {BAD_CSV[text]}"):
        read_plan(path, Scenario(Area("square", np.zeros((2, 3))), [(2, 0)]))


def test_csv_needs_a_scenario(tmp_path):
    path = tmp_path / "p.csv"
    path.write_text(f"{HEADER}\n0,0,0,0,start,0\n")
    with pytest.raises(FormatError, match="does not hold its area"):
        read_plan(path)


@pytest.fixture
def entries(tmp_path):
    """Return the entries of a small good plan."""
    scenario = Scenario(Area("hexagonal", np.zeros((2, 3))), [(2, 0)], [(0, 0), (0, 1)])
    write_plan_npz(plan_from_lists(scenario, [[2, 1], []]), tmp_path / "good.npz")
    with np.load(tmp_path / "good.npz") as file:
        return dict(file)


BAD_ENTRIES = {
    "version must be 1, not 9": {"version": 9},
    "must have the entry 'robots'": {"robots": None},
    "must not have the entry 'extra'": {"extra": 1},
    "entry 'actions' must be of kind u with 1 axes, not float64": {"actions": np.zeros(2)},
    "entry 'actions' must be of kind u with 1 axes, not uint16": {"actions": np.zeros(2, dtype=np.uint16)},
    "entry 'jumps' must be of kind i with 2 axes, not object": {"jumps": np.array([{}], dtype=object)},
    "robot 0 leaves the area at step 1": {"actions": np.array([0, 1], dtype=np.uint8)},
    "first_action must rise from 0": {"first_action": np.array([0, 2**63 - 1, 2])},
    "first_action must rise": {"first_action": np.array([0, 3, 2])},
    "tessellation must be one of": {"tessellation": "pentagonal"},
    "robot 1 must stand on a free cell": {"barriers": np.array([[0, 0, 0], [1, 0, 0]], dtype=bool)},
}


@pytest.mark.parametrize("message", BAD_ENTRIES)
def test_bad_npz(tmp_path, entries, message):
    changed = {name: value for name, value in {**entries, **BAD_ENTRIES[message]}.items() if value is not None}
    np.savez_compressed(tmp_path / "bad.npz", **changed)
    with pytest.raises(ValueError, match=message):
        read_plan(tmp_path / "bad.npz")


def test_damaged_npz(tmp_path, entries):
    content = (tmp_path / "good.npz").read_bytes()
    path = tmp_path / "bad.npz"
    for damaged in (content[:-40], content[: len(content) // 2], b"PK\x03\x04" + bytes(100)):
        path.write_bytes(damaged)
        with pytest.raises(FormatError, match=r"is no whole \.npz file"):
            read_plan(path)
    for at in range(0, len(content), 7):  # a flipped byte is noticed or does no harm
        path.write_bytes(content[:at] + bytes([content[at] ^ 0x55]) + content[at + 1 :])
        with suppress(ValueError):
            assert read_plan(path).scenario.robot_count == 2


def test_a_bomb_is_refused_before_it_is_unpacked(tmp_path, entries, monkeypatch):
    monkeypatch.setattr("trihex.formats.archive.MAX_UNPACKED", 2**20)
    entries["barriers"] = np.zeros((1025, 1024), dtype=bool)
    np.savez_compressed(tmp_path / "bomb.npz", **entries)
    with pytest.raises(FormatError, match="must unpack to at most 1048576 bytes"):
        read_plan(tmp_path / "bomb.npz")


@pytest.mark.parametrize("suffix", [".csv", ".npz", ".parquet"])
@pytest.mark.parametrize(
    ("robots", "message"),
    [
        ([(1, 1), (0, 0)], r"robot 0 must stand on a free cell; \(1, 1\) is a barrier"),
        ([(0, 0), (2, 0), (0, 0)], r"robots 0 and 2 both start at \(0, 0\)"),
    ],
)
def test_impossible_starts_are_read_for_the_judge_alone(tmp_path, suffix, robots, message):
    scenario = Scenario(Area("hexagonal", [[0, 0, 0], [0, 1, 0]]), [(2, 1)])
    claim = Claim(scenario.area, scenario.destinations, robots)
    plan = plan_from_lists(claim, [[WAIT]] * len(robots))
    write_plan(plan, path := tmp_path / f"plan{suffix}")
    own = None if suffix == ".npz" else scenario
    with pytest.raises(ScenarioError, match=message):
        read_plan(path, own)
    assert read_plan(path, own, for_judge=True) == plan
    possible = plan_from_lists(scenario.with_robots([(0, 0)]), [[WAIT]])
    write_plan(possible, path)
    assert type(read_plan(path, own, for_judge=True).scenario) is Scenario
