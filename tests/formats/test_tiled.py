"""Maps of Tiled: hexagons of every stagger drawn as its documentation says, and all ways in which layers are packed."""

# ruff: noqa: E501

import gzip
import json
import zlib
from base64 import b64encode

import numpy as np
import pytest
import shapely
from click.testing import CliRunner

import trihex as th
from trihex.cli import main
from trihex.formats import read_draft

STAGGERS = [(axis, index) for axis in "xy" for index in ("odd", "even")]
WIDE, HIGH = 5, 4


def numbers(rows):
    return [int(number) for row in rows for number in row]


def map_of(rows, *, stagger=None, name="walls", **others):
    """Return a map in JSON with one layer."""
    kind = {"orientation": "orthogonal"}
    if stagger:
        kind = {"orientation": "hexagonal", "hexsidelength": 16, "staggeraxis": stagger[0], "staggerindex": stagger[1]}
    size = {"width": len(rows[0]), "height": len(rows)}
    layer = {"type": "tilelayer", "name": name, **size, "data": numbers(rows)}
    tiled = {"type": "map", "infinite": False, **size, **kind, "tilewidth": 32, "tileheight": 28}
    return tiled | {"layers": [layer], "tilesets": []} | others


def xml_of(tiled, data):
    """Return the same map as XML; `data` is the element of its layer."""
    names = (
        "orientation",
        "width",
        "height",
        "tilewidth",
        "tileheight",
        "hexsidelength",
        "staggeraxis",
        "staggerindex",
    )
    own = " ".join(f'{name}="{tiled[name]}"' for name in names if name in tiled)
    (layer,) = tiled["layers"]
    size = f'width="{tiled["width"]}" height="{tiled["height"]}"'
    return f'<?xml version="1.0"?>\n<map infinite="0" {own}><layer name="{layer["name"]}" {size}>{data}</layer></map>'


def written(tiled, path):
    if path.suffix == ".tmj":
        path.write_text(json.dumps(tiled))
    else:
        rows = ",".join(str(number) for number in tiled["layers"][0]["data"])
        path.write_text(xml_of(tiled, f'<data encoding="csv">\n{rows}\n</data>'))
    return path


def hexagon(column, row, axis, index):
    """Return the hexagon of a tile as the documentation has it.

    "Tiles 32 wide and 28 high, hexsidelength 16. The staggered axis is x or y, shifted are its odd or even indexes": by
    half a tile, along the other axis. Along the staggered axis a tile lies half of what is no side beyond the last.
    """
    w, h, side = 32, 28, 16
    is_shifted = (column if axis == "x" else row) % 2 == (1 if index == "odd" else 0)
    if axis == "x":
        left, top = column * (w + side) / 2, row * h + (h / 2 if is_shifted else 0)
        a = (w - side) / 2
        corners = [(a, 0), (a + side, 0), (w, h / 2), (a + side, h), (a, h), (0, h / 2)]
    else:
        left, top = column * w + (w / 2 if is_shifted else 0), row * (h + side) / 2
        a = (h - side) / 2
        corners = [(w / 2, 0), (w, a), (w, a + side), (w / 2, h), (0, a + side), (0, a)]
    return shapely.Polygon([(left + x, top + y) for x, y in corners])


