"""Seeds: one small, good file of every format that trihex reads."""

from __future__ import annotations

import json
from base64 import b64encode
from pathlib import Path
from tempfile import TemporaryDirectory
from zlib import compress

import ezdxf
import numpy as np
from PIL import Image

from trihex import (
    Area,
    Frame,
    Scenario,
    Tessellation,
    Trial,
    write_area,
    write_plan,
    write_run,
    write_scenario,
    write_waypoints,
)
from trihex.formats import draft_of
from trihex.plans import plan_from_lists
from trihex.running import Event
from trihex.viewer.bundle import encode
from trihex.viewer.document import document_of

ROWS = ["...B....", ".B....B.", "........", "..BB...."]
YAML = """image: house.pgm
resolution: 0.1
origin: [-1.0, 2.0, 0.3]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
STYLE = """{
  "image": "house.pgm",  # in the style of JSON
  "resolution": 0.1, "origin": [-1.0, 2.0, 0.3],
  "negate": 0
}
"""
_RING = [[0, 0], [6, 0], [6, 4], [0, 4], [0, 0]]
GEOJSON = {
    "type": "FeatureCollection",
    "features": [
        {"type": "Feature", "properties": {"kind": "free"}, "geometry": {"type": "Polygon", "coordinates": [_RING]}},
        {"type": "Feature", "properties": {"kind": "obstacle"}, "geometry": {"type": "Point", "coordinates": [3, 2]}},
        {
            "type": "Feature",
            "properties": {"kind": "destination", "name": "west, gate"},
            "geometry": {"type": "LineString", "coordinates": [[1, 1], [1, 3]]},
        },
        {
            "type": "Feature",
            "properties": {"kind": "robot"},
            "geometry": {"type": "MultiPoint", "coordinates": [[5, 1], [5, 3]]},
        },
    ],
}
_PARTS = [[_RING], [[[5, 0], [9, 0], [9, 4], [5, 4], [5, 0]]]]  # they overlap
PARTS = {"type": "MultiPolygon", "coordinates": _PARTS}
WKT = "GEOMETRYCOLLECTION (POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0), (2 1, 3 1, 3 2, 2 2, 2 1)), LINESTRING (4 1, 4 2))"
TOML = """destinations = [[0, 0]]
[area]
rows = ["....", ".B..", "...."]
tessellation = "triangular"
[area.frame]
cell_size = 0.5
origin = [1, 2]
[rules]
waiting_cost = 12
corners = "no-cut"
[robots]
random = 4
seed = 7
[planner]
name = "greedy"
"""
EVENTS = [Event(2, "barrier", cell=(3, 2)), Event(3, "join", cell=(1, 2)), Event(4, "clear", cell=(3, 2))]
STUDY = """robots = [3, 5]
seeds = [1, 2]
planners = ["greedy", "fcost"]
tessellations = ["square", "triangular"]
[[areas]]
generator = "random"
size = [8, 6]
density = 0.1
[[areas]]
path = "yard.map"
[limits]
seconds = 5
"""
_BARRIER = {"name": "barrier", "type": "bool", "value": True}
LEVEL = {
    "height": 2, "infinite": False,
    "layers": [
        {"type": "tilelayer", "name": "ground", "width": 3, "height": 2, "data": [1, 2, 1, 1, 1, 2147483650]},
        {"type": "group", "layers": [
            {"type": "tilelayer", "name": "destinations", "data": "AAAAAAAAAAABAAAAAAAAAAAAAAAAAAAA"}
        ]},
    ],
    "orientation": "hexagonal", "hexsidelength": 16, "staggeraxis": "y", "staggerindex": "even",
    "tilesets": [{"firstgid": 1, "tiles": [{"id": 1, "properties": [_BARRIER]}]}],
    "tilewidth": 32, "tileheight": 28, "width": 3,
}  # fmt: skip
TMX = """<?xml version="1.0" encoding="UTF-8"?>
<map orientation="hexagonal" width="3" height="2" infinite="0" staggeraxis="x" staggerindex="even">
 <tileset firstgid="1">
  <tile id="1"><properties><property name="solid" type="bool" value="true"/></properties></tile>
 </tileset>
 <layer name="ground" width="3" height="2"><data encoding="csv">
1,2,1,
1,1,2
</data></layer>
 <layer name="robots"><data encoding="base64" compression="zlib">PACKED</data></layer>
