"""Queues: what arrivals at the destinations in each step are worth, and whose they are, if robots meet nowhere else."""

from __future__ import annotations

from typing import Any, NamedTuple

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


class Queues(NamedTuple):
    """What arrivals are worth, and who has which."""

    price: NDArray[np.int64]  # by step and destination
    slot: NDArray[np.int64]  # of each robot, step * destinations + destination, or NONE


def share_arrivals(network: Network, cells: NDArray[np.int64], room: NDArray[np.int64]) -> Queues:
    """Return what arrivals cost beyond the way where robots share them out at the least cost, and who has which.

    Parameters
    ----------
    network : Network
    cells : ndarray of int64
        Node where each robot starts, in ascending order of value.
    room : ndarray of int64, shape (steps, destinations)
        How many may arrive when and where.

    Returns
    -------
    Queues
        Prices that prove that arrivals are shared out well; 0, and nobody has any, where that is too much work.
    """
    from trihex.optimum.kernels.residual import NONE

    if room.size * network.node_count > _MOST_NODES or cells.size * room.size**2 > _MOST_SLOTS:
        return Queues(np.zeros_like(room), np.full(cells.size, NONE))
    from trihex.optimum.kernels.queues import share_slot

    sharing = _make_sharing(_find_costs(network, cells, len(room)), room.reshape(-1))
    for robot in range(cells.size):
        share_slot(robot, sharing)
    slot = np.full(cells.size, NONE)
    for first in range(room.size):
        robot = sharing.first[first]
        while robot != NONE:
            slot[robot], robot = first, sharing.following[robot]
    return Queues(sharing.price.reshape(room.shape), slot)


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
