"""Fields and plans as maps of Tiled: tile by tile what the records say, where the documentation of Tiled draws it."""

import json
from math import atan2, degrees
from pathlib import Path

import numpy as np
import pytest
import shapely
from click.testing import CliRunner
from PIL import Image

import trihex as th
from tests.formats.test_tiled import STAGGERS, hexagon, map_of
from trihex.cli import main

ROWS = [[0, 0, 0, 1, 0], [0, 1, 0, 1, 0], [0, 1, 0, 0, 0], [0, 0, 0, 1, 0]]
COMPASS = {"N": 90, "NE": 45, "E": 0, "SE": -45, "S": -90, "SW": -135, "W": 180, "NW": 135}


@pytest.fixture(params=[None, *STAGGERS], ids=str)
def level(request, tmp_path):
    """Return a map, its stagger, and a scenario on it."""
    tiled = map_of(ROWS, stagger=request.param)
    for name, marked in (("destinations", 4), ("robots", 15)):
        data = [
            int(number in (marked, marked + 1)) if name == "robots" else int(number == marked) for number in range(20)
        ]
        tiled["layers"].append({"type": "tilelayer", "name": name, "data": data})
    path = tmp_path / "level.tmj"
    path.write_text(json.dumps(tiled))
    return path, request.param, th.read_scenario(path)


def properties_of(path, layer):
    """Return the property of each tile of a layer, None where none is; shape (rows, columns)."""
    tiled = json.loads(path.read_text())
    (tileset,) = tiled["tilesets"]
    value = {tile["id"] + tileset["firstgid"]: tile["properties"][0]["value"] for tile in tileset["tiles"]}
    (own,) = (one for one in tiled["layers"] if one["name"] == layer)
    shape = tiled["height"], tiled["width"]
    assert (own["height"], own["width"]) == shape
    return np.array([value[number] if number else None for number in own["data"]], dtype=object).reshape(shape)


def layers_of(name):
    return json.loads(Path(name).read_text())["layers"]


def middle(column, row, stagger):
    if stagger is None:
        return 32 * column + 16, 32 * row + 16
    if stagger[0] == "y":  # tiles are as wide as they are high on the map of the test of reading
        x, y = middle(row, column, ("x", stagger[1]))
        return y, x
    centre = shapely.centroid(hexagon(column, row, *stagger))
    return centre.x, centre.y


def test_distances(level, tmp_path):
    path, _, scenario = level
    n_scheme = th.make_n_scheme(scenario)
    th.write_tiled(n_scheme, tmp_path / "n.tmj", like=path)
    found = properties_of(tmp_path / "n.tmj", "n_scheme")
    assert found.shape == (4, 5) and found[0, 4] == 0
    bare = n_scheme.distance
    own = sorted(int(value) for value in bare[bare < 10**6])
    assert sorted(found[found != None].tolist()) == own  # noqa: E711
    assert ((found == None) == np.array(ROWS, dtype=bool)).all()  # noqa: E711
    again = th.read_scenario(tmp_path / "n.tmj")
    assert np.array_equal(again.area.barriers, scenario.area.barriers) and again.destinations == scenario.destinations
    with Image.open(tmp_path / "n.tiles.png") as picture:
        tileset = json.loads((tmp_path / "n.tmj").read_text())["tilesets"][0]
        assert picture.size == (tileset["imagewidth"], tileset["imageheight"]) and tileset["image"] == "n.tiles.png"


def test_directions_lead_to_a_tile_that_is_nearer(level, tmp_path):
    path, stagger, scenario = level
    n_scheme = th.make_n_scheme(scenario)
    th.write_tiled(n_scheme, tmp_path / "n.tmj", like=path)
    th.write_tiled(th.make_d_scheme(n_scheme), tmp_path / "d.tmj", like=path)
    distance, names = properties_of(tmp_path / "n.tmj", "n_scheme"), properties_of(tmp_path / "d.tmj", "d_scheme")
    tiles = [(column, row) for row in range(4) for column in range(5) if distance[row, column] is not None]
    near = 46 if stagger is None else 33
    for column, row in tiles:
        x, y = middle(column, row, stagger)
        expected = set()
        for other in tiles:
            to_x, to_y = np.subtract(middle(*other, stagger), (x, y))
            step = distance[row, column] - distance[other[1], other[0]]
            cost = 14 if abs(to_x) == abs(to_y) and stagger is None else 10
            if 0 < np.hypot(to_x, to_y) < near and step == cost:
                angle = degrees(atan2(-to_y, to_x))
                expected.add(min(COMPASS, key=lambda name: abs((COMPASS[name] - angle + 180) % 360 - 180)))
        assert set((names[row, column] or "").split()) == expected, (column, row)


