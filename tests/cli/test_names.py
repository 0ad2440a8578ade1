"""Names that are not UTF-8: what the file system allows, every command takes, and what it writes is read again."""

import os
import subprocess
import sys

import pytest
from click.testing import CliRunner

from trihex import read_area, read_plan
from trihex.cli import main

MAP = "type octile\nheight 3\nwidth 4\nmap\n....\n.@..\n....\n"
ROBOTS = ["--destination", "3,0", "--robots", "2", "--planner", "greedy"]
ODD = "b\udce4r"  # how Python spells the byte 0xE4 of Latin-1


@pytest.fixture
def folder(tmp_path, monkeypatch):
    folder = tmp_path / f"f{ODD}"
    folder.mkdir()
    (folder / f"{ODD}.map").write_text(MAP)
    monkeypatch.chdir(folder)
    return folder


@pytest.mark.parametrize(
    ("command", "written"),
    [
        (["plan", f"{ODD}.map", *ROBOTS, "--write-scenario", "s.toml"], "s.toml"),
        (["plan", f"{ODD}.map", *ROBOTS, "--write-scenario", f"{ODD}.toml"], f"{ODD}.toml"),
        (["plan", f"{ODD}.map", *ROBOTS, "--summary", "s.json"], "s.json"),
        (["plan", f"{ODD}.map", *ROBOTS, "--summary", "-"], None),
        (["plan", f"{ODD}.map", *ROBOTS, "--out", f"{ODD}.npz"], f"{ODD}.npz"),
        (["plan", f"{ODD}.map", *ROBOTS, "--out", f"{ODD}.csv"], f"{ODD}.csv"),
        (["plan", f"{ODD}.map", *ROBOTS, "--out", f"{ODD}.parquet"], f"{ODD}.parquet"),
        (["plan", f"{ODD}.map", *ROBOTS, "--picture", f"{ODD}.svg"], f"{ODD}.svg"),
        (["plan", f"{ODD}.map", *ROBOTS, "--picture", f"{ODD}.png"], f"{ODD}.png"),
        *(
            (["plan", f"{ODD}.map", *ROBOTS, "--cell-size", "1", "--waypoints", f"w{suffix}"], f"w{suffix}")
            for suffix in (".csv", ".yaml", ".json", ".geojson", ".sqlite")
        ),
        (["convert", f"{ODD}.map", f"{ODD}.toml"], f"{ODD}.toml"),
        (["convert", f"{ODD}.map", f"{ODD}.png"], f"{ODD}.png"),
        (["generate", "random", "--size", "4,3", "--out", f"{ODD}.toml"], f"{ODD}.toml"),
        (["generate", "random", "--size", "4,3", "--out", f"{ODD}.txt"], f"{ODD}.txt"),
        (["field", f"{ODD}.map", *ROBOTS[:2], "--picture", f"{ODD}.svg", "--out", f"{ODD}.npy"], f"{ODD}.npy"),
        (["compare", f"{ODD}.map", *ROBOTS[:4], "--planners", "greedy", "--out", "c.csv"], "c.csv"),
        (["run", f"{ODD}.map", *ROBOTS[:4], "--out", "r.npz"], "r.npz"),
    ],
)  # fmt: skip
def test_every_writer_takes_the_name(folder, command, written):
    result = CliRunner().invoke(main, command)
    assert (result.stderr, result.exit_code) == ("", 0)
    assert written is None or (folder / written).stat().st_size


def test_what_is_written_is_read_again(folder):
    outputs = ["--out", "p.npz", "--write-scenario", "s.toml"]
    assert CliRunner().invoke(main, ["plan", f"{ODD}.map", *ROBOTS, *outputs]).exit_code == 0
    assert read_plan("p.npz").scenario.area.name == read_area("s.toml").name == "b\ufffdr"
    assert CliRunner().invoke(main, ["check", "p.npz"]).exit_code == 0
    for out in (f"{ODD}.html", f"{ODD}.gif", f"{ODD}.mp4"):
        assert CliRunner().invoke(main, ["animate", "p.npz", "--out", out]).exit_code == 0
    assert CliRunner().invoke(main, ["plan", "s.toml", "--out", "q.npz"]).exit_code == 0


def test_a_study_may_lie_in_such_a_folder(folder):
    (folder / "a.map").write_text(MAP)
    (folder / f"{ODD}.toml").write_text(
        'destinations = ["centre"]\nrobots = [1]\nplanners = ["greedy"]\n[[areas]]\npath = "a.map"\n'
    )
    for table in (f"{ODD}.csv", f"{ODD}.parquet"):
        result = CliRunner().invoke(main, ["study", f"{ODD}.toml", "--jobs", "1", "--out", table])
        assert (result.stderr, result.exit_code) == ("", 0)
        assert (folder / table).stat().st_size


def test_an_output_that_no_scenario_can_name_is_refused_before_the_work(folder):
    result = CliRunner().invoke(
        main, ["plan", f"{ODD}.map", *ROBOTS, "--out", f"{ODD}.npz", "--write-scenario", "s.toml"]
    )
    assert result.stderr.startswith("trihex: error: --write-scenario can name no output but in printable UTF-8, not ")
    assert result.exit_code == 2
    assert [one.name for one in folder.iterdir()] == [f"{ODD}.map"]


@pytest.mark.parametrize("encoding", ["utf-8:strict", "utf-8:surrogateescape"])
def test_a_path_is_told_as_it_is(folder, encoding):
    assert CliRunner().invoke(main, ["plan", f"{ODD}.map", *ROBOTS, "--out", f"{ODD}.npz"]).exit_code == 0
    result = subprocess.run(
        [sys.executable, "-m", "trihex", "check", f"{ODD}.npz"],
        env={**os.environ, "PYTHONIOENCODING": encoding},
        capture_output=True,
    )
    assert result.stdout.startswith(b"b\xe4r.npz: 2 of 2 robots arrive") and result.returncode == 0
