"""Axial and cube coordinates: the inverse of offsets, and such that neighbours differ by one of six steps."""

import numpy as np
import pytest

import trihex as th
from trihex.areas import axial_to_xy, xy_to_axial

AREA = th.Area("hexagonal", np.zeros((7, 9), dtype=bool))
STEPS = {"N": (0, -1), "NE": (1, -1), "SE": (1, 0), "S": (0, 1), "SW": (-1, 1), "NW": (-1, 0)}


def test_ways_there_and_back():
    cells = np.arange(AREA.cell_count)
    assert np.array_equal(AREA.axial_to_cell(*AREA.cell_to_axial(cells)), cells)
    q, r, s = AREA.cell_to_cube(cells)
    assert not (q + r + s).any()
    assert np.array_equal(AREA.cube_to_cell(q, r, s), cells)
    x, y = np.random.default_rng(1).integers(-1000, 1000, size=(2, 500))
    assert np.array_equal(axial_to_xy(*xy_to_axial(x, y)), [x, y])


def test_each_direction_is_one_step_in_axial_coordinates_whatever_the_column():
    tessellation = AREA.tessellation
    for side in (0, 1):
        q, r = (int(number) for number in xy_to_axial(side, 0))
        for name, (dx, dy) in zip(
            tessellation.direction_names[side], tessellation.step_of_direction[side], strict=True
        ):
            to_q, to_r = xy_to_axial(side + dx, dy)
            assert (int(to_q) - q, int(to_r) - r) == STEPS[name]


def test_cube_distance_is_that_of_the_field_where_nothing_stands():
    n_scheme = th.make_n_scheme(th.Scenario(AREA, (4, 3)))
    cube = np.stack(AREA.cell_to_cube(np.arange(AREA.cell_count)))
    away = np.abs(cube - np.stack(AREA.cell_to_cube((4, 3)))[:, None]).max(axis=0)
    assert np.array_equal(10 * away, n_scheme.distance.reshape(-1))


def test_what_is_no_hexagon_of_the_area_is_refused():
    with pytest.raises(th.TessellationError, match="axial and cube coordinates are of hexagons; the area is square"):
        AREA.with_tessellation("square").cell_to_axial(0)
    with pytest.raises(th.AreaError, match=r"cell \(-1, 0\) lies outside"):
        AREA.axial_to_cell(-1, 1)
    with pytest.raises(th.AreaError, match=r"cube coordinates must have q \+ r \+ s = 0"):
        AREA.cube_to_cell(1, 1, 1)
