"""GeoJSON and WKT: places drawn by hand, with exits and robots, and drawings that are none."""

import json

import numpy as np
import pytest
import shapely

from trihex import (
    AreaError,
    FormatError,
    TooLargeError,
    make_plan,
    read_area,
    read_plan,
    read_scenario,
    write_plan,
    write_scenario,
)
from trihex.formats import read_draft

HALL = [[[0, 0], [10, 0], [10, 6], [0, 6], [0, 0]], [[4, 2], [6, 2], [6, 4], [4, 4], [4, 2]]]
SQUARES = {"tessellation": "square", "cell_size": 1.0, "robot_radius": 0.2}


def feature(kind, type_, coordinates):
    properties = {} if kind is None else {"kind": kind}
    return {"type": "Feature", "properties": properties, "geometry": {"type": type_, "coordinates": coordinates}}


def write(path, *features):
    path.write_text(json.dumps({"type": "FeatureCollection", "features": list(features)}))
    return path


def rows(area):
    return ["".join(".B"[barrier] for barrier in row) for row in area.barriers.astype(int)]


PICTURE = [
    "BBBBBBBBBB",
    "B...BB...B",  # the pillar blocks the cells that touch it, too
    "B..BBBB..B",
    "B..BBBB..B",
    "B...BB...B",
    "BBBBBBBBBB",
]


def drawn(tmp_path):
    area = read_area(write(tmp_path / "hall.geojson", feature(None, "Polygon", HALL)), **SQUARES)
    return rows(area)


def test_a_hall_with_a_pillar(tmp_path):
    picture = drawn(tmp_path)
    for y, x in np.ndindex(6, 10):
        near = 3 <= x <= 6 and 1 <= y <= 4
        wall = x in (0, 9) or y in (0, 5)
        if not near:
            assert picture[y][x] == ".B"[wall]
    assert all(picture[y][x] == "B" for y in (2, 3) for x in (4, 5))
    area = read_area(tmp_path / "hall.geojson", **SQUARES)
    assert area.frame.origin == (0.0, 6.0) and area.name == "hall"


def test_geojson_and_wkt_draw_the_same_hall_however_it_is_put(tmp_path):
    picture = drawn(tmp_path)
    hall = feature("free", "Polygon", HALL[:1])
    wall = [hall, feature("obstacle", "Polygon", HALL[1:])]
    spots = [[x / 10, y / 10] for x in range(40, 61) for y in range(20, 41)]
    spots = [hall, feature("obstacle", "MultiPoint", spots)]
    for features in (wall, spots):
        assert rows(read_area(write(tmp_path / "a.geojson", *features), **SQUARES)) == picture
    (tmp_path / "b.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": HALL}))
    assert rows(read_area(tmp_path / "b.geojson", **SQUARES)) == picture
    collection = {"type": "GeometryCollection", "geometries": [{"type": "Polygon", "coordinates": HALL}]}
    (tmp_path / "b.json").write_text(json.dumps(feature(None, "Point", 0) | {"geometry": collection}))
    assert rows(read_area(tmp_path / "b.json", **SQUARES)) == picture
    for text in (
        shapely.Polygon(HALL[0], HALL[1:]).wkt,
        f"GEOMETRYCOLLECTION ({shapely.Polygon(HALL[0], HALL[1:]).wkt}, GEOMETRYCOLLECTION EMPTY)",
        f"geometrycollection z ({shapely.Polygon([(*p, 5) for p in HALL[0]], [[(*p, 5) for p in HALL[1]]]).wkt})",
        shapely.MultiPolygon([(HALL[0], HALL[1:])]).wkt,
    ):
        (tmp_path / "hall.wkt").write_text(text)
        assert rows(read_area(tmp_path / "hall.wkt", **SQUARES)) == picture


def test_lines_and_points_of_wkt_are_obstacles(tmp_path):
    (tmp_path / "a").write_text("GEOMETRYCOLLECTION (POLYGON ((0 0, 6 0, 6 5, 0 5, 0 0)), LINESTRING (2.5 0, 2.5 5))")
    assert rows(read_area(tmp_path / "a", **SQUARES)) == ["BBBBBB", *["B.B..B"] * 3, "BBBBBB"]


