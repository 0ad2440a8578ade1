"""Regions: the connected parts of an area, the largest first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.areas.area import Area
from trihex.record import Record, read_only

_SITES_AT_ONCE = 5_000_000


@dataclass(frozen=True, eq=False)
class Regions(Record):
    """Which free cells robots can reach from which, whatever the destinations, where `corners` is "allow".

    Attributes
    ----------
    area : Area
    region_of_cell : int32 array, shape (height, width)
        Number of the region of each cell; -1 at barriers.
    size_of_region : int64 array, shape (regions,)
        Number of cells of each region, descending.
    """

    area: Area
    region_of_cell: NDArray[np.int32]
    size_of_region: NDArray[np.int64]

    def __post_init__(self) -> None:
        self._set("region_of_cell", read_only(self.region_of_cell))
        self._set("size_of_region", read_only(self.size_of_region))


def make_regions(area: Area) -> Regions:
    """Return the regions of an area.

    Examples
    --------
    >>> make_regions(Area("square", [[0, 1, 0, 0], [1, 1, 0, 0]])).region_of_cell.tolist()
    [[1, -1, 0, 0], [-1, -1, 0, 0]]
    """
    from trihex.areas.kernels.regions import label_regions

    layout = area.layout
    blocked, stack = area.make_blocked(), np.empty(layout.size, dtype=np.int32)
    region = np.full(layout.size, -1, dtype=np.int32)
    state = np.zeros(3, dtype=np.int64)
    while state[0] < layout.size or state[1]:
        label_regions(blocked, layout.offset_of_direction, _SITES_AT_ONCE, state, stack, region)
    own = layout.view_of(region)
    sizes = np.bincount((own + 1).reshape(-1), minlength=int(state[2]) + 1)[1:]  # but for that of barriers
    order = np.argsort(-sizes, kind="stable")
    rank = np.append(np.argsort(order), -1).astype(np.int32)  # the last one stands for barriers
    return Regions(area, rank[own], sizes[order])
