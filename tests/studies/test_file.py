"""Study files: the grid they describe, what lies where, and all mistakes at once."""

import pytest

import trihex as th
from trihex.formats import Draft
from trihex.studies.case import run_case
from trihex.studies.grid import Grid
from trihex.studies.placing import place_destinations, place_robots
from trihex.studies.results import write_results
from trihex.studies.study import make_study

SMALL = """
seeds = 2
robots = [3, {count = [4, 5], placement = ["west", "east"]}]
tessellations = ["triangular", {name = "square", neighbourhood = ["full", "edge"]}]
planners = ["greedy", {name = "fcost", options = {rule = ["queue", "aside"]}}]
[[areas]]
generator = "random"
size = [9, 7]
density = [0.0, 0.1]
"""


def written(folder, text, name="study.toml"):
    path = folder / name
    path.write_text(text)
    return path


def test_a_grid_has_all_combinations_the_planners_changing_fastest(tmp_path):
    cases = th.read_study(written(tmp_path, SMALL)).trials
    assert len(cases) == 2 * 3 * 5 * 2 * 3
    assert [case["planner"]["options"] for case in cases[:3]] == [{}, {"rule": "queue"}, {"rule": "aside"}]
    assert [case["seed"] for case in cases[:7]] == [0, 0, 0, 1, 1, 1, 0]
    robots = [(case["robots"]["count"], case["robots"].get("placement")) for case in cases[:30:6]]
    assert robots == [(3, None), (4, "west"), (4, "east"), (5, "west"), (5, "east")]
    assert cases[-1]["tessellation"] == {"name": "square", "neighbourhood": "edge"}
    assert cases[-1]["area"]["density"] == 0.1
    assert len({str(case) for case in cases}) == len(cases)


def test_a_sample_keeps_order_and_depends_on_its_seed_alone(tmp_path):
    every = [str(case) for case in th.read_study(written(tmp_path, SMALL)).trials]
    some = [str(case) for case in th.read_study(written(tmp_path, "sample = 20\n" + SMALL)).trials]
    again = [str(case) for case in th.read_study(written(tmp_path, "sample = 20\n" + SMALL)).trials]
    other = [str(case) for case in th.read_study(written(tmp_path, "sample = 20\nsample_seed = 1\n" + SMALL)).trials]
    assert len(set(some)) == 20 and some == again != other
    assert [every.index(case) for case in some] == sorted(every.index(case) for case in some)


def test_a_grid_too_large_to_list_can_be_sampled():
    axes = {name: range(10**4) for name in "abcd"}
    assert len(Grid(axes, sample=3)) == 3
    with pytest.raises(th.StudyError, match=r"at most 100000000 runs, not 10000000000000000; draw some"):
        Grid(axes)
    with pytest.raises(th.StudyError, match="combinations"):
        Grid(axes | {"e": range(10**4)}, sample=3)


def test_the_key_changes_with_all_that_results_depend_on_and_with_nothing_else(tmp_path):
    (tmp_path / "a.txt").write_text("a..D\n....\n")
    text = 'robots = [1]\nseeds = 1\n[[areas]]\npath = "a.txt"\n'
    key = th.read_study(written(tmp_path, text)).key
    assert th.read_study(written(tmp_path, "# a remark\nname = 'other'\n" + text)).key == key
    assert th.read_study(written(tmp_path, text.replace("1]", "2]"))).key != key
    assert th.read_study(written(tmp_path, "limits.seconds = 3\n" + text)).key != key
    (tmp_path / "a.txt").write_text("a..D\n.B..\n")
    assert th.read_study(written(tmp_path, text)).key != key


def test_all_mistakes_are_told_at_once(tmp_path):
    (tmp_path / "bad.map").write_text("type octile\nheight 9\nwidth 2\nmap\n..\n")
    text = """
seeds = 0
robots = [3, "many", {count = 4, placement = "wst"}, {}]
tesselations = ["square"]
destinations = ["center"]
planners = [{name = "fcost", option = 3}]
limits = {seconds = -1, memory = "lots"}
areas = [{size = [3, 4]}, {generator = "randm", density = 20}]
"""
    with pytest.raises(th.FormatError) as error:
        th.read_study(written(tmp_path, text))
    told = str(error.value).replace(f"{tmp_path}/", "").splitlines()
    assert told == [
        "study.toml: areas.1.generator: must be one of random, rooms, maze, caves, warehouse, not 'randm'; "
        "did you mean 'random'?",
        "study.toml: areas.1.density: must be less than or equal to 1, not 20",
        "study.toml: destinations.0: must be one of centre, west, east, north, south, random, file, not 'center'; "
        "did you mean 'centre'?",
        "study.toml: robots.1: must be a whole number, not 'many'",
        "study.toml: robots.2.placement: must be one of uniform, west, east, north, south, far, not 'wst'; "
        "did you mean 'west'?",
        "study.toml: seeds: must be a list of seeds, or how many from 1 to 10000000, not 0",
        "study.toml: planners.0.option: there is no such key; did you mean 'options'?",
        "study.toml: limits.seconds: must be greater than 0, not -1",
        "study.toml: limits.memory: must be at least 1 MB, such as '2 GB', not 'lots'",
        "study.toml: tesselations: there is no such key; did you mean 'tessellations'?",
        "study.toml: areas.0: must have one of path, generator",
        "study.toml: robots.3: must have one of count, cells, file",
    ]


