"""Tables of the tessellations against drawn polygons, and the names and costs of the paper."""

import itertools

import numpy as np
import pytest
import shapely

import trihex as th
from trihex.areas import COSTS, NEIGHBOURHOODS, TESSELLATIONS

HEIGHT, WIDTH = 5, 7
ALL = [
    th.Tessellation(name, neighbourhood, costs)
    for name, neighbourhood, costs in itertools.product(TESSELLATIONS, NEIGHBOURHOODS, COSTS)
]
IDS = ["-".join((t.name, t.neighbourhood, t.costs)) for t in ALL]


def drawn_cells(tessellation):
    y, x = np.divmod(np.arange(HEIGHT * WIDTH), WIDTH)
    return [shapely.Polygon(corners) for corners in tessellation.polygon_of_cell(x, y)]


def neighbours_of(tessellation, x, y):
    """(x, y) -> cost, from the tables."""
    o = int(tessellation.orientation_of_cell(x, y))
    steps = tessellation.step_of_direction[o]
    return {
        (x + int(dx), y + int(dy)): int(c) for (dx, dy), c in zip(steps, tessellation.cost_of_direction, strict=True)
    }


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
def test_neighbours_are_those_whose_drawn_polygons_touch(tessellation):
    polygons = drawn_cells(tessellation)
    wide = [p.buffer(1e-7) for p in polygons]
    for one, other in itertools.permutations(range(len(polygons)), 2):
        shared = wide[one].intersection(wide[other])
        # Two grown polygons that share an edge overlap along it; two that share a corner in a speck.
        length = max(np.ptp(shared.envelope.exterior.xy, axis=1)) if not shared.is_empty else 0.0
        expected = None
        if length > 0.1:
            expected = tessellation.edge_cost
        elif length > 0 and tessellation.neighbourhood == "full":
            distance = polygons[one].centroid.distance(polygons[other].centroid)
            expected = 14 if tessellation.costs == "paper" else round(1000 * distance)
        table = neighbours_of(tessellation, one % WIDTH, one // WIDTH)
        assert table.get((other % WIDTH, other // WIDTH)) == expected


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
def test_cells_cover_the_plane_once(tessellation):
    polygons = drawn_cells(tessellation)
    union = shapely.union_all(polygons)
    assert union.area == pytest.approx(sum(p.area for p in polygons))
    width, height = tessellation.extent(HEIGHT, WIDTH)
    assert union.bounds == pytest.approx((0, 0, width, height))


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
def test_cell_at_point_is_the_polygon_that_contains_it(tessellation):
    polygons = drawn_cells(tessellation)
    points = np.random.default_rng(1).random((1000, 2)) * 1.2 * np.array(tessellation.extent(HEIGHT, WIDTH)) - 0.3
    x, y = tessellation.cell_at_point(points[:, 0], points[:, 1])
    for point, cx, cy in zip(points, x, y, strict=True):
        drawn = [i for i, p in enumerate(polygons) if p.contains(shapely.Point(point))]
        inside = 0 <= cx < WIDTH and 0 <= cy < HEIGHT
        assert drawn == ([cy * WIDTH + cx] if inside else [])


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
def test_cell_at_point_inverts_centre_of_cell_also_west_and_north_of_the_area(tessellation):
    y, x = np.mgrid[-6:7, -6:7]
    back_x, back_y = tessellation.cell_at_point(*tessellation.centre_of_cell(x, y))
    assert np.array_equal(back_x, x)
    assert np.array_equal(back_y, y)


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
def test_every_move_has_a_way_back_at_the_same_cost(tessellation):
    for x, y in itertools.product(range(4, 6), range(4, 6)):
        for (to_x, to_y), cost in neighbours_of(tessellation, x, y).items():
            assert neighbours_of(tessellation, to_x, to_y)[x, y] == cost


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
def test_direction_names_say_where_the_neighbour_lies(tessellation):
    for orientation in (0, 1):
        names = tessellation.direction_names[orientation]
        assert len(set(names)) == tessellation.direction_count
        x, y = (4 + orientation, 4)
        cx, cy = tessellation.centre_of_cell(x, y)
        for name, (dx, dy) in zip(names, tessellation.step_of_direction[orientation], strict=True):
            to_x, to_y = tessellation.centre_of_cell(x + dx, y + dy)
            east, south = round(float(to_x - cx), 9), round(float(to_y - cy), 9)
            assert ("E" in name, "W" in name) == (east > 0, east < 0)
            if name not in ("E", "W", "EE", "WW"):  # the two orientations of a row of triangles lie at two heights
                assert ("S" in name, "N" in name) == (south > 0, south < 0)


def test_the_table_of_the_reading_for_a_triangle_that_points_north():
    rows = {
        "NW": (-1, -1, 14), "N": (0, -1, 14), "NE": (1, -1, 14),
        "WW": (-2, 0, 14), "W": (-1, 0, 10), "E": (1, 0, 10), "EE": (2, 0, 14),
        "SSW": (-2, 1, 14), "SW": (-1, 1, 14), "S": (0, 1, 10), "SE": (1, 1, 14), "SSE": (2, 1, 14),
    }  # fmt: skip
    t = th.Tessellation("triangular")
    table = {
        name: (int(dx), int(dy), int(cost))
        for name, (dx, dy), cost in zip(t.direction_names[0], t.step_of_direction[0], t.cost_of_direction, strict=True)
    }
    assert table == rows
    mirrored = {name.translate(str.maketrans("NS", "SN")): (dx, -dy, cost) for name, (dx, dy, cost) in rows.items()}
    south = {
        name: (int(dx), int(dy), int(cost))
        for name, (dx, dy), cost in zip(t.direction_names[1], t.step_of_direction[1], t.cost_of_direction, strict=True)
    }
    assert south == mirrored


def test_the_paper_s_list_for_a_hexagon_of_an_odd_column():
    steps = th.Tessellation("hexagonal").step_of_direction[1].tolist()
    assert sorted(map(tuple, steps)) == sorted([(0, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0)])


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
def test_a_vertex_move_passes_the_corner_that_both_polygons_share_and_each_corner_has_one_number(tessellation):
    area = th.Area(tessellation, np.zeros((HEIGHT, WIDTH), bool))
    layout = area.layout
    corner_of_number, number_of_corner = {}, {}
    for y, x in itertools.product(range(HEIGHT), range(WIDTH)):
        site = layout.origin + y * layout.pitch + x
        corners = {tuple(np.round(c, 6)) for c in tessellation.polygon_of_cell(x, y)}
        orientation = int(tessellation.orientation_of_cell(x, y))
        for k in range(tessellation.edge_count, tessellation.direction_count):
            dx, dy = tessellation.step_of_direction[orientation, k]
            shared = corners & {tuple(np.round(c, 6)) for c in tessellation.polygon_of_cell(x + dx, y + dy)}
            number = site + int(layout.vertex_of_direction[site & 1, k])
            assert 0 <= number < layout.size
            (corner,) = shared
            assert corner_of_number.setdefault(number, corner) == corner
            assert number_of_corner.setdefault(corner, number) == number


@pytest.mark.parametrize("tessellation", ALL, ids=IDS)
@pytest.mark.parametrize("width", [1, 2, 5, 6])
def test_no_step_leads_across_the_margin_into_another_row(tessellation, width):
    area = th.Area(tessellation, np.zeros((4, width), bool))
    layout = area.layout
    sites = {layout.origin + y * layout.pitch + x: (x, y) for y in range(4) for x in range(width)}
    for site, (x, y) in sites.items():
        if tessellation.name != "square":
            assert site & 1 == tessellation.orientation_of_cell(x, y)
        for k in range(tessellation.direction_count):
            target = site + int(layout.offset_of_direction[site & 1, k])
            assert 0 <= target < layout.size
            dx, dy = tessellation.step_of_direction[site & 1, k]
            inside = 0 <= x + dx < width and 0 <= y + dy < 4
            assert sites.get(target) == ((x + dx, y + dy) if inside else None)


def test_layout_turns_cells_into_sites_and_back():
    layout = th.Area("triangular", np.zeros((3, 4), bool)).layout
    cells = np.arange(12)
    assert np.array_equal(layout.site_to_cell(layout.cell_to_site(cells)), cells)
    padded = np.arange(layout.size)
    assert np.array_equal(layout.cells_of(padded).reshape(-1), layout.cell_to_site(cells))


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_views_of_a_layout_are_written_to_and_between_them_hold_all_rows(name):
    layout = th.Area(name, np.zeros((3, 4), bool)).layout
    padded = np.zeros(layout.size, dtype=np.int64)
    layout.view_of(padded)[:] = np.arange(12).reshape(3, 4) + 1
    layout.margin_of(padded)[:] = -1
    assert padded[layout.cell_to_site(np.arange(12))].tolist() == list(range(1, 13))
    assert not padded[: layout.origin].any()
    assert not padded[layout.origin + 3 * layout.pitch :].any()
    assert np.count_nonzero(padded) == 3 * layout.pitch
    with pytest.raises(ValueError, match="read-only"):
        layout.cells_of(padded)[0, 0] = 1


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (
            ("hexagon",),
            "tessellation must be one of triangular, hexagonal, square, not 'hexagon'; did you mean 'hexagonal'",
        ),
        (("square", "edges"), "neighbourhood must be one of full, edge, not 'edges'; did you mean 'edge'"),
        (("square", "full", 3), "costs must be one of paper, euclidean, not 3"),
    ],
)
def test_an_unknown_name_is_refused_with_the_near_one(names, message):
    with pytest.raises(th.TessellationError, match=message):
        th.Tessellation(*names)
