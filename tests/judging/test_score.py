"""Scores: recorded crowds never pass the bound, whoever recorded them; what is denser than the cells is refused."""

import json
from dataclasses import replace
from pathlib import Path

import jupedsim
import numpy as np
import pytest
import shapely
from click.testing import CliRunner

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.areas import Frame, least_advance
from trihex.cli import main
from trihex.judging import make_score
from trihex.plans import Trajectories

KINDS = [(name, kind) for name in ("hexagonal", "square", "triangular") for kind in ("full", "edge")]


@pytest.mark.parametrize(("name", "kind"), KINDS)
def test_whoever_walks_straight_on_passes_no_more_cells_than_moves_lead(name, kind):
    """Moves to each cell of an open area, beside how far it is; far away the worst direction is just attained."""
    tessellation = th.Tessellation(name, kind, "euclidean")
    area = th.Area(tessellation, np.zeros((81, 81)))
    middle, cells = 40 * 81 + 40, np.arange(81 * 81)
    moves = np.full(cells.size, -1)
    moves[middle], ring = 0, np.array([middle])
    while ring.size:
        x, y = area.cell_to_xy(ring)
        steps = tessellation.step_of_direction[tessellation.orientation_of_cell(x, y)]
        to_x, to_y = (x[:, None] + steps[..., 0]).ravel(), (y[:, None] + steps[..., 1]).ravel()
        inside = (to_x >= 0) & (to_y >= 0) & (to_x < 81) & (to_y < 81)
        there = np.unique((to_y * 81 + to_x)[inside])
        new = there[moves[there] < 0]
        moves[new], ring = moves[ring[0]] + 1, new
    x, y = tessellation.centre_of_cell(*area.cell_to_xy(cells))
    away = np.hypot(x - x[middle], y - y[middle])
    advance = least_advance(tessellation)
    assert (moves <= away / advance + 1).all()
    far = away > 20
    assert (away[far] / moves[far]).min() == pytest.approx(advance, rel=0.06)


def in_metres(scenario, size=0.5):
    area = replace(scenario.area, frame=Frame(size, (2.0, 3.0), 0.4))
    return replace(scenario, area=area, crossing="forbid", destination_capacity=1)


@pytest.mark.parametrize("seed", range(12))
def test_our_own_files_are_read_back_and_lie_within_the_bound(tmp_path, seed):
    scenario = in_metres(random_scenario(seed, sides=(3, 9), most_robots=20))
    plan = th.make_plan(scenario, "fcost")
    if not plan.scenario.robot_count or not plan.arrived.all():
        plan = th.make_plan(scenario.with_robots(scenario.robots[plan.arrived]), "fcost")
    if not plan.steps:
        return
    th.write_waypoints(plan, tmp_path / "t.sqlite", speed=0.8)
    crowd = th.read_trajectories(tmp_path / "t.sqlite")
    assert crowd.greatest_speed <= 0.8 + 1e-9 and crowd.person_count == plan.scenario.robot_count
    score = make_score(crowd, plan.scenario)
    step = th.make_report(plan, speed=0.8).as_dict()["step_seconds"]
    np.testing.assert_allclose(score.seconds, plan.arrival_step_of_robot * step)
    assert score.is_within and score.arrived.all() and (score.earliest <= score.arrivals + 1e-9).all()
    exits = th.make_exits(plan)
    assert list(score.exits.values()) == exits.arrived[:, -1].tolist()
    waits = th.make_waiting_map(plan) * step
    assert (score.lost >= waits - 1e-6).all()


def a_door(persons):
    """Return a scenario behind a door, with its plan: a hall of 0.5 metre squares, and so many persons in it."""
    rows = ["....#...", "........", "....#..."]
    area = th.Area(
        th.Tessellation("square", "edge"), [[letter == "#" for letter in row] for row in rows], "hall", Frame(0.5)
    )
    robots = [(x, y) for y in range(3) for x in range(4)][:persons]
    return th.Scenario(area, [(7, y) for y in range(3)], robots)


