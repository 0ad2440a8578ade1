"""Units: what blocks the way along a row and leads from row to row; a cell, or on triangles two side by side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError


def units_of_row(tessellation: Tessellation, width: int) -> int:
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


def widened(units: NDArray[np.bool_], width: int) -> NDArray[np.bool_]:
    """Return the cells of units, with a barrier in the column that is left over."""
    cells = np.repeat(units, width // units.shape[1], axis=1)
    return np.pad(cells, ((0, 0), (0, width - cells.shape[1])), constant_values=True)