def test_destinations_and_robots_are_drawn_too(tmp_path):
    path = write(
        tmp_path / "hall.geojson",
        feature(None, "Polygon", HALL),
        feature("destination", "LineString", [[1.2, 1.5], [2.8, 1.5]]),
        feature("destination", "Point", [8.5, 4.5]),
        feature("robot", "MultiPoint", [[1.1, 4.9], [8.9, 1.1]]),
        feature("robot", "Point", [2.5, 4.5]),
    )
    scenario = read_scenario(path, **SQUARES)
    assert scenario.destinations.tolist() == scenario.area.xy_to_cell([1, 2, 8], [4, 4, 1]).tolist()
    assert scenario.robots.tolist() == scenario.area.xy_to_cell([1, 8, 2], [1, 4, 1]).tolist()
    assert scenario.destination_capacity == 1
    assert read_draft(write(path, feature(None, "Polygon", HALL)), **SQUARES).robots is None


def test_an_exit_is_the_free_cells_that_its_polygon_touches(tmp_path):
    door = [[[8.2, 1.2], [8.8, 1.2], [8.8, 3.2], [8.2, 3.2], [8.2, 1.2]]]
    path = write(tmp_path / "a.json", feature(None, "Polygon", HALL), feature("destination", "Polygon", door))
    area = read_draft(path, **SQUARES).area
    assert read_draft(path, **SQUARES).destinations.tolist() == area.xy_to_cell([8, 8, 8], [2, 3, 4]).tolist()


OPEN = [[[0, 0], [1, 0], [1, 1]]]
BOW = [[[0, 0], [2, 2], [2, 0], [0, 2], [0, 0]]]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", "is no JSON"),
        ("{" * 5, "is no JSON"),
        ('{"a":' * 100_000, "is nested too deeply"),
        ('{"type": "Polygon", "coordinates": ' + "[" * 900 + "]" * 900 + "}", "coordinates must be finite numbers"),
        ({"type": "FeatureCollection", "features": 3}, "features must be a list, not int"),
        ({"type": "FeatureCollection", "features": []}, "there must be a polygon that is free"),
        ({"type": "FeatureCollection", "features": [3]}, "feature 0: must be an object, not 3"),
        ({"type": "Polygn", "coordinates": HALL}, "feature 0: type must be one of .*; did you mean 'Polygon'"),
        ({"type": "Feature", "geometry": [], "properties": None}, r"a geometry must be an object, not \[\]"),
        ({"type": "Polygon"}, "is no Polygon: coordinates must be finite numbers"),
        ({"type": "Polygon", "coordinates": OPEN}, "is no Polygon: a ring must end where it begins"),
        ({"type": "Polygon", "coordinates": [[[0, 0], ["a", 0], [1, 1]]]}, "coordinates must be finite numbers"),
        ({"type": "Polygon", "coordinates": [[[0, 0], [float("nan"), 0]]]}, "coordinates must be finite numbers"),
        ({"type": "Polygon", "coordinates": [[[0, 0], [1e300, 0], [1, 1], [0, 0]]]}, "at most 1e.09 metres"),
        ({"type": "Polygon", "coordinates": BOW}, r"a Polygon is invalid: Self-intersection\[1 1\]"),
        (feature("exit", "Polygon", HALL), "feature 0: kind must be one of free, obstacle, destination, robot"),
        (feature("robt", "Polygon", HALL), "did you mean 'robot'"),
        (feature(None, "Point", [1, 1]), "a Point must have the property kind"),
        (feature("free", "LineString", [[1, 1], [2, 2]]), "what is 'free' must be a polygon, not a LineString"),
        (feature("robot", "Polygon", HALL), "what is 'robot' must be a point, not a Polygon"),
    ],
)  # fmt: skip
def test_geojson_that_is_none_is_refused(tmp_path, content, message):
    (tmp_path / "a.geojson").write_text(content if isinstance(content, str) else json.dumps(content))
    with pytest.raises((FormatError, TooLargeError), match=message):
        read_area(tmp_path / "a.geojson", **SQUARES)


