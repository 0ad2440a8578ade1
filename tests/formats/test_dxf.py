"""DXF: one floor drawn in many styles, layers and their roles, and files that are damaged."""

import json
from contextlib import suppress
from io import StringIO
from itertools import pairwise

import ezdxf
import numpy as np
import pytest
import shapely
from click.testing import CliRunner
from PIL import Image

from trihex import FormatError, read_area, read_scenario
from trihex.cli import main
from trihex.formats import read_draft
from trihex.formats.areas.cad import read_drawing

# Two rooms of 6 by 8 metres, a door between them, an exit of 2 metres in the east; walls 0.2 metres thick.
WALLS = [
    [(12, 3), (12, 0), (0, 0), (0, 8), (12, 8), (12, 5)],
    [(6, 0), (6, 3)],
    [(6, 5), (6, 8)],
]
EXIT = [(12, 3), (12, 5)]
OPTIONS = {"tessellation": "hexagonal", "cell_size": 0.5, "robot_radius": 0.12, "wall_thickness": 0.2}


def scaled(points, scale):
    return [(x * scale, y * scale) for x, y in points]


def new(units=4, version="R2010"):
    document = ezdxf.new(version, units=units)
    return document, document.modelspace(), {4: 1000, 6: 1, 5: 100, 1: 1 / 0.0254, 2: 1 / 0.3048, 0: 1}[units]


def exit_of(space, scale, layer="EXIT"):
    space.add_line(*scaled(EXIT, scale), dxfattribs={"layer": layer})


def lines(space, scale, layer="A-WALL"):
    for wall in WALLS:
        for start, end in pairwise(wall):
            space.add_line(*scaled([start, end], scale), dxfattribs={"layer": layer})


def as_lines():
    document, space, scale = new()
    lines(space, scale)
    exit_of(space, scale)
    return document


def as_polylines():
    document, space, scale = new(6)
    for wall in WALLS:
        space.add_lwpolyline(scaled(wall, scale), dxfattribs={"layer": "a-wall-full"})
    exit_of(space, scale)
    return document


def as_old_polylines():
    document, space, scale = new(6, "R12")
    for wall in WALLS:
        space.add_polyline2d(scaled(wall, scale), dxfattribs={"layer": "WALLS"})
    exit_of(space, scale)
    return document


def as_a_block():
    document, space, scale = new()
    lines(document.blocks.new("FLOOR"), scale, "A-WALL")
    space.add_blockref("FLOOR", (0, 0), dxfattribs={"layer": "REFERENCES"})
    exit_of(space, scale)
    return document


def as_nested_blocks():
    """What a block draws on layer 0 is on the layer of the block, also two blocks deep."""
    document, space, scale = new()
    inner, outer = document.blocks.new("INNER"), document.blocks.new("OUTER")
    lines(inner, scale / 2, "0")
    outer.add_blockref("INNER", (-500, 0), dxfattribs={"layer": "0", "xscale": 2, "yscale": 2})
    space.add_blockref("OUTER", (500, 0), dxfattribs={"layer": "A-WALL"})
    exit_of(space, scale)
    return document


def as_a_mirrored_block():
    document, space, scale = new()
    block = document.blocks.new("HALF")
    for wall in WALLS:
        block.add_lwpolyline([(12 * scale - x, y) for x, y in scaled(wall, scale)], dxfattribs={"layer": "A-WALL"})
    space.add_blockref("HALF", (12 * scale, 0), dxfattribs={"xscale": -1})
    exit_of(space, scale)
    return document


def as_a_turned_block():
    document, space, scale = new()
    block = document.blocks.new("TURNED")
    for wall in WALLS:
        block.add_lwpolyline([(y, -x) for x, y in scaled(wall, scale)], dxfattribs={"layer": "A-WALL"})
    space.add_blockref("TURNED", (0, 0), dxfattribs={"rotation": 90})
    exit_of(space, scale)
    return document


def in_inches():
    document, space, scale = new(1)
    lines(space, scale)
    exit_of(space, scale)
    return document


def as_splines():
    document, space, scale = new()
    for wall in WALLS:
        for start, end in pairwise(wall):
            a, b = (np.array(point) * scale for point in (start, end))
            space.add_spline([(*(a + part * (b - a)), 0) for part in (0, 0.3, 0.6, 1)], dxfattribs={"layer": "A-WALL"})
    exit_of(space, scale)
    return document


