"""Doors: in which layers of a network a door lets nobody in, and how many fewer than others a destination does."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.optimum.network import Network

Ints = NDArray[np.int64]


class ShutNodes(NamedTuple):
    """Where doors keep robots out.

    Neither needs a word in the kernels: nobody enters a gate that has the mark of a start, or is dead, and in a
    destination stand as many who have arrived already as the door lets in fewer.
    """

    gates: Ints  # indices of gates that are shut
    slots: Ints  # indices of the destinations of each layer that let in fewer than `most`
    missing: Ints  # by how many fewer


def find_shut_nodes(network: Network, most: int | Ints, first: int, last: int) -> ShutNodes:
    """Return where doors keep robots out in the layers from `first` to before `last`.

    Parameters
    ----------
    network : Network
    most : int or int64 array
        How many robots get into each destination in a step where no door keeps them out.
    first, last : int
    """
    nothing = np.empty(0, dtype=np.int64)
    if not network.scenario.has_flows:
        return ShutNodes(nothing, nothing, nothing)
    layer, schedule = np.arange(first, last), network.scenario.schedule
    nodes = network.node_of_site[network.scenario.area.layout.cell_to_site(schedule.cells)].astype(np.int64)
    gate = np.flatnonzero((nodes >= 0) & (nodes < network.cell_count))
    # Whoever is in a gate enters in the step after.
    step = layer[:, None] - network.hops[network.gate_of_node[nodes[gate]]] + 1
    shut, door = np.nonzero((schedule.openings_at(gate, step) == 0) & (step > 0))
    gates = layer[shut] * network.node_count + network.gate_of_node[nodes[gate]][door]

    goal = np.flatnonzero(nodes >= network.first_destination)
    limit = np.broadcast_to(most, network.node_count - network.first_destination)
    room = limit[nodes[goal] - network.first_destination]
    missing = np.maximum(room - schedule.openings_at(goal, np.broadcast_to(layer[:, None], (layer.size, goal.size))), 0)
    fewer, end = np.nonzero(missing)
    return ShutNodes(gates, layer[fewer] * network.node_count + nodes[goal][end], missing[fewer, end])


def shut_doors(network: Network, flow: NDArray[np.uint8], first: int) -> None:
    """Write into the flow of all layers from `first` on where doors keep robots out."""
    from trihex.optimum.kernels.flow_byte import START

    shut = find_shut_nodes(network, network.capacity, first, flow.size // network.node_count)
    flow[shut.gates] = START << 4 | 15  # as no robot has it that starts
    flow[shut.slots] = shut.missing