def test_what_lies_outside_the_hall_is_refused(tmp_path):
    hall = feature(None, "Polygon", HALL)
    path = write(tmp_path / "a.json", hall, feature("robot", "Point", [30, 1]))
    with pytest.raises(FormatError, match=r"a robot: point \(30, 1\) metres lies outside the area"):
        read_draft(path, **SQUARES)
    write(path, hall, feature("destination", "LineString", [[4.8, 3], [5.2, 3]]))
    with pytest.raises(FormatError, match=r"a destination between \(4.8, 3\) and \(5.2, 3\) metres touches no free"):
        read_draft(path, **SQUARES)
    with pytest.raises(FormatError, match="a place drawn by polygons is measured in metres"):
        read_draft(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("POLYGON ((0 0, 1 1", "is no WKT: Expected word but encountered end of stream"),
        ("POLYGON ((0 0, 1 1, 2 2, 0 0))", "a Polygon is invalid|none with an area"),
        ("POLYGON ((0 0, nan 1, 1 1, 0 0))", "coordinates must be finite numbers"),
        ("POLYGON ((0 0, 1e999 1, 1 1, 0 0))", "coordinates must be finite numbers"),
        ("CURVEPOLYGON (CIRCULARSTRING (0 0, 4 0, 4 4, 0 4, 0 0))", "is no WKT: Nonlinear geometry types"),
        ("GEOMETRYCOLLECTION (" * 100_000, "is nested too deeply"),
        ("POINT (1 1)", "there must be a polygon that is free"),
        ("GEOMETRYCOLLECTION EMPTY", "there must be a polygon that is free"),
        ("POLYGON ((0 0, 1 1\0", "there is a zero byte in it"),
    ],
)  # fmt: skip
def test_wkt_that_is_none_is_refused(tmp_path, text, message):
    (tmp_path / "a.wkt").write_text(text)
    with pytest.raises(FormatError, match=message):
        read_area(tmp_path / "a.wkt", **SQUARES)


TOUCHING = [[[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]], [[[4, 0], [8, 0], [8, 4], [4, 4], [4, 0]]]]
OVERLAPPING = [TOUCHING[0], [[[3, 0], [8, 0], [8, 4], [3, 4], [3, 0]]]]


@pytest.mark.parametrize("parts", [TOUCHING, OVERLAPPING])
def test_parts_of_a_multipolygon_may_touch_and_overlap_as_in_wkt(tmp_path, parts):
    path = write(tmp_path / "parts.geojson", feature(None, "MultiPolygon", parts))
    (tmp_path / "parts.wkt").write_text(shapely.MultiPolygon([shapely.Polygon(part[0]) for part in parts]).wkt)
    area = read_area(path, **SQUARES)
    assert rows(area) == rows(read_area(tmp_path / "parts.wkt", **SQUARES))
    assert rows(area) == ["BBBBBBBB", "B......B", "B......B", "BBBBBBBB"]


def test_what_is_wrong_has_the_number_of_its_feature_and_part(tmp_path):
    hall, bow = feature(None, "Polygon", HALL), [[[0, 0], [2, 2], [2, 0], [0, 2], [0, 0]]]
    for wrong, message in {
        "feature 1: a Polygon is invalid: Self-intersection": feature("obstacle", "Polygon", bow),
        "feature 1: part 1: a Polygon is invalid": feature("free", "MultiPolygon", [HALL[:1], bow]),
        r"feature 1: a robot: point \(40, 1\) metres lies outside": feature("robot", "Point", [40, 1]),
        r"feature 1: part 1: a robot: point \(40, 1\)": feature("robot", "MultiPoint", [[2, 3], [40, 1]]),
        r"feature 1: a destination: point \(40, 1\)": feature("destination", "Point", [40, 1]),
        r"feature 1: a destination between \(20, 1\) and": feature("destination", "LineString", [[20, 1], [20, 2]]),
        "feature 1: coordinates must be finite": feature("obstacle", "Point", [1e10, 1]),
    }.items():
        with pytest.raises(FormatError, match=wrong):
            read_area(write(tmp_path / "a.geojson", hall, message), **SQUARES)


@pytest.mark.parametrize("kind", ["destination", "robot"])
@pytest.mark.parametrize(
    ("type_", "coordinates"), [("Point", []), ("MultiPoint", []), ("MultiPolygon", []), ("LineString", []), (None, 0)]
)
def test_a_destination_or_robot_without_coordinates_does_not_vanish(tmp_path, kind, type_, coordinates):
    nothing = feature(kind, type_, coordinates)
    if type_ is None:
        nothing["geometry"] = None
    with pytest.raises(FormatError, match=rf"feature 1: (a {kind} must have coordinates; it has none|what is 'robot')"):
        read_draft(write(tmp_path / "a.geojson", feature(None, "Polygon", HALL), nothing), **SQUARES)


