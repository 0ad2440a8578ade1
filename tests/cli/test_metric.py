"""The command line on places in metres: from a ROS map to waypoints, scenarios and other formats, and `show`."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from tests.oracles.continuous import boxes_of_pixels, find_contacts
from trihex.cli import main

SIZE = ["--cell-size", "0.4", "--robot-radius", "0.1"]
PLACES = ["--destination", "2,2m", "--destination", "2,2.4m"]


def run(*arguments):
    planner = ["--planner", "greedy"] if arguments[0] == "plan" else []
    return CliRunner().invoke(main, [str(argument) for argument in [*arguments, *planner]])


@pytest.fixture
def house(tmp_path, monkeypatch):
    """The working folder holds a house of 8 x 6 metres; returns what is occupied in it."""
    monkeypatch.chdir(tmp_path)
    pixels = np.full((60, 80), 254, dtype=np.uint8)
    pixels[[0, -1]] = pixels[:, [0, -1]] = pixels[20:40, 40] = 0
    Image.fromarray(pixels).save("house.pgm")
    (tmp_path / "house.yaml").write_text("image: house.pgm\nresolution: 0.1\norigin: [-1, -1, 0]\n")
    return boxes_of_pixels(pixels == 0, 0.1, (-1.0, -1.0))


@pytest.mark.parametrize("tessellation", ["hexagonal", "square"])
def test_from_a_ros_map_to_safe_waypoints(house, tmp_path, tessellation):
    size = ["--cell-size", "0.5", "--robot-radius", "0.1", "--tessellation", tessellation]
    done = run("plan", "house.yaml", *size, *PLACES, "--robots", 20, "--waypoints", "w.csv", "--out", "p.npz")
    assert done.exit_code == 0, done.output
    assert "20 of 20 robots arrive" in done.output
    assert find_contacts("w.csv", 0.1, house) == []
    assert run("check", "p.npz").exit_code == 0


def test_a_scenario_that_was_written_gives_the_same_plan_byte_for_byte(house, tmp_path):
    first = ["--robots", 20, "--write-scenario", "s.toml", "--out", "1.npz", "--waypoints", "1.csv"]
    assert run("plan", "house.yaml", *SIZE, *PLACES, *first).exit_code == 0
    assert run("plan", "s.toml", "--out", "2.npz", "--waypoints", "2.csv").exit_code == 0
    assert (tmp_path / "1.npz").read_bytes() == (tmp_path / "2.npz").read_bytes()
    assert (tmp_path / "1.csv").read_bytes() == (tmp_path / "2.csv").read_bytes()


def test_a_plan_in_metres_becomes_every_format_of_motion(house, tmp_path):
    assert (
        run("plan", "house.yaml", *SIZE, *PLACES, "--robots", 5, "--out", "p.npz", "--waypoints", "w.csv").exit_code
        == 0
    )
    for name in ("w.json", "w.yaml", "w.geojson", "w.sqlite", "w.mcap", "p.csv", "p.parquet"):
        done = run("convert", "p.npz", name)
        assert done.exit_code == 0, done.output
        assert (tmp_path / name).stat().st_size > 0
    assert run("convert", "p.npz", "again.csv", "--waypoints").exit_code == 0
    assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "w.csv").read_bytes()
    assert len(json.loads((tmp_path / "w.json").read_text())) == 5
    assert run("check", "p.parquet", "house.yaml", *SIZE, *PLACES).exit_code == 0
    refused = run("convert", "p.npz", "p.txt")
    assert refused.exit_code == 2 and "mapf-visualizer draws squares only" in refused.output


def test_a_recording_is_the_same_whoever_writes_it(house, tmp_path):
    words = ["--robots", 5, "--speed", "0.5", "--out"]
    assert run("plan", "house.yaml", *SIZE, *PLACES, *words, "p.npz").exit_code == 0
    done = run("plan", "house.yaml", *SIZE, *PLACES, *words, "one.mcap")
    assert done.exit_code == 0 and "written: one.mcap" in done.output
    assert run("convert", "p.npz", "other.mcap", "--speed", "0.5").exit_code == 0
    assert (tmp_path / "one.mcap").read_bytes() == (tmp_path / "other.mcap").read_bytes()


def test_starts_in_metres_and_from_scen(house, tmp_path):
    (tmp_path / "starts.csv").write_text("x_metres,y_metres\n0,0\n5,3\n")
    done = run("plan", "house.yaml", *SIZE, *PLACES, "--starts", "starts.csv")
    assert done.exit_code == 0 and "2 of 2 robots arrive" in done.output
    (tmp_path / "a.map").write_text("type octile\nheight 1\nwidth 4\nmap\n....\n")
    (tmp_path / "a.scen").write_text("version 1\n0\ta.map\t4\t1\t3\t0\t1\t0\t2\n")
    done = run("plan", "a.map", "--destination", "0,0", "--starts", "a.scen")
    assert done.exit_code == 0 and "1 of 1 robots arrive" in done.output
    assert "goals of a.scen are not used: all robots go to the destinations" in done.output


def test_show_tells_and_draws_an_area(house):
    done = run("show", "house.yaml", *SIZE, "--columns", 30)
    lines = done.output.splitlines()
    assert done.exit_code == 0
    assert lines[:3] == [
        "house: 23 x 15 cells, hexagonal, full neighbourhood; 256 free (74.2 %)",
        "8.0829 x 6.2 metres, cell size 0.4, robot radius 0.1; north-west corner at (-1, 5), yaw 0",
        "1 connected part, of 256 cells",
    ]
    assert len(lines) == 3 + 15 and set("".join(lines[3:])) == set(".#")  # a letter for each cell
    assert lines[-1] == "#" * 23


TURNS = ("--turn-time", "0.25", "--frame-id", "hall")


def test_a_scenario_tells_its_outputs_and_writes_them_beside_itself(house, tmp_path, monkeypatch):
    first = [
        "--robots",
        5,
        "--speed",
        "0.5",
        *TURNS,
        "--write-scenario",
        "s.toml",
        "--out",
        "p.npz",
        "--waypoints",
        "w.csv",
    ]
    assert run("plan", "house.yaml", *SIZE, *PLACES, *first, "--picture", "p.svg").exit_code == 0
    text = (tmp_path / "s.toml").read_text()
    outputs = 'plan = "p.npz"\npicture = "p.svg"\nwaypoints = "w.csv"\nspeed = 0.5\nturn_time = 0.25\n'
    assert f'[outputs]\n{outputs}frame_id = "hall"\n' in text
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "s.toml").write_text(text.replace("p.svg", "p.png"))
    before = {name: (tmp_path / name).read_bytes() for name in ("p.npz", "w.csv")}
    assert run("plan", "elsewhere/s.toml", "--waypoints", "other.csv").exit_code == 0
    assert (tmp_path / "elsewhere" / "p.npz").read_bytes() == before["p.npz"]
    assert (tmp_path / "elsewhere" / "p.png").exists() and not (tmp_path / "elsewhere" / "w.csv").exists()
    assert (tmp_path / "other.csv").read_bytes() == before["w.csv"]


@pytest.mark.parametrize("output", ["../p.npz", "/p.npz", "a/../../p.npz", ""])
def test_a_scenario_must_not_write_elsewhere(house, tmp_path, output):
    assert run("plan", "house.yaml", *SIZE, *PLACES, "--robots", 2, "--write-scenario", "s.toml").exit_code == 0
    (tmp_path / "s.toml").write_text((tmp_path / "s.toml").read_text() + f'[outputs]\nplan = "{output}"\n')
    done = run("plan", "s.toml")
    assert done.exit_code == 2 and "outputs.plan: must be a path beside the scenario or below it" in done.output


def test_a_place_becomes_an_area_in_a_file_of_its_own(house, tmp_path):
    assert run("convert", "house.yaml", "house.toml", *SIZE).exit_code == 0
    assert run("show", "house.toml").output == run("show", "house.yaml", *SIZE).output
    refused = run("convert", "house.yaml", "house.map", *SIZE)
    assert refused.exit_code == 2 and "which this format cannot carry" in refused.output
    done = run("plan", "house.toml", *PLACES, "--robots", 5)
    assert done.exit_code == 0 and "5 of 5 robots arrive" in done.output


DOORS = """{"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"kind": "free"}, "geometry":
    {"type": "Polygon", "coordinates": [[[0, 0], [6, 0], [6, 2], [0, 2], [0, 0]]]}},
  {"type": "Feature", "properties": {"kind": "KIND", "name": "east", "capacity": "0.6/s"}, "geometry":
    {"type": "LineString", "coordinates": [[AT, 0], [AT, 2]]}}]}"""


def test_flows_a_second_are_judged_at_the_speed_of_the_plan(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.geojson").write_text(DOORS.replace("KIND", "destination").replace("AT", "6"))
    size = ["a.geojson", "--cell-size", "0.5"]
    assert run("plan", *size, "--robots", 8, "--speed", 0.5, "--out", "p.csv").exit_code == 0
    done = run("check", "p.csv", *size, "--speed", 0.5)
    assert done.exit_code == 0 and "safe: no conflicts" in done.output
    assert run("check", "p.csv", *size).exit_code == 1  # at 1 metre in a second half as many a step
    for speed, status in (((), 1), (("--speed", 0.5), 0)):
        assert run("convert", "p.csv", "p.npz", "--area", *size, *speed).exit_code == 0
        assert run("check", "p.npz").exit_code == status
    for told, status in ((["--speed", 0.5], 2), (["--speed", 0.5, "--capacity", "east=0.6/s"], 0)):
        assert run("convert", "p.npz", "again.csv", *told).exit_code == status  # the plan knows flows a step alone
    summary = run("check", "p.npz", "--capacity", "east=0.6/s", "--speed", 0.5, "--summary", "-")
    assert '"east": "0.6/s"' in summary.output and '"conflicts": 0' in summary.output


def test_doors_that_cannot_be_carried_are_refused_not_dropped(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.geojson").write_text(DOORS.replace("KIND", "door").replace("AT", "3"))
    refused = run("convert", "a.geojson", "a.toml", "--cell-size", 0.5)
    assert refused.exit_code == 2 and not (tmp_path / "a.toml").exists()
    assert "an area without destinations cannot carry doors with a flow, as a.geojson has" in refused.output
    doors = "[[doors]]\ncells = [[1, 0]]\ncapacity = 0.5\n"
    (tmp_path / "s.toml").write_text('destinations = [[0, 0]]\n[area]\nrows = ["..."]\n' + doors)
    refused = run("convert", "s.toml", "s.txt")
    assert refused.exit_code == 2 and "letters cannot carry doors with a flow, as s.toml has" in refused.output


def test_starts_of_scen_become_csv(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.map").write_text("type octile\nheight 1\nwidth 4\nmap\n....\n")
    (tmp_path / "a.scen").write_text("version 1\n0\ta.map\t4\t1\t3\t0\t1\t0\t2\n")
    assert run("convert", "a.scen", "a.csv", "--area", "a.map").exit_code == 0
    assert (tmp_path / "a.csv").read_text() == "x,y\n3,0\n"
    refused = run("convert", "a.scen", "b.csv")
    assert refused.exit_code == 2 and "a.scen holds starts in an area: add --area AREA" in refused.output


def test_compare_covers_a_place_anew_by_each_tessellation_that_fits(house):
    size = ["--cell-size", "0.5", "--robot-radius", "0.13"]
    done = run("compare", "house.yaml", *size, *PLACES, "--robots", 10, "--planners", "greedy")
    assert done.exit_code == 0, done.output
    assert [line.split()[0] for line in done.stdout.splitlines()[2:]] == ["hexagonal", "square"]
    assert done.stderr.startswith("trihex: triangular is left out: cell_size must be at least 0.7944 metres (0.52 ")
    done = run("compare", "house.yaml", *size, *PLACES, "--robots", 10, "--tessellations", "square,triangular")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "on triangular cells" in done.stderr
    done = run("compare", "house.yaml", "--cell-size", 0.2, "--robot-radius", 0.1, *PLACES, "--robots", 10)
    assert done.exit_code == 2 and done.stderr.count("is left out") == 3
    assert "no tessellation fits" in done.stderr


def test_clearance_is_kept_beyond_the_radius(house, tmp_path):
    """Robots of 0.05 metres that keep 0.05 clear find the room that robots of 0.1 have; less size is refused."""
    keep = ["--cell-size", "0.4", "--robot-radius", "0.05", "--clearance", "0.05"]
    done = run("convert", "house.yaml", "a.toml", *keep)
    assert done.output.endswith("written: a.toml\n")
    run("convert", "house.yaml", "b.toml", *SIZE)
    assert (tmp_path / "a.toml").read_text() == (tmp_path / "b.toml").read_text()
    small = run("plan", "house.yaml", *keep[2:], "--cell-size", "0.3", "--following", "allow", *PLACES, "--robots", 2)
    assert small.exit_code == 2 and "cell_size must be at least 0.4 metres" in small.output
    assert run("plan", "house.yaml", *SIZE, "--clearance", "-1", *PLACES).output.startswith(
        "trihex: error: --clearance must be a number above 0, not '-1'"
    )


def test_all_that_is_written_of_a_plan_is_in_ticks_by_the_clock_costs(house, tmp_path):
    """Maps, exits and seconds come out; what robots that never stand all at once cannot do is refused in a line."""
    options = ["house.yaml", "--cell-size", "0.5", "--tessellation", "square", "--clock", "costs", *PLACES]
    options += ["--robots", 20]
    more = [
        "--waiting",
        "w.npy",
        "--density",
        "d.png",
        "--arrivals",
        "e.csv",
        "--waypoints",
        "w.csv",
        "--picture",
        "p.png",
    ]
    done = run("plan", *options, *more, "--out", "p.csv", "--summary", "s.json")
    assert done.exit_code == 0, done.output
    summary, exits = json.loads((tmp_path / "s.json").read_text()), (tmp_path / "e.csv").read_text().splitlines()
    assert "a tick lasts 0.0714 s" in done.output and len(exits) == summary["steps"] + 2
    assert summary["last_arrival_seconds"] == pytest.approx(summary["steps"] * summary["step_seconds"])
    assert np.load("w.npy").sum() == (tmp_path / "p.csv").read_text().count(",wait,") == summary["total_waiting"]
    for refused, message in (
        ("--straight", "plan must have moves of one step"),
        ("--turn-time=1", "turn_time must be 0"),
    ):
        done = run("plan", *options, refused)
        assert done.exit_code == 2 and message in done.output and len(done.output.strip().splitlines()) <= 3, (
            done.output
        )


def test_a_turn_time_that_cannot_be_is_told_before_robots_go_their_ways(house, tmp_path, monkeypatch):
    options = ["house.yaml", "--cell-size", "0.5", "--tessellation", "square", "--clock", "costs", *PLACES]
    options += ["--robots", 20]
    assert run("plan", *options, "--out", "p.npz").exit_code == 0
    assert run("run", *options, "--out", "r.npz", "--max-steps", 20).exit_code == 0

    def begun(*args, **more):
        raise AssertionError("robots were planned or ran")

    monkeypatch.setattr("trihex.planners.make_plan", begun)
    monkeypatch.setattr("trihex.running.passing.PassingOrder.run", begun)
    monkeypatch.setattr("trihex.running.trial.Trial.run", begun)
    assert run("plan", *options).exit_code == 3
    for command in (["plan", *options], ["run", *options], ["run", "--plan", "p.npz"], ["run", "--resume", "r.npz"]):
        done = run(*command, "--turn-time", 1, "--waypoints", "w.csv")
        assert done.exit_code == 2 and "turn_time must be 0 where clock is 'costs'" in done.output, done.output
        assert not (tmp_path / "w.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (
            ["plan", "--out", "p.dependencies.json"],
            "dependencies tell who waits for whom, not for how long: doors must",
        ),
        (["plan", "--out", "p.vda5050.json"], "dependencies tell who waits for whom, not for how long: doors must"),
        (
            ["run", "--replan"],
            "planner must be greedy or fcost, without replan, where doors have a flow, not 'fcost' wi",
        ),
        (
            ["run", "--planner", "astar"],
            "planner must be greedy or fcost, without replan, where doors have a flow, not",
        ),
    ],
)
def test_what_doors_forbid_is_told_before_anything_is_planned(arguments, told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.geojson").write_text(DOORS.replace("KIND", "destination").replace("AT", "6"))
    for name in ("trihex.planners.make_plan", "trihex.running.Trial.__init__", "trihex.kernels.preparing.prepare"):
        monkeypatch.setattr(name, lambda *_, **__: pytest.fail("the work has begun"))
    command, *options = arguments
    done = run(command, "a.geojson", "--cell-size", "0.5", "--robots", 3, *options)
    assert done.exit_code == 2 and told in done.output and "\n" not in done.output.strip()
    assert [path.name for path in tmp_path.iterdir()] == ["a.geojson"]


def test_the_order_of_a_plan_is_written_by_plan_and_by_convert_alike(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.map").write_text("type octile\nheight 1\nwidth 5\nmap\n.....\n")
    place = ["a.map", "--destination", "4,0", "--robots", 3]
    assert run("plan", *place, "--out", "p.npz").exit_code == 0
    assert run("plan", *place, "--speed", 0.5, "--out", "p.dependencies.json").exit_code == 0
    assert run("convert", "p.npz", "c.dependencies.json", "--speed", 0.5).exit_code == 0
    assert (tmp_path / "p.dependencies.json").read_bytes() == (tmp_path / "c.dependencies.json").read_bytes()
    refused = run("plan", *place, "--out", "p.vda5050.json")
    assert refused.exit_code == 2 and "--out p.vda5050.json is in metres: add --cell-size" in refused.output
