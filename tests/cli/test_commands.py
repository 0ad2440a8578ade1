"""Command line: what the commands print, write and answer; the wrong uses are in test_bad_input."""

import csv
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

import trihex as th
import trihex.cli
from trihex.areas import TESSELLATIONS
from trihex.cli import COMMANDS, main
from trihex.planners import PLANNERS

# Two rooms and a door; the robot on the right, two on the left.
WORLD = "D..B...\n.......\nb.aB..c\n"
SUMMARY_KEYS = [
    *("area", "tessellation", "neighbourhood", "costs", "corners", "crossing", "destination_capacity"),
    *(
        "clock",
        "following",
        "cells",
        "free_cells",
        "robots",
        "arrived",
        "unreachable",
        "arrivals_of_exit",
        "seed",
        "planner",
        "waiting_cost",
        "steps",
        "total_time",
    ),
    *("total_distance", "total_waiting", "longest_time", "lower_bound", "lower_bound_name", "gap", "optimal"),
    *("conflicts", "corner_moves", "squeezing_moves", "turning", "step_seconds"),
    *("last_arrival_seconds", "mean_arrival_seconds", "seconds"),
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "world.txt").write_text(WORLD)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*command, status=0):
    result = CliRunner().invoke(main, [str(word) for word in command])
    assert result.exit_code == status, result.output
    return result


def plan(*options, status=0):
    return run("plan", "world.txt", "--planner", "greedy", *options, status=status)


def test_plan_prints_a_report(folder):
    lines = plan().stdout.splitlines()
    assert lines[0] == "world: 7 x 3 cells, 19 free; hexagonal, full neighbourhood, costs paper"
    assert lines[1].startswith("greedy: 3 of 3 robots arrive, the last in step ")
    assert lines[3] == "safe: no conflicts"


def test_moves_past_the_corners_of_barriers_are_told(folder):
    (folder / "leak.txt").write_text("D.B.\n.B..\nB..a\n")
    line = "1 move passes the corner of a barrier, 1 of them between two; --corners no-cut forbids it"
    report = run("plan", "leak.txt", "--tessellation", "square", "--out", "leak.npz").stdout.splitlines()
    assert report[3:5] == ["safe: no conflicts", line]
    assert run("check", "leak.npz").stdout.splitlines()[1:] == [line]
    (folder / "open.txt").write_text("....\na..D\n")
    border = run("plan", "open.txt", "--tessellation", "triangular").stdout.splitlines()[4]
    assert border.endswith(" the corner of the border; --corners no-cut forbids it")
    for options in (["--corners", "no-cut"], ["--neighbourhood", "edge"]):
        told = run("plan", "open.txt", "--tessellation", "triangular", *options).stdout
        assert "corner" not in told
    assert "corner" not in run("plan", "leak.txt").stdout  # hexagons have no such moves


def test_fcost_plans_unless_another_is_named(folder):
    assert run("plan", "world.txt").stdout.splitlines()[1].startswith("fcost: 3 of 3")
    summary = json.loads(run("plan", "world.txt", "--planner-option", "rule=paper", "--summary", "-").stdout)
    assert (summary["planner"].split()[0], summary["arrived"]) == ("fcost", 3)
    error = run("plan", "world.txt", "--planner-option", "rulle=paper", status=2).stderr
    assert "option of planner 'fcost' must be one of rule, rounds, not 'rulle'; did you mean 'rule'?" in error


def test_summary_has_the_documented_keys(folder):
    summary = json.loads(plan("--summary", "-").stdout)
    assert list(summary) == SUMMARY_KEYS
    assert list(summary["seconds"]) == ["read", "field", "plan", "audit"]
    assert (summary["robots"], summary["arrived"], summary["conflicts"]) == (3, 3, 0)
    plan("--summary", "s.json")
    again = json.loads((folder / "s.json").read_text())
    assert {**again, "seconds": 0} == {**summary, "seconds": 0}


@pytest.mark.parametrize("tessellation", ["triangular", "hexagonal", "square"])
@pytest.mark.parametrize("name", ["p.csv", "p.npz"])
def test_plan_check_animate(folder, tessellation, name):
    plan("--tessellation", tessellation, "--out", name, "--picture", "p.png")
    area = [] if name == "p.npz" else ["world.txt", "--tessellation", tessellation]
    verdict, *corners = run("check", name, *area).stdout.splitlines()
    assert verdict.endswith("; safe: no conflicts") and bool(corners) == (tessellation != "hexagonal")
    run("animate", name, *area, "--out", "p.gif", "--max-frames", 3)
    with Image.open("p.png") as picture, Image.open("p.gif") as movie:
        assert min(*picture.size, *movie.size) > 50
        assert movie.n_frames > 1
    with open("p.csv" if name == "p.csv" else "p.npz", "rb") as file:
        assert file.read(5) in (b"robot", b"PK\x03\x04\x14", b"PK\x03\x04\x2d")