def among_noise():
    document = as_lines()
    space = document.modelspace()
    for i in range(30):
        space.add_text(f"Room {i} Ä日", dxfattribs={"layer": "TEXT", "insert": (400 * i, 900)})
    space.add_mtext("A long\nnote", dxfattribs={"layer": "A-WALL", "insert": (0, 0)})
    space.add_circle((3000, 4000), 500, dxfattribs={"layer": "FURNITURE"})
    space.add_arc((6000, 3000), 2000, 0, 90, dxfattribs={"layer": "A-DOOR"})
    space.add_hatch(dxfattribs={"layer": "PATTERN"}).paths.add_polyline_path([(0, 0), (9, 0), (9, 9)])
    space.add_linear_dim((0, 0), (0, 0), (12000, 0)).render()
    space.add_point((3000, 2000), dxfattribs={"layer": "A-WALL"})
    space.add_ray((3000, 2000), (1, 0), dxfattribs={"layer": "A-WALL"})
    return document


def as_unclosed_lines():
    """Corners that miss each other by less than a wall is thick, in pieces, some of no length."""
    document, space, scale = new()
    for wall in WALLS:
        for start, end in pairwise(wall):
            a, b = (np.array(point) * scale for point in (start, end))
            along = (b - a) / np.hypot(*(b - a))
            middle = (a + b) / 2
            space.add_lwpolyline([a + 40 * along, middle], dxfattribs={"layer": "A-WALL"})
            space.add_lwpolyline([middle + 20 * along, b - 40 * along], dxfattribs={"layer": "A-WALL"})
    space.add_lwpolyline([(5, 5), (5, 5)], dxfattribs={"layer": "A-WALL"})
    exit_of(space, scale)
    return document


def as_an_array_of_blocks():
    """The walls between the rooms are one block in two rows."""
    document, space, scale = new()
    space.add_lwpolyline(scaled(WALLS[0], scale), dxfattribs={"layer": "A-WALL"})
    document.blocks.new("PART").add_line((0, 0), (0, 3 * scale), dxfattribs={"layer": "0"})
    attribs = {"layer": "A-WALL", "row_count": 2, "row_spacing": 5 * scale}
    space.add_blockref("PART", (6 * scale, 0), dxfattribs=attribs)
    exit_of(space, scale)
    return document


def as_filled_walls():
    document, space, scale = new()
    for wall in WALLS:
        body = shapely.LineString(wall).buffer(0.1, cap_style="square", join_style="mitre")
        ring = scaled(list(body.exterior.coords)[:-1], scale)
        space.add_hatch(dxfattribs={"layer": "A-WALL"}).paths.add_polyline_path(ring, is_closed=True)
    exit_of(space, scale)
    return document


STYLES = [
    *(as_lines, as_polylines, as_old_polylines, as_a_block, as_nested_blocks, as_a_mirrored_block, as_a_turned_block),
    *(in_inches, as_splines, among_noise, as_unclosed_lines, as_an_array_of_blocks, as_filled_walls),
]


def saved(document, path):
    document.saveas(path)
    return path


def near_walls(area):
    x, y = area.cell_to_metres(np.arange(area.cell_count))
    walls = shapely.MultiLineString([*WALLS, EXIT])
    return shapely.distance(walls, shapely.points(x, y)).reshape(area.barriers.shape) < area.frame.cell_size


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.__name__)
def test_one_floor_in_every_style_is_the_same_area(tmp_path, style):
    first = read_scenario(saved(as_lines(), tmp_path / "first.dxf"), **OPTIONS)
    told = {"unit": "m"} if style is as_old_polylines else {}  # R12 keeps none
    own = read_scenario(saved(style(), tmp_path / "own.dxf"), **OPTIONS, **told)
    assert 300 < first.area.free_count < 360
    if style is as_unclosed_lines or style is as_filled_walls:  # corners are a little wider
        assert np.array_equal(own.area.barriers | near_walls(own.area), first.area.barriers | near_walls(own.area))
        return
    assert np.array_equal(own.area.barriers, first.area.barriers)
    assert own.destinations.tolist() == first.destinations.tolist()


