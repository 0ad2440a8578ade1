"""Caves: random barriers, smoothed, and of the free regions the largest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trihex.areas.area import Area
from trihex.areas.generators.common import begin_area, check_share, check_some_free, named_area
from trihex.areas.regions import make_regions
from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError, check_whole

_SITES_AT_ONCE = 4_000_000  # in one call of a kernel, some 0.1 s; Ctrl-C works in between


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
    from trihex.areas.kernels.caves import smooth

    tessellation, rng = begin_area(tessellation, height, width, seed)
    check_share("density", density)
    check_whole("rounds", rounds, 0, None, AreaError)
    layout = replace(tessellation, neighbourhood="full").layout(height, width)
    blocked = np.ones(layout.size, dtype=bool)
    layout.view_of(blocked)[:] = rng.random((height, width), dtype=np.float32) < density
    smoothed = blocked.copy()
    rows = max(1, _SITES_AT_ONCE // layout.pitch)
    for _ in range(rounds):
        for y in range(0, height, rows):
            first, last = layout.origin + y * layout.pitch, layout.origin + min(y + rows, height) * layout.pitch
            smooth(blocked, first, last, layout.offset_of_direction, smoothed)
        layout.margin_of(smoothed)[:] = True
        blocked, smoothed = smoothed, blocked
    through_edges = replace(tessellation, neighbourhood="edge")
    barriers = make_regions(Area(through_edges, layout.view_of(blocked))).region_of_cell != 0  # 0 is the largest
    check_some_free(barriers, density, seed)
    return named_area("caves", tessellation, barriers, seed)
