import itertools
import re
import xml.etree.ElementTree as ET
from io import BytesIO

import numpy as np
import pytest
import shapely
from PIL import Image

import trihex as th
from trihex.areas import TESSELLATIONS, Area, Frame, RasterGround, Scenario, Tessellation
from trihex.errors import FormatError, TooLargeError
from trihex.fields import make_d_scheme, make_n_scheme
from trihex.kernels.codes import WAIT
from trihex.pictures import (
    palette,
    picture_of_area,
    picture_of_d_scheme,
    picture_of_generation,
    picture_of_n_scheme,
    picture_of_plan,
)
from trihex.pictures.png import paint
from trihex.pictures.scene import Bar, Discs, Key, Lines, Ramp, Scene, Texts, centres_of, colour_rows
from trihex.pictures.sheet import RAMP_WIDTH, TEXT_SIZE, arrange, width_of
from trihex.plans import plan_from_lists

SVG = "{http://www.w3.org/2000/svg}"


def distinct_scene(tessellation: str, height: int, width: int, scale: float) -> Scene:
    """A scene in which every cell has a colour of its own: red is its number."""
    area = Area(tessellation, np.zeros((height, width)))
    cells = np.arange(height * width, dtype=np.uint8).reshape(height, width)
    return Scene(area, cells, colour_rows([(cell, 0, 200) for cell in range(height * width)]), scale)


def centre_pixel(scene: Scene, picture: np.ndarray, x: int, y: int, top: int = 0, left: int = 0) -> tuple:
    cx, cy = scene.area.tessellation.centre_of_cell(x, y)
    return tuple(picture[top + int(cy * scene.scale), left + int(cx * scene.scale)].tolist())


