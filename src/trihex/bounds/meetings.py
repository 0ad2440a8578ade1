"""Meetings: the nodes where most shortest ways come together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.demand import Demand


def find_meeting_nodes(demand: Demand, most: int, most_looks: int = 3_000_000) -> NDArray[np.int32]:
    """Return up to `most` nodes where most robots meet if all take some shortest way without regard to the others.

    If that took more than about `most_looks` steps, evenly chosen robots stand for all.
    """
    from trihex.bounds.kernels import meetings as kernels

    every = int(demand.steps.sum()) // most_looks + 1
    sites = np.ascontiguousarray(demand.sites[::every])
    seen, meetings = np.zeros((2, demand.nodes.count), dtype=np.int64)
    site, moving = np.empty(sites.size, dtype=np.int32), np.empty(sites.size, dtype=bool)
    pedestrians = kernels.Pedestrians(site=site, moving=moving, seen=seen, meetings=meetings)
    kernels.count_meetings(sites, demand.nodes.graph, pedestrians)
    met = np.flatnonzero(meetings)
    return met[np.lexsort((met, -meetings[met]))][:most].astype(np.int32)
