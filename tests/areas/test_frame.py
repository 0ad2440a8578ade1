"""Frames: cells to metres and back, by hand and by turning points one by one."""

from math import cos, pi, sin

import numpy as np
import pytest

import trihex as th
from trihex.areas import TESSELLATIONS, Tessellation


def test_y_grows_to_the_north_in_the_world_and_to_the_south_in_cells():
    frame = th.Frame(cell_size=2.0, origin=(100.0, 50.0))
    x, y = frame.centre_of_cell(Tessellation("square"), [0, 1, 0], [0, 0, 1])
    assert x.tolist() == [101.0, 103.0, 101.0]
    assert y.tolist() == [49.0, 49.0, 47.0]


def test_yaw_turns_the_area_anticlockwise_about_its_north_west_corner():
    frame = th.Frame(cell_size=1.0, origin=(10.0, 20.0), yaw=pi / 2)
    assert np.allclose(frame.point_to_metres(3.0, 0.0), (10.0, 23.0))  # its east is the world's north
    assert np.allclose(frame.point_to_metres(0.0, 3.0), (13.0, 20.0))  # its south is the world's east


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize("yaw", [0.0, 0.3, -2.0])
def test_the_cell_at_the_centre_of_a_cell_is_that_cell(name, yaw):
    area = th.Area(name, np.zeros((5, 7)), frame=th.Frame(0.35, (-3.0, 8.0), yaw))
    cells = np.arange(35)
    assert np.array_equal(area.metres_to_cell(*area.cell_to_metres(cells)), cells)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_edge_neighbours_are_one_cell_size_apart(name):
    area = th.Area(name, np.zeros((5, 7)), frame=th.Frame(0.35, (-3.0, 8.0), 1.1))
    x, y = area.cell_to_metres([17, 18])
    assert np.hypot(*np.diff([x, y]).T[0]) == pytest.approx(0.35)


def test_turning_back_gives_the_point():
    frame = th.Frame(0.2, (5.0, -4.0), 0.7)
    px, py = frame.metres_to_point(6.0, -3.0)
    east, north = 0.2 * px, -0.2 * py
    assert 5 + east * cos(0.7) - north * sin(0.7) == pytest.approx(6.0)
    assert -4 + east * sin(0.7) + north * cos(0.7) == pytest.approx(-3.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"cell_size": 0}, "cell_size must be above 0 metres, not 0"),
        ({"cell_size": "wide"}, "cell_size must be a number of at most 1e.09, not 'wide'"),
        ({"cell_size": 10**400}, "cell_size must be a number of at most 1e.09"),
        ({"cell_size": 1, "yaw": float("inf")}, "yaw must be a number of at most 1e.09, not inf"),
        ({"cell_size": 1, "robot_radius": -0.1}, "robot_radius must be at least 0 metres, not -0.1"),
        ({"cell_size": 1, "origin": 3}, "origin must be two numbers, not 3"),
        ({"cell_size": 1, "origin": (0, None)}, "origin must be a number of at most 1e.09, not None"),
    ],
)
def test_frames_that_are_none_are_refused(options, message):
    with pytest.raises(th.AreaError, match=message):
        th.Frame(**options)


@pytest.mark.parametrize("point", [(-0.1, -0.5), (0.5, 0.1), (3.1, -0.5), (1e300, -0.5), (float("nan"), -0.5)])
def test_a_point_outside_is_refused(point):
    area = th.Area("square", [[0, 0, 0]], frame=th.Frame(1.0))
    with pytest.raises(th.AreaError, match="metres lies outside the area"):
        area.metres_to_cell(*point)


def test_an_area_without_frame_has_no_metres():
    with pytest.raises(th.AreaError, match=r"give it a frame \(cell_size\)"):
        th.Area("square", [[0]]).cell_to_metres(0)


def test_the_frame_is_part_of_the_area():
    area = th.Area("triangular", [[0, 1, 0]], frame=th.Frame(1.0))
    assert area == th.Area("triangular", [[0, 1, 0]], frame=th.Frame(1.0))
    assert area != th.Area("triangular", [[0, 1, 0]], frame=th.Frame(2.0))
    assert area != th.Area("triangular", [[0, 1, 0]])


def test_an_area_with_a_frame_keeps_its_shape_and_may_lose_neighbours_only():
    area = th.Area("triangular", [[0, 1, 0]], frame=th.Frame(1.0))
    edge = area.with_tessellation(Tessellation("triangular", "edge"))
    assert edge.frame == area.frame
    with pytest.raises(th.AreaError, match="must stay triangular edge in an area with a frame"):
        edge.with_tessellation("triangular")
    with pytest.raises(th.AreaError, match="read its file again"):
        area.with_tessellation("hexagonal")


@pytest.mark.parametrize("tessellation", ["triangular", "hexagonal"])
def test_a_point_between_the_cells_and_the_wall_is_told_its_nearest_free_cell(tessellation):
    barriers = np.zeros((5, 6), dtype=bool)
    barriers[:, 0] = True
    area = th.Area(tessellation, barriers, frame=th.Frame(2.0, (10.0, 20.0), 0.3))
    cells = np.flatnonzero(~area.barriers.reshape(-1))
    centre_x, centre_y = area.cell_to_metres(cells)
    width, height = area.tessellation.extent(area.height, area.width)
    said = []
    for px, py in np.random.default_rng(5).uniform((-1, -1), (width + 1, height + 1), (200, 2)):
        x, y = (float(number) for number in area.frame.point_to_metres(px, py))
        try:
            area.metres_to_cell(x, y)
        except th.AreaError as error:
            away = np.hypot(centre_x - x, centre_y - y)
            near = int(cells[np.argmin(away)])
            said.append(
                (str(error), f"the nearest free cell is {area.place_of_cell(near)}, {away.min():.3g} metres away")
            )
    assert len(said) > 20 and all(right in text for text, right in said)


def test_the_nearest_free_cell_may_be_far_or_nowhere():
    barriers = np.ones((1, 300), dtype=bool)
    area = th.Area("square", barriers, frame=th.Frame(1.0))
    with pytest.raises(th.AreaError, match=r"lies outside the area: in none of its cells, of which none is free"):
        area.metres_to_cell(1e300, 0)
    with pytest.raises(th.ScenarioError, match=r"is a barrier: something stands there; no cell of the area is free"):
        th.Scenario(area, [(0, 0)])
    barriers[0, 299] = False
    with pytest.raises(th.ScenarioError, match=r"the nearest free cell is \(299, 0\) at \(299\.5, -0\.5\) metres"):
        th.Scenario(th.Area("square", barriers, frame=th.Frame(1.0)), [(0, 0)])
