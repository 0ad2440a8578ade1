"""Warehouses: rows of shelves with aisles between them."""

from __future__ import annotations

import numpy as np

from trihex.areas.area import Area
from trihex.areas.generators.common import begin_area, check_share, named_area
from trihex.areas.generators.units import units_of_row, widened
from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError, check_whole


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

    Lengths count cells, on triangles pairs of cells in a row (see `trihex.areas.make_rooms_area`).

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
    tessellation, rng = begin_area(tessellation, height, width, seed)
    for parameter, value in (("shelf_length", shelf_length), ("shelf_depth", shelf_depth), ("aisle", aisle)):
        check_whole(parameter, value, 1, None, AreaError)
    check_share("missing", missing)
    units = units_of_row(tessellation, width)
    y, x = np.arange(height), np.arange(units)
    in_shelf_row = (y % (shelf_depth + aisle) >= aisle) & (y < height - aisle)
    in_shelf_column = (x % (shelf_length + aisle) >= aisle) & (x < units - aisle)
    row, column = y // (shelf_depth + aisle), x // (shelf_length + aisle)
    stands = rng.random((row[-1] + 1, column[-1] + 1)) >= missing
    shelves = in_shelf_row[:, None] & in_shelf_column & stands[row][:, column]
    return named_area("warehouse", tessellation, widened(shelves, width), seed)
