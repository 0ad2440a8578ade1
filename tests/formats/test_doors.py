"""Doors with a flow in files: kept as they are, drawn in GeoJSON, told in seconds; what is wrong is told in a line."""

import json
from fractions import Fraction

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario, with_random_doors
from trihex.areas import seconds_per_step
from trihex.formats import draft_of, read_draft
from trihex.planners import make_plan


@pytest.mark.parametrize("seed", range(12))
def test_doors_come_back_as_they_were(seed, tmp_path):
    scenario = with_random_doors(random_scenario(seed))
    th.write_plan(make_plan(scenario, "greedy"), tmp_path / "plan.npz")
    assert th.read_plan(tmp_path / "plan.npz").scenario == scenario
    th.write_scenario(scenario, tmp_path / "all.toml")
    again = th.read_scenario(tmp_path / "all.toml")
    assert (again.doors, again.destination_capacity) == (scenario.doors, scenario.destination_capacity)
    assert draft_of(scenario).complete() == scenario


@pytest.mark.parametrize("seed", range(8))
def test_doors_of_runs_come_back_as_they_were(seed, tmp_path):
    scenario = with_random_doors(random_scenario(seed, sides=(2, 6), waiting_costs=(None,)))
    run = th.Trial(scenario, planner="greedy", seed=seed).run()
    th.write_run(run, tmp_path / "run.npz")
    again = th.read_run(tmp_path / "run.npz")
    assert again == run and again.scenario.doors == scenario.doors
    assert again.scenario.destination_capacity == scenario.destination_capacity


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_tables_of_plans_are_read_beside_the_scenario_with_its_doors(suffix, tmp_path):
    scenario = th.Scenario(
        th.Area("square", [[0, 0, 0, 0]]), [3], [0, 1], doors=[([2], "1/2")], destination_capacity="1/3"
    )
    plan = make_plan(scenario)
    th.write_plan(plan, tmp_path / f"plan.{suffix}")
    th.write_scenario(scenario, tmp_path / "s.toml")
    again = th.read_plan(tmp_path / f"plan.{suffix}", th.read_scenario(tmp_path / "s.toml"))
    assert np.array_equal(again.actions, plan.actions) and th.audit_plan(again).is_clean
    assert again.scenario.doors == scenario.doors
    assert again.scenario.destination_capacity == scenario.destination_capacity


def test_a_door_keeps_its_name_though_a_barrier_is_in_its_zone(tmp_path):
    area = th.Area("square", [[0, 0, 0, 1]], zones=[th.Zone("west", [0, 3])])
    scenario = th.Scenario(area, [2], [1], doors={"west": "1/2"})
    th.write_scenario(scenario, tmp_path / "s.toml")
    assert th.read_scenario(tmp_path / "s.toml").doors == scenario.doors
    assert draft_of(scenario).complete() == scenario


@pytest.mark.parametrize("name", ["a\nb", " ", "x" * 201, "\x00"])
def test_names_of_doors_are_lines_that_files_can_hold(name):
    with pytest.raises(th.ScenarioError, match="name of a door must be a line of 1 to 200 characters, or empty, not"):
        th.Door([1], 1, name)


def test_a_plan_without_flows_has_no_entries_of_doors(tmp_path):
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [0], [2], destination_capacity=1)
    th.write_plan(make_plan(scenario), tmp_path / "plan.npz")
    assert not [name for name in np.load(tmp_path / "plan.npz").files if "door" in name or "flow" in name]


