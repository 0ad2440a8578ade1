"""Bad input: exit status 2 and one line that says what, where, the rule and the value; one row a mistake."""

# A row is a mistake and its message; broken lines would hide the table.
# ruff: noqa: E501

import pytest
from click.testing import CliRunner

from trihex import Area, Scenario, write_plan
from trihex.cli import main
from trihex.plans import plan_from_lists

MAP = "type octile\nheight 3\nwidth 4\nmap\n....\n.@..\n....\n"
# What lies in the working folder of every row.
FILES = {
    "world.map": MAP,
    "closed.map": "type octile\nheight 1\nwidth 3\nmap\n.@.\n",
    "world.txt": "a.D\n.B.\n",
    "starts.csv": "x,y\n0,0\n2,0\n",
    "plan.csv": "robot,step,x,y,action,time\n0,0,2,0,start,0\n0,1,3,0,SE,10\n",
}
AIM = ["--destination", "3,0"]
PLAN = ["plan", "world.map", *AIM, "--planner", "greedy"]
ONE = [*PLAN, "--robots", "1"]

# What is wrong: a file of the row and its content, the command, and what it says.
CASES = {
    # files
    "missing file": (None, ["plan", "wrold.map", *AIM, "--robots", "1"], "wrold.map: No such file or directory; did you mean 'world.map'?"),
    "directory": (None, ["plan", ".", *AIM], ".: Is a directory"),
    "empty file": ("", ["plan", "bad", *AIM], "bad: the file is empty"),
    "no text": (b"\x00\xff\xfe", ["plan", "bad", *AIM], "bad: must be UTF-8 text; byte 0xff at position 1 is none"),
    "truncated map": (MAP[:-10], ["plan", "bad", *AIM], "bad: truncated: height 3 and width 4 promise 12 cells (at most 2000000000), but the rows take only 5 bytes"),
    "truncated by a row": ("type octile\nheight 4\nwidth 2\nmap\n..\n..\n..\n", ["plan", "bad", *AIM], "bad: truncated: height is 4, but there are 3 rows"),
    "wrong header": (MAP.replace("height", "hight"), ["plan", "bad", *AIM], "bad: line 2: wrong header: expected height or width, not 'hight 3'"),
    "wrong type": (MAP.replace("octile", "octlie"), ["plan", "bad", *AIM], "bad: line 1: type must be one of octile, tile, octile_unicost, hex, not 'octlie'; did you mean 'octile'?"),
    "wrong height": (MAP.replace("3", "-3"), ["plan", "bad", *AIM], "bad: line 2: height must be a whole number from 1, not '-3'"),
    "no rows": ("type octile\nheight 3\nwidth 4\n", ["plan", "bad.map", *AIM], "bad.map: line 4: wrong header: expected map, not ''"),
    "more rows": (MAP + "....\n", ["plan", "bad", *AIM], "bad: height is 3, but there are 4 rows"),
    "ragged map": (MAP.replace("\n.@..", "\n.@."), ["plan", "bad", *AIM], "bad: ragged rows: row 1 has 3 letters, it must have 4"),
    "ragged letters": ("..D\n....\n", ["plan", "bad"], "bad: ragged rows: row 1 has 4 letters, it must have 3"),
    "unknown letter": (MAP.replace("@", "x"), ["plan", "bad", *AIM], "bad: row 1, column 1: unknown letter 'x'; known are . G S E (free) and @ O T W (barriers)"),
    "letter of no alphabet": ("..D\n.é.\n", ["plan", "bad"], "bad: row 1, column 1: unknown letter 'é'; known are . (free), B or # (barrier), D (destination), a to z (robots)"),
    "one robot twice": ("a.D\n..a\n", ["plan", "bad"], "bad: robot 'a' must stand in one cell, not in (0, 0) and (2, 1)"),
    "claim of 1 GB": (MAP.replace("3", "1000000000"), ["plan", "bad", *AIM], "bad: truncated: height 1000000000 and width 4 promise 4000000000 cells (at most 2000000000), but the rows take only 15 bytes"),
    "claim beyond all numbers": (MAP.replace("3", "9" * 50), ["plan", "bad", *AIM], f"bad: line 2: height must be a whole number from 1, not '{'9' * 40}'"),
    "compressed": (b"\x1f\x8b\x08\x00", ["plan", "bad", *AIM], "bad: is gzip, which trihex cannot read"),
    "wrong header of starts": ("y,x\n1,1\n", [*PLAN, "--starts", "bad"], "bad: line 1: the header must be 'x,y', not 'y,x'"),
    "start outside": ("x,y\n4,0\n", [*PLAN, "--starts", "bad"], "bad: line 2: cell (4, 0) lies outside the area: x is 0..3, y is 0..2"),
    "start in halves": ("x,y\n0,0.5\n", [*PLAN, "--starts", "bad"], "bad: line 2: y must be a whole number of at most 18 digits, not '0.5'"),
    "scenario with a strange key": ('[area]\npath = "world.map"\ntesselation = "square"\n', ["plan", "bad"], "bad: area.tesselation: there is no such key; did you mean 'tessellation'?"),
    # places
    "destination outside": (None, ["plan", "world.map", "--destination", "4,0", "--robots", "1"], "--destination: cell (4, 0) lies outside the area: x is 0..3, y is 0..2"),
    "destination on a barrier": (None, ["plan", "world.map", "--destination", "1,1", "--robots", "1"], "destination 0 must stand on a free cell; (1, 1) is a barrier; the nearest free cell is (1, 0)"),
    "destination in one number": (None, ["plan", "world.map", "--destination", "4", "--robots", "1"], "--destination must be X,Y, two whole numbers, not '4'"),
    "no destination": (None, ["plan", "world.map", "--robots", "1"], "there is no destination: add --destination X,Y"),
    "robot on a barrier": ("x,y\n0,0\n1,1\n", [*PLAN, "--starts", "bad"], "robot 1 must stand on a free cell; (1, 1) is a barrier; the nearest free cell is (1, 0)"),
    "two robots in one cell": ("x,y\n0,0\n2,2\n0,0\n", [*PLAN, "--starts", "bad"], "two robots must not share a cell; robots 0 and 2 both start at (0, 0)"),
    "more robots than free cells": (None, [*PLAN, "--robots", "11"], "robots must be at most the number of free cells, 10, not 11"),
    "no robots": (None, PLAN, "there are no robots: add --robots N or --starts FILE"),
    # options
    "unknown tessellation": (None, [*ONE, "--tessellation", "hexgonal"], "--tessellation must be one of triangular, hexagonal, square, not 'hexgonal'; did you mean 'hexagonal'?"),
    "unknown clock": (None, [*ONE, "--clock", "cost"], "--clock must be one of steps, costs, not 'cost'; did you mean 'costs'?"),
    "unknown following": (None, [*ONE, "--following", "never"], "--following must be one of allow, forbid, not 'never'"),
    "waiting by a clock": (None, [*ONE, "--clock", "costs", "--waiting-cost", "3"], "waiting_cost must be 1 where clock is 'costs', not 3"),
    "unknown corners": (None, [*ONE, "--corners", "nocut"], "--corners must be one of allow, no-squeeze, no-cut, not 'nocut'; did you mean 'no-cut'?"),
    "unknown planner": (None, [*ONE, "--planner", "gredy"], "--planner must be one of *, not 'gredy'; did you mean 'greedy'?"),
    "unknown option of a planner": (None, [*ONE, "--planner-option", "speed=3"], "planner 'greedy' has no options, so not 'speed'"),
    "half an option of a planner": (None, [*ONE, "--planner-option", "speed"], "--planner-option must be NAME=VALUE, not 'speed'"),
    "negative cost": (None, [*ONE, "--waiting-cost", "-3"], "--waiting-cost must be a whole number from 0 to 1073741824, not '-3'"),
    "capacity of nothing": (None, [*ONE, "--destination-capacity", "0"], "--destination-capacity must be a number of robots above 0: a step, such as 2, 0.5 or 1/3, or in metres a second, such as 1.6/s; not '0'"),
    "capacity in words": (None, [*ONE, "--capacity", "3,0=much"], "--capacity must be a number of robots above 0: a step, such as 2, 0.5 or 1/3, or in metres a second, such as 1.6/s; not 'much'"),
    "capacity of no place": (None, [*ONE, "--capacity", "0.5"], "--capacity must be the name of a zone or a cell X,Y, =, and a flow, as north=1.6/s or 3,4=0.5, not '0.5'"),
    "capacity of a zone that does not exist": (None, [*ONE, "--capacity", "north=0.5"], "door: zone 'north' does not exist: the area has none"),
    "capacity of a barrier": (None, [*ONE, "--capacity", "1,1=0.5"], "door 0 must have free cells; (1, 1) is a barrier"),
    "capacity in seconds without metres": (None, [*ONE, "--capacity", "3,0=1.6/s"], "capacity of a door must be robots a step, such as 0.5, in an area without metres, not '1.6/s'"),
    "capacity of next to nothing": (None, [*ONE, "--destination-capacity", "0.00001"], "destination_capacity must be from 1/10000 to 1073741824 robots a step, not '0.00001'"),
    "certificate where doors have a flow": (None, [*ONE, "--planner", "optimal", "--destination-capacity", "0.5", "--certificate", "c.csv"], "a certificate needs destinations that let in as many in each step, not doors of a flow"),
    "replanning where doors have a flow": (None, ["run", "world.map", *AIM, "--robots", "1", "--destination-capacity", "0.5", "--replan"], "planner must be greedy or fcost, without replan, where doors have a flow, not 'fcost' with replan: *"),
    "robots in words": (None, [*PLAN, "--robots", "many"], "--robots must be a whole number from 0 to 1073741824, not 'many'"),
    "more robots than starts": (None, [*PLAN, "--robots", "3", "--starts", "starts.csv"], "--robots takes the first of starts.csv: at most 2, not 3"),
    "seed for nothing": (None, [*PLAN, "--starts", "starts.csv", "--seed", "3"], "--seed draws robots: add --robots N"),
    "unknown option": (None, [*ONE, "--tesselation", "square"], "there is no option '--tesselation'; did you mean '--tessellation'?"),
    "unknown command": (None, ["plam", "world.map"], "there is no command 'plam'; did you mean 'plan'?"),
    "no time for a plan": (None, ["run", "world.map", *AIM, "--budget", "0"], "--budget must be a number above 0, not '0'"),
    "sensing in words": (None, ["run", "world.map", *AIM, "--sense", "far"], "--sense must be a number from 0 to 100, not 'far'"),
    "a run of nothing": (None, ["run"], "there is no AREA: name one, or add --plan PLAN or --resume RUN"),
    "processes without tiles": (None, ["field", "world.map", *AIM, "--jobs", "2"], "--jobs is for areas in .npy or .zarr"),
    "no area": (None, ["plan"], "Missing argument 'AREA'"),
    "too many areas": (None, ["plan", "world.map", "closed.map"], "Got unexpected extra argument (closed.map)"),
    "option without a value": (None, ["plan", "world.map", "--robots"], "Option '--robots' requires an argument"),
    # outputs
    "output nowhere": (None, [*ONE, "--out", "nowhere/plan.csv"], "nowhere: No such directory"),
    "output to a directory": (None, [*ONE, "--summary", "."], ".: Is a directory"),
    "output under a file": (None, [*ONE, "--picture", "world.map/p.png"], "world.map: Not a directory"),
    "output of no kind": (None, [*ONE, "--out", "plan.cvs"], "plan.cvs: the suffix of a plan must be one of *, not '.cvs'; did you mean '.csv'?"),
    "two outputs of one name": (None, [*ONE, "--picture", "p.png", "--summary", "p.png"], "two outputs must not have one name, p.png"),
    "certificate of no kind": (None, [*ONE, "--planner", "optimal", "--certificate", "c.json"], "c.json: the suffix of a certificate must be one of .csv, not '.json'"),
    "certificate of a plan that is not optimal": (None, [*ONE, "--certificate", "c.csv"], "--certificate proves what planner 'optimal' plans, not 'greedy'"),
    "certificate where nobody follows": (None, [*ONE, "--planner", "optimal", "--following", "forbid", "--certificate", "c.csv"], "a certificate needs time in steps alone: clock='steps' and following='allow', not 'steps', 'forbid'"),
    "prices of no kind": (None, ["prices", "world.map", *AIM, "--robots", "1", "--out", "p.json"], "p.json: the suffix of prices must be one of .csv, not '.json'"),
    "prices of windows": (None, ["prices", "world.map", *AIM, "--robots", "1", "--kind", "window"], "--kind must be one of barrier, choke, door, not 'window'"),
    "prices where nobody follows": (None, ["prices", "world.map", *AIM, "--robots", "1", "--following", "forbid"], "planner 'optimal' needs following='allow', not 'forbid', *"),
    "no time for prices": (None, ["prices", "world.map", *AIM, "--robots", "1", "--limit-seconds", "0"], "--limit-seconds must be a number above 0, not '0'"),
    # other commands
    "plan without its area": (None, ["check", "plan.csv"], "plan.csv does not hold its area: add AREA"),
    "plan to convert without its area": (None, ["convert", "plan.csv", "p.npz"], "plan.csv does not hold its area: add --area AREA"),
    "triangular plan on hexagons": ("robot,step,x,y,action,time\n0,0,1,0,start,0\n0,1,3,0,EE,14\n", ["check", "bad", "world.map", *AIM], "bad: line 3: action must be one of *; the plan looks triangular (--tessellation triangular), not hexagonal"),
    "a long name": ('[area]\nname = "' + "x" * 2000 + '"\nrows = ["D."]\n', ["plan", "bad", "--robots", "1"], "bad: area: name must be text of at most 1000 characters, not 'xxxx*"),
    "a wrong letter among walls": ("#####\n#X.D#\n#####\n", ["plan", "bad"], "bad: row 1, column 1: unknown letter 'X'; known are . (free), B or # (barrier), *"),
    "waypoints in cells": (None, [*ONE, "--waypoints", "w.csv"], "--waypoints are in metres: add --cell-size"),
    "recording in cells": (None, [*ONE, "--out", "p.mcap"], "--out p.mcap is in metres: add --cell-size"),
    "plan of another area": (None, ["check", "plan.csv", "closed.map", "--destination", "0,0"], "plan.csv: line 3: cell (3, 0) lies outside the area: x is 0..2, y is 0..0"),
    "plan of another cost": (None, ["check", "plan.csv", "world.map", *AIM, "--costs", "euclidean"], "plan.csv: line 3: time must rise by 1000 for 'SE', not by 10; the plan was made with other costs or another waiting cost"),
    "npz of another tessellation": (None, ["check", "plan.npz", "--tessellation", "square"], "plan.npz is a plan for tessellation hexagonal, which cannot be read as square"),
    "npz of another place": (None, ["check", "plan.npz", "--cell-size", "0.5"], "plan.npz holds its area itself, so how to read one cannot be told"),
    "npz of another size": (None, ["check", "plan.npz", "closed.map"], "plan.npz needs an area of 4 x 3 cells, closed.map has 3 x 1"),
    "waypoints without metres": (None, ["convert", "plan.npz", "p.geojson"], "the area is measured in cells, not in metres"),
    "an area is no plan": (None, ["check", "world.map", "world.map", *AIM], "world.map must hold a plan (.npz, .csv or .parquet), not a MovingAI map"),
    "movie of no kind": (None, ["animate", "plan.csv", "world.map", *AIM, "--out", "p.avi"], "p.avi: the suffix of a movie must be one of *, not '.avi'"),
    "field without destination": (None, ["field", "world.map"], "there is no destination: add --destination X,Y"),
    "unknown generator": (None, ["generate", "rooom", "--size", "9,9", "--out", "a.map"], "KIND must be one of random, rooms, maze, caves, warehouse, not 'rooom'; did you mean 'rooms'?"),
    "density of a maze": (None, ["generate", "maze", "--size", "9,9", "--density", "0.1", "--out", "a.map"], "--density belongs to random and caves, not to maze"),
    "density in percent": (None, ["generate", "random", "--size", "9,9", "--density", "20", "--out", "a.map"], "--density must be a number from 0 to 1, not '20'"),
    "area of no cells": (None, ["generate", "random", "--size", "0,9", "--out", "a.map"], "width must be a whole number from 1, not 0"),
    "area beyond all size": (None, ["generate", "random", "--size", "99999999,99999999", "--out", "a.map"], "an area may have at most 2000000000 cells, not 99999999 x 99999999"),
    "robots as an area": (None, ["convert", "world.txt", "world2.map"], "world2.map: the suffix of a scenario must be one of .toml, .txt, not '.map'"),
    "plan as an area": (None, ["convert", "plan.csv", "a.map"], "a.map: the suffix of a plan, waypoints, dependencies or layers must be one of *, not '.map'"),
    "an order as waypoints of a run": (None, ["run", "world.map", *AIM, "--robots", "1", "--waypoints", "r.dependencies.json"], "r.dependencies.json: the suffix of waypoints must be one of *, not '.dependencies.json': that is for who waits for whom in a plan (write_dependencies, trihex plan --out)"),
    "turn time of a table": (None, ["convert", "plan.npz", "p.csv", "--turn-time", "2"], "--turn-time is for waypoints; p.csv holds none without --waypoints"),
    "turn time of an order": (None, ["convert", "plan.npz", "p.dependencies.json", "--turn-time", "2"], "--turn-time is for waypoints; p.dependencies.json holds none"),
    "turn time of an area": (None, ["convert", "world.map", "a.txt", "--turn-time", "2"], "--turn-time is for plans; world.map holds none"),
    "rules for an area": (None, ["convert", "world.map", "a.txt", *AIM], "--destination is for plans; world.map holds none"),
}  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch):
    scenario = Scenario(Area("hexagonal", [[0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]]), [(3, 0)], [(2, 0)])
    write_plan(plan_from_lists(scenario, [[2]]), tmp_path / "plan.npz")
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("case", CASES)
def test_bad_input(folder, case):
    content, command, message = CASES[case]
    if content is not None:
        name = next(word for word in command if word.startswith("bad"))
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    before = set(folder.iterdir())
    result = CliRunner().invoke(main, command)
    head, star, tail = message.partition("*")
    assert result.stderr.startswith(f"trihex: error: {head}")
    assert tail in result.stderr if star else True
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert result.exit_code == 2
    assert set(folder.iterdir()) == before