def test_planners_may_bring_their_options_in_their_names(tmp_path):
    text = """
areas = {generator = "random", size = [4, 4]}
robots = 1
planners = ["fcost:rule=paper", {name = ["fcost:rule=queue", "greedy"]},
  {name = "optimal", options = {objective = "steps"}}]
"""
    study = th.read_study(written(tmp_path, text))
    assert [(case["planner"]["name"], case["planner"]["options"]) for case in study.trials] == [
        ("fcost", {"rule": "paper"}),
        ("fcost", {"rule": "queue"}),
        ("greedy", {}),
        ("optimal", {"objective": "steps"}),
    ]
    area = {"generator": "random", "size": [4, 4]}
    (row,) = th.run_study([{"area": area, "robots": 1, "planner": "fcost:rule=paper"}])
    assert (row["planner"], row["planner_options"]) == ("fcost", '{"rule":"paper"}')
    with pytest.raises(th.FormatError, match=r"planners.0: option of planner 'fcost' must be one of rule, rounds, not"):
        th.read_study(written(tmp_path, text.replace("rule=paper", "rulle=paper")))


def test_mistakes_that_only_files_and_planners_tell(tmp_path):
    (tmp_path / "bad.map").write_text("type octile\nheight 9\nwidth 2\nmap\n..\n")
    text = """
robots = [1, {file = "starts.csv"}]
planners = ["gredy", {name = "greedy", options = {rule = "best"}}, {name = "fcost", options = {rule = ["bset"]}}]
areas = ["bad.map", "none.map", {path = "bad.map", room = 3}, {generator = "maze", size = [3, 3], room = 3},
  {generator = "maze"}]
"""
    with pytest.raises(th.FormatError) as error:
        th.read_study(written(tmp_path, text))
    told = [line.replace(f"{tmp_path}/", "") for line in str(error.value).splitlines()]
    assert [line.removeprefix("study.toml: ").split(":")[0] for line in told] == [
        "areas.0", "areas.1.path", "areas.2.room", "areas.3", "areas.4",
        "robots.1.file", "planners.0", "planners.1", "planners.2",
    ]  # fmt: skip
    assert told[1] == "study.toml: areas.1.path: No such file or directory: none.map"
    assert told[3] == "study.toml: areas.3: room: belongs to rooms, not to maze"
    assert told[-1].endswith("rule must be one of best, paper, queue, aside, lanes, not 'bset'; did you mean 'best'?")