def edge_distance(tessellation: Tessellation, px: float, py: float) -> float:
    """How far a point is from the outline of its cell, by the lines through the drawn corners."""
    corners = tessellation.polygon_of_cell(*tessellation.cell_at_point(px, py))
    away = []
    for one, other in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = (other - one) / np.linalg.norm(other - one)
        away.append(abs(along[0] * (py - one[1]) - along[1] * (px - one[0])))
    return min(away)


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize(("height", "width", "scale"), [(9, 11, 23.7), (11, 9, 3.3), (1, 40, 5.0), (40, 1, 5.0)])
def test_a_pixel_has_the_colour_of_the_cell_in_which_it_lies(name, height, width, scale):
    scene = distinct_scene(name, height, width, scale)
    picture = paint(scene)
    tessellation = scene.area.tessellation
    across, down = tessellation.extent(height, width)
    assert picture.shape == (round(down * scale), round(across * scale), 3)
    rng, tested = np.random.default_rng(1), 0
    for _ in range(400):
        i, j = int(rng.integers(picture.shape[0])), int(rng.integers(picture.shape[1]))
        px, py = (j + 0.5) / scale, (i + 0.5) / scale
        if edge_distance(tessellation, px, py) * scale < 1.2:
            continue
        x, y = (int(index) for index in tessellation.cell_at_point(px, py))
        inside = 0 <= x < width and 0 <= y < height
        assert tuple(picture[i, j]) == ((y * width + x, 0, 200) if inside else palette.PAGE)
        tested += 1
    assert tested > (150 if scale > 10 else 20)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_outlines_run_along_drawn_polygons(name):
    scene = distinct_scene(name, 6, 7, 40.0)
    picture = paint(scene).astype(int)
    corners = scene.area.tessellation.polygon_of_cell(3, 3)
    for one, other in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        px, py = (one + other) / 2 * scene.scale
        assert picture[int(py), int(px), 2] < 190  # darker than the blue of all cells
    assert centre_pixel(scene, picture, 3, 3) == (24, 0, 200)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_north_is_up_and_west_is_left(name):
    barriers = np.zeros((8, 8), dtype=bool)
    barriers[0, 0] = barriers[1, 5] = True
    picture = picture_of_area(Area(name, barriers), width=400, title="", legend=False)
    image = picture.to_array()
    for y, x in np.ndindex(8, 8):
        expected = palette.BARRIER if barriers[y, x] else palette.FREE
        assert centre_pixel(picture.scene, image, x, y) == expected


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_thin_walls_outlive_small_pictures(name):
    barriers = np.zeros((600, 600), dtype=bool)
    barriers[300, :] = barriers[:, 200] = True
    image = picture_of_area(Area(name, barriers), width=100, title="", legend=False).to_array().astype(int)
    height = image.shape[0]
    # Every column meets the horizontal wall, every row the vertical one, in a tone between both colours.
    assert (image[height // 3 : 2 * height // 3, 5:-5, 0].min(axis=0) < palette.FREE[0] - 60).all()
    assert (image[5:-5, 25:45, 0].min(axis=1) < palette.FREE[0] - 60).all()
    assert (image[5 : height // 3, 45:-3, 0] == palette.FREE[0]).all()


def small_scenario(name: str, **rules) -> Scenario:
    barriers = np.zeros((5, 6), dtype=bool)
    barriers[1, 2] = barriers[2, 2] = barriers[3, 4] = True
    return Scenario(Area(name, barriers, "small"), [(5, 4)], [(0, 0), (3, 1), (1, 4)], **rules)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_n_scheme_shows_all_numbers_where_they_fit(name):
    n_scheme = make_n_scheme(small_scenario(name))
    picture = picture_of_n_scheme(n_scheme)
    shown = {}
    for mark in picture.scene.marks:
        assert isinstance(mark, Texts)
        for x, y, word in zip(mark.x, mark.y, mark.words, strict=True):
            shown[tuple(int(i) for i in n_scheme.scenario.area.tessellation.cell_at_point(x, y))] = word
    free = np.argwhere(~n_scheme.scenario.area.barriers)
    assert shown == {(x, y): str(n_scheme.distance[y, x]) for y, x in free.tolist()}
    words = re.findall(r"<text[^>]*>([^<]*)</text>", picture.to_svg())
    assert sorted(words)[:3] == sorted([*shown.values(), "0"])[:3]
    # In cells too small for them there are none, but the destination is still marked.
    assert all(isinstance(mark, Discs) for mark in picture_of_n_scheme(n_scheme, width=40).scene.marks)


def test_farther_cells_are_darker():
    scenario = Scenario(Area("square", np.zeros((1, 12)), "corridor"), [(0, 0)])
    n_scheme = make_n_scheme(scenario)
    scene = picture_of_n_scheme(n_scheme, width=240).scene
    light = scene.colours[scene.colour_of_cell[0, 1:]].astype(int) @ [299, 587, 114]
    assert (np.diff(light) < 0).all()
    ramp = next(entry for entry in scene.legend if isinstance(entry, Ramp))
    assert (ramp.low, ramp.high) == ("0", "110")
    assert ramp.colours[-1] == tuple(scene.colours[scene.colour_of_cell[0, -1]].tolist())


def test_generations_show_what_is_not_reached_yet():
    from trihex.fields import distance_generations

    scenario = small_scenario("hexagonal")
    n_scheme = make_n_scheme(scenario)
    generations = list(distance_generations(scenario))
    first = picture_of_generation(scenario, generations[0], 0, far=70)
    assert sum(len(mark.words) for mark in first.scene.marks) == 1  # only the 0 of the destination
    assert Key("cell", palette.UNREACHED, "not reached") in first.scene.legend
    last = picture_of_generation(scenario, generations[-1], len(generations) - 1)
    assert last.scene.title == f"Generation {len(generations) - 1} of small"
    assert np.array_equal(last.to_array()[80:], picture_of_n_scheme(n_scheme).to_array()[80:])


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_d_scheme_has_an_arrow_along_each_best_move(name):
    d_scheme = make_d_scheme(make_n_scheme(small_scenario(name)))
    area = d_scheme.n_scheme.scenario.area
    lines = [mark for mark in picture_of_d_scheme(d_scheme).scene.marks if isinstance(mark, Lines)]
    assert len(lines) == 1
    ends = set()
    for arrow in lines[0].paths:
        x, y = (int(index) for index in area.tessellation.cell_at_point(*arrow[0]))
        assert area.tessellation.cell_at_point(*arrow[1]) == (x, y)  # arrows stay in their cell
        way = (arrow[1] - arrow[0]) / np.linalg.norm(arrow[1] - arrow[0])
        orientation = int(area.tessellation.orientation_of_cell(x, y))
        fits = []
        for k, (dx, dy) in enumerate(area.tessellation.step_of_direction[orientation].tolist()):
            here = area.tessellation.centre_of_cell(x, y)
            there = area.tessellation.centre_of_cell(x + dx, y + dy)
            target = np.subtract(there, here) / np.linalg.norm(np.subtract(there, here))
            fits += [k] if np.allclose(way, target) else []
        assert len(fits) == 1
        ends.add((x, y, fits[0]))
    bits = d_scheme.directions
    assert ends == {
        (x, y, k) for y, x in np.ndindex(bits.shape) for k in range(12) if bits[y, x] >> k & 1
    }  # fmt: skip
    assert len(lines[0].paths) == len(ends)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_arrows_of_a_cell_are_apart(name):
    """On triangles they may be but 30 degrees apart; neither heads nor shafts may touch."""
    scenario = Scenario(Area(name, np.zeros((9, 15))), [(7, 4)])
    picture = picture_of_d_scheme(make_d_scheme(make_n_scheme(scenario)))
    (lines,) = [mark for mark in picture.scene.marks if isinstance(mark, Lines)]
    arrows = {}
    for arrow in lines.paths:
        arrows.setdefault(tuple(map(int, scenario.area.tessellation.cell_at_point(*arrow[0]))), []).append(arrow)
    assert max(map(len, arrows.values())) > 1
    shapes = {cell: [shapely.LineString(arrow) for arrow in own] for cell, own in arrows.items()}
    width = lines.width / picture.scene.scale
    for own in shapes.values():
        for one, other in itertools.combinations(own, 2):
            assert one.distance(other) > width


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_small_cells_take_the_colour_of_their_direction(name):
    area = Area(name, np.zeros((41, 41)))
    scene = picture_of_d_scheme(make_d_scheme(make_n_scheme(Scenario(area, [(20, 20)]))), width=200).scene
    wheel = palette.compass_ramp(240).astype(int)
    for x, y, compass in ((20, 40, 0), (0, 20, 60), (20, 0, 120), (40, 20, 180)):
        colour = scene.colours[scene.colour_of_cell[y, x]].astype(int)
        nearest = int(np.abs(wheel - colour).sum(axis=1).argmin())
        assert abs((nearest - compass + 120) % 240 - 120) <= 20
    names = [entry.words for entry in scene.legend[:8]]
    assert names == ["N", "NE", "E", "SE", "S", "SW", "W", "NW"]


def test_opposite_ties_still_have_a_colour():
    area = Area("square", np.zeros((1, 3)))
    scene = picture_of_d_scheme(make_d_scheme(make_n_scheme(Scenario(area, [(0, 0), (2, 0)]))), width=20).scene
    wheel = palette.compass_ramp(240)
    assert scene.colour_of_cell[0, 1] == 60  # between two destinations: the first of its directions, east
    assert tuple(scene.colours[60]) == tuple(wheel[60])


def corridor_plan():
    """Three robots in a corridor; the last is walled in."""
    barriers = np.zeros((2, 7), dtype=bool)
    barriers[1], barriers[0, 5] = True, True
    area = Area("square", barriers, "corridor")
    scenario = Scenario(area, [(0, 0)], [(2, 0), (4, 0), (6, 0)])
    west = area.tessellation.direction_names[0].index("W")
    return plan_from_lists(scenario, [[west, west], [WAIT, west, west, west, west], []], planner="hand")


def test_plan_of_few_robots_shows_paths_letters_and_who_is_stranded():
    plan = corridor_plan()
    scene = picture_of_plan(plan).scene
    lines = [mark for mark in scene.marks if isinstance(mark, Lines)]
    lengths = [np.abs(np.diff(line.paths[0], axis=0)).sum() for line in lines]
    assert np.allclose(lengths, [2, 4, 0])
    letters = [mark.words[0] for mark in scene.marks if isinstance(mark, Texts)]
    assert sorted(letters) == ["D", "a", "b", "c"]
    assert Key("disc", palette.STRANDED, "never arrives") in scene.legend
    assert scene.subtitle == "square, 7 x 2 cells, 2 of 3 robots arrive, 5 steps, total time 70"
    image = picture_of_plan(plan, width=700, title="", legend=False).to_array()
    assert tuple(image[50 - 30, 650]) == palette.STRANDED
    assert tuple(image[50, 150]) != palette.FREE  # a path
    assert tuple(image[10, 150]) == palette.FREE


def test_plan_of_many_robots_shows_how_often_cells_are_visited():
    plan = corridor_plan()
    scene = picture_of_plan(plan, paths=False).scene
    assert not any(isinstance(mark, Lines) for mark in scene.marks)
    # Visited once: 3, 4 and 6; twice: 1 and 2.
    once, twice = scene.colours[0], scene.colours[239]
    assert [tuple(colour) for colour in scene.colours[scene.colour_of_cell[0, [3, 4, 6]]]] == [tuple(once)] * 3
    assert [tuple(colour) for colour in scene.colours[scene.colour_of_cell[0, [1, 2]]]] == [tuple(twice)] * 2
    assert tuple(scene.colours[scene.colour_of_cell[1, 0]]) == palette.BARRIER


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_svg_has_a_polygon_for_each_cell(name):
    scenario = small_scenario(name)
    root = ET.fromstring(picture_of_area(scenario).to_svg())
    fills = {}
    for path in root.iter(f"{SVG}path"):
        fills[path.get("fill")] = path.get("d").count("z")
    assert sum(fills.values()) == 30
    assert fills["#{:02x}{:02x}{:02x}".format(*palette.BARRIER)] == 3
    assert len(list(root.iter(f"{SVG}circle"))) == 3 + 1  # robots, and one in the legend
    words = [text.text for text in root.iter(f"{SVG}text")]
    assert words == ["D", "a", "b", "c", "small", f"{name}, 6 x 5 cells, 3 robots", "barrier", "destination", "robot"]


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_svg_polygons_are_those_of_the_tessellation(name):
    scene = distinct_scene(name, 4, 5, 31.0)
    from trihex.pictures.svg import UNITS, svg_of

    for path in ET.fromstring(svg_of(scene)).iter(f"{SVG}path"):
        cell = int(path.get("fill")[1:3], 16)
        start, way = re.fullmatch(r"M(-?\d+ -?\d+)l([-\d ]+)z", path.get("d")).groups()
        steps = np.array([int(number) for number in re.findall(r"-?\d+", way)]).reshape(-1, 2)
        corners = np.array(start.split(), dtype=int) + np.vstack([[0, 0], np.cumsum(steps, axis=0)])
        expected = scene.area.tessellation.polygon_of_cell(cell % 5, cell // 5) * scene.scale * UNITS
        assert np.abs(corners - expected).max() <= 2  # a tenth of a pixel


def test_large_areas_are_embedded_in_svg():
    scenario = Scenario(Area("hexagonal", np.zeros((300, 300))), [(150, 150)])
    svg = picture_of_n_scheme(make_n_scheme(scenario)).to_svg()
    assert len(svg) < 3_000_000
    root = ET.fromstring(svg)
    assert len(list(root.iter(f"{SVG}image"))) == 1
    assert not list(root.iter(f"{SVG}path"))


def test_titles_are_escaped_and_wrapped():
    area = Area("square", np.zeros((2, 2)), "<b>&" + "long " * 40 + "x" * 300)
    picture = picture_of_area(area)
    assert picture.to_array().shape[1] == 300
    root = ET.fromstring(picture.to_svg())
    assert next(root.iter(f"{SVG}text")).text.startswith("<b>&long long")


def test_the_page_of_a_narrow_corridor_is_as_wide_as_its_legend():
    """Robots a square metre, with colours and numbers, need more than the 300 pixels that a page has at least."""
    area = Area("hexagonal", np.zeros((60, 2)), frame=Frame(0.5))
    plan = th.make_plan(Scenario(area, [(0, 0)], [(1, 40), (0, 50)]), "greedy")
    picture = th.picture_of_density(plan, width=60)
    sheet = arrange(picture.scene)
    ((left, _, ramp),) = sheet.ramps
    assert ramp.words == "robots a square metre"
    assert 300 < left + RAMP_WIDTH + width_of(ramp.high, TEXT_SIZE) < sheet.width
    page = picture.to_array()
    assert page.shape[1] == sheet.width and (page[:, -14:] == palette.PAGE).all()


def test_saved_png_is_what_was_painted(tmp_path):
    picture = picture_of_area(small_scenario("triangular"))
    picture.save(tmp_path / "small.PNG")
    with Image.open(tmp_path / "small.PNG") as image:
        assert np.array_equal(np.array(image.convert("RGB")), picture.to_array())
    rich = picture_of_n_scheme(make_n_scheme(Scenario(Area("hexagonal", np.zeros((60, 60))), [(3, 3)])))
    rich.save(tmp_path / "rich.png")
    with Image.open(tmp_path / "rich.png") as image:
        assert np.array_equal(np.array(image.convert("RGB")), rich.to_array())
    with Image.open(BytesIO(rich._repr_png_())) as image:
        assert image.size == rich.to_array().shape[1::-1]


def test_few_colours_make_a_palette_image(tmp_path):
    picture_of_area(Area("square", [[0, 1], [0, 0]]), title="", legend=False).save(tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as image:
        assert image.mode == "P"


def test_unknown_suffix_names_the_choices_and_leaves_nothing(tmp_path):
    picture = picture_of_area(small_scenario("square"))
    with pytest.raises(FormatError, match=r"must be one of \.png, \.svg, \.pdf, not '\.pgn'; did you mean '\.png'"):
        picture.save(tmp_path / "small.pgn")
    with pytest.raises(FileNotFoundError):
        picture.save(tmp_path / "no" / "small.png")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("width", [7, -1, 3.5, "wide", True])
def test_width_must_be_a_whole_number_of_pixels(width):
    with pytest.raises(FormatError, match="width of a picture must be a whole number of at least 8 pixels"):
        picture_of_area(small_scenario("square"), width=width)


def test_giant_pictures_are_refused():
    with pytest.raises(TooLargeError, match="at most"):
        picture_of_area(small_scenario("square"), width=20_000)


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize("shape", [(1, 1), (1, 3000), (3000, 1)])
def test_areas_of_any_shape_have_pictures(name, shape):
    scenario = Scenario(Area(name, np.zeros(shape)), [(0, 0)])
    n_scheme = make_n_scheme(scenario)
    for picture in (
        picture_of_area(scenario),
        picture_of_n_scheme(n_scheme),
        picture_of_d_scheme(make_d_scheme(n_scheme)),
        picture_of_plan(plan_from_lists(scenario, [])),
    ):
        image = picture.to_array()
        assert 100 < image.shape[1] < 1700
        assert image.shape[0] < 1800
        ET.fromstring(picture.to_svg())


MACHADO = {  # how colours look to people without one kind of cones, Machado et al. (2009), on linear light
    "trichromacy": np.eye(3),
    "deuteranopia": np.array([[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]]),
    "protanopia": np.array([[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]]),
    "tritanopia": np.array([[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]]),
}


def lab_seen(colour: tuple, sight: str) -> np.ndarray:
    """CIELAB of a colour as seen; a distance of 2 is just noticed side by side."""
    light = np.clip(MACHADO[sight] @ (np.array(colour) / 255) ** 2.2, 0, 1)
    rows = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    x, y, z = np.cbrt(np.array(rows) @ light / [0.9505, 1.0, 1.089])
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("sight", MACHADO)
def test_colours_of_things_are_told_apart_by_all_eyes(sight):
    names = ("FREE", "BARRIER", "DESTINATION", "MOVING", "WAITING", "FINAL", "STRANDED")
    things = [lab_seen(getattr(palette, name), sight) for name in names]
    for number, one in enumerate(things):
        for other in things[:number]:
            assert np.linalg.norm(one - other) > 15


@pytest.mark.parametrize("sight", MACHADO)
@pytest.mark.parametrize("ramp", [palette.distance_ramp, palette.visits_ramp])
def test_ramps_grow_darker_all_the_way(ramp, sight):
    lightness = [lab_seen(colour, sight)[0] for colour in ramp(40)]
    assert (np.diff(lightness) < -0.4).all()


@pytest.mark.parametrize("tessellation", ["triangular", "hexagonal", "square"])
def test_a_place_in_a_large_nowhere_is_cropped_and_shows_the_same(tessellation):
    barriers = np.ones((40, 50), dtype=bool)
    barriers[9:20, 13:30] = th.make_random_area(tessellation, 11, 17, density=0.1, seed=2).barriers
    area = th.Area(tessellation, barriers, "yard", th.Frame(0.5, (3.0, 8.0), 0.4))
    free = np.flatnonzero(~area.barriers)
    plan = th.make_plan(th.Scenario(area, free[:1], th.random_robots(area, 40, 3, avoid=free[:1])), "greedy")
    ground = RasterGround(np.random.default_rng(1).random((160, 200)) < 0.3, 0.25, (3.0, 8.0), 0.4)
    part = th.picture_of_plan(plan, title="", legend=False, ground=ground, crop=True).scene
    left, top = 10, 6  # two cells beside what is free, and even
    assert part.colour_of_cell.shape == (20 + 2 - top, 30 + 2 - left)
    whole = th.picture_of_plan(plan, title="", legend=False, ground=ground).scene
    corner, shifted = (np.array(area.tessellation.centre_of_cell(*cell)) for cell in ((0, 0), (left, top)))
    y, x = np.mgrid[: part.area.height, : part.area.width]
    px, py = area.tessellation.centre_of_cell(x, y)
    dx, dy = shifted - corner
    np.testing.assert_allclose([px + dx, py + dy], area.tessellation.centre_of_cell(x + left, y + top))
    np.testing.assert_array_equal(
        part.colours[part.colour_of_cell], whole.colours[whole.colour_of_cell][y + top, x + left]
    )
    np.testing.assert_allclose(
        part.area.frame.point_to_metres(px, py), area.frame.point_to_metres(px + dx, py + dy), atol=1e-9
    )
    discs = ([m for m in scene.marks if isinstance(m, Discs) and m.x.size == 40] for scene in (part, whole))
    for one, other in zip(*discs, strict=True):
        np.testing.assert_allclose([one.x + dx, one.y + dy], [other.x, other.y])
    assert "of 50 x 40" in th.picture_of_plan(plan, crop=True).scene.subtitle
    full = th.make_plan(th.Scenario(th.Area(tessellation, np.zeros((9, 9))), [(0, 0)], [(5, 5)]), "greedy")
    assert th.picture_of_plan(full, crop=True).to_svg() == th.picture_of_plan(full).to_svg()


def test_starts_are_left_out_where_they_would_hide_all_else():
    area = th.Area("hexagonal", np.zeros((100, 100), dtype=bool))
    crowd = th.make_plan(th.Scenario(area, [(50, 50)], th.random_robots(area, 3000, avoid=[(50, 50)])), "greedy")
    shown = {width: "start" in str(th.picture_of_plan(crowd, width=width).scene.legend) for width in (100, 2000)}
    assert shown == {100: False, 2000: True}


def bars_of(picture: th.Picture) -> list[Bar]:
    return [entry for entry in picture.scene.legend if isinstance(entry, Bar)]


def in_the_world(name: str, cell_size: float = 0.5) -> Scenario:
    scenario = small_scenario(name)
    area = Area(name, scenario.area.barriers, "hall", th.Frame(cell_size, origin=(3.0, 4.0), yaw=0.3))
    return Scenario(area, scenario.destinations, scenario.robots)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_pictures_of_places_in_the_world_have_a_scale(name):
    scenario = in_the_world(name)
    n_scheme = make_n_scheme(scenario)
    for picture in (
        picture_of_area(scenario.area, width=300),
        picture_of_n_scheme(n_scheme, width=300),
        picture_of_d_scheme(make_d_scheme(n_scheme), width=300),
        picture_of_plan(plan_from_lists(scenario, [[], [], []]), width=300),
        th.picture_of_run(th.Trial(scenario).run(), width=300),
    ):
        (bar,) = bars_of(picture)
        metres, unit = bar.words.split()
        assert unit == "m"
        assert bar.length * 0.5 == float(metres)
        long = round(bar.length * picture.scene.scale)
        assert 48 <= long <= 120
        ((x, y, _),) = arrange(picture.scene).bars
        row = (picture.to_array()[round(y), round(x) - 3 : round(x) + long + 3] == palette.INK).all(axis=1)
        assert row.tolist() == [False] * 3 + [True] * long + [False] * 3
        assert f"h{long}m" in picture.to_svg()
    assert not bars_of(picture_of_area(scenario, legend=False))
    assert not bars_of(picture_of_area(small_scenario(name)))


@pytest.mark.parametrize(
    ("cell_size", "words"),
    [(0.001, "0.002 m"), (0.05, "0.1 m"), (0.5, "1 m"), (1.0, "2 m"), (2.5, "5 m"), (480.0, "1 km"), (1e9, "2e+06 km")],
)
def test_scales_are_round_lengths_that_fit(cell_size, words):
    area = Area("square", np.zeros((4, 6)), "", th.Frame(cell_size))
    (bar,) = bars_of(picture_of_area(area, width=300))
    assert bar.words == words
    (tiny,) = bars_of(picture_of_area(area, width=20))
    assert tiny.length * 20 / 6 <= 24


def test_a_part_of_a_place_in_the_world_keeps_its_scale():
    barriers = np.ones((40, 50), dtype=bool)
    barriers[9:20, 13:30] = False
    area = Area("hexagonal", barriers, "yard", th.Frame(0.5, origin=(-3.0, 8.0), yaw=0.4))
    plan = th.make_plan(Scenario(area, [(20, 12)], [(14, 10)]), "greedy")
    picture = picture_of_plan(plan, width=400, crop=True)
    part = picture.scene.area
    assert part.height < 20
    assert bars_of(picture)[0].length * 0.5 == 2
    here, there = (one.cell_to_metres(cell) for one, cell in ((part, 0), (area, 6 * 50 + 10)))
    np.testing.assert_allclose(here, there)


def test_paths_do_not_hide_where_they_end():
    """Ten robots come from all sides; the colour of the destination is still seen around its letter."""
    area = Area("hexagonal", np.zeros((11, 11)))
    ring = [(x, y) for x in (0, 10) for y in (0, 5, 10)] + [(5, 0), (5, 10), (3, 0), (7, 10)]
    plan = th.make_plan(Scenario(area, [(5, 5)], ring), "greedy")
    picture = picture_of_plan(plan, width=440, title="", legend=False)
    x, y = (float(at) * picture.scene.scale for at in area.tessellation.centre_of_cell(5, 5))
    turn = np.linspace(0, 2 * np.pi, 60)
    radius = 0.36 * picture.scene.scale
    around = picture.to_array()[(y + radius * np.sin(turn)).astype(int), (x + radius * np.cos(turn)).astype(int)]
    assert (around == palette.DESTINATION).all()


@pytest.mark.parametrize(("width", "is_named"), [(400, True), (160, False)])
def test_robots_that_never_arrive_are_named(width, is_named):
    barriers = np.zeros((20, 20), dtype=bool)
    barriers[:, 10] = True
    area = Area("hexagonal", barriers)
    robots = [(x, y) for y in range(0, 20, 2) for x in (2, 5, 8)] + [(15, 3), (16, 9)]
    scenario = Scenario(area, [(0, 0)], robots[1:])
    plan = th.make_plan(scenario, "greedy")
    stranded = np.flatnonzero(~plan.arrived)
    assert stranded.tolist() == [29, 30]
    marks = picture_of_plan(plan, width=width).scene.marks
    texts = [mark for mark in marks if isinstance(mark, Texts)]
    assert [mark.words for mark in texts if "D" not in mark.words] == ([("29", "30")] if is_named else [])
    if is_named:
        x, y = centres_of(area, scenario.robots[stranded])
        np.testing.assert_allclose([texts[-1].x, texts[-1].y], [x, y])


def test_robots_that_never_arrive_have_their_letter_or_their_number():
    plan = corridor_plan()
    words = {
        width: [mark.words for mark in picture_of_plan(plan, width=width).scene.marks if isinstance(mark, Texts)]
        for width in (700, 100)
    }
    assert words == {700: [("D",), ("a",), ("b",), ("c",)], 100: [("2",)]}