def test_a_door_holds_up_the_bound_and_a_flow_more_so():
    """Twelve behind a door of one cell: one a move at best, 4 moves away; at 1 m/s a move takes 0.5 s at the least."""
    scenario = a_door(12)
    x, y = scenario.area.cell_to_metres(scenario.robots)
    person = np.repeat(np.arange(12), 2)
    crowd = Trajectories("t", 1.0, person, np.tile([0, 99], 12), np.repeat(x, 2), np.repeat(y, 2))
    score = make_score(crowd, scenario, speed=1.0)
    unit = 0.5 * least_advance(scenario.area.tessellation)
    np.testing.assert_allclose(score.earliest, np.maximum(np.arange(4, 16) * unit - 1.5, 0))
    assert not score.arrived.any() and score.gap is None and score.is_within
    slow = make_score(crowd, scenario, speed=1.0, flow=0.5)
    np.testing.assert_allclose(slow.earliest, slow.earliest[0] + 2.0 * np.arange(12))
    assert slow.lost.sum() == pytest.approx(12 * 99)
    for rules in ({"clock": "costs", "waiting_cost": 1}, {"following": "forbid"}):  # persons know no rules of robots
        other = make_score(crowd, replace(scenario, **rules), speed=1.0)
        np.testing.assert_array_equal(other.earliest, score.earliest)


@pytest.mark.parametrize("seed", range(8))
def test_plans_that_keep_the_flow_of_exits_lie_within_the_bound(tmp_path, seed):
    """Robots of 0.8 m/s whose doors let in so many a second; the score has doors as persons a second again."""
    rng = np.random.default_rng(seed)
    scenario = in_metres(random_scenario(seed, sides=(3, 9), most_robots=20))
    area, exits = scenario.area, rng.permutation(scenario.destinations)
    cut = rng.integers(1, exits.size + 1)
    told = [(own.tolist(), f"{rng.integers(2, 20) / 10}/s") for own in (exits[:cut], exits[cut:]) if own.size]
    plan = th.make_plan(replace(scenario, doors=th.make_doors(area, told, speed=0.8)), "fcost")
    plan = th.make_plan(plan.scenario.with_robots(plan.scenario.robots[plan.arrived]), "fcost")
    if not plan.steps:
        return
    th.write_waypoints(plan, tmp_path / "t.sqlite", speed=0.8)
    crowd = th.read_trajectories(tmp_path / "t.sqlite")
    score = make_score(crowd, replace(plan.scenario, doors=th.make_doors(area, told)))
    assert score.is_within and score.arrived.all()
    assert score.flow == pytest.approx(sum(float(flow[:-2]) for _, flow in told), rel=1e-6)
    assert (score.earliest >= make_score(crowd, scenario).earliest).all()


def test_exits_let_out_what_each_of_them_does():
    """Six beside three exits: one lets out 0.5 a second, the two others 1 together, if that is told."""
    scenario = a_door(12)
    scenario = replace(scenario.with_robots(()), destinations=[(0, 0), (1, 0), (2, 0)], doors=[((0, 0), "0.5/s")])
    x, y = scenario.area.cell_to_metres(np.array([8, 9, 10, 16, 17, 18]))
    crowd = Trajectories("t", 1.0, np.repeat(np.arange(6), 2), np.tile([0, 99], 6), np.repeat(x, 2), np.repeat(y, 2))
    score = make_score(crowd, scenario, speed=1.0, flow=1.0)
    np.testing.assert_allclose(score.earliest, [0, 0, 1, 2, 2, 3])
    assert score.flow == 1.5 and score.as_dict()["flows"] == {"(0, 0)": 0.5, "elsewhere": 1.0}
    some = make_score(crowd, scenario, speed=1.0)  # the others let out any number
    assert some.flow is None and some.flows == {"(0, 0)": 0.5} and not some.earliest.any()
    every = replace(scenario, doors=[([0, 1, 2], "0.5/s")])
    np.testing.assert_allclose(make_score(crowd, every, speed=1.0).earliest, 2.0 * np.arange(6))
    with pytest.raises(th.ScenarioError, match="flow is of exits without a capacity, and all have one, so 1 cannot"):
        make_score(crowd, every, speed=1.0, flow=1.0)


