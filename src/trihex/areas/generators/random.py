"""Random areas: each cell for itself is a barrier or not."""

from __future__ import annotations

import numpy as np

from trihex.areas.area import Area
from trihex.areas.generators.common import begin_area, check_share, check_some_free, named_area
from trihex.areas.tessellation import Tessellation


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
    'random 40 x 30, seed 1'
    """
    tessellation, rng = begin_area(tessellation, height, width, seed)
    check_share("density", density)
    barriers = rng.random((height, width), dtype=np.float32) < density
    check_some_free(barriers, density, seed)
    return named_area("random", tessellation, barriers, seed)
