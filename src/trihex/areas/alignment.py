"""Alignment: where the grid of cells had better begin and how be turned, so that much of a place is connected.

The same hall of pillars has 13 or 40 cells for the same robots by where its grid begins.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import pi, sqrt

from trihex.areas.area import Area
from trihex.areas.coverage import cover
from trihex.areas.grid import Covering
from trihex.areas.ground import Ground, RasterGround
from trihex.areas.regions import make_regions

ALIGNS = ("corner", "best")
# A shift by these lengths, in edge steps to the east and to the south, or by these angles, brings a grid to itself.
_PERIODS = {
    "triangular": (sqrt(3), 1.5, pi / 3),
    "hexagonal": (sqrt(3) / 2, 1.0, pi / 3),
    "square": (1.0, 1.0, pi / 2),
}
_TURNS = 8
_SHIFTS = (4, 8, 16)  # parts of a period, in each direction
# As a share of the cells that a ground may have: what all tries cover together takes 1 or 2 s.
_BUDGET = 0.04
_WORTH = 1.05  # rows along the walls are easier to understand


def cover_aligned(ground: Ground, covering: Covering, align: str = "best", *, name: str = "") -> Area:
    """Return the area that covers a ground by the grid whose largest connected part has most cells.

    Tried are shifts by quarters of a period under eight turns, then shifts by eighths and sixteenths under the turn
    that was best; fewer where a place has very many cells, as it then matters little. Of equal ones the first is taken,
    and that is the grid that begins in the corner; one that is turned must connect a twentieth more. Where all that
    lies outside a place is free, nothing is tried: the more of it a grid covers, the more it connects.

    Parameters
    ----------
    ground : Ground
    covering : Covering
        Its offset and turn are where the search begins.
    align : {"corner", "best", "shift"}
        "corner" tries nothing, "shift" only shifts by halves.
    name : str

    Examples
    --------
    >>> import numpy as np
    >>> from trihex.areas import RasterGround
    >>> hall, covering = RasterGround(np.zeros((26, 26)), 0.1), Covering("square", 1.0)  # 2.6 metres wide
    >>> [cover_aligned(hall, covering, align).free_count for align in ("corner", "best")]
    [1, 4]
    """
    best = cover(ground, covering, name=name)
    most, turn = _largest_part(best), covering.turn
    tries = int(_BUDGET * ground.most_cells) // best.cell_count
    if isinstance(ground, RasterGround) and not ground.is_outside_occupied:
        return best
    rounds = {"corner": (), "shift": (2,), "best": _SHIFTS}[align]
    for parts in rounds:
        turns = _turns(covering) if parts == _SHIFTS[0] and align == "best" else [turn]
        for own, offset in product(turns, _offsets(covering, parts)):
            tries -= 1
            if tries < 0:
                return best
            area = cover(ground, replace(covering, offset=offset, turn=own), name=name)
            part = _largest_part(area)
            if part > (most if own == turn else _WORTH * most):
                best, most, turn = area, part, own
    return best


def _turns(covering: Covering) -> list[float]:
    period = _PERIODS[covering.tessellation.name][2]
    return [covering.turn + part / _TURNS * period for part in range(_TURNS)]


def _offsets(covering: Covering, parts: int) -> list[tuple[float, float]]:
    """Return shifts by parts of a period to the west and to the north; none is the first."""
    east, south, _ = _PERIODS[covering.tessellation.name]
    return [
        (covering.offset[0] + i / parts * east, covering.offset[1] + j / parts * south)
        for i, j in product(range(parts), repeat=2)
    ]


def _largest_part(area: Area) -> int:
    """Return how many cells the largest connected part has."""
    sizes = make_regions(area).size_of_region
    return int(sizes[0]) if sizes.size else 0
