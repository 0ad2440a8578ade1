"""Bad input of places in metres: exit status 2 and one line each; and all mistakes as the table in docs/mistakes.md.

``python -m tests.cli.test_bad_places`` writes the table anew.
"""

# A row is a mistake and its message; broken lines would hide the table.
# ruff: noqa: E501

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from tests.cli import test_bad_input
from tests.test_mistakes_in_python import chapter_lines
from trihex import Area, Scenario, write_plan
from trihex.cli import main
from trihex.fields import every_field_kernels
from trihex.kernels.needs import KERNELS_OF
from trihex.kernels.preparing import prepare
from trihex.plans import plan_from_lists

TABLE = Path(__file__).parents[2] / "docs" / "mistakes.md"
YAML = "image: house.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
SQUARE = [[0, 0], [9, 0], [9, 6], [0, 6], [0, 0]]
GEOJSON = (
    '{"type": "Feature", "properties": {"kind": "free"}, "geometry": {"type": "Polygon", "coordinates": ['
    + str(SQUARE)
    + "]}}"
)


def with_feature(kind, type_, coordinates):
    """Return GeoJSON of the square with one feature more."""
    other = f'{{"type": "Feature", "properties": {{"kind": "{kind}"}}, "geometry": {{"type": "{type_}", "coordinates": {coordinates}}}}}'
    return f'{{"type": "FeatureCollection", "features": [{GEOJSON}, {other}]}}'


SIZE = ["--cell-size", "0.5", "--robot-radius", "0.1"]
AIM = ["--destination", "2.2,2.2m"]
ROBOTS = ["--robots", "3", "--planner", "greedy"]
PLAN = ["plan", "house.yaml", *SIZE, *AIM, *ROBOTS]
BAD = ["plan", "bad", *SIZE, *AIM, *ROBOTS]

