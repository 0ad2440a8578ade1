"""Queues: what arrivals at the destinations in each step are worth, as if robots met nowhere else."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.optimum.doors import find_shut_nodes
from trihex.optimum.network import Network
from trihex.optimum.workspace import layer_of

# Prices are left out where it would take more looks at nodes, or at slots, than this: some 10 s.
_MOST_NODES, _MOST_SLOTS = 1 << 29, 1 << 33


def room_of_slots(network: Network, steps: int) -> NDArray[np.int64]:
    """Return how many robots get into each destination in each step before `steps`, by step and destination."""
    room = np.tile(network.room, (steps, 1))
    shut = find_shut_nodes(network, network.room, 0, steps)
    layer, node = np.divmod(shut.slots, network.node_count)
    room[layer, node - network.first_destination] -= shut.missing
    return room


def price_arrivals(network: Network, cells: NDArray[np.int64], room: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return what arrivals cost beyond the way where robots share them out at the least cost.

    Parameters
    ----------
    network : Network
    cells : ndarray of int64
        Node where each robot starts, in ascending order of value.
    room : ndarray of int64, shape (steps, destinations)
        How many may arrive when and where.

    Returns
    -------
    ndarray of int64, shape (steps, destinations)
        Prices that prove that arrivals are shared out well; 0 where that is too much work.
    """
    if room.size * network.node_count > _MOST_NODES or cells.size * room.size**2 > _MOST_SLOTS:
        return np.zeros_like(room)
    from trihex.optimum.kernels.queues import share_slot

    sharing = _make_sharing(_find_costs(network, cells, len(room)), room.reshape(-1))
    for robot in range(cells.size):
        share_slot(robot, sharing)
    prices: NDArray[np.int64] = sharing.price
    return prices.reshape(room.shape)


def _find_costs(network: Network, cells: NDArray[np.int64], steps: int) -> NDArray[np.int32]:
    """Return what each robot pays beyond its value for each arrival before `steps`."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import queues as kernels
    from trihex.optimum.kernels.residual import ROWS

    goals = range(network.first_destination, network.node_count)
    earliest = network.hops[cells] + network.start_time[cells]
    ways = given(kernels.SlotWays, order=network.order, cells=cells, earliest=earliest)
    costs = np.full((cells.size, steps * len(goals)), kernels.NEVER, dtype=np.int32)
    layers = np.empty((int(network.out_arcs[:, :, ROWS].max(initial=0)) + 1, network.node_count), dtype=np.int32)
    for goal in goals:
        for late in range(steps - int(earliest.min(initial=steps))):
            kernels.find_costs(layer_of(network), ways, goal, layers, costs, late)
    return costs


def _make_sharing(costs: NDArray[np.int32], room: NDArray[np.int64]) -> Any:
    """Return all slots, still open."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import queues as kernels
    from trihex.optimum.kernels.residual import NONE

    robots, slots = costs.shape
    return given(
        kernels.Sharing,
        costs=costs,
        room=room,
        price=np.zeros(slots, dtype=np.int64),
        taken=np.zeros(slots, dtype=np.int64),
        first=np.full(slots, NONE),
        following=np.full(robots, NONE),
        least=np.empty(slots, dtype=np.int64),
        robot=np.empty(slots, dtype=np.int64),
        before=np.empty(slots, dtype=np.int64),
        done=np.empty(slots, dtype=np.bool_),
    )