def test_empty_obstacles_and_places_do_no_harm(tmp_path):
    features = [feature(None, "Polygon", HALL), feature("obstacle", "Point", []), feature(None, "MultiPolygon", [])]
    assert rows(read_area(write(tmp_path / "a.geojson", *features), **SQUARES)) == drawn(tmp_path)


@pytest.mark.parametrize("size", [0.01, 0.4])
def test_a_place_in_degrees_or_kilometres_is_told(tmp_path, size):
    corner = [[[13.4, 52.5], [13.4 + size, 52.5], [13.4 + size, 52.5 + size], [13.4, 52.5]]]
    with pytest.raises(FormatError, match=r"must be larger than a cell of 1 metres, .*not degrees or kilometres"):
        read_area(write(tmp_path / "a.geojson", feature(None, "Polygon", corner)), **SQUARES)


HALL_ONLY = [[0, 0], [10, 0], [10, 6], [0, 6], [0, 0]]
ON_THE_EAST_WALL = {
    "a line on it": ("LineString", [[10, 1.2], [10, 3.2]]),
    "a strip in it": ("Polygon", [[[10, 1.2], [10.2, 1.2], [10.2, 3.2], [10, 3.2], [10, 1.2]]]),
    "a strip before it": ("Polygon", [[[9.8, 1.2], [10, 1.2], [10, 3.2], [9.8, 3.2], [9.8, 1.2]]]),
    "a line beyond it": ("LineString", [[10.3, 1.2], [10.3, 3.2]]),
}


@pytest.mark.parametrize("radius", [0.0, 0.12])
@pytest.mark.parametrize("tessellation", ["square", "hexagonal", "triangular"])
@pytest.mark.parametrize("drawn", ON_THE_EAST_WALL)
def test_an_exit_on_a_wall_is_the_row_of_free_cells_that_leads_through_it(tmp_path, drawn, tessellation, radius):
    path = write(
        tmp_path / "a.geojson", feature(None, "Polygon", [HALL_ONLY]), feature("destination", *ON_THE_EAST_WALL[drawn])
    )
    step = {"square": 0.55, "hexagonal": 0.5, "triangular": 0.75}[tessellation]
    draft = read_draft(path, tessellation, cell_size=step, robot_radius=radius)
    area, exits = draft.area, set(draft.destinations.tolist())
    x, y = area.cell_to_metres(sorted(exits))
    # They lie side by side, as many as there is room for, and nothing free lies between them and the wall.
    assert (y > 1.2 - step / 2).all() and (y < 3.2 + step / 2).all()
    pitch = 1.5 * step if tessellation == "triangular" else step
    assert 2 / pitch - 1 <= len(exits) <= 2 / pitch + 2
    free = np.flatnonzero(~area.barriers)
    free_x, free_y = area.cell_to_metres(free)
    for cell, east, north in zip(sorted(exits), x, y, strict=True):
        beyond = set(free[(abs(free_y - north) < step / 4) & (free_x > east + step / 4)].tolist())
        assert beyond <= exits, area.name_of_cell(cell)


def test_an_exit_on_a_wall_along_columns_of_hexagons_is_as_wide_as_drawn(tmp_path):
    """Every other column begins half a cell deeper: it leads through all the same."""
    exit_ = feature("destination", "LineString", [[3, 6], [6, 6]])
    path = write(tmp_path / "a.geojson", feature(None, "Polygon", [HALL_ONLY]), exit_)
    draft = read_draft(path, "hexagonal", cell_size=0.5, robot_radius=0.12)
    x = draft.destinations % draft.area.width
    assert sorted(x.tolist()) == list(range(x.min(), x.max() + 1)) and 6 <= x.size <= 7


def test_an_exit_leads_into_the_room_that_it_is_drawn_in(tmp_path):
    """The cells of the room beside it, behind a wall, may be as near."""
    wall = feature("obstacle", "LineString", [[5, 6], [5, 1]])
    exit_ = feature("destination", "LineString", [[5.05, 6], [5.25, 6]])
    path = write(tmp_path / "a.geojson", feature(None, "Polygon", [HALL_ONLY]), wall, exit_)
    for step in (0.81, 0.87, 0.9, 0.95, 1.0):
        draft = read_draft(path, "hexagonal", cell_size=step, robot_radius=0.2)
        assert (draft.area.cell_to_metres(draft.destinations)[0] > 5).all()