@pytest.mark.parametrize("suffix", [".tmj", ".tmx"])
@pytest.mark.parametrize("stagger", STAGGERS)
def test_every_stagger_is_the_hexagons_drawn(tmp_path, stagger, suffix):
    tiles = [(column, row) for row in range(HIGH) for column in range(WIDE)]
    drawn = {tile: hexagon(*tile, *stagger) for tile in tiles}
    cell_of_tile = {}
    for tile in tiles:  # alone on its map, cell by cell
        rows = [[int((column, row) == tile) for column in range(WIDE)] for row in range(HIGH)]
        area = th.read_area(written(map_of(rows, stagger=stagger), tmp_path / f"m{suffix}"))
        bare = th.read_area(written(map_of(np.zeros((HIGH, WIDE)), stagger=stagger), tmp_path / f"m{suffix}"))
        assert area.tessellation == th.Tessellation("hexagonal") and area.name == "m"
        (found,) = np.argwhere(area.barriers & ~bare.barriers).tolist()
        cell_of_tile[tile] = (found[1], found[0])
    assert len(set(cell_of_tile.values())) == WIDE * HIGH
    assert bare.free_count == WIDE * HIGH  # what is beside the tiles is barrier
    steps = bare.tessellation.step_of_direction
    for one in tiles:
        x, y = cell_of_tile[one]
        around = {(x + dx, y + dy) for dx, dy in steps[x % 2].tolist()}
        for other in tiles:
            shared = drawn[one].boundary.intersection(drawn[other].boundary).length
            assert (cell_of_tile[other] in around) == (one != other and shared > 1), (one, other)


@pytest.mark.parametrize("suffix", [".tmj", ".tmx"])
def test_squares(tmp_path, suffix):
    rows = [[0, 1, 0], [7, 0, 0]]
    area = th.read_area(written(map_of(rows), tmp_path / f"m{suffix}"))
    assert area.tessellation.name == "square" and area.barriers.tolist() == (np.array(rows) > 0).tolist()
    assert th.read_area(tmp_path / f"m{suffix}", cell_size=2).frame == th.Frame(2)
    edge = th.read_area(tmp_path / f"m{suffix}", th.Tessellation("square", "edge", "euclidean"))
    assert edge.tessellation == th.Tessellation("square", "edge", "euclidean")
    with pytest.raises(th.FormatError, match=r"has square cells, which cannot be read as hexagonal"):
        th.read_area(tmp_path / f"m{suffix}", "hexagonal")


ROWS = [[0, 1, 0], [2147483649, 0, 3]]
PACKINGS = {"": bytes, "zlib": zlib.compress, "gzip": gzip.compress}


@pytest.mark.parametrize("packing", PACKINGS)
def test_packed_layers(tmp_path, packing):
    packed = b64encode(PACKINGS[packing](np.array(ROWS, dtype="<u4").tobytes())).decode()
    tiled = map_of(ROWS)
    xml = xml_of(tiled, f'<data encoding="base64" compression="{packing}">\n   {packed}\n  </data>')
    tiled["layers"][0] |= {"data": packed, "encoding": "base64", "compression": packing}
    (tmp_path / "m.tmj").write_text(json.dumps(tiled))
    (tmp_path / "m.tmx").write_text(xml)
    for name in ("m.tmj", "m.tmx"):
        assert th.read_area(tmp_path / name).barriers.tolist() == (np.array(ROWS) > 0).tolist()


def test_tiles_one_by_one_in_xml(tmp_path):
    data = "".join(f'<tile gid="{number}"/>' if number else "<tile/>" for number in numbers(ROWS))
    (tmp_path / "m.tmx").write_text(xml_of(map_of(ROWS), f"<data>{data}</data>"))
    assert th.read_area(tmp_path / "m.tmx").barriers.tolist() == (np.array(ROWS) > 0).tolist()


TILES = [{"id": 1, "properties": [{"name": "Barrier", "type": "bool", "value": True}]}, {"id": 2, "properties": []}]


def test_tiles_are_barriers_by_their_property(tmp_path):
    (tmp_path / "tiles").mkdir()
    (tmp_path / "tiles" / "outer.tsj").write_text(json.dumps({"type": "tileset", "tiles": TILES}))
    (tmp_path / "tiles" / "outer.tsx").write_text(
        '<tileset name="t"><tile id="0"><properties><property name="solid" type="bool" value="true"/></properties></tile>'
        '<tile id="9"><properties><property name="solid" type="bool" value="true"/></properties></tile></tileset>'
    )
    tilesets = [
        {"firstgid": 20, "source": "tiles/outer.tsx"},
        {"firstgid": 1, "tiles": TILES},
        {"firstgid": 10, "source": "tiles/outer.tsj"},
        {"firstgid": 25, "tiles": []},  # 29 is the fifth of this one, not the tenth of the one before
    ]
    rows = [[0, 1, 2, 3, 10, 11, 12, 20, 21, 29, 2 + 2**31]]
    (tmp_path / "m.tmj").write_text(json.dumps(map_of(rows, name="ground", tilesets=tilesets)))
    assert th.read_area(tmp_path / "m.tmj").barriers.astype(int).tolist() == [[0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1]]
    (tmp_path / "tiles" / "outer.tsj").unlink()
    with pytest.raises(FileNotFoundError, match=r"tiles/outer\.tsj"):
        th.read_area(tmp_path / "m.tmj")


