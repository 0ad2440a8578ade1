"""Coverage: barriers against distances drawn with shapely, and moves swept by discs that touch nothing."""

from math import pi

import numpy as np
import pytest
import shapely
from hypothesis import given, settings, strategies as st
from shapely import affinity

import trihex as th
from tests.sweeps import swept
from trihex.areas import NEIGHBOURHOODS, TESSELLATIONS, Covering, Tessellation, cover_polygons, cover_raster
from trihex.areas.clearance import least_cell_size
from trihex.areas.coverage import star_of_cell

KINDS = [(name, neighbourhood) for name in TESSELLATIONS for neighbourhood in NEIGHBOURHOODS]


def drawn_world(occupied, resolution, origin, yaw):
    """Return the occupied squares as one geometry in the world."""
    rows, columns = np.nonzero(occupied)
    boxes = [shapely.box(c, -r - 1, c + 1, -r) for r, c in zip(rows, columns, strict=True)]
    union = affinity.scale(shapely.union_all(boxes), resolution, resolution, origin=(0, 0))
    return affinity.translate(affinity.rotate(union, yaw, origin=(0, 0), use_radians=True), *origin)


def moves_of(area):
    """Yield (cell, neighbour, segment in the world) for all moves within the area, barriers or not."""
    for cell in range(area.cell_count):
        x, y = (int(number) for number in area.cell_to_xy(cell))
        for dx, dy in area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(x, y))]:
            if 0 <= x + dx < area.width and 0 <= y + dy < area.height:
                other = int(area.xy_to_cell(x + dx, y + dy))
                yield cell, other, shapely.LineString(np.transpose(area.cell_to_metres([cell, other])))


@st.composite
def rasters(draw):
    rows, columns = draw(st.integers(4, 60)), draw(st.integers(20, 60))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    return rng.random((rows, columns)) < draw(st.sampled_from([0.0, 0.002, 0.01, 0.1]))


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@given(data=st.data())
@settings(max_examples=swept(12, 3), deadline=None)
def test_a_disc_that_moves_from_free_cell_to_free_cell_touches_nothing_that_is_occupied(name, neighbourhood, data):
    occupied = data.draw(rasters())
    tessellation = Tessellation(name, neighbourhood)
    radius = data.draw(st.sampled_from([0.05, 0.11, 0.2]))
    size = least_cell_size(tessellation, radius) * data.draw(st.sampled_from([1.0, 1.7]))
    origin, yaw = (3.0, -7.0), data.draw(st.sampled_from([0.0, 0.7, pi]))
    area = cover_raster(occupied, Covering(tessellation, size, radius), resolution=0.07, origin=origin, yaw=yaw)
    world = drawn_world(occupied, 0.07, origin, yaw)
    box = drawn_world(np.ones_like(occupied), 0.07, origin, yaw)
    free = ~area.barriers.reshape(-1)
    for cell, other, segment in moves_of(area):
        if free[cell] and free[other]:
            assert world.is_empty or segment.distance(world) > radius
            assert segment.within(box) and segment.distance(box.boundary) > radius


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@given(data=st.data())
@settings(max_examples=swept(8, 3), deadline=None)
def test_a_cell_is_a_barrier_only_if_something_lies_within_the_radius_of_its_star(name, neighbourhood, data):
    occupied = data.draw(rasters())
    size, radius = data.draw(st.sampled_from([(0.4, 0.0), (0.55, 0.03), (0.9, 0.12)]))
    if size < least_cell_size(Tessellation(name, neighbourhood), radius):
        radius = 0.03
    area = cover_raster(
        occupied,
        Covering(Tessellation(name, neighbourhood), size, radius),
        resolution=0.07,
        is_outside_occupied=False,
    )
    world = drawn_world(occupied, 0.07, (0, 0), 0)
    star = star_of_cell(area.tessellation)
    for cell in range(area.cell_count):
        px, py = area.tessellation.centre_of_cell(*area.cell_to_xy(cell))
        arms = star[int(area.tessellation.orientation_of_cell(*area.cell_to_xy(cell)))] + [px, py]
        lines = [[(px * size, -py * size), (x * size, -y * size)] for x, y in arms]
        away = shapely.MultiLineString(lines).distance(world)
        if abs(away - radius) > 1e-7 or np.isnan(away):
            assert area.barriers.reshape(-1)[cell] == (away <= radius)


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
def test_stars_meet_half_way_and_are_all_that_moves_sweep(name, neighbourhood):
    tessellation = Tessellation(name, neighbourhood)
    star = star_of_cell(tessellation)
    for x, y in [(4, 4), (5, 4), (4, 5), (5, 5)]:
        orientation = int(tessellation.orientation_of_cell(x, y))
        centre = np.array(tessellation.centre_of_cell(x, y))
        for k, (dx, dy) in enumerate(tessellation.step_of_direction[orientation]):
            other = np.array(tessellation.centre_of_cell(x + dx, y + dy))
            ends_of_other = other + star[int(tessellation.orientation_of_cell(x + dx, y + dy))]
            middle = centre + star[orientation, k]
            assert np.allclose(middle, (centre + other) / 2)
            assert np.isclose(np.abs(ends_of_other - middle).sum(axis=1), 0).any()


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
def test_polygons_and_a_raster_of_the_same_world_give_the_same_area(name, neighbourhood):
    occupied = np.random.default_rng(5).random((40, 50)) < 0.02
    covering = Covering(Tessellation(name, neighbourhood), 0.5, 0.07)
    raster = cover_raster(occupied, covering, resolution=0.1)
    world = drawn_world(occupied, 0.1, (0, 0), 0)
    box = shapely.box(0, -4, 5, 0)
    assert cover_polygons(box.difference(world), covering) == raster
    assert cover_polygons(box, covering, obstacles=world) == raster
    assert 0 < raster.free_count < raster.cell_count


