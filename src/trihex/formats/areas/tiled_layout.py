"""Tiled layout: how the tiles of a map of Tiled lie, and which cells they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.record import Record


@dataclass(frozen=True)
class TiledLayout(Record):
    """Where tiles lie: in rows and columns of squares, or of hexagons of which every other row or column is shifted.

    Cells of a hexagonal area stand in columns, odd ones half a cell lower: "stagger axis x, index odd". Where rows are
    shifted x and y are swapped, where even ones are, a column of barriers is put in front.

    Parameters
    ----------
    axis : {"", "x", "y"}
        The axis along which every other column (x) or row (y) of hexagons is shifted; empty for squares.
    is_even : bool
        Whether those are shifted whose number is even.
    """

    axis: str = ""
    is_even: bool = False

    @property
    def shape(self) -> str:
        """The name of the tessellation."""
        return "hexagonal" if self.axis else "square"

    def cells_of(self, tiles: NDArray[Any], outside: Any) -> NDArray[Any]:
        """Return values of tiles [row, column] as those of cells [y, x], `outside` where no tile is.

        Examples
        --------
        >>> TiledLayout("y", True).cells_of(np.array([[1, 2, 3], [4, 5, 6]]), 0).tolist()
        [[0, 1, 4], [0, 2, 5], [0, 3, 6]]
        """
        turned = tiles.T if self.axis == "y" else tiles
        return np.pad(turned, ((0, 0), (1, 0)), constant_values=outside) if self.is_even else turned

    def tiles_of(self, cells: NDArray[Any]) -> NDArray[Any]:
        """Return values of cells as those of tiles; the inverse of `cells_of`."""
        own = cells[:, 1:] if self.is_even else cells
        return own.T if self.axis == "y" else own

    @property
    def note(self) -> str:
        """What users must know to name cells; empty if tile (x, y) is cell (x, y)."""
        x, y = ("row", "column") if self.axis == "y" else ("column", "row")
        if self.axis != "y" and not self.is_even:
            return ""
        plus = " + 1" * self.is_even
        return (
            f"hexagons of stagger axis {self.axis}, index {'even' if self.is_even else 'odd'}: the tile in column c, "
            + (f"row r is cell ({x[0]}{plus}, {y[0]})")
        )
