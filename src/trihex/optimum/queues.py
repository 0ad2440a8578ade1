"""Queues: what arrivals at the destinations in each step are worth, as if robots met nowhere else."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.optimum.network import Network
from trihex.optimum.workspace import layer_of

# Prices are left out where it would take more looks at nodes, or at slots, than this: some 10 s.
_MOST_NODES, _MOST_SLOTS = 1 << 29, 1 << 33


def price_arrivals(network: Network, cells: NDArray[np.int64], steps: int) -> NDArray[np.int64]:
    """Return what arrivals cost beyond the way, by step and destination, where all share them out at the least cost.

    Parameters
    ----------
    network : Network
    cells : ndarray of int64
        Node where each robot starts, in ascending order of value.
    steps : int
        All arrive before this step.

    Returns
    -------
    ndarray of int64, shape (steps, destinations)
        The least prices that prove that the arrivals are shared out well; 0 where that is too much work.
    """
    goals = network.node_count - network.first_destination
    slots = steps * goals
    if slots * network.node_count > _MOST_NODES or cells.size * slots**2 > _MOST_SLOTS:
        return np.zeros((steps, goals), dtype=np.int64)
    sharing = _make_sharing(network, _find_costs(network, cells, steps), steps)
    from trihex.optimum.kernels.queues import share_slot

    for robot in range(cells.size):
        share_slot(robot, sharing)
    return sharing.price.reshape(steps, goals)


def _find_costs(network: Network, cells: NDArray[np.int64], steps: int) -> NDArray[np.int32]:
    """Return what each robot pays beyond its value for each arrival, by step and destination."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import queues as kernels
    from trihex.optimum.kernels.residual import ROWS

    goals = range(network.first_destination, network.node_count)
    ways = given(kernels.SlotWays, order=network.order, hops=network.hops, cells=cells)
    costs = np.full((cells.size, steps * len(goals)), kernels.NEVER, dtype=np.int32)
    layers = np.empty((int(network.out_arcs[:, :, ROWS].max(initial=0)) + 1, network.node_count), dtype=np.int32)
    for goal in goals:
        for late in range(steps - int(network.hops[cells].min(initial=steps))):
            kernels.find_costs(layer_of(network), ways, goal, layers, costs, late)
    return costs


def _make_sharing(network: Network, costs: NDArray[np.int32], steps: int) -> Any:
    """Return all slots, still open."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import queues as kernels

    robots, slots = costs.shape
    return given(
        kernels.Sharing,
        costs=costs,
        room=np.tile(network.room, steps),
        price=np.zeros(slots, dtype=np.int64),
        taken=np.zeros(slots, dtype=np.int64),
        first=np.full(slots, kernels.NONE),
        following=np.full(robots, kernels.NONE),
        least=np.empty(slots, dtype=np.int64),
        robot=np.empty(slots, dtype=np.int64),
        before=np.empty(slots, dtype=np.int64),
        done=np.empty(slots, dtype=np.bool_),
    )
