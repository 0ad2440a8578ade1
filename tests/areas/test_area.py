"""Areas: what makes one, and the numbers of its cells."""

import numpy as np
import pytest

import trihex as th


def test_an_area_keeps_a_read_only_copy_of_its_barriers():
    barriers = np.zeros((2, 3), bool)
    area = th.Area("square", barriers)
    barriers[0, 0] = True
    assert area.free_count == 6
    with pytest.raises(ValueError, match="read-only"):
        area.barriers[0, 0] = True


def test_cells_are_numbered_row_by_row_from_the_north_west():
    area = th.Area("hexagonal", np.zeros((3, 5), bool))
    assert area.xy_to_cell([0, 4, 0], [0, 0, 1]).tolist() == [0, 4, 5]
    x, y = area.cell_to_xy(np.arange(15))
    assert np.array_equal(area.xy_to_cell(x, y), np.arange(15))


@pytest.mark.parametrize(
    ("barriers", "message"),
    [
        ([[0, 1], [0]], "its rows differ in length"),
        ([], r"not \(0,\)"),
        ([0, 1], r"not \(2,\)"),
        (np.zeros((0, 4)), r"not \(0, 4\)"),
    ],
)
def test_barriers_that_are_no_rectangle_are_refused(barriers, message):
    with pytest.raises(th.AreaError, match=message):
        th.Area("square", barriers)


def test_a_cell_outside_is_refused_with_the_range():
    area = th.Area("square", np.zeros((3, 5), bool))
    with pytest.raises(th.AreaError, match=r"cell \(5, 0\) lies outside the area: x is 0..4, y is 0..2"):
        area.xy_to_cell([1, 5], [0, 0])


def test_areas_compare_by_value():
    one = th.Area("square", [[0, 1]])
    assert one == th.Area("square", [[False, True]])
    assert one != th.Area("square", [[1, 0]])
    assert one != one.with_tessellation("hexagonal")
    assert one.with_tessellation("hexagonal").with_tessellation("square") == one


@pytest.mark.parametrize("name", ["b\udce4r", "a\nb\tc", "\0x\0", "\ud800", "x\uffff"])
def test_a_name_holds_only_what_every_file_can_keep(name):
    kept = th.Area("square", [[0]], name).name
    assert len(kept) == len(name) and kept.isprintable() and kept.encode() and "\ufffd" in kept


def test_good_names_are_kept_and_long_ones_refused():
    assert th.Area("square", [[0]], "Bär ξ 大").name == "Bär ξ 大"
    assert len(th.Area("square", [[0]], "x" * 1000).name) == 1000
    for wrong in ("x" * 1001, 5):
        with pytest.raises(th.AreaError, match="name must be text of at most 1000 characters"):
            th.Area("square", [[0]], wrong)
