"""Flow: least-cost paths of robots through the layers of a network."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.planners.network import Network
from trihex.record import read_only

# Bytes for each node of a layer: flow and two bounds.
BYTES_PER_NODE = 9
# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the lists of the search at first.
_LIST = 1 << 12
_GIB = 1 << 30


@dataclass(eq=False)
class Flow:
    """Paths of robots through a network, one byte a node: see `trihex.kernels.flow`.

    Parameters
    ----------
    network : Network
    start_of_robot : ndarray of int64
        Index of each robot's node at step 0, in the order in which they were served.
    flow : ndarray of uint8, shape (layers * nodes,)
    total : int
        Least sum of costs, in the unit of the cost table.
    """

    network: Network
    start_of_robot: NDArray[np.int64]
    flow: NDArray[np.uint8]
    total: int


def make_flow(
    network: Network,
    cells: NDArray[np.int64],
    *,
    progress: Callable[[int, int], None] | None = None,
    memory_limit: int | None = None,
) -> Flow:
    """Find paths of least total cost for robots that start in `cells`, nodes of the network.

    Parameters
    ----------
    network : Network
    cells : ndarray of int64
        In ascending order of value.
    progress : callable, optional
        Called with (robots with a path, robots).
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Raises
    ------
    TooLargeError
        If the layers would take more than `memory_limit`.
    """
    from trihex.kernels import flow as kernels
    from trihex.kernels import flow_search as searches

    size = network.node_count
    limit = _available_memory() * 4 // 5 if memory_limit is None else memory_limit
    capacity = network.scenario.destination_capacity
    layers = _least_layers(network, cells) + 8
    _check_memory(size, layers, cells.size, limit)
    is_vertex = (np.arange(size) >= network.cell_count) & (np.arange(size) < network.first_destination)
    layer = searches.Layer(
        network.out_arcs,
        network.in_arcs,
        network.hops,
        read_only(np.lexsort((is_vertex, -network.hops)).astype(np.int32)),
        read_only(is_vertex),
        network.first_destination,
        255 if capacity is None else min(capacity, 255),
        network.base,
        int(np.gcd.reduce(network.out_arcs[:, :, 3], axis=None)) or searches.MARK,
    )
    nodes = searches.Nodes(*(np.zeros(layers * size, dtype) for dtype in (np.uint8, np.int32, np.int32)))
    back, ahead = (
        searches.Search(
            np.empty((_LIST, 8), dtype=np.int64), np.array([0, searches.NONE, 0, searches.MARK], dtype=np.int64)
        )
        for _ in range(2)
    )
    lacks = np.zeros(size, dtype=np.uint8)
    lacks[cells] = 1
    ends = searches.Ends(
        read_only(network.hops[cells].astype(np.int64) * size + cells),
        read_only(network.value[cells].astype(np.int64)),
        lacks,
        np.empty(layers * (size - network.first_destination), dtype=np.int64),
        np.zeros(size, dtype=np.int32),
        np.empty(size, dtype=np.int32),
    )
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.LEVEL] = -1
    state[kernels.SIDE] = kernels.AHEAD
    while True:
        status = kernels.search(layer, nodes, back, ahead, ends, state, _BUDGET)
        if progress:
            progress(int(state[kernels.SERVED]), cells.size)
        if status == kernels.DONE:
            return Flow(network, ends.start, nodes.flow, int(state[kernels.TOTAL]) * network.unit)
        if status == searches.LIST_FULL:
            back, ahead = _with_room(back), _with_room(ahead)
        elif status == kernels.LAYERS_FULL:
            more = max(8, layers // 2)
            _check_memory(size, layers + more, cells.size, limit)
            nodes = searches.Nodes(*(_grown(array, array.size // layers * more) for array in nodes))
            ends = ends._replace(goals=_grown(ends.goals, ends.goals.size // layers * more))
            layers += more
        elif status == kernels.LEVELS_FULL:
            raise TooLargeError(
                "costs above 2^29 units for one robot cannot be searched; choose a smaller waiting_cost"
            )


def _with_room(search: Any) -> Any:
    """Return a search with a longer log if that is full."""
    from trihex.kernels import flow_search as searches

    if search.state[searches.LOGGED] < len(search.log):
        return search
    log = np.empty((2 * len(search.log), search.log.shape[1]), dtype=np.int64)
    log[: len(search.log)] = search.log
    return search._replace(log=log)


def _grown(array: NDArray[Any], more: int) -> NDArray[Any]:
    """Return a copy with room for `more` entries; the new ones are 0."""
    grown = np.zeros(array.size + more, dtype=array.dtype)
    grown[: array.size] = array
    return grown


def _least_layers(network: Network, cells: NDArray[np.int64]) -> int:
    """Return a lower bound on the last arrival: so many robots enter the destinations in a step and no more."""
    arcs = np.count_nonzero(network.in_arcs[network.first_destination :, :, 0], axis=1)
    doors = int(np.minimum(arcs, network.scenario.destination_capacity or arcs).sum())
    hops = np.sort(network.hops[cells])
    behind = np.arange(cells.size)[::-1]
    return int((hops + behind // max(doors, 1)).max(initial=0)) + 1


def _check_memory(nodes: int, layers: int, robots: int, limit: int) -> None:
    need = nodes * layers * BYTES_PER_NODE
    if need > limit:
        raise TooLargeError(
            f"the optimum for {robots} robots needs at least {need / _GIB:.1f} GiB ({layers} steps of {nodes} cells "
            f"and vertices), more than memory_limit, {limit / _GIB:.1f} GiB; plan fewer robots, a smaller area, "
            f"or use planner 'fcost' and a lower bound"
        )


def _available_memory() -> int:
    """Return the bytes of memory that could be used now, or 8 GiB where the system does not tell."""
    try:
        with open("/proc/meminfo") as lines:
            for line in lines:
                if line.startswith("MemAvailable:"):
                    return int(line.split()[1]) * 1024
    except OSError:
        pass
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return 8 * _GIB