def test_layers_come_before_tiles_and_may_be_in_groups(tmp_path):
    tiled = map_of([[2, 0, 0]], name="ground", tilesets=[{"firstgid": 1, "tiles": TILES}])
    size = {"type": "tilelayer", "width": 3, "height": 1}
    marked = {
        **size,
        "name": "x",
        "data": [0, 0, 5],
        "properties": [{"name": "barrier", "type": "bool", "value": True}],
    }
    group = {"type": "group", "layers": [{**size, "name": "Collision", "data": [0, 5, 0]}]}
    tiled["layers"] += [{"type": "objectgroup", "name": "walls"}, {"type": "group", "layers": [group]}, marked]
    (tmp_path / "m.tmj").write_text(json.dumps(tiled))
    assert th.read_area(tmp_path / "m.tmj").barriers.tolist() == [[False, True, True]]


@pytest.mark.parametrize("stagger", STAGGERS)
def test_destinations_and_robots_are_layers(tmp_path, stagger):
    tiled = map_of([[0, 1, 0], [0, 0, 0]], stagger=stagger)
    size = {"type": "tilelayer", "width": 3, "height": 2}
    tiled["layers"] += [
        {**size, "name": "destinations", "data": [0, 0, 9, 0, 0, 0]},
        {**size, "name": "Robots", "data": [9, 0, 0, 0, 0, 9]},
    ]
    (tmp_path / "m.tmj").write_text(json.dumps(tiled))
    draft = read_draft(tmp_path / "m.tmj")
    plus = stagger[1] == "even"
    place = {
        (column, row): (row + plus, column) if stagger[0] == "y" else (column + plus, row)
        for column, row in [(0, 0), (2, 0), (2, 1)]
    }
    cells = [x + y * draft.area.width for x, y in place.values()]
    assert draft.destinations.tolist() == [cells[1]] and draft.robots.tolist() == [cells[0], cells[2]]
    assert bool(draft.notes) == (stagger != ("x", "odd"))
    assert th.make_plan(draft.complete(), "greedy").arrived.all()


