"""Ground: what stands in the world beneath an area, as a raster of squares, for pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.record import Record, read_only


@dataclass(frozen=True, eq=False)
class Ground(Record):
    """Which squares beneath an area are occupied.

    Attributes
    ----------
    occupied : bool array, shape (rows, columns)
        Row 0 is the north, column 0 the west.
    square : float
        Width of a square in edge steps.
    corner : (float, float)
        Where the north-west corner of the area lies in the raster, in edge steps.
    """

    occupied: NDArray[np.bool_]
    square: float
    corner: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        self._set("occupied", read_only(np.asarray(self.occupied, dtype=bool)))

    def occupied_at(self, px: ArrayLike, py: ArrayLike) -> NDArray[np.bool_]:
        """Tell whether points are occupied, in edge steps from the corner of the area; what lies outside is not.

        Examples
        --------
        >>> Ground([[False, True]], 0.5).occupied_at([0.2, 0.7, 1.2], 0.1).tolist()
        [False, True, False]
        """
        column = np.floor(np.add(px, self.corner[0]) / self.square).astype(np.int64)
        row = np.floor(np.add(py, self.corner[1]) / self.square).astype(np.int64)
        rows, columns = self.occupied.shape
        is_inside = (row >= 0) & (column >= 0) & (row < rows) & (column < columns)
        return np.asarray(is_inside & self.occupied[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)])