def test_options_come_before_the_file(folder):
    """The letters aim north-west; the option aims east, with other robots and rules."""
    rules = ("--waiting-cost", 3, "--crossing", "allow", "--corners", "no-cut", "--destination-capacity", 1)
    shape = ("--tessellation", "square", "--costs", "euclidean", "--neighbourhood", "edge")
    result = plan(
        "--destination", "6,0", "--destination", "6,2", "--robots", 5, "--seed", 9, *rules, *shape, "--summary", "-"
    )
    summary = json.loads(result.stdout)
    told = (summary[key] for key in ("waiting_cost", "crossing", "corners", "destination_capacity", "robots", "seed"))
    assert tuple(told) == (3, "allow", "no-cut", 1, 5, 9)
    assert (summary["tessellation"], summary["neighbourhood"], summary["costs"]) == ("square", "edge", "euclidean")


def test_the_clock_and_following_are_options_and_come_before_the_file(folder):
    rules = ("--clock", "costs", "--following", "forbid", "--tessellation", "square")
    summary = json.loads(plan(*rules, "--out", "p.npz", "--write-scenario", "s.toml", "--summary", "-").stdout)
    assert (summary["clock"], summary["following"], summary["waiting_cost"]) == ("costs", "forbid", 1)
    assert summary["steps"] == summary["longest_time"] >= 5 and summary["conflicts"] == 0
    assert "arrive in" in run("check", "p.npz").stdout and " ticks; safe" in run("check", "p.npz").stdout
    again = json.loads(run("plan", "s.toml", "--summary", "-").stdout)
    assert (again["clock"], again["following"], again["total_time"]) == ("costs", "forbid", summary["total_time"])
    steps = json.loads(run("plan", "s.toml", "--clock", "steps", "--following", "allow", "--summary", "-").stdout)
    assert (steps["clock"], steps["following"], steps["waiting_cost"]) == ("steps", "allow", 10)
    assert plan(*rules).stdout.splitlines()[1].startswith("greedy: 3 of 3 robots arrive, the last in tick ")
    told = run("convert", "s.toml", "s.txt", status=2).stderr
    assert "letters cannot carry name square, " in told and "clock costs, following forbid" in told


def test_a_plan_in_csv_is_judged_by_the_clock_that_is_named(folder):
    rules = ("--clock", "costs", "--tessellation", "square")
    plan(*rules, "--out", "p.csv")
    assert "safe: no conflicts" in run("check", "p.csv", "world.txt", *rules).stdout
    told = run("check", "p.csv", "world.txt", *rules[2:], status=2).stderr
    assert "lacks step 1; here is step " in told and ", as by clock costs" in told
    rows = (folder / "p.csv").read_text().splitlines()[1:]
    assert [row.split(",")[1] for row in rows] == [row.split(",")[5] for row in rows]
    # Whoever follows at once is told where that is forbidden.
    (folder / "row.txt").write_text("ab.D\n")
    run("plan", "row.txt", *rules, "--out", "row.npz")
    assert "safe" in run("check", "row.npz").stdout
    assert "unsafe" in run("check", "row.npz", "--following", "forbid", status=1).stdout


def test_movies_keep_the_switch_of_their_clock_and_take_that_of_the_rules(folder):
    plan("--clock", "costs", "--tessellation", "square", "--out", "p.csv")
    rules = ("world.txt", "--tessellation", "square", "--clock", "costs")
    for name, switch in (("a.gif", "--no-clock"), ("b.gif", "--show-clock"), ("c.gif", "--show-clock")):
        assert " ticks" in run("animate", "p.csv", *rules, switch, "--out", name, "--max-frames", 4).stdout
    one, other, same = ((folder / f"{name}.gif").read_bytes() for name in "abc")
    assert one != other == same


def test_same_seed_same_plan(folder):
    for name in ("one.csv", "two.csv"):
        plan("--robots", 8, "--seed", 4, "--out", name)
    assert (folder / "one.csv").read_bytes() == (folder / "two.csv").read_bytes()
    plan("--robots", 8, "--seed", 5, "--out", "three.csv")
    assert (folder / "one.csv").read_bytes() != (folder / "three.csv").read_bytes()