# As in test_bad_input: what the file `bad` holds, the command, and what it says.
CASES = {
    # sizes
    "map without cell size": (None, ["plan", "house.yaml", *AIM, *ROBOTS], "house.yaml: a ROS map (8 by 6 metres) is measured in metres: say how far apart the centres of neighbouring cells shall be, cell_size 0.5 for half a metre (--cell-size on the command line)"),
    "cells too small for two robots": (None, ["plan", "house.yaml", "--cell-size", "0.3", "--robot-radius", "0.15", *AIM, *ROBOTS], "cell_size must be at least 0.6 metres (0.3465 where following is 'forbid') on hexagonal cells for two robots of radius 0.15 to pass each other (they come as near as 0.866 of it), not 0.3; at that size the radius may be at most 0.1299"),
    "cells too small for triangles": (None, [*PLAN, "--tessellation", "triangular", "--robot-radius", "0.13"], "cell_size must be at least 0.7944 metres (0.52 where following is 'forbid') on triangular cells for two robots of radius 0.13"),
    "cells far too small": (None, ["plan", "house.yaml", "--cell-size", "0.0001", *AIM, *ROBOTS], "cell_size must be at least 0.0016 metres for a world of 8 by 6 metres (at most 25000000 cells), not 0.0001"),
    "cell size of nothing": (None, [*PLAN, "--cell-size", "0"], "--cell-size must be a number above 0, not '0'"),
    "radius for letters": (None, ["plan", "world.txt", *SIZE, *ROBOTS], "world.txt: has one cell for each letter; robot_radius needs a place with walls in metres"),
    "robots too large for the place": (None, ["plan", "house.yaml", "--cell-size", "8", "--robot-radius", "2", *AIM, *ROBOTS], "destination 0 must stand on a free cell; (0, 0) at (4.6188, 2) metres is a barrier: something stands too near for robots of radius 2"),
    "crossing of robots with a radius": (None, [*PLAN, "--tessellation", "square", "--crossing", "allow"], "crossing must be 'forbid' for robots of radius 0.1, not 'allow': two that pass one vertex meet there"),
    "robots that enter together": (None, [*PLAN, "--destination-capacity", "2"], "destination_capacity must be 1 for robots of radius 0.1, not 2: those that enter together meet there; name more destinations instead"),
    # ROS maps
    "ROS map without resolution": (YAML.replace("resolution: 0.1\n", ""), BAD, "bad: a ROS map must have the key 'resolution'"),
    "ROS map with a slip": (YAML.replace("resolution", "resolutoin"), BAD, "bad: a ROS map must have the key 'resolution'; is it 'resolutoin'?"),
    "resolution in words": (YAML.replace("0.1", "fine"), BAD, "bad: resolution must be a number, not 'fine'"),
    "resolution below 0": (YAML.replace("0.1", "-0.1"), BAD, "bad: resolution must be between 1e-9 and 1e9 metres, not -0.1"),
    "origin of one number": (YAML.replace("[0, 0, 0]", "0"), BAD, "bad: origin must be a list [x, y, yaw], not '0'"),
    "origin that does not end": (YAML.replace("[0, 0, 0]", "[0, 0"), BAD, "bad: line 3: the list of origin must end with ] on the same line"),
    "thresholds the wrong way round": (YAML + "free_thresh: 0.9\n", BAD, "bad: thresholds must be 0 <= free_thresh <= occupied_thresh <= 1, not 0.9 and 0.65"),
    "unknown mode": (YAML + "mode: ternary\n", BAD, "bad: mode must be one of trinary, scale, raw, not 'ternary'; did you mean 'trinary'?"),
    "negate in words": (YAML.replace("negate: 0", "negate: perhaps"), BAD, "bad: negate must be 0 or 1, not 'perhaps'"),
    "key twice": (YAML + "negate: 1\n", BAD, "bad: line 5: negate is there twice"),
    "line that is no key": (YAML + "robots\n", BAD, "bad: line 5: must be 'key: value', not 'robots'"),
    "missing image": (YAML.replace("house.pgm", "hut.pgm"), BAD, "hut.pgm: No such file or directory"),
    "map that is its own image": (YAML.replace("house.pgm", "bad"), BAD, "bad: is no image that trihex reads (PNG, PPM, BMP, GIF, JPEG)"),
    # images
    "torn image": (b"P5\n40 40\n255\n" + bytes(70), ["plan", "bad", "--destination", "0,0", *ROBOTS], "bad: the image is damaged: *"),
    "image of 10 gigapixels": (b"P5\n100000 100000\n255\n" + bytes(70), ["plan", "bad", "--destination", "0,0", *ROBOTS], "bad: an image may have at most 100000000 pixels"),
    "image without a measure": (None, ["plan", "house.pgm", *SIZE, *AIM, *ROBOTS], "house.pgm: an image has no measure: say how many metres a pixel is wide, resolution 0.05 for five centimetres (--resolution on the command line)"),
    "radius without a cell size": (None, ["plan", "house.pgm", "--robot-radius", "0.1", "--destination", "4,4", *ROBOTS], "house.pgm: an image has no measure: say how many metres a pixel is wide, resolution 0.05 for five centimetres (--resolution on the command line)"),
    "brightness in per cent": (None, ["plan", "house.pgm", "--threshold", "50", "--destination", "4,4", *ROBOTS], "--threshold must be a number from 0 to 1, not '50'"),
    "unknown kind of unknown": (None, [*PLAN, "--unknown", "fre"], "--unknown must be one of barrier, free, not 'fre'; did you mean 'free'?"),
    "PFM of other numbers": (b"Pf\n2 1\n-1.0\n" + np.array([0, 255], dtype="<f4").tobytes(), ["plan", "bad", "--destination", "0,0", *ROBOTS], "bad: brightness in a PFM must be a number from 0 to 1, not 255"),
    "image a little too large": (b"P5\n12000 9000\n255\n" + bytes(70), ["plan", "bad", "--destination", "0,0", *ROBOTS], "bad: an image may have at most 100000000 pixels, not 12000 x 9000: cut off what is not needed, or shrink it (a half as wide has twice the resolution in metres)"),
    # polygons
    "JSON cut short": (GEOJSON[:-2], BAD, "bad: is no JSON: *delimiter"),
    "unknown kind": (GEOJSON.replace('"free"', '"obstacles"'), BAD, "bad: feature 0: kind must be one of free, obstacle, destination, robot, door, not 'obstacles'; did you mean 'obstacle'?"),
    "unknown type": (GEOJSON.replace("Polygon", "Polygone"), BAD, "bad: feature 0: type must be one of *, not 'Polygone'; did you mean 'Polygon'?"),
    "open ring": (GEOJSON.replace(", [0, 0]]", "]"), BAD, "bad: feature 0: is no Polygon: a ring must end where it begins"),
    "ring in words": (GEOJSON.replace("[9, 0]", '["nine", 0]'), BAD, "bad: feature 0: is no Polygon: coordinates must be finite numbers in lists as deep as its type asks for"),
    "ring that crosses itself": (GEOJSON.replace("[9, 0], [9, 6]", "[9, 6], [9, 0]"), BAD, "bad: feature 0: a Polygon is invalid: Self-intersection"),
    "nothing free": (GEOJSON.replace('"free"', '"obstacle"'), BAD, "bad: there must be a polygon that is free; there is none with an area"),
    "WKT cut short": ("POLYGON ((0 0, 9 0", BAD, "bad: is no WKT: *end of stream"),
    "WKT with curves": ("CURVEPOLYGON (CIRCULARSTRING (0 0, 4 0, 4 4, 0 4, 0 0))", ["plan", "bad.wkt", *SIZE, *AIM, *ROBOTS], "bad.wkt: is no WKT: *"),
    "MultiPolygon with a bad part": (GEOJSON.replace('"Polygon"', '"MultiPolygon"').replace('"coordinates": [', '"coordinates": [[[[0, 0], [2, 2], [2, 0], [0, 2], [0, 0]]], [').replace("]}}", "]]}}"), BAD, "bad: feature 0: part 0: a Polygon is invalid: Self-intersection"),
    "exit far outside": (with_feature("destination", "LineString", "[[10, 2], [10, 4]]"), ["plan", "bad", *SIZE, *ROBOTS], "bad: feature 1: a destination between (10, 2) and (10, 4) metres touches no free cell, and none leads through it; the nearest is (19, 3) at (8.51592, 4) metres, its centre 1.48 metres away"),
    "exit with half a name": (GEOJSON.replace('"kind": "free"', '"kind": "destination", "name": ["north"]'), BAD, "bad: feature 0: name of a zone must be a line of 1 to 200 characters, not ['north']"),
    "exit without coordinates": (with_feature("destination", "LineString", "[]"), ["plan", "bad", *SIZE, *ROBOTS], "bad: feature 1: a destination must have coordinates; it has none"),
    "door that lets in nobody knows how many": (with_feature("door", "LineString", "[[4, 0], [4, 6]]"), ["plan", "bad", *SIZE, *AIM, *ROBOTS], "bad: feature 1: a door must have the property capacity, what it lets in, such as '1.6/s'"),
    "door of a strange capacity": (with_feature("door", "LineString", "[[4, 0], [4, 6]]").replace('"door"', '"door", "capacity": "many"'), ["plan", "bad", *SIZE, *AIM, *ROBOTS], "bad: feature 1: capacity must be a number of robots above 0: a step, such as 2, 0.5 or 1/3, or in metres a second, such as 1.6/s; not 'many'"),
    "door outside": (with_feature("door", "LineString", "[[12, 0], [12, 6]]").replace('"door"', '"door", "capacity": 1'), ["plan", "bad", *SIZE, *AIM, *ROBOTS], "bad: feature 1: a door must lead through free cells; it meets none"),
    "robot without coordinates": (with_feature("robot", "Point", "[]"), ["plan", "bad", *SIZE, *AIM], "bad: feature 1: a robot must have coordinates; it has none"),
    "place in degrees": (GEOJSON.replace(str(SQUARE), "[[13.40, 52.51], [13.41, 52.51], [13.41, 52.52], [13.40, 52.51]]"), BAD, "bad: a place drawn by polygons must be larger than a cell of 0.5 metres, not 0.01 by 0.01 metres: numbers are metres, not degrees or kilometres"),
    "place in kilometres": ("POLYGON ((0 0, 0.09 0, 0.09 0.06, 0 0))", BAD, "bad: a place drawn by polygons must be larger than a cell of 0.5 metres, not 0.09 by 0.06 metres: numbers are metres, not degrees or kilometres"),
    "WKT with one bracket": ("POLYGON (0 0, 9 0, 9 6, 0 0)", BAD, "bad: is no WKT: *; a POLYGON has two brackets: POLYGON ((0 0, 9 0, 9 6, 0 0))"),
    "WKT of several": ("POLYGON ((0 0, 9 0, 9 6, 0 0))\nPOLYGON ((9 0, 12 0, 9 6, 9 0))", BAD, "bad: is no WKT: *; several are one GEOMETRYCOLLECTION (..., POLYGON)"),
    # places
    "destination outside, in metres": (None, ["plan", "house.yaml", *SIZE, "--destination", "20,2m", *ROBOTS], "--destination: point (20, 2) metres lies outside the area: in none of its cells; the nearest free cell is (16, 7) at (7.21688, 2.25) metres, 12.8 metres away"),
    "destination between cells and wall": (None, ["plan", "house.yaml", *SIZE, "--destination", "7.99,0.01m", *ROBOTS], "--destination: point (7.99, 0.01) metres lies outside the area: in none of its cells; the nearest free cell is"),
    "destination half in metres": (None, ["plan", "house.yaml", *SIZE, "--destination", "2m", *ROBOTS], "--destination in metres must be X,Ym, such as 3.2,-1m, not '2m'"),
    "metres in an area of cells": (None, ["plan", "world.txt", "--destination", "2,2m", *ROBOTS], "--destination: the area is measured in cells, not in metres; give it a frame (cell_size)"),
    "start outside, in metres": ("x_metres,y_metres\n1.2,2.2\n20,2\n", [*PLAN[:-4], "--planner", "greedy", "--starts", "bad"], "bad: line 3: point (20, 2) metres lies outside the area"),
    "start in words": ("x_metres,y_metres\n1.2,two\n", [*PLAN[:-4], "--planner", "greedy", "--starts", "bad"], "bad: line 2: must be two numbers, not '1.2,two'"),
    "start time below 0": ("x,y,start\n1,1,-2\n", ["plan", "world.txt", "--planner", "greedy", "--starts", "bad"], "bad: line 2: start must be a number from 0, not '-2'"),
    "start times of no law": (None, ["plan", "world.txt", "--planner", "greedy", "--robots", "1", "--start-times", "gauss:3,1"], "start times must be drawn as one of constant:time, uniform:least,most, normal:mean,sd, lognormal:mean,sd, such as 'lognormal:30,15', not 'gauss:3,1'"),
    "speed of nobody": ("x,y,speed\n1,1,0\n", ["plan", "world.txt", "--planner", "greedy", "--starts", "bad"], "bad: line 2: speed must be a number above 0, not '0'"),
    "slowness of a snail": ("x,y,slowness\n1,0,99\n", ["plan", "world.txt", "--planner", "greedy", "--starts", "bad"], "slowness[0] must be a whole number from 1 to 30: no move may last longer than 30 ticks, not 99"),
    "slowness in a search": ("x,y,slowness\n1,0,3\n", ["plan", "world.txt", "--planner", "astar", "--starts", "bad"], "planner 'astar' needs robots that are all as fast, without slowness, not slowness up to 3"),
    "scen of another map": ("version 1\n0\ta.map\t9\t9\t0\t0\t1\t1\t2\n", ["plan", "world.txt", "--planner", "greedy", "--starts", "bad"], "bad: line 2: is for an area of 9 x 9 cells, not of 3 x 2"),
    "scen with a column too few": ("version 1\n0\ta.map\t3\t2\t0\t0\t1\t1\n", ["plan", "world.txt", "--planner", "greedy", "--starts", "bad"], "bad: line 2: must have 9 columns *, not 8"),
    # outputs
    "waypoints of no kind": (None, [*PLAN, "--waypoints", "w.xlsx"], "w.xlsx: the suffix of waypoints must be one of .csv, .yaml, .json, .geojson, .sqlite, .mcap, not '.xlsx'"),
    "speed below 0": (None, [*PLAN, "--waypoints", "w.csv", "--speed", "-1"], "--speed must be a number above 0, not '-1'"),
    "hexagons for mapf-visualizer": (None, ["convert", "plan.npz", "p.txt"], "p.txt: mapf-visualizer draws squares only; the plan is hexagonal"),
    "metres in a scenario of letters": (None, ["convert", "house.geojson", "p.txt"], "house.geojson: a place drawn by polygons is measured in metres"),
    "torn Parquet": (b"PAR1" + bytes(40) + b"PAR1", ["check", "bad", "house.yaml", *SIZE, *AIM], "bad: is no whole Parquet file of a plan: *"),
    "Parquet without its area": (b"PAR1" + bytes(40) + b"PAR1", ["check", "bad"], "bad does not hold its area: add AREA"),
}  # fmt: skip