def test_an_exit_deep_in_a_wall_is_told_where_the_nearest_free_cell_is(tmp_path):
    exit_ = feature("destination", "LineString", [[10.7, 2.2], [10.7, 2.8]])
    path = write(tmp_path / "a.geojson", feature(None, "Polygon", HALL), exit_)
    with pytest.raises(
        FormatError, match=r"none leads through it; the nearest is \(8, 3\) at \(8\.5, 2\.5\) metres, its c"
    ):
        read_draft(path, **SQUARES)
    exit_ = feature("destination", "Polygon", [[[8.5, 2.2], [10, 2.2], [10, 2.8], [8.5, 2.8], [8.5, 2.2]]])
    draft = read_draft(write(path, feature(None, "Polygon", HALL), exit_), **SQUARES)
    assert [draft.area.name_of_cell(cell) for cell in draft.destinations] == ["(8, 3)"]


def named(kind, type_, coordinates, name):
    return feature(kind, type_, coordinates) | {"properties": {"kind": kind, "name": name}}


def test_names_of_exits_are_kept_and_survive_files(tmp_path):
    features = [
        feature(None, "Polygon", HALL),
        named("destination", "LineString", [[10, 1.2], [10, 2.8]], 'east "door" 日'),
        named("destination", "Point", [1.5, 1.5], 7),
        named("destination", "Point", [1.5, 2.5], "7"),
        named("destination", "Point", [2.5, 4.5], None),
    ]
    scenario = read_scenario(write(tmp_path / "a.geojson", *features), **SQUARES)
    area = scenario.area
    zones = {zone.name: [area.name_of_cell(cell) for cell in zone.cells.tolist()] for zone in area.zones}
    assert zones == {'east "door" 日': ["(8, 3)", "(8, 4)"], "7": ["(1, 3)", "(1, 4)"]}
    assert area.cells_of_zone("7").tolist() == [31, 41] and scenario.destinations.size == 5
    write_scenario(scenario, tmp_path / "s.toml")
    assert read_scenario(tmp_path / "s.toml").area.zones == area.zones
    write_plan(make_plan(scenario), tmp_path / "p.npz")
    assert read_plan(tmp_path / "p.npz").scenario.area.zones == area.zones
    with pytest.raises(
        AreaError, match=r"zone must be one of east \"door\" 日, 7, not 'east dor'; did you mean 'east \"d"
    ):
        area.cells_of_zone("east dor")


@pytest.mark.parametrize("name", ["a\nb", " ", 1.5, ["a"], "x" * 201])
def test_names_that_are_no_line_of_text_are_refused(tmp_path, name):
    path = write(
        tmp_path / "a.geojson", feature(None, "Polygon", HALL), named("destination", "Point", [1.5, 1.5], name)
    )
    with pytest.raises(FormatError, match="feature 1: name of a zone must be a line of 1 to 200 characters, not"):
        read_draft(path, **SQUARES)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("POLYGON (0 0, 9 0, 9 6, 0 0)", r"a POLYGON has two brackets: POLYGON \(\(0 0,"),
        ("MULTIPOLYGON ((0 0, 9 0, 9 6, 0 0))", "a MULTIPOLYGON has three brackets"),
        ("MULTIPOLYGON Z (0 0 1, 9 0 1, 9 6 1, 0 0 1)", "a MULTIPOLYGON has three brackets"),
        ("LINESTRING ((0 0, 9 0))", "a LINESTRING has one bracket"),
        ("POLYGON ((0 0, 9 0, 9 6, 0 0))\nPOLYGON ((0 0, 9 0, 9 6, 0 0))", "several are one GEOMETRYCOLLECTION"),
    ],
)
def test_wkt_with_too_few_or_many_brackets_is_told_how_many(tmp_path, text, hint):
    (tmp_path / "a.wkt").write_text(text)
    with pytest.raises(FormatError, match=f"is no WKT: .*; {hint}"):
        read_area(tmp_path / "a.wkt", **SQUARES)


@pytest.mark.parametrize("name", ["a.wkt", "a"])
def test_the_srid_of_postgis_is_skipped(tmp_path, name):
    (tmp_path / name).write_text(f"srid = 25832 ;\n{shapely.Polygon(HALL[0], HALL[1:]).wkt}")
    assert rows(read_area(tmp_path / name, **SQUARES)) == drawn(tmp_path)
