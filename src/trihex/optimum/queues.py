"""Queues: what arrivals at the destinations are worth, as if robots met nowhere else."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.optimum.network import Network


def price_arrivals(network: Network, cells: NDArray[np.int64], layers: int) -> NDArray[np.int64]:
    """Return what arrivals cost beyond the way there, by step and destination.

    Robots share them out at the least sum of costs. What they cost is their price in this smaller problem.
    """
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import queues as kernels
    from trihex.optimum.workspace import layer_of

    goals = range(network.first_destination, network.node_count)
    hops = network.hops[cells]
    ways = given(kernels.Ways, order=network.order, hops=network.hops, cells=cells)
    ring = np.empty((int(network.out_arcs[:, :, 5].max(initial=0)) + 1, network.node_count), dtype=np.int32)
    costs = np.full((cells.size, layers, len(goals)), kernels.NEVER, dtype=np.int32)
    late = np.empty((cells.size, layers - int(hops.min())), dtype=np.int32)
    for goal in goals:
        kernels.find_costs(layer_of(network), ways, goal, ring, late)
        for robot, first in enumerate(hops):
            costs[robot, first:, goal - goals[0]] = late[robot, : layers - first]
    costs = costs.reshape(cells.size, -1)
    count = costs.shape[1]
    slots = given(
        kernels.Slots,
        np.tile(network.room, layers), np.zeros(count, np.int64), np.zeros(count, np.int64),
        np.full(cells.size, kernels.NONE), np.full(count, kernels.NONE), np.full(cells.size, kernels.NONE),
        np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count, np.uint8),
    )
    kernels.share_slots(costs, slots)
    return slots.price.reshape(layers, -1), slots.taken.reshape(layers, -1)