def fill(folder):
    """Put into `folder` what the commands of all rows need."""
    for name, text in test_bad_input.FILES.items():
        (folder / name).write_text(text)
    pixels = np.full((60, 80), 254, dtype=np.uint8)
    pixels[[0, -1]] = pixels[:, [0, -1]] = 0
    Image.fromarray(pixels).save(folder / "house.pgm")
    (folder / "house.yaml").write_text(YAML)
    (folder / "house.geojson").write_text(GEOJSON)
    area = Area("hexagonal", [[0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]])
    write_plan(plan_from_lists(Scenario(area, [(3, 0)], [(2, 0)]), [[2]]), folder / "plan.npz")


def run(folder, content, command):
    """Return the result of a row, and whether it left files behind."""
    bad = next((word for word in command if word.startswith("bad")), None)
    if content is not None:
        (folder / bad).write_bytes(content if isinstance(content, bytes) else content.encode())
    before = set(folder.iterdir())
    result = CliRunner().invoke(main, command)
    left = set(folder.iterdir()) - before
    if content is not None:
        (folder / bad).unlink()
    return result, left


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bad")
    fill(folder)
    here = Path.cwd()
    os.chdir(folder)
    yield folder
    os.chdir(here)


@pytest.mark.parametrize("case", CASES)
def test_bad_place(folder, case):
    content, command, message = CASES[case]
    result, left = run(folder, content, command)
    head, _, tail = message.partition("*")
    assert result.stderr.startswith(f"trihex: error: {head}")
    assert tail in result.stderr
    assert result.stderr.count("\n") == 1
    assert (result.stdout, result.exit_code, left) == ("", 2, set())


