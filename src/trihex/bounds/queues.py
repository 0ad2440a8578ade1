"""Queues: least numbers of steps, delayed where robots must pass narrow places one after the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.cuts import Cut
from trihex.bounds.demand import Demand


def queue_past_cuts(demand: Demand, cuts: list[Cut], entries: int) -> NDArray[np.int64]:
    """Return a least number of steps of each robot in some order, if of those behind a cut only `width` pass it a step.

    Where a robot passes the cut it is known how soon it can arrive. So the numbers of steps of those behind the first
    cut are delayed until each occurs at most `width` times, then together with the next ones at the next cut.
    """
    from trihex.bounds.kernels import steps as kernels

    queued = demand.steps[:0]
    is_behind = np.zeros(demand.sites.size, dtype=bool)
    for cut in cuts:
        new = cut.behind[~is_behind[cut.behind]]
        is_behind[new] = True
        queued = np.sort(np.concatenate([queued, demand.steps[new]]))
        kernels.queue_up(queued, cut.width)
    queued = np.sort(np.concatenate([queued, demand.steps[~is_behind]]))
    kernels.queue_up(queued, max(entries, 1))
    return queued