def test_runs_given_one_by_one_are_checked_alike():
    area = {"generator": "random", "size": [5, 5]}
    with pytest.raises(th.StudyError) as error:
        make_study([{"area": area, "robots": 1}, {"area": area, "robots": [1, 2]}, {"aera": area, "robots": 1}])
    assert str(error.value).splitlines() == [
        "run 1: a run must not vary anything",
        "run 2: areas: is missing",
        "run 2: aera: there is no such key; did you mean 'areas'?",
    ]
    with pytest.raises(th.StudyError, match="run 0: a run must not vary anything"):
        make_study([{"area": area, "robots": {"count": [1, 2]}}])
    with pytest.raises(th.StudyError, match="run 0: scenario must be a Scenario"):
        make_study([{"scenario": "here"}])


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"])
def test_destinations_lie_where_they_are_said_to(name):
    area = th.make_random_area(name, 20, 30, density=0.2, seed=3)
    for place, axis, side in (("west", 0, 0), ("east", 0, 1), ("north", 1, 0), ("south", 1, 1)):
        cells = place_destinations(area, place, 4, seed=0)
        xy = area.cell_to_xy(cells)
        assert len(set(cells.tolist())) == 4 and not area.is_barrier(cells).any()
        length = (area.width, area.height)
        assert (abs(xy[axis] - side * (length[axis] - 1)) <= 0.15 * length[axis]).all()
        along = sorted((xy[1 - axis] / length[1 - axis]).tolist())
        assert along == pytest.approx([1 / 8, 3 / 8, 5 / 8, 7 / 8], abs=0.12)
    (centre,) = place_destinations(area, "centre", 1, seed=0)
    x, y = area.cell_to_xy(centre)
    assert abs(x - 15) <= 3 and abs(y - 10) <= 3
    drawn = [place_destinations(area, "random", 3, seed=seed).tolist() for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    with pytest.raises(th.ScenarioError, match="connected cells"):
        place_destinations(area, "centre", 600, seed=0)


def test_robots_are_drawn_as_the_command_line_draws_them_or_in_one_half():
    area = th.make_random_area("hexagonal", 20, 30, density=0.3, seed=3)
    destination = place_destinations(area, "centre", 1, 0)
    n_scheme = th.make_n_scheme(th.Scenario(area, destination))
    drawn = Draft(area, destinations=destination, random_count=50, seed=4).complete().robots
    assert place_robots(n_scheme, 50, "uniform", 4).tolist() == drawn.tolist()
    for placement, least, most in (("west", 0, 14), ("east", 15, 29)):
        x, _ = area.cell_to_xy(place_robots(n_scheme, 50, placement, 4))
        assert least <= x.min() and x.max() <= most
    for placement, least, most in (("north", 0, 9), ("south", 9, 19)):
        _, y = area.cell_to_xy(place_robots(n_scheme, 50, placement, 4))
        assert least <= y.min() and y.max() <= most


def test_areas_in_metres_can_have_cells_of_equal_area(tmp_path):
    (tmp_path / "hall.wkt").write_text("POLYGON ((0 0, 12 0, 12 9, 0 9, 0 0))")
    text = 'robots = [3]\ntessellations = ["triangular", "hexagonal", "square"]\n'
    text += '[[areas]]\npath = "hall.wkt"\ncell_area = 0.25\nrobot_radius = 0.05\n'
    rows = th.run_study(written(tmp_path, text))
    for row, unit in zip(rows, (0.75 * 3**0.5, 0.5 * 3**0.5, 1.0), strict=True):
        assert row["error"] is None
        assert unit * row["cell_size"] ** 2 == pytest.approx(0.25)
        assert row["free_cells"] == pytest.approx(108 / 0.25, rel=0.25)


def test_the_rules_of_a_run_decide_on_the_least_cells_for_robots(tmp_path):
    (tmp_path / "hall.wkt").write_text("POLYGON ((0 0, 5 0, 5 4, 0 4, 0 0))")
    head = 'robots = [3]\nrules = [{following = "forbid"}, {following = "allow"}]\n'
    text = head + '[[areas]]\npath = "hall.wkt"\nrobot_radius = 0.1\n'
    sized = '[[areas]]\npath = "hall.wkt"\ncell_size = 0.5\nrobot_radius = 0.1\n'
    rows = th.run_study(written(tmp_path, text + sized))
    assert [(row["following"], row["cell_size"]) for row in rows] == [
        ("forbid", 0.231), ("allow", 0.4), ("forbid", 0.5), ("allow", 0.5),
    ]  # fmt: skip
    timed = 'robots = [2]\nrules = [{clock = "costs"}, {clock = "steps"}]\ntessellations = ["square"]\n'
    rows = th.run_study(written(tmp_path, timed + '[[areas]]\npath = "hall.wkt"\nrobot_radius = 0.1\n'))
    assert [(row["clock"], row["cell_size"]) for row in rows] == [("costs", 0.4334), ("steps", 0.4473)]
    # A place with room by one rule alone is no mistake of the file: told at once only where the first rule has none.
    (tmp_path / "hall.wkt").write_text("POLYGON ((0 0, 0.35 0, 0.35 0.35, 0 0.35, 0 0))")
    th.read_study(written(tmp_path, text))


def test_what_a_file_of_letters_names_is_used(tmp_path):
    (tmp_path / "yard.txt").write_text("a..B\n...D\n")
    (tmp_path / "starts.csv").write_text("x,y\n0,0\n0,1\n")
    text = 'robots = [{file = "starts.csv"}, {cells = [[1, 1]]}]\ndestinations = ["file", {cells = [[0, 0], [2, 0]]}]\n'
    rows = th.run_study(written(tmp_path, text + 'areas = ["yard.txt"]\ntessellations = ["square"]\n'))
    assert [(row["robots"], row["total_time"], row["area"]) for row in rows] == [
        (2, 34 + 30, "yard"), (1, 20, "yard"), (2, 0 + 10, "yard"), (1, 14, "yard"),
    ]  # fmt: skip


def test_a_row_tells_lengths_and_waits():
    # Two robots in a corridor, the destination at its end takes one a step: the second walks behind and never waits.
    area = th.Area("hexagonal", [[0], [0], [0], [0]])
    scenario = th.Scenario(area, [(0, 3)], [(0, 0), (0, 1)])
    row = run_case({"scenario": scenario, "planner": {"name": "greedy", "options": {}}, "bound": True})
    assert (row["path_length"], row["straight_length"], row["waits"], row["most_waiting"]) == (5.0, 5.0, 0, 0)
    # Around a wall on squares: 2 diagonals in place of 2 straight steps.
    area = th.Area("square", [[0, 0, 0], [0, 1, 0]])
    scenario = th.Scenario(area, [(2, 1)], [(0, 1)])
    row = run_case({"scenario": scenario, "planner": {"name": "greedy", "options": {}}, "bound": True})
    assert (row["path_length"], row["straight_length"]) == (pytest.approx(2 * 2**0.5, abs=1e-3), 2.0)
    # Two beside a destination for one robot at a time: one waits once.
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [(1, 0)], [(0, 0), (2, 0)], destination_capacity=1)
    row = run_case({"scenario": scenario, "planner": {"name": "greedy", "options": {}}, "bound": False})
    assert (row["waits"], row["most_waiting"], row["lower_bound_name"]) == (1, 1, "distance")


