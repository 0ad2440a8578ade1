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

# Bytes for each node of a layer: two labels, flow, parent, two marks.
BYTES_PER_NODE = 12
# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 1_000_000
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
    layers: int | None = None,
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
    layers : int, optional
        Forbid arrivals after this step. Default: no limit.

    Raises
    ------
    TooLargeError
        If the layers would take more than `memory_limit`.
    """
    from trihex.kernels import flow as kernels

    nodes = network.node_count
    limit = _available_memory() * 4 // 5 if memory_limit is None else memory_limit
    start_of_robot = network.hops[cells].astype(np.int64) * nodes + cells
    capacity = network.scenario.destination_capacity
    count = layers + 1 if layers is not None else _least_layers(network, cells) + 8
    _check_memory(nodes, count, cells.size, limit)
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.FREE_ENTRY] = state[kernels.HIGHEST] = -1
    state[kernels.LOWEST] = 2 * count * nodes
    arrays: tuple[NDArray[Any], ...] = tuple(
        np.zeros(sides * count * nodes, dtype=dtype)
        for sides, dtype in ((2, np.int32), (1, np.uint8), (1, np.uint8), (2, np.uint16))
    )
    label, flow, parent, mark = arrays
    stack = np.empty(1 << 12, dtype=np.int64)
    entry_side, entry_next = np.empty(1 << 12, dtype=np.int64), np.empty(1 << 12, dtype=np.int64)
    due_first = np.full(kernels.WINDOW, -1, dtype=np.int64)
    trail = [np.empty(1 << 10, dtype=dtype) for dtype in (np.int64, np.int64, np.uint8, *[np.int64] * 6)]
    lacking = np.zeros(nodes, dtype=np.uint8)
    state[63]=int(os.environ.get('INF','10'))
    state[62]=int(os.environ.get('PEN','5'))
    away, queue = np.full(nodes, kernels.NOT_NEAR, dtype=np.int32), np.empty(20*nodes, dtype=np.int32)
    while True:
        status = kernels.search(
            network.first_destination,
            network.cell_count,
            255 if capacity is None else min(capacity, 255),
            layers is not None,
            network.out_arcs,
            network.in_arcs,
            network.hops,
            start_of_robot,
            network.value[cells].astype(np.int64),
            lacking,
            away,
            queue,
            label,
            flow,
            parent,
            mark,
            stack,
            due_first,
            entry_side,
            entry_next,
            *trail,
            state,
            _BUDGET,
        )
        if progress:
            progress(int(state[kernels.SERVED]), cells.size)
        if status == kernels.DONE:
            return Flow(network, start_of_robot, flow, int(state[kernels.TOTAL]) * network.unit)
        if status == kernels.STACK_FULL:
            stack = _grown(stack, stack.size + 2 * int(state[kernels.TRAIL]))
        elif status == kernels.ENTRIES_FULL:
            entry_side, entry_next = _grown(entry_side), _grown(entry_next)
        elif status == kernels.TRAIL_FULL:
            trail = [_grown(array) for array in trail]
        elif status == kernels.LAYERS_FULL:
            more = max(8, count // 2)
            _check_memory(nodes, count + more, cells.size, limit)
            count += more
            label, flow, parent, mark = (
                _grown(array, array.size // (count - more) * more) for array in (label, flow, parent, mark)
            )
        elif status == kernels.LEVELS_FULL:
            raise TooLargeError(
                "costs above 2^30 units for one robot cannot be searched; choose a smaller waiting_cost"
            )


def _grown(array: NDArray[Any], more: int = 0) -> NDArray[Any]:
    """Return a copy with room for twice as many entries, or `more`; the new ones are 0."""
    grown = np.zeros(array.size + (more or array.size), dtype=array.dtype)
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
