"""Flow: least-cost paths of robots through the layers of a network."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.optimum.network import Network
from trihex.optimum.workspace import Workspace, most_entries

# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Robots get their paths singly if the destinations hold them up by less than this share of their distances.
_SELDOM = 0.03


@dataclass(eq=False)
class Flow:
    """Paths of robots through a network, one byte a node: see `trihex.optimum.kernels.flow_byte`.

    Parameters
    ----------
    network : Network
    start_of_robot : ndarray of int64
        Index of each robot's node at step 0, or when it may go, in the order in which they were served.
    flow : ndarray of uint8, shape (layers * nodes,)
    total : int
        Least sum of costs from when robots may go, in the unit of the cost table.
    """

    network: Network
    start_of_robot: NDArray[np.int64]
    flow: NDArray[np.uint8]
    total: int


def make_flow_singly(
    network: Network,
    cells: NDArray[np.int64],
    *,
    progress: Callable[[int, int], None] | None = None,
    memory_limit: int | None = None,
) -> Flow | None:
    """Find paths of least total cost for robots that start in `cells`, one after another, if they seldom meet.

    Parameters
    ----------
    network : Network
    cells : ndarray of int64
        Nodes, in ascending order of value.
    progress : callable, optional
        Called with (robots with a path, robots).
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Returns
    -------
    Flow or None
        None if they meet too often for that.

    Raises
    ------
    TooLargeError
        If the layers would take more than `memory_limit`.
    """
    if not _meet_seldom(network, cells):
        return None
    from trihex.optimum.kernels.residual import DONE, SPENT, VISITS
    from trihex.optimum.kernels.single import serve_singly

    work = Workspace(network, cells, memory_limit)
    # There is a quicker way to go on where steps cost the same.
    patience = 1 / 16 if network.has_equal_steps else 1
    while True:
        status = serve_singly(work.layer, work.nodes, work.search, work.ends, work.state, _BUDGET)
        _tell(progress, work)
        if status == DONE:
            return _flow_of(work)
        one_robot, every_robot, size = int(work.state[SPENT]), int(work.state[VISITS]), work.nodes.flow.size
        if one_robot > patience * size or every_robot > 4 * size:
            return None
        work.make_room(status)


def _tell(progress: Callable[[int, int], None] | None, work: Workspace) -> None:
    from trihex.optimum.kernels.residual import SERVED

    if progress:
        progress(int(work.state[SERVED]), work.cells.size)


def _flow_of(work: Workspace) -> Flow:
    from trihex.optimum.kernels.residual import TOTAL

    return Flow(work.network, work.ends.start, work.nodes.flow, int(work.state[TOTAL]) * work.network.unit)


def _meet_seldom(network: Network, cells: NDArray[np.int64]) -> bool:
    """Tell whether robots are hardly held up at the destinations, in each step of which so many arrive and no more."""
    distance = np.sort(network.value[cells] + network.base * network.start_time[cells])
    index = np.arange(cells.size)
    entries = most_entries(network)
    # The latest of the slots that robots before may have taken; robots are in ascending order of value.
    arrival = np.maximum.accumulate(distance // network.base - index // entries) + index // entries
    held_up = int(np.maximum(arrival * network.base - distance, 0).sum())
    return held_up < _SELDOM * int(distance.sum())