def test_robots_may_begin_later(tmp_path):
    (tmp_path / "starts.csv").write_text("x,y,start\n0,0,4\n1,0,0\n")
    robots = '[{count = 4, start_times = ["uniform:3,9", "constant:5"]}, {file = "starts.csv"}, 4]'
    text = f'robots = {robots}\nplanners = ["greedy"]\n[[areas]]\ngenerator = "random"\nsize = [9, 7]\ndensity = 0\n'
    rows = list(th.run_study(written(tmp_path, text)))
    assert not any(row["error"] for row in rows)
    assert len({row["scenario"] for row in rows}) == 4
    assert rows[0]["placement"] == '{"count":4,"start_times":"uniform:3,9"}' and rows[3]["placement"] == "uniform"
    at_once, late = rows[3], rows[1]
    assert late["total_time"] >= at_once["total_distance"] + 4 * 5 * 10 and rows[2]["total_waiting"] >= 40
    with pytest.raises(th.FormatError, match=r"robots.0.start_times.1: must be drawn as one of .*, not 'soon'"):
        th.read_study(written(tmp_path, text.replace("constant:5", "soon")))


DOORS = """
robots = 6
destinations = "file"
planners = "greedy"
rules = {destination_capacity = ["1/2", 2, 0.4]}
[[areas]]
path = "row.toml"
"""
ROW = 'destinations = [[5, 0], [5, 1]]\n[area]\nrows = ["......", "......"]\n[area.zones]\ngate = [[3, 0], [3, 1]]\n'


def test_flows_of_doors_and_destinations_are_varied_and_told(tmp_path):
    written(tmp_path, ROW, "row.toml")
    text = DOORS + 'capacity = [{}, {gate = "1/3"}, {gate = 1}]\n'
    rows = [run_case(case) for case in th.read_study(written(tmp_path, text)).trials]
    for name in ("rows.csv", "rows.parquet"):
        write_results(rows, tmp_path / name)
        assert th.read_results(tmp_path / name) == rows
    assert len(rows) == 9 and not any(row["error"] for row in rows)
    assert {row["destination_capacity"] for row in rows} == {"1/2", "2", "2/5"}
    assert len({row["scenario"] for row in rows}) == 9
    assert all(row["conflicts"] == 0 for row in rows)
    waiting = dict.fromkeys(("{}", '{"gate":"1/3"}'), 0)
    for row in rows:
        for area in waiting:
            waiting[area] += row["total_waiting"] * (f'"capacity":{area},' in row["area_options"])
    assert waiting['{"gate":"1/3"}'] > waiting["{}"] > 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (DOORS + 'capacity = {west = "1/3"}', "areas.0: door: zone must be one of gate, not 'west'"),
        (
            DOORS + 'capacity = {gate = "1/s"}',
            "areas.0: capacity of door 'gate' must be robots a step, such as 0.5, in",
        ),
        (DOORS + "capacity = {gate = 0}", "areas.0.capacity.gate: must be a number of robots above 0"),
        (DOORS.replace('"1/2"', '"1/0"'), "rules.destination_capacity.0: must be a number of robots above 0"),
        (SMALL + 'capacity = {gate = "1/3"}', "areas.0: capacity: belongs to a file, not to random"),
    ],
)
def test_what_is_wrong_with_flows_is_told(tmp_path, text, message):
    written(tmp_path, ROW, "row.toml")
    with pytest.raises(th.FormatError) as error:
        th.read_study(written(tmp_path, text))
    assert message in str(error.value)
