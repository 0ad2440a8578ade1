"""Ways: robots that pass a corner are drawn through it, never across a barrier."""

import numpy as np
import pytest
import shapely

import trihex as th
from tests.strategies import random_scenario
from trihex.areas import TESSELLATIONS
from trihex.kernels.codes import WAIT
from trihex.pictures.movie import PlanFilm
from trihex.pictures.scene import centres_of
from trihex.pictures.ways import places_between, robot_paths
from trihex.plans import plan_from_lists


def cells_of(area, cells):
    return [shapely.Polygon(polygon) for polygon in area.tessellation.polygon_of_cell(*area.cell_to_xy(cells))]


@pytest.mark.parametrize("seed", range(25))
def test_no_path_leads_across_a_barrier(seed):
    plan = th.make_plan(random_scenario(91_000 + seed, sides=(3, 8)), "greedy")
    area = plan.scenario.area
    barriers = shapely.unary_union(cells_of(area, np.flatnonzero(area.barriers)))
    free = shapely.unary_union(cells_of(area, np.flatnonzero(~area.barriers))).buffer(1e-6)
    for path in robot_paths(plan):
        if len(path) > 1:
            line = shapely.LineString(path)
            assert line.intersection(barriers.buffer(-1e-6)).is_empty
            assert free.covers(line)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_every_move_stays_in_its_two_cells_all_the_way(name):
    tessellation = th.Tessellation(name)
    area = th.Area(tessellation, np.zeros((7, 9), dtype=bool))
    for x, y in ((4, 3), (5, 3)):
        here = area.xy_to_cell([x], [y])
        side = int(tessellation.orientation_of_cell(x, y))
        for dx, dy in tessellation.step_of_direction[side].tolist():
            there = area.xy_to_cell([x + dx], [y + dy])
            both = shapely.union_all(cells_of(area, np.concatenate([here, there]))).buffer(1e-9)
            shares = np.linspace(0, 1, 21)
            places = np.array([places_between(area, here, there, share) for share in shares.tolist()])[..., 0]
            assert all(both.covers(shapely.Point(place)) for place in places)
            for share, cell in ((0, here), (1, there)):
                assert np.allclose(places_between(area, here, there, share), centres_of(area, cell))
            lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
            assert np.allclose(lengths, lengths[0])  # as fast before the corner as behind it


def test_paths_bend_at_vertices_alone():
    squares = th.Area("square", np.zeros((3, 3)))
    plan = plan_from_lists(th.Scenario(squares, [(2, 2)], [(0, 0)]), [[5, 5]])
    assert [path.tolist() for path in robot_paths(plan)] == [[[0.5, 0.5], [1.5, 1.5], [2.5, 2.5]]]
    triangles = th.Area("triangular", [[0, 1, 0]])
    plan = plan_from_lists(th.Scenario(triangles, [(2, 0)], [(0, 0)]), [[WAIT, 3]])
    (path,) = robot_paths(plan)
    assert np.allclose(path, [[3**0.5 / 2, 1], [3**0.5, 1.5], [3 * 3**0.5 / 2, 1]])


def test_what_is_no_move_goes_straight():
    area = th.Area("triangular", np.zeros((6, 9)))
    here, there = area.xy_to_cell([0, 4], [0, 3]), area.xy_to_cell([8, 4], [5, 3])  # a jump, and a wait
    x, y = places_between(area, here, there, 0.5)
    (ax, ay), (bx, by) = centres_of(area, here), centres_of(area, there)
    assert np.allclose(x, (ax + bx) / 2) and np.allclose(y, (ay + by) / 2)


def test_movies_glide_through_the_vertex():
    area = th.Area("triangular", [[0, 1, 0]])
    plan = plan_from_lists(th.Scenario(area, [(2, 0)], [(0, 0)]), [[3]])
    film = PlanFilm(plan, 9, None, "", False, False)
    places = [(float(x[0]), float(y[0])) for _, x, y in film._places()]
    assert len(places) == 9
    assert places[4] == pytest.approx((3**0.5, 1.5))
