"""Alignment and fit: where the grid lies, and what robots of a radius find on which cells."""

from math import pi

import numpy as np
import pytest
import shapely

import trihex as th
from trihex.areas import (
    TESSELLATIONS,
    Covering,
    DrawnGround,
    RasterGround,
    Tessellation,
    cover,
    cover_aligned,
    least_cell_size,
    make_fits,
    make_regions,
)

# Pillars a metre apart, as on the TurtleBot3 sandbox.
PILLARS = np.zeros((60, 60), dtype=bool)
for _y in range(7, 60, 10):
    for _x in range(5, 60, 10):
        PILLARS[_y : _y + 2, _x : _x + 2] = True
HALL = RasterGround(PILLARS, 0.1, (3.0, -2.0), 0.3)


def touches(area, world, radius):
    """Tell whether a disc that moves between two free cells touches the world, looked at with shapely alone."""
    free = set(np.flatnonzero(~area.barriers).tolist())
    tessellation = area.tessellation
    for cell in free:
        x, y = divmod(cell, area.width)[::-1]
        for dx, dy in tessellation.step_of_direction[int(tessellation.orientation_of_cell(x, y))].tolist():
            other = (y + dy) * area.width + x + dx
            if other in free and 0 <= x + dx < area.width:
                ends = np.stack(area.cell_to_metres(np.array([cell, other])), axis=-1)
                if shapely.LineString(ends).distance(world) <= radius:
                    return True
    return False


def squares_of(ground):
    """Return the occupied squares and all that is outside as one shape in the world."""
    squares = []
    rows, columns = ground.occupied.shape
    for row, column in zip(*np.nonzero(ground.occupied), strict=True):
        squares.append(shapely.box(column * 0.1, -(row + 1) * 0.1, (column + 1) * 0.1, -row * 0.1))
    box = shapely.box(0, -rows * 0.1, columns * 0.1, 0)
    world = shapely.union_all([*squares, shapely.box(-9, -15, 15, 9).difference(box)])
    turned = shapely.affinity.rotate(world, ground.yaw, origin=(0, 0), use_radians=True)
    return shapely.affinity.translate(turned, *ground.origin)


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize(("offset", "turn"), [((0.3, 0.7), 0.0), ((0.0, 0.0), 0.4), ((0.6, 0.1), pi / 6)])
def test_a_shifted_and_turned_grid_is_as_safe(name, offset, turn):
    tessellation, radius = Tessellation(name, "edge"), 0.1
    covering = Covering(tessellation, least_cell_size(tessellation, radius), radius, offset, turn)
    area, world = cover(HALL, covering), squares_of(HALL)
    assert area.free_count > 10 and not touches(area, world, radius)
    assert area.frame.yaw == pytest.approx(HALL.yaw + turn)
    # A drawing of the same world is covered by the same cells.
    box = shapely.Polygon(shapely.box(0, -6, 6, 0).exterior)
    drawing = DrawnGround(
        box,
        shapely.union_all(
            [
                shapely.box(x / 10, -(y + 2) / 10, (x + 2) / 10, -y / 10)
                for y in range(7, 60, 10)
                for x in range(5, 60, 10)
            ]
        ),
    )
    own = cover(drawing, covering)
    flat = cover(RasterGround(PILLARS, 0.1), covering)
    assert np.array_equal(own.barriers, flat.barriers)


def test_the_grid_in_the_corner_is_the_one_that_it_always_was():
    covering = Covering("hexagonal", 0.5, 0.1)
    area = cover(HALL, covering)
    assert area.frame.origin == HALL.origin and area.frame.yaw == HALL.yaw
    assert area == cover_aligned(HALL, covering, "corner")


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_the_best_grid_connects_at_least_as_much(name):
    tessellation = Tessellation(name, "edge")
    radius = 0.11 if name == "hexagonal" else 0.15
    covering = Covering(tessellation, least_cell_size(tessellation, radius), radius)
    parts = [
        int(make_regions(cover_aligned(HALL, covering, align)).size_of_region[0])
        for align in ("corner", "shift", "best")
    ]
    assert parts[0] <= parts[1] <= parts[2] and parts[0] < parts[2]
    assert not touches(cover_aligned(HALL, covering), squares_of(HALL), radius)


