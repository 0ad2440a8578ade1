"""Start times on the command line: drawn, from a column, in a report, in a run, and what is wrong with them."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

import trihex as th
from trihex.cli import main

ROOM = ["room.txt", "--planner", "greedy"]


@pytest.fixture(autouse=True)
def room(tmp_path, monkeypatch):
    """The working folder holds a room of 8 x 3 cells with a destination."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.txt").write_text("........\nD.......\n........\n")
    (tmp_path / "late.csv").write_text("x,y,start\n3,0,0\n5,1,4\n7,2,2\n")


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def test_drawn_they_are_told_in_the_report_and_kept_in_the_scenario():
    done = run("plan", *ROOM, "--robots", 5, "--start-times", "uniform:2,9", "--seed", 3, "--summary", "s.json",
               "--out", "p.npz", "--write-scenario", "s.toml")  # fmt: skip
    assert done.exit_code == 0, done.output
    scenario = th.read_plan("p.npz").scenario
    assert np.array_equal(scenario.start_times, th.random_start_times(scenario.area, 5, "uniform:2,9", 3))
    before = 10 * int(scenario.start_times.sum())
    assert f"waiting, {before} of it before they may start)" in done.output
    with open("s.json") as file:
        assert json.load(file)["waiting_before_start"] == before
    assert run("check", "p.npz").exit_code == 0
    assert run("plan", "s.toml", "--planner", "greedy", "--out", "q.npz").exit_code == 0
    assert th.read_plan("q.npz") == th.read_plan("p.npz")


def test_those_who_begin_at_once_are_told_nothing_of_it():
    done = run("plan", *ROOM, "--robots", 5, "--summary", "-")
    assert "waiting_before_start" not in json.loads(done.output)


def test_a_column_of_starts_is_for_plans_and_runs():
    assert run("plan", *ROOM, "--starts", "late.csv", "--out", "p.npz").exit_code == 0
    assert th.read_plan("p.npz").scenario.start_times.tolist() == [0, 4, 2]
    assert run("plan", *ROOM, "--starts", "late.csv", "--robots", 2, "--out", "p.npz").exit_code == 0
    assert th.read_plan("p.npz").scenario.start_times.tolist() == [0, 4]
    assert run("run", *ROOM, "--starts", "late.csv", "--out", "r.npz").exit_code == 0
    happened = th.read_run("r.npz")
    assert happened.scenario.start_times.tolist() == [0, 4, 2] and th.audit_run(happened).is_clean
    drawn = ["--start-times", "constant:7", "--seed", 5]
    assert run("plan", *ROOM, "--starts", "late.csv", *drawn, "--out", "p.npz").exit_code == 0
    assert th.read_plan("p.npz").scenario.start_times.tolist() == [7, 7, 7]


def test_speed_tells_which_second_is_which_step():
    room = ["room.toml", "--planner", "greedy"]
    with open("room.toml", "w") as file:
        file.write('destinations = [[0, 1]]\n[area]\nrows = ["......", "......"]\n[area.frame]\ncell_size = 0.5\n')
    for speed, steps in ((1, 6), (2, 12)):
        asked = ["--robots", 3, "--start-times", "constant:3", "--speed", speed]
        assert run("plan", *room, *asked, "--out", "p.npz").exit_code == 0
        assert th.read_plan("p.npz").scenario.start_times.tolist() == [steps] * 3
        assert run("run", *room, *asked, "--out", "r.npz").exit_code == 0
        assert th.read_run("r.npz").scenario.start_times.tolist() == [steps] * 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--robots", 3, "--start-times", "soon"], "start times must be drawn as one of constant:time, "),
        (["--starts", "late.csv", "--seed", 1], "--seed draws robots: add --robots N"),
        (
            ["--robots", 3, "--start-times", "constant:2", "--planner", "optimal", "--certificate", "c.csv"],
            "--certificate needs robots that may all begin at once, without start times",
        ),
        (
            ["--robots", 3, "--start-times", "constant:2", "--planner", "fcost", "--planner-option", "rule=paper"],
            "rule must not be 'paper' where there are start_times",
        ),
    ],
)
def test_wrong_use_is_one_line(arguments, message):
    done = run("plan", "room.txt", *arguments)
    assert done.exit_code == 2
    assert done.stderr.splitlines()[-1].startswith(f"trihex: error: {message}"), done.stderr
