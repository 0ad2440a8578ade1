"""Regions and previews: against scipy's labels, and drawings small enough to check by eye."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

import trihex as th
from trihex.areas import NEIGHBOURHOODS, TESSELLATIONS, Tessellation, make_regions
from trihex.pictures import preview_lines


@settings(deadline=None, max_examples=60)
@given(
    name=st.sampled_from(TESSELLATIONS),
    neighbourhood=st.sampled_from(NEIGHBOURHOODS),
    size=st.tuples(st.integers(1, 12), st.integers(1, 12)),
    seed=st.integers(0, 2**32),
)
def test_regions_are_the_components_of_the_graph_of_moves(name, neighbourhood, size, seed):
    area = th.Area(Tessellation(name, neighbourhood), np.random.default_rng(seed).random(size) < 0.55)
    ends = []
    for y, x in np.argwhere(~area.barriers):
        for dx, dy in area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(x, y))]:
            if 0 <= x + dx < size[1] and 0 <= y + dy < size[0] and not area.barriers[y + dy, x + dx]:
                ends.append((y * size[1] + x, (y + dy) * size[1] + x + dx))
    rows, columns = np.array(ends, dtype=int).reshape(-1, 2).T
    _, label = connected_components(coo_matrix((np.ones(rows.size), (rows, columns)), shape=(area.cell_count,) * 2))
    regions = make_regions(area)
    free = np.flatnonzero(~area.barriers)
    own = regions.region_of_cell.reshape(-1)
    assert (own[area.barriers.reshape(-1)] == -1).all()
    assert len(set(zip(own[free], label[free], strict=True))) == len(set(label[free])) == regions.size_of_region.size
    assert (np.diff(regions.size_of_region) <= 0).all()
    assert np.array_equal(np.bincount(own[free], minlength=regions.size_of_region.size), regions.size_of_region)


def test_work_in_small_pieces_gives_the_same(monkeypatch):
    area = th.make_caves_area("hexagonal", 60, 60, seed=1)
    whole = make_regions(area)
    monkeypatch.setattr("trihex.areas.regions._SITES_AT_ONCE", 7)
    assert make_regions(area) == whole


def test_each_cell_has_a_letter_where_there_is_room():
    area = th.Area("square", [[0, 0, 0, 1], [0, 1, 0, 0], [0, 0, 0, 0], [1, 1, 1, 1]])
    whole = ["o.o#", "D#..", "....", "####"]
    for rows in (80, 4, 2):
        assert preview_lines(area, np.array([4]), np.array([0, 2]), columns=80, rows=rows) == whole
    assert preview_lines(area, np.array([4]), np.array([0, 2]), columns=3) == ["Do+", "+++"]
    assert preview_lines(th.Area("square", np.zeros((1, 3)))) == ["..."]
    assert preview_lines(th.Area("square", np.ones((5, 1)))) == ["#"] * 5
    lines = preview_lines(th.make_maze_area("square", 41, 61, seed=1))
    assert (len(lines), len(lines[0])) == (41, 61) and set("".join(lines)) == set(".#")


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize("size", [(1, 1), (1, 900), (900, 1), (300, 200), (25, 80)])
def test_a_preview_fits_and_keeps_the_proportions(name, size):
    area = th.Area(name, np.zeros(size))
    lines = preview_lines(area, columns=60, rows=20)
    assert len(lines) <= 20 and {len(line) for line in lines} == {len(lines[0])} and len(lines[0]) <= 60
    across, down = area.tessellation.extent(*size)
    if min(size) > 20:
        assert len(lines[0]) / len(lines) / 2 == pytest.approx(across / down, rel=0.15)