def test_a_scenario_that_was_written_gives_the_same_plan(folder):
    plan(
        "--robots",
        8,
        "--corners",
        "no-cut",
        "--tessellation",
        "triangular",
        "--write-scenario",
        "s.toml",
        "--out",
        "p.csv",
    )
    summary = json.loads(run("plan", "s.toml", "--out", "again.csv", "--summary", "-").stdout)
    assert (folder / "p.csv").read_bytes() == (folder / "again.csv").read_bytes()
    assert (summary["planner"], summary["corners"], summary["seed"]) == ("greedy", "no-cut", 0)
    run("plan", "s.toml", "--tessellation", "square", "--out", "square.npz")
    assert th.read_plan(folder / "square.npz").scenario.area.tessellation.name == "square"


def test_starts_from_csv(folder):
    (folder / "starts.csv").write_text("x,y\n6,1\n5,1\n")
    plan("--starts", "starts.csv", "--out", "p.npz")
    assert th.read_plan(folder / "p.npz").scenario.robots.tolist() == [13, 12]


BROKEN = "robot,step,x,y,action,time\n0,0,1,0,start,0\n0,1,0,0,NW,10\n1,0,3,1,start,0\n1,1,1,0,jump,0\n1,2,0,0,NW,10\n"


def test_check_finds_what_is_unsafe(folder):
    (folder / "broken.csv").write_text(BROKEN)
    result = run("check", "broken.csv", "world.txt", status=1)
    assert "unsafe: 1 conflict\nstep 1: robot 1 jumps from (3, 1) to (1, 0), which is no neighbour\n" in result.stdout
    result = run("check", "broken.csv", "world.txt", "--summary", "-", status=1)
    assert json.loads(result.stdout)["conflicts"] == 1
    assert "step 1: robot 1 jumps" in result.stderr
    assert "jumps" not in run("check", "broken.csv", "world.txt", "--limit", 0, status=1).stdout


def test_check_by_stricter_rules(folder):
    (folder / "door.txt").write_text("a.B\nB.D\n")
    run("plan", "door.txt", "--planner", "greedy", "--tessellation", "square", "--out", "p.npz")
    run("check", "p.npz")
    assert "corner that the rule closes" in run("check", "p.npz", "--corners", "no-cut", status=1).stdout


def test_check_on_another_area(folder):
    plan("--out", "p.npz")
    (folder / "new.txt").write_text(WORLD.replace("\n.......\n", "\n...B...\n"))
    assert "onto the barrier (3, 1)" in run("check", "p.npz", "new.txt", status=1).stdout


def test_field(folder):
    run("field", "world.txt", "--out", "n.npy", "--directions", "d.npy", "--generations", "steps")
    scenario = th.read_scenario("world.txt")
    n_scheme = th.make_n_scheme(scenario)
    assert np.array_equal(np.load("n.npy"), n_scheme.distance)
    assert np.array_equal(np.load("d.npy"), th.make_d_scheme(n_scheme).directions)
    names = sorted(path.name for path in (folder / "steps").iterdir())
    assert names == [f"generation-{i:04d}.png" for i in range(len(list(th.distance_generations(scenario))))]
    far = n_scheme.farthest
    assert far == n_scheme.distance[~scenario.area.barriers].max()
    for number, states in enumerate(th.distance_generations(scenario)):
        title = f"world, generation {number}"
        wanted = th.picture_of_generation(scenario, states, number, far=far, title=title).to_array()
        with Image.open(folder / "steps" / names[number]) as picture:
            assert np.array_equal(np.asarray(picture.convert("RGB")), wanted)
    run("field", "world.txt", "--picture", "n.svg", "--directions-picture", "d.png")
    assert (folder / "n.svg").read_text().startswith("<svg")