def test_a_binary_file_is_read_as_well(tmp_path):
    document = as_lines()
    document.saveas(tmp_path / "binary.dxf", fmt="bin")
    saved(document, tmp_path / "text.dxf")
    (tmp_path / "no suffix").write_bytes((tmp_path / "binary.dxf").read_bytes())
    areas = [read_area(tmp_path / name, **OPTIONS) for name in ("binary.dxf", "text.dxf", "no suffix")]
    assert all(np.array_equal(area.barriers, areas[0].barriers) for area in areas)


PIXEL = 0.05


def one_floor(folder, degrees):
    """Write the floor, turned about its north-west corner, as DXF, GeoJSON, WKT and image; return what is free."""
    walls = shapely.affinity.rotate(shapely.MultiLineString(WALLS), degrees, (0, 0))
    exit_ = shapely.affinity.rotate(shapely.LineString([(11.9, 3), (11.9, 5)]), degrees, (0, 0))
    hall = shapely.affinity.rotate(shapely.box(0.1, 0.1, 11.9, 7.9), degrees, (0, 0))
    free = hall.difference(walls.buffer(0.1, cap_style="square", join_style="mitre"))
    features = [
        {"type": "Feature", "properties": {"kind": kind}, "geometry": shapely.geometry.mapping(shape)}
        for kind, shape in (("free", free), ("destination", exit_))
    ]
    (folder / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    (folder / "a.wkt").write_text(free.wkt)
    west, south, east, north = free.bounds
    y, x = np.mgrid[0 : round((north - south) / PIXEL), 0 : round((east - west) / PIXEL)]
    shown = shapely.contains_xy(free, west + (x + 0.5) * PIXEL, north - (y + 0.5) * PIXEL)
    Image.fromarray(np.where(shown, 255, 0).astype(np.uint8)).save(folder / "a.png")
    document, space, scale = new()
    for wall in walls.geoms:
        space.add_lwpolyline(scaled(wall.coords, scale), dxfattribs={"layer": "A-WALL"})
    middle = shapely.affinity.rotate(shapely.LineString(EXIT), degrees, (0, 0))
    space.add_line(*scaled(middle.coords, scale), dxfattribs={"layer": "EXIT"})
    saved(document, folder / "a.dxf")
    return free, middle


@pytest.mark.parametrize("degrees", [0, 20, 45])
@pytest.mark.parametrize(
    ("tessellation", "size", "half"), [("hexagonal", 0.5, 0.5), ("square", 0.55, 0.708), ("triangular", 0.75, 1.0)]
)
def test_the_same_floor_as_dxf_geojson_wkt_and_image_differs_by_less_than_a_cell_at_walls(
    tmp_path, tessellation, size, half, degrees
):
    free, exit_ = one_floor(tmp_path, degrees)
    plain = {"tessellation": tessellation, "cell_size": size, "robot_radius": 0.12}
    by_lines = read_area(tmp_path / "a.dxf", **plain, wall_thickness=0.2)
    drawn, written = (read_area(tmp_path / name, **plain) for name in ("a.geojson", "a.wkt"))
    pixels = read_area(tmp_path / "a.png", resolution=PIXEL, **plain)
    assert drawn.free_count > 40
    assert np.array_equal(drawn.barriers, written.barriers)
    corners = drawn.tessellation.polygon_of_cell(*drawn.cell_to_xy(np.arange(drawn.cell_count)))
    cells = shapely.polygons(np.stack(drawn.metres.point_to_metres(corners[..., 0], corners[..., 1]), axis=-1))
    centres = shapely.points(*drawn.cell_to_metres(np.arange(drawn.cell_count)))
    for other, places, error in ((by_lines, exit_, 0.1), (pixels, free.boundary, PIXEL)):
        height, width = (min(lengths) for lengths in zip(other.barriers.shape, drawn.barriers.shape, strict=True))
        assert max(other.height, drawn.height) - height <= 1 and max(other.width, drawn.width) - width <= 1
        is_other = np.ones(drawn.barriers.shape, dtype=bool)  # all outside is a barrier
        is_other[:height, :width] = other.barriers[:height, :width]
        differ = (is_other != drawn.barriers).reshape(-1)
        assert (shapely.distance(cells[differ], places) < size).all()
        # Half way to a neighbour the wall is nearer than the radius in the one, and not in the other.
        assert (shapely.distance(centres[differ], places) < half * size + plain["robot_radius"] + error).all()
        assert differ.sum() <= 0.03 * differ.size
    if degrees == 0:  # where walls end between pixels, all is the same
        assert np.array_equal(pixels.barriers, drawn.barriers)


def test_an_exit_in_the_middle_of_a_wall_and_on_its_face_is_the_same_row_of_cells(tmp_path):
    one_floor(tmp_path, 0)
    plain = {name: value for name, value in OPTIONS.items() if name != "wall_thickness"}
    one, other = (read_scenario(tmp_path / name, **own) for name, own in (("a.dxf", OPTIONS), ("a.geojson", plain)))
    ends = [np.stack(own.area.cell_to_metres(own.destinations), axis=-1) for own in (one, other)]
    away = np.linalg.norm(ends[0][:, None] - ends[1], axis=-1)
    assert max(away.min(axis=0).max(), away.min(axis=1).max()) <= 1.01 * OPTIONS["cell_size"]


@pytest.mark.parametrize("size", [1e8, 1e30])
def test_curves_that_are_too_large_take_no_time_and_are_told(tmp_path, size):
    """Chords a centimetre from a curve of 1e30 metres took gigabytes; 1e8 metres are a place still."""
    document, space, scale = new(6)
    lines(space, scale)
    exit_of(space, scale)
    space.add_circle((0, 0), size, dxfattribs={"layer": "A-WALL"})
    space.add_ellipse((0, 0), (size, 0), 0.5, dxfattribs={"layer": "A-WALL"})
    space.add_open_spline([(0, 0, 0), (size, 0, size), (size, size, 0), (0, size, 0)], dxfattribs={"layer": "A-WALL"})
    drawing = read_drawing(saved(document, tmp_path / "a.dxf").read_bytes(), "a.dxf")
    kinds = {kind for _, kind in drawing.unknown}
    assert kinds == (set() if size == 1e8 else {f"{kind} without a length" for kind in ("CIRCLE", "ELLIPSE", "SPLINE")})
    assert sum(len(piece.points) for piece in drawing.pieces["A-WALL"]) < 20_000


def test_rooms_and_named_exits_come_from_their_layers(tmp_path):
    document, space, scale = new()
    lines(space, scale, "PEN 1")
    space.add_lwpolyline(scaled([(0, 0), (6, 0), (6, 8), (0, 8)], scale), close=True, dxfattribs={"layer": "FLAECHE"})
    space.add_lwpolyline(scaled([(1, 1), (2, 1)], scale), dxfattribs={"layer": "FLAECHE"})
    space.add_lwpolyline(scaled([(0, 3), (0, 5), (0.2, 5), (0.2, 3)], scale), close=True, dxfattribs={"layer": "AUS"})
    space.add_text("west  gate", dxfattribs={"layer": "AUS", "insert": (-900, 4000)})
    options = {**OPTIONS, "walls": "pen *, none", "rooms": "Flaeche", "exits": "AUS"}
    draft = read_draft(saved(document, tmp_path / "a.dxf"), **options)
    x, _ = draft.area.cell_to_metres(np.flatnonzero(~draft.area.barriers))
    assert x.max() < 6 and x.min() > 0 and 120 < x.size < 200
    assert [zone.name for zone in draft.area.zones] == ["west gate"] and draft.destinations.size >= 3
    assert draft.notes == (
        "took walls from PEN 1; exits from AUS; rooms from FLAECHE",
        "not understood: 1 lines of rooms that do not close",
    )
    (tmp_path / "s.toml").write_text(
        '[area]\npath = "a.dxf"\ncell_size = 0.5\nrobot_radius = 0.12\nwall_thickness = 0.2\n'
        'walls = "pen *"\nrooms = "Flaeche"\nexits = "AUS"\n'
    )
    assert read_scenario(tmp_path / "s.toml").area.free_count == draft.area.free_count


def test_layers_are_listed_with_what_is_not_understood(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    saved(among_noise(), tmp_path / "plan.dxf")
    result = CliRunner().invoke(main, ["show", "plan.dxf", "--layers"])
    rows = {line.split("  ")[0]: line for line in result.stdout.splitlines()}
    assert result.exit_code == 0
    assert " walls " in rows["A-WALL"] and rows["A-WALL"].endswith("1 POINT, 1 RAY") and " exits " in rows["EXIT"]
    assert rows["TEXT"].split()[1:5] == ["-", "0", "0", "30"]
    result = CliRunner().invoke(main, ["show", "plan.dxf", "--cell-size", "0.5"])
    assert result.exit_code == 0
    assert "not understood: 1 POINT on A-WALL, 1 RAY on A-WALL" in result.stderr
    (tmp_path / "a.wkt").write_text("POLYGON ((0 0, 9 0, 9 6, 0 0))")
    result = CliRunner().invoke(main, ["show", "a.wkt", "--layers"])
    assert result.exit_code == 2 and "--layers lists those of a DXF file, which a.wkt is not" in result.stderr


def bomb():
    document, _space, _ = new()
    document.blocks.new("B0").add_line((0, 0), (1, 1))
    for level in range(1, 15):
        block = document.blocks.new(f"B{level}")
        for _ in range(10):
            block.add_blockref(f"B{level - 1}", (0, 0))
    document.modelspace().add_blockref("B14", (0, 0))
    return document


def loop():
    document, space, _ = new()
    for one, other in ("AB", "BA"):
        document.blocks.new(one).add_blockref(other, (0, 0))
    space.add_blockref("A", (0, 0))
    return document


def array_bomb():
    document, space, _ = new()
    document.blocks.new("B").add_line((0, 0), (1, 1))
    space.add_blockref(
        "B", (0, 0), dxfattribs={"row_count": 30000, "column_count": 30000, "row_spacing": 1, "column_spacing": 1}
    )
    return document


def without_unit():
    document, space, scale = new(0)
    lines(space, scale)
    exit_of(space, scale)
    return document


def with_a_gap():
    document, space, scale = new()
    lines(space, scale)
    return document


@pytest.mark.parametrize(
    ("make", "options", "message"),
    [
        (without_unit, {}, r"names no unit of length; say which it is, one of m, cm, .* \(--unit\)"),
        (without_unit, {"unit": "yards"}, "unit must be one of m, cm, .*, not 'yards'"),
        (with_a_gap, {}, "walls enclose no place: exits close openings"),
        (as_lines, {"walls": "WAND*"}, r"walls must be on layers of the file, A-WALL, EXIT; not 'WAND.*'"),
        (as_lines, {"wall_thickness": -1}, "wall_thickness must be between 0 and 1000 metres, not -1"),
        (bomb, {}, "may draw at most 200000 entities, those of blocks counted each time that they are used, not 2111"),
        (array_bomb, {}, "may draw at most 200000 entities, .* not 900000001"),
        (loop, {}, "is nested too deeply"),
    ],
)
def test_what_is_refused(tmp_path, make, options, message):
    with pytest.raises(FormatError, match=message):
        read_area(saved(make(), tmp_path / "a.dxf"), **{**OPTIONS, **options})


def test_a_unit_may_be_told(tmp_path):
    area = read_area(saved(without_unit(), tmp_path / "a.dxf"), unit="m", **OPTIONS)
    assert np.array_equal(area.barriers, read_area(saved(as_lines(), tmp_path / "b.dxf"), **OPTIONS).barriers)


def test_a_file_cut_short_is_refused_in_one_line(tmp_path):
    stream = StringIO()
    as_lines().write(stream)
    text = stream.getvalue()
    for part in (0.01, 0.1, 0.3, 0.5):
        (tmp_path / "a.dxf").write_text(text[: int(part * len(text))])
        with pytest.raises(FormatError) as caught:
            read_area(tmp_path / "a.dxf", **OPTIONS)
        assert "\n" not in str(caught.value)
    for part in (0.9, 0.97):  # what is whole is recovered
        (tmp_path / "a.dxf").write_text(text[: int(part * len(text))])
        with suppress(FormatError):
            read_area(tmp_path / "a.dxf", **OPTIONS)


def test_text_nowhere_and_exits_without_end_do_no_harm(tmp_path):
    """Found by fuzzing."""
    document = as_lines()
    space = document.modelspace()
    space.add_text("far", dxfattribs={"layer": "EXIT", "insert": (1e300, 0)})
    space.add_line((12000, 3000), (12000, -9e11), dxfattribs={"layer": "EXIT"})
    with suppress(FormatError):
        read_area(saved(document, tmp_path / "a.dxf"), **OPTIONS)
    for x in ("nan", "1e300"):
        text = (tmp_path / "a.dxf").read_text().replace("1e+300", x)
        (tmp_path / "b.dxf").write_text(text)
        with suppress(FormatError):
            read_area(tmp_path / "b.dxf", **OPTIONS)
