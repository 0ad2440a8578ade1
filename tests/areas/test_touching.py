"""Touching: what comes to stand in the world makes the cells barriers that a map with it in would have made."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings, strategies as st

import trihex as th
from tests.sweeps import swept
from trihex.areas import NEIGHBOURHOODS, TESSELLATIONS, Covering, Tessellation, cover_polygons, least_cell_size

HALL = shapely.box(0, 0, 9, 6)


@given(
    st.sampled_from(TESSELLATIONS),
    st.sampled_from(NEIGHBOURHOODS),
    st.lists(st.tuples(st.floats(-1, 10), st.floats(-1, 7)), min_size=1, max_size=5),
)
@settings(max_examples=swept(40), deadline=None)
def test_an_obstacle_blocks_what_it_would_block_in_the_map(name, neighbourhood, points):
    tessellation, radius = Tessellation(name, neighbourhood), 0.15
    covering = Covering(tessellation, least_cell_size(tessellation, radius) * 1.1, radius)
    shape = shapely.MultiPoint(points).convex_hull
    bare, filled = cover_polygons(HALL, covering), cover_polygons(HALL, covering, obstacles=shape)
    blocked = bare.barriers.copy()
    blocked.reshape(-1)[bare.cells_touched(shape)] = True
    assert np.array_equal(blocked, filled.barriers)


def test_in_a_turned_area_a_point_a_line_and_a_polygon():
    area = th.Area("hexagonal", np.zeros((30, 40), dtype=bool), frame=th.Frame(0.5, (10.0, 20.0), 0.7, 0.12))
    for points in ([(12, 19)], [(12, 19), (15, 18)], [(12, 19), (15, 18), (14, 15)]):
        shape = {1: shapely.Point, 2: shapely.LineString, 3: shapely.Polygon}[len(points)](
            points if len(points) > 1 else points[0]
        )
        cells = area.cells_touched(points)
        x, y = area.cell_to_metres(np.arange(area.cell_count))
        away = shapely.distance(shape, shapely.points(x, y))
        # The centre is part of the star, and its arms are a quarter of a metre long.
        assert set(np.flatnonzero(away <= 0.12)) <= set(cells.tolist()) <= set(np.flatnonzero(away <= 0.12 + 0.2501))
        assert np.array_equal(cells, area.cells_touched(shape)) and (np.diff(cells) > 0).all()
    assert area.cells_touched((500, 500)).size == 0 and area.cells_touched(shapely.Point()).size == 0


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        ([(0, 0), (2, 2), (2, 0), (0, 2)], "a Polygon is invalid: Self-intersection"),
        ("wall", "a shape must be a geometry of shapely or points"),
        ([], "a shape must be a geometry of shapely or points"),
        ([(0, float("nan"))], "finite coordinates of at most 1e.09 metres"),
        (shapely.Point(1e300, 0), "finite coordinates"),
    ],
)
def test_what_is_no_shape_is_refused(shape, message):
    area = th.Area("square", [[0, 0]], frame=th.Frame(1.0))
    with pytest.raises(th.AreaError, match=message):
        area.cells_touched(shape)
    with pytest.raises(th.AreaError, match="measured in cells, not in metres"):
        th.Area("square", [[0]]).cells_touched([(0, 0)])