def test_compare(folder):
    result = run("compare", "world.txt", "--planners", "greedy", "--out", "t.csv", "--picture", "bars.png")
    lines = result.stdout.splitlines()
    assert lines[0].split("  ")[:2] == ["tessellation", "planner"]
    assert [line.split()[:2] for line in lines[2:-1]] == [[name, "greedy"] for name in TESSELLATIONS]
    assert lines[-1] == "written: t.csv, bars.png"
    with open("t.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["tessellation"] for row in rows] == list(TESSELLATIONS)
    for row, line in zip(rows, lines[2:-1], strict=True):
        assert float(row["gap"]) == pytest.approx(int(row["total_time"]) / int(row["reference"]) - 1)
        assert row["total_time"] == line.split()[2]
        assert ("<=" in line) == (row["is_proven"] == "False")
    assert (folder / "bars.png").read_bytes().startswith(b"\x89PNG")


def test_compare_takes_planners_with_options(folder):
    lines = run("compare", "world.txt", "--planners", "fcost:rule=paper, greedy", "--tessellation", "square").stdout
    assert [line.split()[1] for line in lines.splitlines()[2:]] == ["fcost:rule=paper", "greedy"]
    for wrong, message in (
        ("fcost:rulle=paper", "--planners: option of planner 'fcost' must be one of rule, rounds, not 'rulle'"),
        ("fcots:rule=paper", "--planners must be one of greedy, fcost, astar, optimal, not 'fcots'"),
        ("fcost:rule=papr", "rule must be one of best, paper, queue, aside, lanes, not 'papr'; did you mean 'paper'?"),
    ):
        assert message in run("compare", "world.txt", "--planners", wrong, status=2).stderr


def test_compare_on_named_tessellations(folder):
    for option in (["--tessellations", "square"], ["--tessellation", "square"]):
        lines = run("compare", "world.txt", "--planners", "greedy", *option).stdout.splitlines()
        assert [line.split()[0] for line in lines[2:]] == ["square"]


def test_compare_says_who_cannot_arrive(folder):
    (folder / "closed.txt").write_text("DB.\n.Ba\n.B.\n")
    result = run("compare", "closed.txt", "--planners", "greedy", "--tessellations", "square,hexagonal", status=1)
    message = "1 of 1 robots cannot reach a destination: 0 at (2, 1)"
    assert result.stderr.splitlines() == [f"trihex: {name}: {message}" for name in ("square", "hexagonal")]


def test_demo(folder):
    result = run("demo", "--out", "shown")
    rows = [line.split() for line in result.stdout.splitlines()[3:]]
    assert [row[:2] for row in rows[: len(PLANNERS) * 3]] == [
        [one, other] for one in TESSELLATIONS for other in PLANNERS
    ]
    names = {"table.csv", "n-scheme.png", "plan.gif", *(f"plan-{name}.png" for name in TESSELLATIONS)}
    assert {path.name for path in (folder / "shown").iterdir()} == names
    for name in names - {"table.csv"}:
        with Image.open(folder / "shown" / name) as picture:
            assert min(picture.size) > 200
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 5


@pytest.mark.parametrize("kind", ["random", "rooms", "maze", "caves", "warehouse"])
def test_generate(folder, kind):
    result = run("generate", kind, "--size", "30,20", "--seed", 7, "--out", "a.map", "--picture", "a.png")
    area = th.read_area("a.map")
    assert (area.width, area.height) == (30, 20)
    assert result.stdout.startswith(f"a.map: 30 x 20 cells, {area.free_count} free (")
    run("generate", kind, "--size", "30,20", "--seed", 7, "--out", "b.txt")
    assert np.array_equal(th.read_area("b.txt").barriers, area.barriers)


def test_generate_with_options(folder):
    run("generate", "random", "--size", "30,20", "--density", 0, "--out", "a.map")
    assert th.read_area("a.map").free_count == 600
    run(
        "generate",
        "warehouse",
        "--size",
        "30,20",
        "--shelf-length",
        5,
        "--shelf-depth",
        1,
        "--aisle",
        3,
        "--out",
        "a.map",
    )
    assert th.read_area("a.map").free_count == 600 - 3 * 4 * 5


def test_convert_there_and_back(folder):
    plan("--out", "p.npz")
    run("convert", "p.npz", "p.csv")
    run("convert", "p.csv", "q.npz", "--area", "world.txt")
    one, other = th.read_plan("p.npz"), th.read_plan("q.npz")
    assert one.scenario == other.scenario
    assert np.array_equal(one.actions, other.actions)
    run("convert", "world.txt", "world.toml")
    run("convert", "world.toml", "again.txt")
    assert (folder / "again.txt").read_text() == WORLD
    (folder / "bare.txt").write_text("..B\n")
    run("convert", "bare.txt", "bare.map")
    run("convert", "bare.map", "again.txt")
    assert (folder / "again.txt").read_text() == "..B\n"


def test_convert_refuses_what_would_be_lost(folder):
    plan("--tessellation", "square", "--waiting-cost", 3, "--write-scenario", "s.toml")
    error = run("convert", "s.toml", "s.txt", status=2).stderr
    assert error.startswith("trihex: error: letters cannot carry name square, waiting cost 3, as s.toml has")


def test_help_of_every_command(folder):
    overview = run("--help").stdout
    for name, summary in COMMANDS.items():
        assert f"  {name} " in overview
        assert summary.endswith(".")
        assert run(name, "--help").stdout.startswith(f"Usage: trihex {name} ")
    assert run().stdout == overview
    assert run("--version").stdout == f"trihex {th.__version__}\n"


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError(28, "No space left on device"), ZeroDivisionError("why")])
def test_nothing_is_left_half_written(folder, monkeypatch, error):
    def fail(*_):
        raise error

    monkeypatch.setattr("trihex.formats.plans.csv.spelling_of", fail)
    before = set(folder.iterdir())
    status, message = {
        "type": (130, "interrupted; nothing is left half-written"),
        "OSError": (2, "No space left on device"),
        "ZeroDivisionError": (
            3,
            "this is a fault of trihex: ZeroDivisionError: 'why' (TRIHEX_TRACEBACK=1 shows where)",
        ),
    }[type(error).__name__]
    result = plan("--out", "p.csv", status=status)
    assert result.stderr.strip() == f"trihex: error: {message}"
    assert set(folder.iterdir()) == before


