"""Ways: the first best direction as number, next cell and vector, beside the names of the directions."""

import numpy as np
import pytest

import trihex as th

SHAPES = [("triangular", "full"), ("triangular", "edge"), ("hexagonal", "full"), ("square", "full"), ("square", "edge")]


def scheme(name, neighbourhood, seed=3):
    tessellation = th.Tessellation(name, neighbourhood)
    area = th.Area(tessellation, np.random.default_rng(seed).random((9, 11)) < 0.3)
    free = np.flatnonzero(~area.barriers)
    return th.make_d_scheme(th.make_n_scheme(th.Scenario(area, free[:2])))


@pytest.mark.parametrize(("name", "neighbourhood"), SHAPES)
def test_the_first_best_direction_leads_nearer_and_is_the_first_name(name, neighbourhood):
    d_scheme = scheme(name, neighbourhood)
    n_scheme, area = d_scheme.n_scheme, d_scheme.n_scheme.scenario.area
    cells = np.arange(area.cell_count)
    direction, there = d_scheme.direction_of_cell(cells), d_scheme.next_cell(cells)
    has = direction >= 0
    lost = n_scheme.distance_of_cell(cells[has]) - n_scheme.distance_of_cell(there[has])
    assert np.array_equal(lost, area.tessellation.cost_of_direction[direction[has]])
    assert np.array_equal(there[~has], cells[~has])
    for cell in cells:
        names = d_scheme.names_of_cell(int(cell))
        side = int(area.tessellation.orientation_of_cell(*area.cell_to_xy(cell)))
        assert (names[0] if names else -1) == (
            area.tessellation.direction_names[side][direction[cell]] if has[cell] else -1
        )


@pytest.mark.parametrize(("name", "neighbourhood"), SHAPES)
def test_unit_vectors_point_from_centre_to_centre(name, neighbourhood):
    d_scheme = scheme(name, neighbourhood)
    area = d_scheme.n_scheme.scenario.area
    cells = np.arange(area.cell_count)
    there = d_scheme.next_cell(cells)
    here, there = (
        np.stack(area.tessellation.centre_of_cell(*area.cell_to_xy(numbers)), axis=-1) for numbers in (cells, there)
    )
    vector = there - here
    length = np.linalg.norm(vector, axis=-1, keepdims=True)
    want = np.divide(vector, length, out=np.zeros_like(vector), where=length > 0)
    assert d_scheme.unit_vectors.shape == (9, 11, 2)
    assert np.allclose(d_scheme.unit_vectors.reshape(-1, 2), want)


def test_following_the_next_cells_arrives():
    d_scheme = scheme("hexagonal", "full")
    cell = cells = np.flatnonzero(d_scheme.directions)
    for _ in range(100):
        cell = d_scheme.next_cell(cell)
    assert cells.size > 20
    assert np.isin(cell, d_scheme.n_scheme.scenario.destinations).all()
