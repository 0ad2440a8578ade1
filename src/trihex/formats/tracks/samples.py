"""Samples: cells of any shape seen as a grid of small squares, as maps of robots have it."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.record import Record, read_only

# Squares to an edge step, less where there would be too many of them. Square cells are one square each.
_FINE, _MOST = 6, 2**24


@dataclass(frozen=True, eq=False)
class Samples(Record):
    """The cell in which the middle of each small square lies.

    Attributes
    ----------
    cells : int64 array, shape (rows, columns)
        Row 0 is the southernmost; -1 outside of all cells.
    resolution : float
        Side of a square in metres.
    origin : (float, float)
        South-west corner in the world, in metres.
    """

    cells: NDArray[np.int64]
    resolution: float
    origin: tuple[float, float]

    def __post_init__(self) -> None:
        self._set("cells", read_only(self.cells))


def make_samples(area: Area) -> Samples:
    """Return the squares that cover an area with a frame.

    Raises
    ------
    AreaError
        If the area has no frame.

    Examples
    --------
    >>> from trihex.areas import Frame
    >>> make_samples(Area("square", [[0, 0], [0, 0]], frame=Frame(0.5))).cells.tolist()
    [[2, 3], [0, 1]]
    """
    frame, tessellation = area.metres, area.tessellation
    east, south = tessellation.extent(area.height, area.width)
    fine = 1 if tessellation.name == "square" else max(1, min(_FINE, int(sqrt(_MOST / (east * south)))))
    columns, rows = (ceil(round(length * fine, 6)) for length in (east, south))
    cells = np.empty((rows, columns), dtype=np.int64)
    px = (np.arange(columns) + 0.5) / fine
    for row in range(rows):  # as a whole this would take a hundred bytes a square
        x, y = tessellation.cell_at_point(px, np.full(columns, (rows - row - 0.5) / fine))
        is_inside = (x >= 0) & (x < area.width) & (y >= 0) & (y < area.height)
        cells[row] = np.where(is_inside, y * area.width + x, -1)
    corner = frame.point_to_metres(0.0, rows / fine)
    return Samples(cells, frame.cell_size / fine, (float(corner[0]), float(corner[1])))