@pytest.mark.parametrize("command", [["prices", "--out"], ["view", "--port"], ["plan", "world.map", "--out"]])
def test_an_option_without_a_value_leads_to_the_help_of_its_command(folder, command):
    result = CliRunner().invoke(main, command)
    assert (
        result.stderr
        == f"trihex: error: Option '{command[-1]}' requires an argument (see trihex {command[0]} --help)\n"
    )
    assert result.exit_code == 2


def test_all_mistakes_of_a_scenario_are_told(folder):
    (folder / "s.toml").write_text('colour = 1\n[area]\nrows = ["..", ".."]\ncosts = "cheap"\n')
    result = CliRunner().invoke(main, ["plan", "s.toml"])
    assert result.exit_code == 2
    assert result.stderr.splitlines() == [
        "trihex: error: s.toml: area.costs: must be one of paper, euclidean, not 'cheap'",
        "trihex: error: s.toml: colour: there is no such key; keys are area, destinations, destinations_in_metres, rules, doors, robots, planner, outputs",
    ]


def test_robots_that_cannot_arrive(folder):
    """The answer is no, but the others are planned and all is written."""
    command = ["plan", "closed.map", "--destination", "0,0", "--planner", "greedy"]
    (folder / "starts.csv").write_text("x,y\n2,0\n0,0\n")
    result = CliRunner().invoke(main, [*command, "--starts", "starts.csv", "--out", "p.csv", "--picture", "p.png"])
    assert result.exit_code == 1
    assert result.stderr == "trihex: 1 of 2 robots cannot reach a destination: 0 at (2, 0)\n"
    assert "1 of 2 robots arrive" in result.stdout
    assert (folder / "p.csv").read_text().splitlines()[1:] == ["0,0,2,0,start,0", "1,0,0,0,start,0"]
    assert (folder / "p.png").stat().st_size > 100


def test_no_robot_can_arrive(folder):
    (folder / "starts.csv").write_text("x,y\n2,0\n")
    command = ["plan", "closed.map", "--destination", "0,0", "--planner", "greedy", "--starts", "starts.csv"]
    result = CliRunner().invoke(main, [*command, "--summary", "s.json"])
    assert result.exit_code == 1
    assert "0 at (2, 0)" in result.stderr
    assert '"unreachable": 1' in (folder / "s.json").read_text()