FLOOR = shapely.union_all([shapely.box(0, 0, 10, 6), shapely.box(10, 2, 12, 4)]).difference(
    shapely.union_all([shapely.box(5, 0, 5.3, 2.4), shapely.box(5, 3.6, 5.3, 6)])
)
EXIT = shapely.box(11.3, 2, 12, 4)


def simulate(path, seed):
    """Let 25 persons of drawn speeds leave the floor, as JuPedSim does it."""
    rng = np.random.default_rng(seed)
    writer = jupedsim.SqliteTrajectoryWriter(output_file=path, every_nth_frame=10)
    model = jupedsim.CollisionFreeSpeedModel()
    simulation = jupedsim.Simulation(model=model, geometry=FLOOR, dt=0.02, trajectory_writer=writer)
    stage = simulation.add_exit_stage(EXIT.exterior.coords[:-1])
    journey = simulation.add_journey(jupedsim.JourneyDescription([stage]))
    places = jupedsim.distribute_by_number(
        polygon=shapely.box(0.3, 0.3, 4.7, 5.7),
        number_of_agents=25,
        distance_to_agents=0.5,
        distance_to_polygon=0.3,
        seed=seed,
    )
    for place in places:
        wish = {"radius": 0.15, "desired_speed": float(rng.uniform(0.8, 1.6))}
        own = {"journey_id": journey, "stage_id": stage, "position": place, **wish}
        simulation.add_agent(jupedsim.CollisionFreeSpeedModelAgentParameters(**own))
    while simulation.agent_count() and simulation.iteration_count() < 2500:
        simulation.iterate()
    writer.close()