</map>
"""
PLACE_TOML = """destinations_in_metres = [[0.98, 5.75]]
[area]
path = "house.yaml"
cell_size = 0.5
robot_radius = 0.05
unknown = "free"
[robots]
metres = [[2.6, 7.3]]
"""


def house() -> Image.Image:
    """Return the picture of a house of 8 x 6 metres."""
    pixels = np.full((60, 80), 254, dtype=np.uint8)
    pixels[[0, -1]] = pixels[:, [0, -1]] = 0
    pixels[20:40, 40] = 0
    return Image.fromarray(pixels)


def drawing(form: str) -> bytes:
    """Return a floor plan as CAD draws it: a nested block, an arc, a spline, a hatch, text and an exit."""
    document = ezdxf.new("R2000", units=4)
    space, inner, outer = document.modelspace(), document.blocks.new("INNER"), document.blocks.new("OUTER")
    inner.add_lwpolyline([(6000, 3000), (6000, 0), (0, 0), (0, 4000), (6000, 4000), (6000, 3600)])
    outer.add_blockref("INNER", (6000, 0), dxfattribs={"xscale": -1})
    outer.add_arc((2000, 2000), 400, 0, 270)
    space.add_blockref("OUTER", (0, 0), dxfattribs={"layer": "WALLS"})
    space.add_spline([(3000, 0), (3200, 700), (3000, 1500)], dxfattribs={"layer": "WALLS"})
    space.add_hatch(dxfattribs={"layer": "WALLS"}).paths.add_polyline_path([(4000, 900), (4400, 900), (4400, 1400)])
    space.add_line((0, 3000), (0, 3600), dxfattribs={"layer": "EXIT"})
    space.add_text("west gate", dxfattribs={"layer": "EXIT", "insert": (-500, 3300)})
    # Most of what ezdxf writes is tables that no drawing needs.
    with TemporaryDirectory() as name:
        document.saveas(Path(name) / "plan.dxf", fmt=form)
        return (Path(name) / "plan.dxf").read_bytes()


def make_seeds() -> dict[str, bytes]:
    """Return the content of a good file by its name."""
    tessellation = Tessellation("square")
    area = Area(tessellation, [[letter == "B" for letter in row] for row in ROWS], "yard", Frame(0.5))
    scenario = Scenario(area, [(7, 0), (0, 3)], [(0, 0), (4, 1)])
    plan = plan_from_lists(scenario, [[2, 2, 2], [1, 1, 1, 0]])
    seeds = {
        "house.yaml": YAML.encode(),
        "house.geojson": json.dumps(GEOJSON).encode(),
        "house.wkt": WKT.encode(),
        "style.yaml": STYLE.encode(),
        "parts.geojson": json.dumps(PARTS).encode(),
        "srid.wkt": b"SRID=25832;" + WKT.encode(),
        "level.tmj": json.dumps(LEVEL).encode(),
        "level.tmx": TMX.replace("PACKED", b64encode(compress(bytes([1, *[0] * 23]))).decode()).encode(),
        "world.toml": TOML.encode(),
        "place.toml": PLACE_TOML.encode(),
        "starts.csv": b"x,y\n0,0\n2,2\n5,1\n",
        "metres.csv": b"x_metres,y_metres\n0.2,-0.2\n1.7,-0.7\n",
        "yard.scen": b"version 1\n0\tyard.map\t8\t4\t1\t0\t7\t0\t6.5\n1\tyard.map\t8\t4\t4\t2\t7\t0\t3.5\n",
        "letters.txt": b"a..B...D\n.B.b..B.\n....D...\n",
        "walls.txt": b"#######\n#a.B.D#\n#.#b..#\n#######\n",
        "house.pfm": b"Pf\n80 60\n-1.0\n" + (np.asarray(house()) / 255).astype("<f4")[::-1].tobytes(),
    }
    seeds["events.csv"] = (
        b"step,event,x,y,zone,metres\n2,barrier,3,2,,\n3,join,1,2,,\n4,close,,,north,\n5,barrier,,,,1 1; 2 1; 2 2\n"
    )
    seeds["events.toml"] = b'[[event]]\nstep = 2\nevent = "barrier"\nmetres = [[1, 1], [2, 1.5]]\n'
    seeds["events.toml"] += b'[[event]]\nsecond = 2.5\nevent = "open"\ncell = [3, 2]\n'
    seeds["seconds.csv"] = b"second,event,x,y\n0,barrier,3,2\n2.5,open,1,2\n"
    seeds["crowd.txt"] = b"# framerate: 2\n0 0 0.2 -0.2\n0 1 0.7 -0.2\n4 0 1.2 -1.2\n4 1 1.2 -1.7\n"
    seeds["study.toml"] = STUDY.encode()
    seeds["plan.dxf"], seeds["binary.dxf"] = drawing("asc"), drawing("bin")
    document, arrays = document_of(draft_of(scenario))
    seeds["request.bundle"] = encode({"op": "plan", "planner": "greedy", "options": {}, "document": document}, arrays)
    with TemporaryDirectory() as name:
        folder = Path(name)
        plain = Area(tessellation, area.barriers, "yard")
        write_area(plain, folder / "yard.map")
        for suffix in ("csv", "npz", "parquet"):
            write_plan(plan, folder / f"plan.{suffix}")
        write_waypoints(plan, folder / "crowd.sqlite")
        write_run(Trial(scenario, events=EVENTS).run(), folder / "run.npz")
        write_scenario(scenario, folder / "yard.toml")
        for suffix in ("pgm", "png", "bmp", "gif", "jpeg"):
            house().save(folder / f"house.{suffix}")
        house().convert("RGBA").save(folder / "colours.png")
        seeds |= {path.name: path.read_bytes() for path in folder.iterdir()}
    return seeds