TRIHEX = [sys.executable, "-m", "trihex"]


def test_interrupt_of_a_process(folder):
    """It waits for a pipe that nobody fills."""
    os.mkfifo("pipe.txt")
    with (
        subprocess.Popen([*TRIHEX, "plan", "pipe.txt", "--out", "p.csv"], stderr=subprocess.PIPE, text=True) as process,
        open("pipe.txt", "w"),
    ):  # returns once trihex has opened its end
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate()
    assert process.returncode == 130
    assert stderr.splitlines()[-1] == "trihex: error: interrupted; nothing is left half-written"
    assert "Traceback" not in stderr
    assert sorted(path.name for path in folder.iterdir()) == ["pipe.txt", "world.txt"]


def test_termination_leaves_nothing_behind(folder):
    code = (
        "import os, signal, trihex.formats.plans.csv as plan_csv\n"
        "plan_csv.spelling_of = lambda *_: os.kill(os.getpid(), signal.SIGTERM)\n"
        "from trihex.cli import main\n"
        "main(['plan', 'world.txt', '--planner', 'greedy', '--out', 'p.csv'])"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, check=False).returncode == 143
    assert [path.name for path in folder.iterdir()] == ["world.txt"]


def test_a_process_whose_reader_has_gone(folder):
    command = [*TRIHEX, "plan", "world.txt", "--planner", "greedy", "--summary", "-"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        process.stdout.close()
        stderr = process.stderr.read()
    assert process.returncode == 141
    assert stderr == ""


def test_bars_are_for_terminals_only(folder):
    result = subprocess.run(
        [*TRIHEX, "plan", "world.txt", "--planner", "greedy"], capture_output=True, text=True, check=True
    )
    assert result.stderr == ""


def test_every_command_is_listed(folder):
    helpers = {"described", "group", "maps", "options", "outputs", "progress", "texts", "tiles", "types"}
    modules = {path.stem for path in Path(trihex.cli.__file__).parent.glob("[a-z]*.py")}
    assert modules == helpers | COMMANDS.keys()


def test_no_command_needs_numpy_before_it_works():
    code = "import sys, importlib; [importlib.import_module(f'trihex.cli.{name}') for name in sys.argv[1:]]"
    command = [sys.executable, "-c", f"{code}; print('numpy' in sys.modules)", *COMMANDS]
    assert subprocess.check_output(command, text=True) == "False\n"


def test_a_certificate_is_written_beside_the_plan_and_can_be_checked(folder):
    from examples.check_certificate import check

    options = ["--robots", 5, "--seed", 1, "--planner", "optimal", "--destination-capacity", 1]
    outputs = ["--out", "p.npz", "--certificate", "c.csv", "--write-scenario", "s.toml"]
    done = run("plan", "world.txt", *options, *outputs)
    assert "written: p.npz, c.csv, s.toml" in done.output
    assert "5 robots, 1 destinations, hexagonal: " in check("world.txt", "p.npz", "c.csv")
    Path("c.csv").unlink()
    run("plan", "s.toml")
    assert "no plan takes less" in check("world.txt", "p.npz", "c.csv")