def write_floor(path):
    features = [("free", FLOOR), ("destination", EXIT)]
    parts = [
        {"type": "Feature", "properties": {"kind": kind}, "geometry": json.loads(shapely.to_geojson(shape))}
        for kind, shape in features
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": parts}))


@pytest.mark.parametrize("name", ["hexagonal", "square", "triangular"])
def test_crowds_of_jupedsim_lie_within_the_bound(tmp_path, name):
    write_floor(tmp_path / "floor.geojson")
    size = {"hexagonal": 0.25, "square": 0.2, "triangular": 0.15}[name]
    scenario = th.read_scenario(tmp_path / "floor.geojson", name, cell_size=size)
    for seed in range(swept(17, 2)):
        simulate(tmp_path / f"{seed}.sqlite", seed)
        score = make_score(th.read_trajectories(tmp_path / f"{seed}.sqlite"), scenario)
        assert score.arrivals.size > 15 and score.speed < 1.7
        assert score.is_within and score.gap > 0
        assert sum(score.exits.values()) == score.arrivals.size


def test_the_command_tells_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_floor(tmp_path / "floor.geojson")
    simulate(tmp_path / "t.sqlite", 5)
    command = ["score", "t.sqlite", "floor.geojson", "--cell-size", "0.2"]
    files = ["--curve", "n.csv", "--lost", "l.npy", "--summary", "s.json"]
    done = CliRunner().invoke(main, [*command, *files])
    assert done.exit_code == 0, done.output
    numbers = json.loads(Path("s.json").read_text())
    assert "at best the last after " in done.output and "assumed: nobody is faster than " in done.output
    assert done.output.endswith("written: s.json, n.csv, l.npy\n")
    rows = np.loadtxt("n.csv", delimiter=",", skiprows=1)
    assert len(rows) == numbers["arrived"] and (rows[:, 1] >= rows[:, 2]).all()
    assert np.load("l.npy").sum() == pytest.approx(numbers["seconds_lost"])
    drawn = CliRunner().invoke(main, [*command, "--curve", "n.svg", "--lost", "l.svg"])
    assert "bound" in Path("n.svg").read_text() and "Time lost" in Path("l.svg").read_text(), drawn.output
    slow = CliRunner().invoke(main, [*command, "--speed", "0.4"])
    assert slow.exit_code == 1 and "more arrived than the bound allows, first after " in slow.output
    dense = CliRunner().invoke(main, ["score", "t.sqlite", "floor.geojson", "--cell-size", "0.5"])
    assert dense.exit_code == 2 and "t.sqlite: the crowd is denser than the cells: persons " in dense.output
    fits = dense.output.split("cell_size must be at most ")[1].split(" ")[0]
    assert CliRunner().invoke(main, [*command[:-1], fits]).exit_code == 0
    assert "at most 9 persons leave in a second" in CliRunner().invoke(main, [*command, "--flow", "9"]).output
    floor = json.loads(Path("floor.geojson").read_text())
    floor["features"][1]["properties"] |= {"name": "east", "capacity": "0.5/s"}
    Path("floor.geojson").write_text(json.dumps(floor))
    few = CliRunner().invoke(main, command)
    assert few.exit_code == 1 and "at most so many persons leave in a second: 0.5 by east" in few.output
    both = CliRunner().invoke(main, [*command, "--flow", "2"])
    assert both.exit_code == 2 and both.output.startswith("trihex: error: flow is of exits without a capacity")
    # As many as leave: within.
    assert CliRunner().invoke(main, [*command, "--capacity", "east=9/s"]).exit_code == 0


def test_text_as_pedpy_reads_it(tmp_path):
    (tmp_path / "t.txt").write_text(
        "# framerate: 2.50\n# id frame x/m y/m z\n7\t10\t0.5\t1\t0\n9 10 3 4 0\n7 12 1.5 1 0\n"
    )
    crowd = th.read_trajectories(tmp_path / "t.txt")
    assert crowd.person.tolist() == [0, 0, 1] and crowd.frame.tolist() == [0, 2, 0] and crowd.frame_rate == 2.5
    assert crowd.greatest_speed == pytest.approx(1.25) and crowd.person_count == 2


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("7 10 0.5 1\n", "must be an sqlite file of JuPedSim, or text with a line '# framerate: N'"),
        ("# framerate: 0\n7 10 0.5 1\n", "the frame rate must be 1e-06 to 1e+06 frames a second, not 0"),
        ("# framerate: 1e\n7 10 0.5 1\n", "the frame rate must be 1e-06 to 1e+06 frames a second, not 0"),
        ("# framerate: 5\n", "there must be at least one person"),
        ("# framerate: 5\n7 10 0.5\n", "line 2: must be id, frame, x and y, not '7 10 0.5'"),
        ("# framerate: 5\n7 10 0.5 a\n", "line 2: must be id, frame, x and y, not '7 10 0.5 a'"),
        ("# framerate: 5\n7 10 0.5 nan\n", "all numbers must be at most 1e+09"),
        ("# framerate: 5\n7 1.5 0.5 1\n", "persons and frames must be whole numbers"),
        ("# framerate: 5\n7 1 0.5 1\n7 1 0.5 2\n", "person 7 must have one place in frame 1, not two"),
        ("SQLite format 3\0 and more", "is no file of trajectories of JuPedSim: "),
    ],
)
def test_what_is_no_trajectory_is_told(tmp_path, text, why):
    (tmp_path / "t.txt").write_text(text)
    with pytest.raises(th.FormatError) as error:
        th.read_trajectories(tmp_path / "t.txt")
    assert str(error.value).startswith(f"{tmp_path / 't.txt'}: {why}") and "\n" not in str(error.value)


def test_who_is_outside_or_walled_in_is_named():
    scenario = a_door(2)
    still = Trajectories("t", 1.0, np.array([0, 0]), np.array([0, 1]), np.array([0.2, 0.2]), np.array([-0.3, -0.3]))
    with pytest.raises(th.FormatError, match="t: nobody moves, so a speed must be told"):
        make_score(still, scenario)
    with pytest.raises(th.AreaError, match="outside"):
        make_score(replace(still, x=still.x - 9), scenario, speed=1.0)
    with pytest.raises(th.ScenarioError, match="speed must be a number from"):
        make_score(still, scenario, speed=-1.0)
    walled = replace(scenario.area, barriers=[[x == 2 for x in range(8)] for _ in range(3)])
    with pytest.raises(th.FormatError, match=r"t: person 0 cannot reach a destination from \(0, 0\)"):
        make_score(still, th.Scenario(walled, scenario.destinations), speed=1.0)