def test_the_command_line_says_which_cell_is_which(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    written(map_of([[0, 1, 0], [0, 0, 0]], stagger=("y", "even")), tmp_path / "m.tmx")
    done = CliRunner().invoke(main, ["convert", "m.tmx", "m.txt"])
    assert done.exit_code == 0 and (tmp_path / "m.txt").read_text() == "B..\nBB.\nB..\n"
    assert (
        "m.tmx: hexagons of stagger axis y, index even: the tile in column c, row r is cell (r + 1, c)" in done.output
    )
    (tmp_path / "s.toml").write_text('destinations = [[1, 0]]\n[area]\npath = "m.tmx"\n[robots]\ncells = [[2, 1]]\n')
    done = CliRunner().invoke(main, ["plan", "s.toml"])
    assert done.exit_code == 0 and "1 of 1 robots arrive" in done.output


LAYER = {"type": "tilelayer", "name": "walls", "data": [0]}
PLAIN = map_of([[0]])
MISTAKES = {
    "nothing says": (map_of([[1]], name="ground"), r"nothing says which tiles are barriers: call a layer 'barriers'.*'ground'"),
    "isometric": (PLAIN | {"orientation": "isometric"}, r"orientation must be one of orthogonal, hexagonal, not 'isometric'"),
    "infinite": (PLAIN | {"infinite": True}, r"must have an end: take the tick from 'Infinite'"),
    "axis": (map_of([[0]], stagger=("z", "odd")), r"staggeraxis must be one of x, y, not 'z'"),
    "index": (map_of([[0]], stagger=("x", "odds")), r"staggerindex must be one of odd, even, not 'odds'; did you mean 'odd'"),
    "size": (PLAIN | {"width": 0}, r"width and height must be whole numbers from 1, not 0, 1"),
    "huge": (PLAIN | {"width": 10**9, "height": 10**9}, r"width and height must be whole numbers from 1, not"),
    "layers": (PLAIN | {"layers": 5}, r"layers must be a list of objects"),
    "short": (PLAIN | {"layers": [LAYER | {"data": [0, 0]}]}, r"layer 'walls' must hold 1 whole numbers, 1 x 1, not 2"),
    "words": (PLAIN | {"layers": [LAYER | {"data": ["a"]}]}, r"layer 'walls' must hold 1 whole numbers"),
    "bits": (PLAIN | {"layers": [LAYER | {"data": [2**70]}]}, r"layer 'walls': numbers of tiles must have at most 32 bits"),
    "zstd": (
        PLAIN | {"layers": [LAYER | {"data": "AAAA", "compression": "zstd"}]},
        r"layer 'walls': compression must be one of , zlib, gzip, not 'zstd'",
    ),
    "no base64": (PLAIN | {"layers": [LAYER | {"data": "!"}]}, r"layer 'walls' is damaged: "),
    "too few": (PLAIN | {"layers": [LAYER | {"data": "AAA="}]}, r"must hold 4 bytes, four for each tile, not 2"),
    "a bomb": (
        PLAIN | {"layers": [LAYER | {"data": b64encode(zlib.compress(bytes(10**6))).decode(), "compression": "zlib"}]},
        r"must hold 4 bytes, four for each tile, not more",
    ),
    "tilesets": (map_of([[1]], name="g", tilesets=[{"firstgid": 0}]), r"tilesets must be a list of objects, each with"),
    "a tile": (map_of([[1]], name="g", tilesets=[{"firstgid": 1, "tiles": [{}]}]), r"each tile of a tileset must have an id"),
    "source": (map_of([[1]], name="g", tilesets=[{"firstgid": 1, "source": 5}]), r"source of a tileset must be the path"),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_are_told_in_one_line(tmp_path, mistake):
    tiled, message = MISTAKES[mistake]
    (tmp_path / "m.tmj").write_text(json.dumps(tiled))
    with pytest.raises(th.FormatError, match=message) as told:
        th.read_area(tmp_path / "m.tmj")
    assert str(told.value).startswith(str(tmp_path / "m.tmj")) and "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<map", "is no whole XML"),
        ('<!DOCTYPE map [<!ENTITY a "b">]><map/>', "must not define entities"),
        ("<plan/>", "must be a <map> of Tiled, not <plan>"),
        ('<map width="a"/>', "width must be a whole number, not 'a'"),
        ('<map orientation="orthogonal" width="1" height="1"><layer name="walls"><data encoding="csv">x</data></layer></map>',
         "layer 'walls': tiles must be whole numbers"),
        ("{", "is no whole JSON"),
        ("[" * 100_000, "is no whole JSON"),
        ("[]", "must be an object in JSON, not list"),
    ],
)  # fmt: skip
def test_damaged_text_is_told_in_one_line(tmp_path, text, message):
    (tmp_path / "m.tmx").write_text(text)
    with pytest.raises(th.FormatError, match=message) as told:
        th.read_area(tmp_path / "m.tmx")
    assert "\n" not in str(told.value)


def test_what_is_cut_off_is_told(tmp_path):
    whole = json.dumps(map_of(ROWS))
    for length in range(1, len(whole), 7):
        (tmp_path / "m.tmj").write_text(whole[:length])
        with pytest.raises(th.FormatError, match="is no whole JSON"):
            th.read_area(tmp_path / "m.tmj")
