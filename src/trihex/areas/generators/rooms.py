"""Rooms: squares with walls and doors between them."""

from __future__ import annotations

from math import ceil

import numpy as np

from trihex.areas.area import Area
from trihex.areas.generators.common import begin_area, check_share, named_area
from trihex.areas.generators.units import units_of_row, widened
from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError, check_whole


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
    tessellation, rng = begin_area(tessellation, height, width, seed)
    check_whole("room", room, 1, None, AreaError)
    check_share("doors", doors)
    units = units_of_row(tessellation, width)
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
    return named_area("rooms", tessellation, widened(walls, width), seed)
