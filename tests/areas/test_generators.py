"""Generators: what they promise of their areas, checked by walking over drawn cells."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import trihex as th
from tests.oracles.lattice import Lattice
from trihex.areas import GENERATORS

TESSELLATIONS = ("square", "hexagonal", "triangular")
CONNECTED = [kind for kind in GENERATORS if kind != "random"]
SIZES = [(1, 2), (2, 1), (2, 3), (9, 9), (13, 18), (10, 31)]


def make(kind, name, height, width, **options):
    if name == "triangular" and width == 1 and kind in ("rooms", "warehouse"):
        width = 2  # they need as much
    return GENERATORS[kind](name, height, width, **options)


def free_cells(area):
    return {(int(x), int(y)) for y, x in np.argwhere(~area.barriers)}


def regions(lattice, free):
    """Sets of free cells that can reach each other."""
    left, found = set(free), []
    while left:
        queue = [left.pop()]
        for cell in queue:
            near = [other for other in lattice.cost[cell] if other in left]
            left.difference_update(near)
            queue.extend(near)
        found.append(set(queue))
    return found


def lattice_of(area, neighbourhood):
    return Lattice(area.tessellation.name, neighbourhood, "paper", area.height, area.width)


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize("kind", GENERATORS)
def test_the_same_seed_gives_the_same_area(kind, name):
    options = {"missing": 0.5} if kind == "warehouse" else {}
    tessellation = th.Tessellation(name, "edge", "euclidean")
    one = GENERATORS[kind](tessellation, 30, 41, seed=3, **options)
    assert one == GENERATORS[kind](tessellation, 30, 41, seed=3, **options)
    assert (one.tessellation, one.height, one.width) == (tessellation, 30, 41)
    assert one.name == f"{kind} 41 x 30, seed 3"
    other = GENERATORS[kind](name, 30, 41, seed=4, **options)
    assert (one.barriers != other.barriers).any()
    # The neighbourhood is no part of what is drawn.
    np.testing.assert_array_equal(one.barriers, GENERATORS[kind](name, 30, 41, seed=3, **options).barriers)


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize("kind", CONNECTED)
def test_free_cells_are_connected_through_edges(kind, name):
    options = {"density": 0.3} if kind == "caves" else {}
    for height, width in SIZES[3:] if kind == "caves" else SIZES:  # with barriers outside, a tiny cave closes
        for seed in range(3):
            area = make(kind, name, height, width, seed=seed, **options)
            assert len(regions(lattice_of(area, "edge"), free_cells(area))) == 1


@pytest.mark.parametrize(
    ("kind", "pieces"),
    [("maze", ["generators.maze._BUDGET"]), ("caves", ["generators.caves._SITES_AT_ONCE", "regions._SITES_AT_ONCE"])],
)
def test_work_in_pieces_changes_nothing(kind, pieces, monkeypatch):
    areas = [GENERATORS[kind](name, 21, 34, seed=5) for name in TESSELLATIONS]
    for piece in pieces:
        monkeypatch.setattr(f"trihex.areas.{piece}", 40)
    assert areas == [GENERATORS[kind](name, 21, 34, seed=5) for name in TESSELLATIONS]


# Random


@pytest.mark.parametrize("density", [0, 0.2, 0.75])
def test_random_areas_have_their_density(density):
    share = th.make_random_area("square", 400, 500, density=density, seed=1).barriers.mean()
    assert abs(share - density) <= 5 * (density * (1 - density) / 200_000) ** 0.5


# Rooms


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_rooms_without_more_doors_than_needed_are_a_tree(name):
    room, unit = 3, 2 if name == "triangular" else 1
    area = th.make_rooms_area(name, 11, 15 * unit, room=room, doors=0, seed=6)
    lattice = lattice_of(area, "full")
    free = free_cells(area)
    in_wall = {(x, y) for x, y in free if y % (room + 1) == room or x // unit % (room + 1) == room}
    doors = {tuple(sorted((x + i, y) for i in range(unit))) for x, y in in_wall if x % unit == 0}
    rooms = regions(lattice, free - in_wall)
    assert sorted(len(cells) for cells in rooms) == [9 * unit] * 12
    assert len(doors) == 11
    # Each door is needed: no move leads through a wall.
    for door in doors:
        assert len(regions(lattice, free - set(door))) == 2


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_rooms_may_have_a_door_in_every_wall(name):
    unit = 2 if name == "triangular" else 1
    few, many = (th.make_rooms_area(name, 11, 15 * unit, room=3, doors=share, seed=6) for share in (0, 1))
    assert many.free_count - few.free_count == unit * ((3 * 3 + 2 * 4) - 11)


def test_rooms_are_cut_at_the_border():
    assert th.make_rooms_area("hexagonal", 5, 6, room=8).free_count == 30
    area = th.make_rooms_area("triangular", 3, 7, room=1, doors=1)
    assert area.barriers.astype(int).tolist() == [[0, 0, 0, 0, 0, 0, 1], [0, 0, 1, 1, 0, 0, 1], [0, 0, 0, 0, 0, 0, 1]]


# Mazes


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize("seed", range(4))
def test_a_maze_is_a_tree_that_vertices_do_not_short_cut(name, seed):
    area = th.make_maze_area(name, 14, 19, seed=seed)
    lattice, free = lattice_of(area, "edge"), free_cells(area)
    edges = sum(other in free for cell in free for other in lattice.cost[cell])
    assert edges == 2 * (len(free) - 1)
    for around in lattice.cells_at.values():
        here = around & free
        assert len(regions(lattice, here)) <= 1  # connected through edges within the ring of the vertex
        assert len(here) < len(around)


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_no_cell_could_be_added_to_a_maze(name):
    area = th.make_maze_area(name, 14, 19, seed=9)
    lattice, free = lattice_of(area, "edge"), free_cells(area)
    for cell in lattice.inside - free:
        for entry in free & set(lattice.cost[cell]):
            far = lattice.corners[cell] - lattice.corners[entry]
            assert any(other in free for corner in far for other in lattice.cells_at[corner])


@pytest.mark.parametrize(("name", "share"), [("square", 0.48), ("hexagonal", 0.46), ("triangular", 0.50)])
def test_mazes_have_the_free_share_they_promise(name, share):
    area = th.make_maze_area(name, 300, 300, seed=1)
    assert area.free_count / area.cell_count == pytest.approx(share, abs=0.01)


# Caves


@pytest.mark.parametrize("name", TESSELLATIONS)
@pytest.mark.parametrize("rounds", [0, 1, 3])
def test_caves_equal_a_loop(name, rounds):
    height, width = 17, 20
    for seed in range(3):
        noise = np.random.default_rng(seed).random((height, width), dtype=np.float32) < 0.4
        full, edge = (Lattice(name, n, "paper", height, width) for n in ("full", "edge"))
        barriers = {(x, y) for x, y in full.inside if noise[y, x]}
        count = {"square": 8, "hexagonal": 6, "triangular": 12}[name]
        for _ in range(rounds):
            before, barriers = barriers, set()
            for cell in full.inside:
                near = full.cost[cell]
                walls = (cell in before) + sum(other in before for other in near) + count - len(near)
                if 2 * walls > count + 1:
                    barriers.add(cell)
        caves = regions(edge, full.inside - barriers)
        seen = free_cells(th.make_caves_area(name, height, width, density=0.4, rounds=rounds, seed=seed))
        assert seen in caves
        assert len(seen) == max(map(len, caves))


@pytest.mark.parametrize(("name", "share"), [("square", 0.70), ("hexagonal", 0.66), ("triangular", 0.73)])
def test_caves_have_the_free_share_they_promise(name, share):
    area = th.make_caves_area(name, 700, 700, seed=1)
    assert area.free_count / area.cell_count == pytest.approx(share, abs=0.04)


# Warehouses


def test_a_warehouse_has_its_shelves():
    area = th.make_warehouse_area("hexagonal", 8, 13, shelf_length=3, shelf_depth=2, aisle=1)
    picture = ["".join(".#"[cell] for cell in row) for row in area.barriers.astype(int)]
    shelf, aisle = ".###.###.###.", "............."
    assert picture == [aisle, shelf, shelf, aisle, shelf, shelf, aisle, aisle]
    on_triangles = th.make_warehouse_area("triangular", 8, 27, shelf_length=3, shelf_depth=2, aisle=1)
    np.testing.assert_array_equal(on_triangles.barriers[:, :26:2], area.barriers)
    np.testing.assert_array_equal(on_triangles.barriers[:, 1:26:2], area.barriers)
    assert on_triangles.barriers[:, 26].all()


def test_shelves_may_be_missing():
    options = {"shelf_length": 3, "shelf_depth": 2, "aisle": 1}
    full = th.make_warehouse_area("square", 301, 401, **options)
    some = th.make_warehouse_area("square", 301, 401, **options, missing=0.25, seed=1)
    assert not (some.barriers & ~full.barriers).any()
    assert some.barriers.sum() % 6 == 0  # whole shelves
    assert some.barriers.sum() / full.barriers.sum() == pytest.approx(0.75, abs=0.02)
    assert not th.make_warehouse_area("square", 30, 40, missing=1).barriers.any()


def test_an_area_too_small_for_a_shelf_is_free():
    assert th.make_warehouse_area("square", 4, 40).free_count == 160


# Mistakes


@pytest.mark.parametrize("kind", GENERATORS)
def test_every_generator_starts_alike(kind):
    names = list(inspect.signature(GENERATORS[kind]).parameters)
    assert names[:3] == ["tessellation", "height", "width"]
    assert names[-1] == "seed"
    assert GENERATORS[kind] is getattr(th, f"make_{kind}_area")


@pytest.mark.parametrize("kind", GENERATORS)
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("square", 0, 5), "height must be a whole number from 1, not 0"),
        (("square", 5, -1), "width must be a whole number from 1, not -1"),
        (("square", 5, 2.5), "width must be a whole number from 1, not 2.5"),
        (("square", True, 5), "height must be a whole number from 1, not True"),
        (("square", 50_000, 100_000), "at most 2000000000 cells, not 100000 x 50000"),
    ],
)
def test_sizes_are_checked(kind, arguments, message):
    with pytest.raises(th.AreaError, match=message):
        GENERATORS[kind](*arguments)


@pytest.mark.parametrize("kind", GENERATORS)
def test_seeds_are_checked(kind):
    for seed in (-1, 1.5, None, "one"):
        with pytest.raises(th.AreaError, match=f"seed must be a whole number from 0, not {seed!r}"):
            GENERATORS[kind]("square", 5, 5, seed=seed)


@pytest.mark.parametrize(
    ("kind", "option", "value", "message"),
    [
        ("random", "density", 1.01, "density must be a number from 0 to 1, not 1.01"),
        ("random", "density", "half", "density must be a number from 0 to 1, not 'half'"),
        ("random", "density", float("nan"), "density must be a number from 0 to 1, not nan"),
        ("random", "density", 1, "density must leave a free cell; 1 leaves none of 12 x 12 with seed 0"),
        ("rooms", "room", 0, "room must be a whole number from 1, not 0"),
        ("rooms", "doors", -0.1, "doors must be a number from 0 to 1, not -0.1"),
        ("caves", "density", -1, "density must be a number from 0 to 1, not -1"),
        ("caves", "density", 0.95, "density must leave a free cell; 0.95 leaves none of 12 x 12 with seed 0"),
        ("caves", "rounds", -1, "rounds must be a whole number from 0, not -1"),
        ("warehouse", "shelf_length", 0, "shelf_length must be a whole number from 1, not 0"),
        ("warehouse", "shelf_depth", 0, "shelf_depth must be a whole number from 1, not 0"),
        ("warehouse", "aisle", 0, "aisle must be a whole number from 1, not 0"),
        ("warehouse", "missing", 2, "missing must be a number from 0 to 1, not 2"),
    ],
)
def test_options_are_checked(kind, option, value, message):
    with pytest.raises(th.AreaError, match=message):
        GENERATORS[kind]("hexagonal", 12, 12, **{option: value})


def test_messages_give_sizes_as_everywhere_x_before_y():
    with pytest.raises(th.AreaError, match="1 leaves none of 9 x 4 with seed 0"):
        th.make_random_area("square", 4, 9, density=1)


def test_pairs_of_triangles_need_two_columns():
    for kind in ("rooms", "warehouse"):
        with pytest.raises(th.AreaError, match="width must be at least 2 on triangular areas of this kind, not 1"):
            GENERATORS[kind]("triangular", 5, 1)


def test_an_unknown_tessellation_is_refused():
    with pytest.raises(th.TessellationError, match="did you mean 'square'"):
        th.make_maze_area("squares", 5, 5)