def hall(tmp_path, *features):
    """Write a hall of 20 x 12 metres that a wall with a gap of 2 metres parts, with some features more."""
    walls = [[[9.8, 0], [10.2, 5]], [[9.8, 7], [10.2, 12]]]
    box = [("obstacle", *wall) for wall in walls] + [("free", [0, 0], [20, 12])]
    shapes = [
        ({"kind": kind}, "Polygon", [[[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]])
        for kind, (x0, y0), (x1, y1) in box
    ]
    document = {
        "type": "FeatureCollection",
        "features": [
            {"type": "Feature", "properties": about, "geometry": {"type": kind, "coordinates": points}}
            for about, kind, points in (*shapes, *features)
        ],
    }
    (tmp_path / "hall.geojson").write_text(json.dumps(document))
    return tmp_path / "hall.geojson"


EAST = ({"kind": "destination", "name": "east", "capacity": "1.6/s"}, "LineString", [[20, 5], [20, 7.4]])
GATE = ({"kind": "door", "name": "gate", "capacity": "1.2/s"}, "LineString", [[10, 4], [10, 8]])


@pytest.mark.parametrize("tessellation", ["hexagonal", "triangular", "square"])
def test_exits_and_doors_are_drawn_with_what_they_let_in(tessellation, tmp_path):
    path = hall(tmp_path, EAST, GATE, ({"kind": "destination", "capacity": 0.25}, "MultiPoint", [[1, 1], [1, 11]]))
    scenario = read_draft(path, tessellation, cell_size=0.5).complete()
    lasts = seconds_per_step(scenario.area)
    east, points, gate = scenario.doors
    assert float(east.flow) == pytest.approx(1.6 * lasts, rel=1e-6) and east.name == "east"
    assert float(gate.flow) == pytest.approx(1.2 * lasts, rel=1e-6) and gate.name == "gate"
    assert (points.flow, points.cells.size) == (Fraction(1, 4), 2)  # both together
    # The cells of a door are a row: nobody comes past them, and most robots enter but one.
    shut = scenario.area.barriers.copy()
    shut.flat[gate.cells] = True
    x, _ = scenario.area.cell_to_metres(np.arange(scenario.area.cell_count))
    west = np.flatnonzero(~shut.reshape(-1) & (x < 9))
    lone = th.Scenario(th.Area(scenario.area.tessellation, shut), east.cells)
    assert (th.make_n_scheme(lone).distance_of_cell(west) == 2**31 - 1).all()
    assert gate.cells.size <= (5 if tessellation != "triangular" else 14)
    report = th.make_report(make_plan(scenario.with_robots(th.random_robots(scenario.area, 20)), "fcost"))
    assert report.as_dict()["doors"]["gate"] == "1.2/s"
    assert set(report.arrivals_of_exit) == {"east"} and report.audit.is_clean


@pytest.mark.parametrize(
    ("feature", "message"),
    [
        (({"kind": "door"}, *GATE[1:]), "feature 3: a door must have the property capacity, what it lets in, such as"),
        (({**GATE[0], "capacity": "much"}, *GATE[1:]), "feature 3: capacity must be a number of robots above"),
        ((GATE[0], "LineString", [[9.9, 1], [10.1, 1]]), "feature 3: a door must lead through free cells; it"),
        ((GATE[0], "LineString", []), "feature 3: a door must have coordinates; it has none"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_door_is_told(feature, message, tmp_path):
    with pytest.raises(th.FormatError, match=message):
        read_draft(hall(tmp_path, feature), cell_size=0.5)


HEAD = 'destinations = [[0, 0]]\n[area]\nrows = ["..."]\n[area.zones]\nwest = [[0, 0]]\n'


def test_a_scenario_file_tells_flows_by_zones_cells_and_speed(tmp_path):
    path, frame = tmp_path / "s.toml", "[area.frame]\ncell_size = 0.5\n"
    doors = '[[doors]]\nzone = "west"\ncapacity = "1.6/s"\n[[doors]]\ncells = [[1, 0]]\ncapacity = 0.5\n'
    path.write_text(f"{HEAD}{frame}{doors}[outputs]\nspeed = 2.0\n[rules]\ndestination_capacity = '1/4'\n")
    scenario = th.read_scenario(path)
    assert [(door.cells.tolist(), door.flow) for door in scenario.doors] == [
        ([0], Fraction(2, 5)),
        ([1], Fraction(1, 2)),
    ]
    assert scenario.destination_capacity == Fraction(1, 4)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("[[doors]]\nzone = 'west'\n", "doors.0.capacity: is missing"),
        ("[[doors]]\ncapacity = 1\n", "doors.0: must have one of zone, cells"),
        ("[[doors]]\nzone = 'west'\ncapacity = 0\n", "doors.0.capacity: must be a number of robots above 0"),
        ("[[doors]]\nzone = 'west'\ncapacity = [1]\n", "doors.0.capacity: must be a number, or text such as '1.6/s'"),
        ("[[doors]]\nzone = 'east'\ncapacity = 1\n", "door: zone must be one of west, not 'east'"),
        ("[[doors]]\nzone = 'west'\ncapacity = '1/s'\n", "must be robots a step, such as 0.5, in an area without"),
        ("[rules]\ndestination_capacity = '1/0'\n", "rules.destination_capacity: must be a number of robots above 0"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_scenario_file_is_told(more, message, tmp_path):
    (tmp_path / "s.toml").write_text(HEAD + more)
    with pytest.raises(th.TrihexError, match=message):
        th.read_scenario(tmp_path / "s.toml")
