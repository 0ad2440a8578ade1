"""Command line: `trihex fit`, its table, its picture and what it refuses."""

import json
import re

import pytest
from click.testing import CliRunner
from PIL import Image

from trihex import read_plan, read_scenario
from trihex.cli import main

HALL = [[0, 0], [9, 0], [9, 6], [0, 6], [0, 0]]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    exit_ = {"type": "LineString", "coordinates": [[9, 2], [9, 4]]}
    features = [({"kind": "free"}, {"type": "Polygon", "coordinates": [HALL]}), ({"kind": "destination"}, exit_)]
    document = {
        "type": "FeatureCollection",
        "features": [{"type": "Feature", "properties": p, "geometry": g} for p, g in features],
    }
    (tmp_path / "hall.geojson").write_text(json.dumps(document))
    (tmp_path / "hall.wkt").write_text("POLYGON ((0 0, 9 0, 9 6, 0 6, 0 0))")
    (tmp_path / "world.txt").write_text("D..a\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def fit(*command, status=0):
    result = CliRunner().invoke(main, ["fit", *map(str, command)])
    assert result.exit_code == status, result.output
    return result.output


def test_the_table_and_the_picture(folder):
    lines = fit("hall.geojson", "--robot-radius", 0.2, "--align", "corner", "--picture", "fit.png").splitlines()
    assert lines[0].split() == [
        "cells",
        "neighbours",
        "following",
        "clock",
        "cell",
        "size",
        "radius",
        "free",
        "connected",
        "reach",
        "greatest",
        "grid",
    ]
    rows = [line.split() for line in lines[2:14]]
    assert [row[:6] for row in rows[5:10]] == [
        ["hexagonal", "6", "allow", "any", "0.8", "m"],
        ["hexagonal", "6", "forbid", "any", "0.4619", "m"],
        ["square", "8", "allow", "steps", "0.8945", "m"],
        ["square", "8", "allow", "costs", "0.8667", "m"],
        ["square", "8", "forbid", "any", "0.5657", "m"],
    ]
    assert len(rows) == 12 and all("100.0" in row for row in rows) and lines[14] == "written: fit.png"
    with Image.open("fit.png") as image:
        assert image.width > 4 * 460


def test_one_kind_without_a_radius_or_a_destination(folder):
    square = ("--tessellation", "square", "--neighbourhood", "edge", "--align", "corner")
    rows = [re.split(" {2,}", line) for line in fit("hall.geojson", *square).splitlines()[2:]]
    assert len(rows) == 2 and rows[0][5] == rows[0][9]  # the greatest robots are those that it shows
    row = re.split(" {2,}", fit("hall.wkt", *square, "--cell-size", 0.5).splitlines()[2])
    assert row[5] == "0.1767 m" and row[8:10] == ["-", "-"]
    assert "square, 4 neighbours, following allow: cells must be at least 0.7072 metres" in fit(
        "hall.wkt", *square, "--cell-size", 0.6, "--robot-radius", 0.25
    )


def test_a_clock_may_be_chosen_and_is_named_where_cells_depend_on_it(folder):
    full = (
        "hall.wkt",
        "--tessellation",
        "triangular",
        "--neighbourhood",
        "full",
        "--align",
        "corner",
        "--costs",
        "euclidean",
    )
    rows = [line.split()[2:5] for line in fit(*full, "--robot-radius", 0.2, "--clock", "costs").splitlines()[2:]]
    assert rows == [["allow", "costs", "1.0357"], ["forbid", "any", "0.8"]]
    told = fit(*full, "--cell-size", 1.1, "--robot-radius", 0.2)
    assert "triangular, 12 neighbours, following allow, clock steps: cells must be at least 1.2221 metres" in told
    assert "clock costs: cells" not in told


def test_what_fits_is_what_the_least_cells_of_a_plan_are(folder):
    for clock, size in (("steps", 0.6709), ("costs", 0.65)):
        where = (
            "hall.geojson",
            "--tessellation",
            "square",
            "--robot-radius",
            "0.15",
            "--robots",
            "2",
            "--clock",
            clock,
        )
        result = CliRunner().invoke(main, ["plan", *where, "--out", "plan.npz"])
        assert result.exit_code == 0, result.output
        assert read_plan("plan.npz").scenario.area.metres.cell_size == size
        (folder / "s.toml").write_text(
            'destinations = [[3, 3]]\n[area]\npath = "hall.wkt"\ntessellation = "square"\nrobot_radius = 0.15\n'
            f'[rules]\nclock = "{clock}"\n'
        )
        assert read_scenario("s.toml").area.metres.cell_size == size


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (
            ["world.txt", "--cell-size", "0.5"],
            "world.txt: has one cell for each letter; robot_radius needs a place with walls in metres",
        ),
        (["hall.wkt"], "no robot reaches a destination: add --robot-radius R, --cell-size S or --destination X,Ym"),
        (["hall.wkt", "--robot-radius", "0.2", "--destination", "3,3"], "--destination must be in metres, X,Ym"),
        (["none.wkt", "--robot-radius", "0.2"], "none.wkt"),
        (["hall.wkt", "--robot-radius", "0.2", "--picture", "a.gif"], "the suffix of a picture must be one of .png"),
    ],
)
def test_what_is_refused(folder, command, message):
    assert message in fit(*command, status=2)


def test_robots_that_find_no_room(folder):
    assert "must be larger than a cell" in fit("hall.wkt", "--robot-radius", 3, "--align", "corner", status=1)


def test_a_radius_alone_is_enough_to_plan_and_compare(folder):
    for command in (["plan"], ["compare", "--planners", "greedy"]):
        result = CliRunner().invoke(
            main, [*command, "hall.geojson", "--robot-radius", "0.1", "--robots", "5", "--align", "best"]
        )
        assert result.exit_code == 0, result.output


def test_the_least_cells_depend_on_the_rule_for_following(folder):
    told = ["plan", "hall.geojson", "--robot-radius", "0.1", "--robots", "3", "--summary", "-"]
    cells = {}
    for rule in ("allow", "forbid"):
        result = CliRunner().invoke(main, [*told, "--following", rule])
        assert result.exit_code == 0, result.output
        cells[rule] = json.loads(result.stdout)["cells"]
    assert cells["forbid"] > 2.5 * cells["allow"]  # 0.231 metres in place of 0.4
