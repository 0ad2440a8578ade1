"""Command line: `trihex run`, what it prints, writes and answers."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

import trihex as th
from trihex.cli import main
from trihex.pictures.run_movie import RunFilm

# Two rooms and a door.
WORLD = "D..B...\n.......\nb.aB..c\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "world.txt").write_text(WORLD)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*command, status=0):
    result = CliRunner().invoke(main, ["run", *map(str, command)])
    assert result.exit_code == status, result.output
    return result


def test_it_prints_a_report(folder):
    lines = run("world.txt", "--sense", "1").stdout.splitlines()
    assert lines[0] == "world: hexagonal, 3 robots, planner fcost, sensing 1 cells"
    assert lines[1].startswith("3 arrived in 6 steps, 0 cut off, 0 left, 0 broken; 0 events, 0 refused")
    assert lines[2].startswith("total time ") and "with full knowledge and no events 110 (fcost)" in lines[2]
    assert lines[-1] == "safe: no conflicts"


def test_a_door_that_shuts_cuts_one_robot_off_and_the_answer_is_no(folder):
    (folder / "events.csv").write_text("step,event,x,y,robot\n2,barrier,3,1,\n3,leave,,,9\n")
    result = run("world.txt", "--events", "events.csv", "--summary", "summary.json", status=1)
    assert "refused: robot must be one of 0..2, not 9" in result.stderr
    assert "robot 2 is cut off, known after step 1" in result.stderr
    summary = json.loads((folder / "summary.json").read_text())
    assert (summary["arrived"], summary["cut_off"], summary["events"], summary["refused_events"]) == (2, 1, 1, 1)
    assert summary["price"] is None and summary["conflicts"] == 0 and summary["sense"] is None


def test_a_run_is_written_stopped_and_resumed(folder):
    options = ("world.txt", "--delays", "0.3", "--seed", "3", "--robots", "6", "--sense", "2", "--line-of-sight")
    run(*options, "--out", "whole.npz")
    run(*options, "--out", "part.npz", "--max-steps", "3")
    run("--resume", "part.npz", "--out", "rest.npz")
    assert th.read_run("rest.npz") == th.read_run("whole.npz") != th.read_run("part.npz")
    summary = json.loads(run(*options, "--summary", "-").stdout)
    assert summary["delays"] == 0.3 and summary["seed"] == 3 and summary["milliseconds_a_step"]["worst"] > 0


def test_pictures_and_movies_show_what_is_known(folder):
    (folder / "events.toml").write_text('[[event]]\nstep = 3\nevent = "break"\nrobot = 2\n')
    run("world.txt", "--sense", "0", "--events", "events.toml", "--picture", "run.svg", "--animation", "run.gif")
    picture = (folder / "run.svg").read_text()
    assert "first seen in step" in picture and "barrier not seen" in picture
    with Image.open("run.gif") as movie:
        assert movie.n_frames > 6 and movie.size[0] > 200
    area, exits = th.read_area("world.txt", tessellation="square"), [(0, 0)]
    record = th.Trial(th.Scenario(area, exits, [(6, 2)]), sensor=0).run()
    film = RunFilm(record, 100, 300, "")
    frames = list(film.frames())
    assert len(frames) == film.pace.frame_count
    fog = np.array([190, 198, 214])
    seen = [np.count_nonzero((frame == fog).all(axis=-1)) for frame in frames]
    assert seen[0] > seen[-1] and sorted(seen, reverse=True)[0] == seen[0]


def test_what_is_known_is_coloured_by_the_step(folder):
    area = th.Area("square", np.zeros((3, 12), dtype=bool))
    record = th.Trial(th.Scenario(area, [(0, 1)], [(11, 1)]), sensor=1).run()
    pixels = th.picture_of_run(record, width=120, title="", legend=False).to_array()
    assert pixels.shape == (30, 120, 3)
    assert not np.array_equal(pixels[3, 15], pixels[3, 105])  # seen late and seen at once


@pytest.mark.parametrize(
    ("command", "why"),
    [
        (("--sense", "3"), "there is no AREA"),
        (("world.txt", "--line-of-sight"), "add --sense"),
        (("world.txt", "--sense", "-1"), "sense must be a number from 0 to 100, not '-1'"),
        (("world.txt", "--delays", "2"), "delays must be a number from 0 to 1"),
        (("world.txt", "--delays", "1"), "delay must be a number from 0 to below 1"),
        (("world.txt", "--planner", "gredy"), "did you mean 'greedy'"),
        (("world.txt", "--events", "nothing.csv"), "No such file"),
        (("world.txt", "--out", "run.csv"), r"suffix of a run must be one of \.npz"),
        (("world.txt", "--resume", "run.npz"), "AREA cannot be told"),
    ],
)
def test_wrong_use_is_told_in_one_line(folder, command, why):
    result = run(*command, status=2)
    assert len(result.stderr.splitlines()) == 1
    assert re.search(why, result.stderr), result.stderr


def test_robots_follow_plans_that_are_made_anew(folder):
    assert "planner fcost" in run("world.txt", "--sense", "1", "--replan", "--budget", "5").stdout
    assert "3 arrived" in run("world.txt", "--planner", "greedy", "--replan").stdout


def test_a_plan_is_followed_in_its_order(folder):
    CliRunner().invoke(main, ["plan", "world.txt", "--out", "plan.npz"])
    punctual = run("--plan", "plan.npz").stdout
    assert "3 arrived" in punctual and punctual.endswith("safe: no conflicts\n")
    run("--plan", "plan.npz", "--delays", "0.3", "--seed", "1", "--out", "run.npz")
    assert th.read_run("run.npz").arrived.all() and th.read_run("run.npz").delay == 0.3
    assert "--sense cannot be told" in run("--plan", "plan.npz", "--sense", "2", status=2).stderr


def test_a_movie_shows_destinations_as_they_are_in_each_step(folder):
    area = th.Area("square", np.zeros((3, 12), dtype=bool))
    events = [th.Event(2, "close", cell=(0, 1)), th.Event(3, "open", cell=(11, 0)), th.Event(3, "barrier", cell=(1, 1))]
    record = th.Trial(th.Scenario(area, [(0, 1)], [(6, 1)]), events=events).run()
    film = RunFilm(record, record.steps + 1, 120, "")
    green = np.array([0, 158, 115])
    x, y = film.sheet.body
    places = [np.argwhere((frame[y : y + 30, x : x + 120] == green).all(axis=-1)) for frame in film.frames()]
    columns = [sorted(set((found[:, 1] // 10).tolist())) for found in places]
    assert columns[:2] == [[0], [0]] and columns[2] == [] and columns[3:] == [[11]] * len(columns[3:])


def in_metres(folder):
    """Write a scenario in metres for robots of a radius; return its name."""
    frame = th.Frame(0.5, robot_radius=0.1)
    area = th.Area("hexagonal", th.read_area("world.txt").barriers, "world", frame)
    th.write_scenario(th.Scenario(area, [(0, 0)], [(6, 2), (2, 2), (5, 0)]), folder / "world.toml")
    return "world.toml"


def test_what_happened_is_written_as_a_plan_would_be(folder):
    """Waypoints, picture, page and seconds of a run; its file is converted, checked, animated like a plan."""
    (folder / "events.csv").write_text("step,event,x,y,robot,steps\n1,late,,,0,2\n")
    pace = ("--speed", "0.25", "--turn-time", "0.5", "--frame-id", "hall")
    files = ("--out", "r.npz", "--waypoints", "r.csv", "--picture", "r.svg", "--animation", "r.html")
    done = run(in_metres(folder), "--events", "events.csv", *pace, *files)
    record = th.read_run("r.npz")
    last = int(record.ended.max()) * 2.5
    assert f"the last arrives after {last:.1f} s" in done.stdout and "a step lasts 2.5 s" in done.stdout
    assert done.stdout.splitlines()[-1] == "written: r.npz, r.svg, r.html, r.csv"
    assert "Run (fcost)" in (folder / "r.svg").read_text() and "robot and its path" in (folder / "r.svg").read_text()
    rows = np.loadtxt("r.csv", delimiter=",", skiprows=1)
    stands = rows[(rows[:, 0] == 0) & (rows[:, 1] <= 5.0)]
    assert len(stands) == 5 and np.ptp(stands[:, 2:4], axis=0).tolist() == [0, 0] and rows[:, 1].max() == last
    main_run("convert", "r.npz", "again.csv", "--waypoints", *pace)
    assert (folder / "again.csv").read_bytes() == (folder / "r.csv").read_bytes()
    main_run("convert", "r.npz", "r.yaml", *pace)
    assert "frame_id: hall" in (folder / "r.yaml").read_text()
    main_run("convert", "r.npz", "table.csv")
    assert "0,1,6,2,late,10" in (folder / "table.csv").read_text()
    assert (
        main_run("check", "r.npz").stdout
        == f"r.npz: 3 of 3 robots arrived in {record.steps} steps; safe: no conflicts\n"
    )
    assert json.loads(main_run("check", "r.npz", "--summary", "-").stdout)["total_time"] == record.total_time
    assert main_run("animate", "r.npz", "--out", "r.gif").stdout == f"r.gif: 3 robots, {record.steps} steps\n"
    main_run("animate", "r.npz", "--beside", "r.npz", "--out", "both.html")
    assert main_run("check", "r.npz", "--corners", "no-cut", status=2).stderr.startswith(
        "trihex: error: r.npz is a run and says all itself, so --corners cannot be told"
    )


def test_maps_and_exits_are_written(folder):
    """Of a plan and of a run: arrays and pictures of waiting and density, N(t) by exit beside the most possible."""
    (folder / "events.csv").write_text("step,event,robot,steps\n1,late,0,2\n")
    maps = ("--waiting", "w.npy", "--density", "d.npy", "--arrivals", "n.csv", "--speed", "0.5")
    for command in (["run", in_metres(folder), "--events", "events.csv"], ["plan", in_metres(folder)]):
        assert main_run(*command, *maps).stdout.splitlines()[-1] == "written: w.npy, d.npy, n.csv"
        assert np.load("w.npy").sum() == (2 if command[0] == "run" else 0) and np.load("d.npy").shape == (3, 7)
        lines = (folder / "n.csv").read_text().splitlines()
        assert lines[0] == 'step,seconds,arrived,most (optimum),"(0, 0) at (0.288675, -0.25) metres"'
        rows = [[float(value) for value in line.split(",")] for line in lines[1:]]
        assert rows[-1][1:3] == [rows[-1][0], 3] and all(row[2] <= row[3] and row[2] == row[4] for row in rows)
    pictures = ("--waiting", "w.svg", "--density", "d.png", "--arrivals", "n.svg")
    main_run("plan", in_metres(folder), *pictures)
    assert "least possible" in (folder / "n.svg").read_text() and "seconds" in (folder / "n.svg").read_text()
    assert "Waiting (fcost)" in (folder / "w.svg").read_text()
    wrong = main_run("plan", in_metres(folder), "--waiting", "w.csv", status=2)
    assert "w.csv: the suffix of a map must be one of" in wrong.stderr


def test_an_unsafe_run_is_told(folder):
    record = th.Trial(th.read_scenario(in_metres(folder))).run()
    th.write_run(replace(record, state_of_robot=np.array([1, 1, 2], dtype=np.uint8)), "r.npz")
    wrong = main_run("check", "r.npz", status=1)
    assert "unsafe: 1 conflict\nstep 6: robot 2 is said to have left or broken down, or is not" in wrong.stdout


def main_run(*command, status=0):
    result = CliRunner().invoke(main, [*map(str, command)])
    assert result.exit_code == status, result.output
    return result


def test_an_exit_closes_at_a_second_by_the_speed_of_waypoints(tmp_path):
    """Steps on hexagons of 0.5 m last 0.5 s at 1 m/s, 1 s at half of it: second 20 begins step 41 or 21."""
    (tmp_path / "hall.wkt").write_text("POLYGON ((0 0, 30 0, 30 4, 0 4, 0 0))")
    (tmp_path / "e.csv").write_text("second,event,metres\n20,open,1.5 2\n")
    common = [str(tmp_path / "hall.wkt"), "--cell-size", "0.5", "--destination", "28,2m", "--robots", "3"]
    for pace, step in (([], 41), (["--speed", "0.5"], 21)):
        run(*common, "--events", tmp_path / "e.csv", "--out", tmp_path / "run.npz", *pace, "--max-steps", "60")
        happened = th.read_run(tmp_path / "run.npz").occurrences
        assert [one.event.step for one in happened] == [step]
    run(*common, "--out", tmp_path / "part.npz", "--max-steps", "10")
    run("--resume", tmp_path / "part.npz", "--events", tmp_path / "e.csv", "--out", tmp_path / "rest.npz")
    assert [one.event.step for one in th.read_run(tmp_path / "rest.npz").occurrences] == [41]
    slow = run("--resume", tmp_path / "part.npz", "--events", tmp_path / "e.csv", "--speed", "0.01", status=2)
    assert "is past step 10, so what happens must come later, not step 2: destination opens" in slow.stderr
    (tmp_path / "plain.txt").write_text("D..a\n")
    (tmp_path / "e.csv").write_text("second,event,x,y\n20,open,1,0\n")
    refused = run(tmp_path / "plain.txt", "--events", tmp_path / "e.csv", status=2)
    assert "line 2: second needs an area in metres, where steps last; give step in place of 20" in refused.stderr