def test_where_all_outside_is_free_the_grid_stays():
    ground = RasterGround(PILLARS, 0.1, is_outside_occupied=False)
    assert cover_aligned(ground, Covering("square", 0.7)).frame.yaw == 0.0


def laying(ground, goal=None):
    def lay(tessellation, size, radius, align):
        area = cover_aligned(ground, Covering(tessellation, size, radius), align)
        return area, [] if goal is None else [int(area.metres_to_cell(*goal))]

    return lay


CORRIDOR = DrawnGround(
    shapely.union_all([shapely.box(0, 0, 10, 10), shapely.box(10, 4, 20, 6), shapely.box(20, 4, 22, 6)])
)


def test_a_fit_tells_the_least_cells_and_the_greatest_robots():
    fits = list(make_fits(laying(CORRIDOR, (5, 5)), [Tessellation("square", "edge")], robot_radius=0.2))
    assert [fit.following for fit in fits] == ["allow", "forbid"]
    assert [fit.cell_size for fit in fits] == [0.5657, 0.4]
    for fit in fits:
        assert fit.free_count == fit.area.free_count > 100 and fit.connected_share == fit.reaching_share == 1.0
        # The hall of 10 metres holds more than half of the cells; the corridor's 2 metres do not matter for (5, 5).
        assert 0.9 < fit.greatest_radius < 5
    # At the end of a corridor of 2 metres: a robot is as wide as that at most, and needs a row of cells in it.
    for fit in make_fits(laying(CORRIDOR, (21, 5)), [Tessellation("square", "edge")], robot_radius=0.2):
        assert 0.3 < fit.greatest_radius < 1.0
        least = least_cell_size(fit.tessellation, fit.greatest_radius, fit.following)
        again = next(
            f
            for f in make_fits(laying(CORRIDOR, (21, 5)), [fit.tessellation], fit.greatest_radius)
            if f.following == fit.following
        )
        assert again.reaching_share >= 0.5 and again.cell_size == pytest.approx(least, abs=1e-4)


def test_clocks_are_told_apart_where_they_change_how_near_robots_come():
    kinds = [Tessellation(name, clock=clock) for name in ("square", "hexagonal") for clock in ("costs", "steps")]
    fits = list(make_fits(laying(CORRIDOR, (5, 5)), kinds, robot_radius=0.3))
    told = [(fit.tessellation.name, fit.following, fit.clocks) for fit in fits]
    assert told == [
        ("square", "allow", ("costs",)),
        ("square", "allow", ("steps",)),
        ("square", "forbid", ("steps", "costs")),
        ("hexagonal", "allow", ("steps", "costs")),
        ("hexagonal", "forbid", ("steps", "costs")),
    ]
    assert [fit.cell_size for fit in fits[:3]] == [1.3, 1.3417, 0.8486]
    assert fits[0].free_count > fits[1].free_count


def test_a_cell_size_alone_tells_the_robots_and_both_may_not_fit():
    kinds = [Tessellation("hexagonal")]
    allow, forbid = make_fits(laying(CORRIDOR), kinds, cell_size=0.6)
    assert (allow.robot_radius, forbid.robot_radius) == (0.15, 0.2598) and allow.greatest_radius is None
    allow, forbid = make_fits(laying(CORRIDOR), kinds, 0.2, 0.7)
    assert allow.area is None and allow.why == "cells must be at least 0.8 metres" and forbid.free_count > 0
    assert allow.reaching_share is None and allow.connected_share == 0.0
    nothing = [fit.why for fit in make_fits(laying(CORRIDOR), kinds)]
    assert nothing == ["no robot reaches a destination"] * 2


def test_a_radius_alone_chooses_the_least_cells(tmp_path):
    path = tmp_path / "hall.wkt"
    path.write_text("POLYGON ((0 0, 9 0, 9 6, 0 6, 0 0))")
    for name, size in (("hexagonal", 0.6), ("square", 0.6709), ("triangular", 0.9166)):
        assert th.read_area(path, name, robot_radius=0.15).frame.cell_size == size
    area = th.read_area(path, "square", robot_radius=0.15, align="best")
    assert area.free_count >= th.read_area(path, "square", robot_radius=0.15).free_count
    with pytest.raises(
        th.FormatError, match="align must be one of corner, best, shift, not 'bst'; did you mean 'best'"
    ):
        th.read_area(path, robot_radius=0.15, align="bst")
