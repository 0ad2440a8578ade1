"""`check` on plans that are impossible from the start, or made for something else: it judges, and says what it sees."""

import json

import pytest
from click.testing import CliRunner

from trihex.cli import main

MAP = "type octile\nheight 3\nwidth 4\nmap\n....\n.@..\n....\n"
HEADER = "robot,step,x,y,action,time\n"
AIM = ["--destination", "3,0"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "world.map").write_text(MAP)
    (tmp_path / "other.map").write_text(MAP.replace("....\n.@", "..@@\n.@"))
    (tmp_path / "barrier.csv").write_text(f"{HEADER}0,0,1,1,start,0\n0,1,2,0,N,10\n")
    (tmp_path / "cell.csv").write_text(f"{HEADER}0,0,2,0,start,0\n0,1,3,0,SE,10\n1,0,2,0,start,0\n1,1,3,0,SE,10\n")
    return tmp_path


def check(*command):
    return CliRunner().invoke(main, ["check", *command])


@pytest.mark.parametrize(
    ("plan", "conflict"),
    [
        ("barrier.csv", "step 0: robot 0 starts on the barrier (1, 1)"),
        ("cell.csv", "step 0: robots 0 and 1 are both in cell (2, 0)"),
    ],
)
def test_impossible_starts_are_judged(folder, plan, conflict):
    result = check(plan, "world.map", *AIM)
    assert (result.exit_code, result.stdout.splitlines()[1], result.stderr) == (1, conflict, "")
    result = check(plan, "world.map", *AIM, "--summary", "-")
    assert result.exit_code == 1 and json.loads(result.stdout)["conflicts"] > 0
    assert conflict in result.stderr


def test_a_plan_of_another_map_is_judged(folder):
    made = CliRunner().invoke(
        main, ["plan", "world.map", *AIM, "--robots", "6", "--planner", "greedy", "--out", "p.npz"]
    )
    assert made.exit_code == 0
    for summary in ([], ["--summary", "-"]):
        result = check("p.npz", "other.map", *summary)
        assert result.exit_code == 1
        assert "step 0: destination (3, 0) is a barrier" in result.output
        assert "onto the barrier (2, 0)" in result.output


def test_a_destination_that_the_user_names_must_be_free(folder):
    assert CliRunner().invoke(main, ["plan", "world.map", *AIM, "--robots", "2", "--out", "p.npz"]).exit_code == 0
    result = check("p.npz", "other.map", *AIM)
    assert result.exit_code == 2
    assert result.stderr.startswith("trihex: error: destination 0 must stand on a free cell; (3, 0) is a barrier")


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_plan_of_another_tessellation_is_told_as_such(folder, suffix):
    (folder / "open.map").write_text("type octile\nheight 8\nwidth 8\nmap\n" + "........\n" * 8)
    aim = ["--destination", "7,7"]
    for made, checked in [("triangular", "hexagonal"), ("hexagonal", "square"), ("square", "triangular")]:
        options = ["--tessellation", made, "--robots", "3", "--out", f"p{suffix}"]
        assert CliRunner().invoke(main, ["plan", "open.map", *aim, *options]).exit_code == 0
        result = check(f"p{suffix}", "open.map", *aim, "--tessellation", checked)
        assert result.exit_code in (1, 2)
        assert f"the plan looks {made} (--tessellation {made}), not {checked}" in result.stderr
        assert check(f"p{suffix}", "open.map", *aim, "--tessellation", made).exit_code == 0


def test_a_plan_that_fits_no_tessellation_is_not_guessed_at(folder):
    (folder / "p.csv").write_text(f"{HEADER}0,0,0,0,start,0\n0,1,3,2,SE,10\n")
    result = check("p.csv", "world.map", *AIM)
    assert result.exit_code == 1 and result.stderr == ""


def test_the_first_robots_of_a_file_of_starts(folder):
    rows = ["0\tw\t4\t3\t0\t0\t3\t0\t3", "0\tw\t4\t3\t0\t1\t3\t0\t3", "0\tw\t4\t3\t0\t0\t3\t0\t3"]
    (folder / "w.scen").write_text("\n".join(["version 1", *rows, ""]))
    (folder / "w.csv").write_text("x,y\n0,0\n0,1\n0,0\n")
    for starts in ("w.scen", "w.csv"):
        command = ["plan", "world.map", *AIM, "--starts", starts, "--planner", "greedy", "--out", "p.csv"]
        assert CliRunner().invoke(main, command).exit_code == 2  # two robots in one cell
        result = CliRunner().invoke(main, [*command, "--robots", "2"])
        assert result.exit_code == 0 and "2 of 2 robots arrive" in result.stdout
        starts_of = [line for line in (folder / "p.csv").read_text().splitlines() if "start" in line]
        assert starts_of == ["0,0,0,0,start,0", "1,0,0,1,start,0"]
        result = CliRunner().invoke(main, [*command, "--robots", "2", "--seed", "1"])
        assert result.exit_code == 2 and "--seed draws robots; with --starts none are drawn" in result.stderr
