"""Generators: random areas of five kinds, the same for the same seed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import permutations
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas.area import MAX_CELLS, Area
from trihex.areas.tessellation import Layout, Tessellation
from trihex.errors import AreaError

# What one call of a kernel looks at, some 0.1 s; Ctrl-C works in between.
_BUDGET = 4_000_000


def make_random_area(
    tessellation: Tessellation | str, height: int, width: int, *, density: float = 0.2, seed: int = 0
) -> Area:
    """Make an area in which each cell is a barrier with probability `density`.

    Free: a share of 1 - `density`, on average. Free cells need not be connected.

    Parameters
    ----------
    tessellation : Tessellation or str
    height, width : int
        In cells.
    density : float
        From 0 to 1.
    seed : int
        The same seed gives the same area.

    Raises
    ------
    AreaError
        If a parameter is out of its range, or no cell is free.

    Examples
    --------
    >>> make_random_area("hexagonal", 30, 40, density=0.3, seed=1).name
    'random 30 x 40, seed 1'
    """
    tessellation, rng = _checked(tessellation, height, width, seed)
    _check_share("density", density)
    barriers = rng.random((height, width), dtype=np.float32) < density
    _check_some_free(barriers, density, seed)
    return _area("random", tessellation, barriers, seed)


def make_rooms_area(
    tessellation: Tessellation | str, height: int, width: int, *, room: int = 8, doors: float = 0.5, seed: int = 0
) -> Area:
    """Make an area of square rooms, with walls one cell thick and doors one cell wide.

    Lengths count cells, on triangles pairs of cells in a row, because a single triangle neither blocks the way along a
    row nor leads from one row to the next.

    Free: a share of about (room / (room + 1))^2. All free cells are connected through edges.

    Parameters
    ----------
    tessellation : Tessellation or str
    height, width : int
        In cells; on triangles the width must be at least 2, and the last column of an odd width is a barrier.
    room : int
        Cells along the inner side of a room.
    doors : float
        Every room has a door to the north or to the west, which connects them all; this is the share of the other
        walls that have a door, too.
    seed : int
        The same seed gives the same area.

    Raises
    ------
    AreaError
        If a parameter is out of its range.
    """
    tessellation, rng = _checked(tessellation, height, width, seed)
    _check_whole("room", room, 1)
    _check_share("doors", doors)
    units = _units(tessellation, width)
    pitch = room + 1
    walls = (np.arange(height) % pitch == room)[:, None] | (np.arange(units) % pitch == room)
    rows, columns = ceil(height / pitch), ceil(units / pitch)
    north = rng.random((rows, columns)) < 0.5
    north[:, 0] = True
    north[0] = False
    west = ~north
    west[:, 0] = False
    north[1:] |= rng.random((rows - 1, columns)) < doors
    west[:, 1:] |= rng.random((rows, columns - 1)) < doors
    first_y, first_x = np.arange(rows) * pitch, np.arange(columns) * pitch
    inner_height, inner_width = np.minimum(room, height - first_y), np.minimum(room, units - first_x)
    door_y = first_y[:, None] + (rng.random((rows, columns)) * inner_height[:, None]).astype(np.int64)
    door_x = first_x + (rng.random((rows, columns)) * inner_width).astype(np.int64)
    i, j = np.nonzero(north)
    walls[first_y[i] - 1, door_x[i, j]] = False
    i, j = np.nonzero(west)
    walls[door_y[i, j], first_x[j] - 1] = False
    return _area("rooms", tessellation, _widened(walls, width), seed)


def make_maze_area(tessellation: Tessellation | str, height: int, width: int, *, seed: int = 0) -> Area:
    """Make a perfect maze: corridors one cell wide, and exactly one way between any two free cells.

    A walker frees cell after cell in random directions, and goes back where no way is open. It may free a cell that
    touches free ones nowhere but at the edge by which it enters. So the free cells form a tree of edge neighbours, and
    moves through vertices only cut the corners of a corridor, never through a wall. No further cell could be freed.

    Free: a share of about 0.48 on squares, 0.46 on hexagons, 0.50 on triangles. All free cells are connected through
    edges.

    Parameters
    ----------
    tessellation : Tessellation or str
    height, width : int
        In cells.
    seed : int
        The same seed gives the same area.

    Raises
    ------
    AreaError
        If a parameter is out of its range.
    """
    from trihex.areas.kernels import generate as kernels

    tessellation, rng = _checked(tessellation, height, width, seed)
    edge = replace(tessellation, neighbourhood="edge")
    # At least 8 columns, so that different cells around a site have different offsets.
    layout = edge.layout(height, max(width, 8))
    inside = np.zeros(layout.size, dtype=bool)
    _writable_cells(layout, inside)[:, :width] = True
    turns = np.array(list(permutations(range(edge.edge_count))), dtype=np.uint8)
    turn_of_site = rng.integers(len(turns), size=layout.size, dtype=np.uint16)
    trail = np.empty(np.count_nonzero(inside), dtype=np.int32)
    trail[0] = layout.origin + rng.integers(height) * layout.pitch + rng.integers(width)
    free, taken, length = np.zeros(layout.size, dtype=bool), np.zeros(layout.size, dtype=np.uint8), np.array([1])
    free[trail[0]] = True
    front = _front_of_move(layout)
    while length[0]:
        kernels.carve_maze(
            free, inside, layout.offset_of_direction, front, turns, turn_of_site, taken, trail, length, _BUDGET
        )
    return _area("maze", tessellation, ~_writable_cells(layout, free)[:, :width], seed)


def make_caves_area(
    tessellation: Tessellation | str,
    height: int,
    width: int,
    *,
    density: float = 0.45,
    rounds: int = 4,
    seed: int = 0,
) -> Area:
    """Make a cave: random barriers, smoothed, and of the free regions only the largest.

    In each round a cell becomes what most of itself and its neighbours (through edges or vertices) are; outside there
    are barriers.

    Free: by default a share of about 0.70 on squares, 0.66 on hexagons, 0.73 on triangles, less in small areas; it
    falls fast as `density` passes one half, where the cave breaks up. All free cells are connected through edges.

    Parameters
    ----------
    tessellation : Tessellation or str
    height, width : int
        In cells.
    density : float
        Share of barriers before the first round, from 0 to 1.
    rounds : int
        More rounds, smoother walls.
    seed : int
        The same seed gives the same area.

    Raises
    ------
    AreaError
        If a parameter is out of its range, or no cell is free.
    """
    from trihex.areas.kernels import generate as kernels

    tessellation, rng = _checked(tessellation, height, width, seed)
    _check_share("density", density)
    _check_whole("rounds", rounds, 0)
    layout = replace(tessellation, neighbourhood="full").layout(height, width)
    blocked = np.ones(layout.size, dtype=bool)
    _writable_cells(layout, blocked)[:] = rng.random((height, width), dtype=np.float32) < density
    smoothed = blocked.copy()
    rows = max(1, _BUDGET // layout.pitch)
    for _ in range(rounds):
        for y in range(0, height, rows):
            first, last = layout.origin + y * layout.pitch, layout.origin + min(y + rows, height) * layout.pitch
            kernels.smooth(blocked, first, last, layout.offset_of_direction, smoothed)
        _fill_margin(layout, smoothed)
        blocked, smoothed = smoothed, blocked
    barriers = ~_writable_cells(layout, _largest_region(replace(tessellation, neighbourhood="edge"), layout, blocked))
    _check_some_free(barriers, density, seed)
    return _area("caves", tessellation, barriers, seed)


def make_warehouse_area(
    tessellation: Tessellation | str,
    height: int,
    width: int,
    *,
    shelf_length: int = 10,
    shelf_depth: int = 2,
    aisle: int = 2,
    missing: float = 0.0,
    seed: int = 0,
) -> Area:
    """Make a warehouse: rows of shelves, which are barriers, with aisles between and all around.

    Lengths count cells, on triangles pairs of cells in a row (see `make_rooms_area`).

    Free: all but a share of about shelf_length * shelf_depth / ((shelf_length + aisle) * (shelf_depth + aisle)) of the
    cells, for large areas. All free cells are connected through edges.

    Parameters
    ----------
    tessellation : Tessellation or str
    height, width : int
        In cells; on triangles the width must be at least 2, and the last column of an odd width is a barrier.
    shelf_length, shelf_depth : int
        Of a shelf from west to east, and from north to south; the last ones are cut where they do not fit.
    aisle : int
        Width of the aisles.
    missing : float
        Share of the shelves left out, at random.
    seed : int
        The same seed gives the same area; it matters only if shelves are missing.

    Raises
    ------
    AreaError
        If a parameter is out of its range.

    Examples
    --------
    >>> area = make_warehouse_area("square", 5, 12, shelf_length=4, shelf_depth=1, aisle=1)
    >>> print(area.barriers.astype(int))
    [[0 0 0 0 0 0 0 0 0 0 0 0]
     [0 1 1 1 1 0 1 1 1 1 0 0]
     [0 0 0 0 0 0 0 0 0 0 0 0]
     [0 1 1 1 1 0 1 1 1 1 0 0]
     [0 0 0 0 0 0 0 0 0 0 0 0]]
    """
    tessellation, rng = _checked(tessellation, height, width, seed)
    for parameter, value in (("shelf_length", shelf_length), ("shelf_depth", shelf_depth), ("aisle", aisle)):
        _check_whole(parameter, value, 1)
    _check_share("missing", missing)
    units = _units(tessellation, width)
    y, x = np.arange(height), np.arange(units)
    in_shelf_row = (y % (shelf_depth + aisle) >= aisle) & (y < height - aisle)
    in_shelf_column = (x % (shelf_length + aisle) >= aisle) & (x < units - aisle)
    row, column = y // (shelf_depth + aisle), x // (shelf_length + aisle)
    stands = rng.random((row[-1] + 1, column[-1] + 1)) >= missing
    shelves = in_shelf_row[:, None] & in_shelf_column & stands[row][:, column]
    return _area("warehouse", tessellation, _widened(shelves, width), seed)


GENERATORS: dict[str, Callable[..., Area]] = {
    "random": make_random_area,
    "rooms": make_rooms_area,
    "maze": make_maze_area,
    "caves": make_caves_area,
    "warehouse": make_warehouse_area,
}


def _area(kind: str, tessellation: Tessellation, barriers: NDArray[np.bool_], seed: int) -> Area:
    height, width = barriers.shape
    return Area(tessellation, barriers, f"{kind} {height} x {width}, seed {seed}")


def _units(tessellation: Tessellation, width: int) -> int:
    """Return the number of units of a row: cells, or pairs of them where a cell has but three edge neighbours.

    A row of such cells is no way for those who come from the row above and want to go to the one below, as each cell
    has an edge neighbour in one of the two rows only; and a column of them is no wall, as moves of two columns exist.
    Two side by side do both, as one square does.
    """
    if tessellation.edge_count > 3:
        return width
    if width < 2:
        raise AreaError(f"width must be at least 2 on {tessellation.name} areas of this kind, not {width}")
    return width // 2


def _widened(units: NDArray[np.bool_], width: int) -> NDArray[np.bool_]:
    """Return the cells of units, with a barrier in the column that is left over."""
    cells = np.repeat(units, width // units.shape[1], axis=1)
    return np.pad(cells, ((0, 0), (0, width - cells.shape[1])), constant_values=True)


def _writable_cells(layout: Layout, sites: NDArray[Any]) -> NDArray[Any]:
    """Return the part of a padded array that belongs to cells, as a writable view."""
    rows = sites[layout.origin : layout.origin + layout.height * layout.pitch].reshape(layout.height, layout.pitch)
    return rows[:, : layout.width]


def _fill_margin(layout: Layout, sites: NDArray[np.bool_]) -> None:
    rows = sites[layout.origin : layout.origin + layout.height * layout.pitch].reshape(layout.height, layout.pitch)
    rows[:, layout.width :] = True


def _front_of_move(layout: Layout) -> NDArray[np.int32]:
    """Return which sites a move across an edge comes to face, shape (2 orientations * edge neighbours, 5).

    These are, as offsets from where the move starts, all sites that touch the target otherwise than at that edge.
    """
    full = replace(layout.tessellation, neighbourhood="full").layout(layout.height, layout.width)
    offset, vertex, ring = full.offset_of_direction, full.vertex_of_direction, full.ring_of_vertex
    edges = layout.tessellation.edge_count
    fronts = []
    for parity in (0, 1):
        for target in offset[parity, :edges].tolist():
            there = (parity + target) & 1
            faced = set((target + offset[there]).tolist())
            for corner in (target + vertex[there, edges:]).tolist():
                around = set((corner + ring).tolist())
                if 0 in around:  # a corner of the edge that is crossed
                    faced -= around - set((target + offset[there, :edges]).tolist())
            fronts.append(sorted(faced - {0}))
    return np.array(fronts, dtype=np.int32)


def _largest_region(edge: Tessellation, layout: Layout, blocked: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which sites belong to the largest region of free ones that are connected through edges."""
    from trihex.areas.kernels import generate as kernels

    region = np.where(blocked, np.int32(-1), np.int32(0))
    queue = np.empty(np.count_nonzero(~blocked) + 1, dtype=np.int32)
    state = np.zeros(6, dtype=np.int64)
    offset = edge.layout(layout.height, layout.width).offset_of_direction
    while state[0] < layout.size:
        kernels.label_regions(region, offset, queue, state, _BUDGET)
    return np.asarray(region == max(state[4], 1))


def _checked(
    tessellation: Tessellation | str, height: int, width: int, seed: int
) -> tuple[Tessellation, np.random.Generator]:
    if isinstance(tessellation, str):
        tessellation = Tessellation(tessellation)
    _check_whole("height", height, 1)
    _check_whole("width", width, 1)
    if height * width > MAX_CELLS:
        raise AreaError(f"an area may have at most {MAX_CELLS} cells, not {height} x {width}")
    _check_whole("seed", seed, 0)
    return tessellation, np.random.default_rng(seed)


def _check_whole(parameter: str, value: object, least: int) -> None:
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or int(value) < least:  # type: ignore[call-overload]
        raise AreaError(f"{parameter} must be a whole number from {least}, not {value!r}")


def _check_share(parameter: str, value: object) -> None:
    number = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    if not number or not 0 <= float(value) <= 1:  # type: ignore[arg-type]
        raise AreaError(f"{parameter} must be a number from 0 to 1, not {value!r}")


def _check_some_free(barriers: NDArray[np.bool_], density: float, seed: int) -> None:
    if barriers.all():
        height, width = barriers.shape
        raise AreaError(f"density must leave a free cell; {density} leaves none of {height} x {width} with seed {seed}")