def table_lines(folder):
    """Yield the lines of the table of all mistakes, with what trihex says to each."""
    yield "# Mistakes, and what trihex says\n"
    yield "Every row is run by the tests; `python -m tests.cli.test_bad_places` writes this page anew.\n"
    yield "## On the command line\n"
    yield "Each time the exit status is 2, nothing is on the standard output, and no file is left behind. `bad` is the file with the"
    yield "mistake in it.\n"
    yield "| mistake | in `bad` | command | message |"
    yield "|---|---|---|---|"
    for case, (content, command, message) in (test_bad_input.CASES | CASES).items():
        result, _ = run(folder, content, command)
        head, star, tail = message.partition("*")
        words = " ".join(f"'{word}'" if " " in word else word for word in ["trihex", *command])
        said = result.stderr.removeprefix("trihex: error: ").strip()
        if star and tail in said:  # a list of names that grows, or the words of a library
            said = f"{head}...{said[said.index(tail) :] if tail else ''}"
        yield f"| {case} | {odd_lines(content)} | `{words}` | {said} |".replace("\0", "\\0")
    yield ""
    yield from chapter_lines()


def odd_lines(content):
    """Return the lines of a bad file that a good one would not have."""
    if content is None:
        return ""
    if isinstance(content, bytes):
        return f"`{content[:24]!r}`" + " ..." * (len(content) > 24)
    good = [line for text in (YAML, test_bad_input.MAP) for line in text.splitlines()]
    lines = [line for line in content.splitlines() if line not in good]
    return f"`{' / '.join(lines)[:150]}`" if lines else ""


def test_the_table_in_the_docs_is_what_trihex_says(folder):
    anew = "\n".join(table_lines(folder)).splitlines()
    assert TABLE.read_text().splitlines() == anew, "write the page anew: python -m tests.cli.test_bad_places"


if __name__ == "__main__":
    prepare(*KERNELS_OF, *every_field_kernels())  # or the first commands would tell that they compile
    with TemporaryDirectory() as name:
        fill(Path(name))
        os.chdir(name)
        TABLE.write_text("\n".join([*table_lines(Path(name)), ""]))
    sys.exit()