def test_a_plan_is_lines_from_tile_to_tile(level, tmp_path):
    path, stagger, scenario = level
    plan = th.make_plan(scenario, "greedy")
    th.write_tiled(plan, tmp_path / "p.tmj", like=path)
    again = th.read_scenario(tmp_path / "p.tmj")
    assert again.robots.tolist() == scenario.robots.tolist() and again.destinations == scenario.destinations
    (lines,) = (one for one in json.loads((tmp_path / "p.tmj").read_text())["layers"] if one["name"] == "paths")
    for robot, line in enumerate(lines["objects"]):
        assert line["properties"] == [
            {"name": "arrival", "type": "int", "value": int(plan.arrival_step_of_robot[robot])}
        ]
        places = [(line["x"] + point["x"], line["y"] + point["y"]) for point in line["polyline"]]
        assert places[0] == pytest.approx(middle(robot, 3, stagger))  # row by row, both in the last row
        assert places[-1] == pytest.approx(middle(4, 0, stagger))
        tiles = {tuple(np.round(middle(column, row, stagger), 6)) for row in range(4) for column in range(5)
                 if not ROWS[row][column]}  # fmt: skip
        assert {tuple(np.round(place, 6)) for place in places} <= tiles


def test_the_command_line_writes_layers(level, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path, _, scenario = level
    run = CliRunner().invoke
    done = run(main, ["field", path.name, "--out", "n.tmj", "--directions", "d.tmj"])
    assert done.exit_code == 0 and "written: n.tmj, d.tmj" in done.output
    th.write_tiled(th.make_n_scheme(scenario.with_robots(())), "own.tmj", like=path)
    assert layers_of("own.tmj") == layers_of("n.tmj")
    assert run(main, ["plan", path.name, "--out", "p.tmj"]).exit_code == 0
    assert run(main, ["plan", path.name, "--out", "p.npz"]).exit_code == 0
    assert run(main, ["convert", "p.npz", "again.tmj", "--area", path.name]).exit_code == 0
    assert layers_of("again.tmj") == layers_of("p.tmj")
    # Whose own map is no map of Tiled is drawn as cells lie.
    assert run(main, ["convert", "p.npz", "plain.tmj"]).exit_code == 0
    plain = th.read_scenario("plain.tmj")
    assert np.array_equal(plain.area.barriers, scenario.area.barriers) and (plain.robots == scenario.robots).all()


def test_what_cannot_be_layers_is_told(tmp_path):
    square = th.make_n_scheme(th.Scenario(th.Area("square", [[0, 0]]), (0, 0)))
    with pytest.raises(th.FormatError, match=r"t\.tmj: Tiled knows squares and hexagons, no triangles"):
        th.write_tiled(th.make_n_scheme(th.Scenario(th.Area("triangular", [[0]]), (0, 0))), tmp_path / "t.tmj")
    with pytest.raises(th.FormatError, match=r"the suffix of layers for Tiled must be one of \.tmj, not '\.tmx'"):
        th.write_tiled(square, tmp_path / "t.tmx")
    (tmp_path / "h.tmj").write_text(json.dumps(map_of(ROWS, stagger=("x", "even"))))
    with pytest.raises(th.FormatError, match=r"h\.tmj must be the map from which the area was read"):
        th.write_tiled(square, tmp_path / "t.tmj", like=tmp_path / "h.tmj")
    long = th.make_n_scheme(th.Scenario(th.Area("square", np.zeros((1, 20_001))), (0, 0)))
    with pytest.raises(th.FormatError, match=r"may have at most 20000 different distances, not 20001"):
        th.write_tiled(long, tmp_path / "t.tmj")
    with pytest.raises(th.ArgumentError, match=r"record must be an NScheme or a DScheme or a Plan, not"):
        th.write_tiled(th.Area("square", [[0]]), tmp_path / "t.tmj")
    assert [path.name for path in tmp_path.iterdir()] == ["h.tmj"]