def test_lines_and_points_are_obstacles_too():
    covering = Covering("square", 1.0, 0.2)
    things = shapely.from_wkt("GEOMETRYCOLLECTION (POINT (2.5 2.5), LINESTRING (4.5 0, 4.5 1.7))")
    area = cover_polygons(shapely.box(0, 0, 6, 4), covering, obstacles=things)
    inner = np.argwhere(area.barriers[1:-1, 1:-1]) + 1
    assert inner[:, ::-1].tolist() == [[2, 1], [4, 2]]


def test_what_lies_outside_the_raster_is_free_only_if_asked_for():
    covering = Covering(Tessellation("square", "edge"), 1.0, 0.1)
    closed = cover_raster(np.zeros((5, 5)), covering, resolution=1.0)
    assert closed.barriers.sum() == 16
    assert cover_raster(np.zeros((5, 5)), covering, resolution=1.0, is_outside_occupied=False).free_count == 25


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_the_cells_with_their_centres_in_the_box_are_covered(name):
    area = cover_raster(np.zeros((30, 70)), Covering(name, 0.9), resolution=0.1, is_outside_occupied=False)
    around = area.frame.cell_size * np.array(area.tessellation.extent(area.height, area.width))
    assert (np.abs(around - (7.0, 3.0)) < (0.9, 1.4)).all()
    x, y = area.cell_to_metres(np.arange(area.cell_count))
    assert x.max() < 7.0 and np.sort(-y)[area.cell_count - area.width] < 3.0


def test_progress_is_told_row_by_row():
    told = []
    cover_raster(
        np.zeros((400, 400)), Covering("hexagonal", 30.0), resolution=1.0, progress=lambda *now: told.append(now)
    )
    assert told[-1] == (told[-1][1], told[-1][1]) and told == sorted(told)


def test_worlds_that_cannot_be_covered_are_refused():
    with pytest.raises(
        th.AreaError,
        match=r"cell_size must be at least 0\.6 metres \(0\.3465 where following is .forbid.\) on hexagonal",
    ):
        Covering("hexagonal", 0.3, 0.15)
    with pytest.raises(th.TooLargeError, match=r"cell_size must be at least 0\.01 metres for a world of 50 by 40"):
        cover_raster(np.zeros((40, 50)), Covering("hexagonal", 0.001), resolution=1.0)
    strip = shapely.box(0, 0, 1e8, 1e-6)  # hardly any area, and yet hundreds of millions of columns
    with pytest.raises(th.TooLargeError, match=r"cell_size must be at least 24 metres for a world of 1e\+08 by 1e-06"):
        cover_polygons(strip, Covering("hexagonal", 0.5))
    with pytest.raises(th.AreaError, match="at least one square"):
        cover_raster(np.zeros((0, 5)), Covering("hexagonal", 1.0), resolution=1.0)
    with pytest.raises(th.AreaError, match="their area is 0"):
        cover_polygons(shapely.from_wkt("POLYGON EMPTY"), Covering("hexagonal", 1.0))
