"""Slowness on the command line: a column of speeds, the report, files that are read again, and what refuses."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

import trihex as th
from trihex.cli import main


@pytest.fixture(autouse=True)
def room(tmp_path, monkeypatch):
    """The working folder holds a room of 8 x 3 cells with a destination."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.txt").write_text("........\nD.......\n........\n")
    (tmp_path / "slow.csv").write_text("x,y,slowness\n3,0,1\n5,1,4\n7,2,2\n")
    (tmp_path / "speed.csv").write_text("x,y,start,speed\n3,0,0,1.5\n5,1,2,0.5\n7,2,0,1\n")


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def test_slowness_is_kept_told_and_planned_again():
    done = run("plan", "room.txt", "--starts", "slow.csv", "--summary", "s.json", "--out", "p.npz",
               "--write-scenario", "s.toml")  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "moves of slower robots last up to 4 times as long, 2.33 in the mean" in done.output
    with open("s.json") as file:
        assert json.load(file)["slowness"] == 4
    plan = th.read_plan("p.npz")
    assert plan.scenario.slowness.tolist() == [1, 4, 2] and run("check", "p.npz").exit_code == 0
    assert run("plan", "s.toml", "--out", "q.npz").exit_code == 0 and th.read_plan("q.npz") == plan
    assert run("plan", "room.txt", "--starts", "slow.csv", "--robots", 2, "--out", "p.npz").exit_code == 0
    assert th.read_plan("p.npz").scenario.slowness.tolist() == [1, 4]
    assert run("plan", "s.toml", "--robots", 2, "--out", "p.npz").exit_code == 0
    assert th.read_plan("p.npz").scenario.slowness.tolist() == [1, 1]


def test_in_metres_waypoints_keep_to_each_speed():
    for options, top, slowness in (([], 1.5, [1, 3, 2]), (["--speed", 3], 3.0, [2, 6, 3])):
        done = run("plan", "room.txt", "--starts", "speed.csv", "--cell-size", 0.5, *options, "--out", "p.npz",
                   "--waypoints", "w.csv")  # fmt: skip
        assert done.exit_code == 0, done.output
        assert th.read_plan("p.npz").scenario.slowness.tolist() == slowness
        rows = np.loadtxt("w.csv", delimiter=",", skiprows=1)
        for robot, most in enumerate((1.5, 0.5, 1.0)):
            own = rows[rows[:, 0] == robot]
            speeds = np.hypot(*np.diff(own[:, 2:4], axis=0).T) / np.diff(own[:, 1])
            assert speeds.max() == pytest.approx(top / slowness[robot], rel=1e-4)  # seconds in the file are rounded
            assert speeds.max() <= most * 1.0001
            assert own[:, 1][np.flatnonzero(speeds)[0]] >= (2 if robot == 1 else 0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["plan", "--planner", "astar"], "planner 'astar' needs robots that are all as fast, without slowness"),
        (["plan", "--planner", "optimal"], "planner 'optimal' needs robots that are all as fast, without slowness"),
        (["plan", "--straight"], "--straight needs robots that are all as fast"),
        (["plan", "--planner", "optimal", "--certificate", "c.csv"], "--certificate needs robots that are all as fast"),
        (["plan", "--planner-option", "rule=paper"], "rule must not be 'paper' where robots have slowness"),
        (["plan", "--out", "o.dependencies.json"], "--out needs robots that are all as fast for an order of who waits"),
        (["run"], "an execution needs robots that are all as fast, without slowness"),
        (["prices"], "needs robots that are all as fast, without slowness"),
    ],
)
def test_what_knows_no_slowness_refuses_in_one_line(arguments, message):
    command, *options = arguments
    done = run(command, "room.txt", "--starts", "slow.csv", *options)
    assert done.exit_code == 2 and done.output.startswith(
        f"trihex: error: {message}" if message[0] != "n" else "trihex"
    )
    assert message in done.output and done.output.count("\n") == 1
