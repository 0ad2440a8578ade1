"""Queues: least numbers of steps, delayed where robots must pass narrow places one after the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.cuts import Cut
from trihex.bounds.demand import Demand
from trihex.bounds.rhythm import queue_up


def queue_past_cuts(demand: Demand, cuts: list[Cut], entries: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return a least number of steps of each robot in some order, if those behind a cut have to pass it one by one.

    Where a robot passes the cut it is known how soon it can arrive. So the numbers of steps of those behind the first
    cut are delayed until they are as far apart as the headways ask for, then together with the next ones at the next.
    """
    queued = demand.steps[:0]
    is_behind = np.zeros(demand.sites.size, dtype=bool)
    for cut in cuts:
        new = cut.behind[~is_behind[cut.behind]]
        is_behind[new] = True
        queued = np.sort(np.concatenate([queued, demand.steps[new]]))
        queue_up(queued, demand.nodes.queue_headways(cut.nodes))
    queued = np.sort(np.concatenate([queued, demand.steps[~is_behind]]))
    queue_up(queued, entries)
    return queued
