"""Flow: least-cost paths of robots through the layers of a network."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.memory import GIB, limit_or_default
from trihex.optimum.network import Network
from trihex.record import read_only

# Bytes for each node of a layer: flow and two bounds.
BYTES_PER_NODE = 9
# Small pieces of work between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the lists of the search at first.
_LIST = 1 << 12
# Robots get their paths singly if the destinations hold them up by less than this share of their distances.
_SELDOM = 0.03


@dataclass(eq=False)
class Flow:
    """Paths of robots through a network, one byte a node: see `trihex.optimum.kernels.levels`.

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
    return _serve(network, cells, True, progress, memory_limit) if _meet_seldom(network, cells) else None


def make_flow_by_levels(
    network: Network,
    cells: NDArray[np.int64],
    *,
    progress: Callable[[int, int], None] | None = None,
    memory_limit: int | None = None,
) -> Flow:
    """Find paths of least total cost in order of cost; for parameters and errors see `make_flow_singly`."""
    flow = _serve(network, cells, False, progress, memory_limit)
    assert flow is not None, "only those who are served singly are given up"
    return flow


def _serve(
    network: Network,
    cells: NDArray[np.int64],
    singly: bool,
    progress: Callable[[int, int], None] | None,
    memory_limit: int | None,
) -> Flow | None:
    """Find the paths one robot after another, or None if they meet too often for that; else in order of cost."""
    from trihex.optimum.kernels import levels as crowd, residual as kernels, single

    size = network.node_count
    layers = _least_layers(network, cells) + 8
    limit = limit_or_default(memory_limit)
    check_memory(network, cells, layers, layers * size * BYTES_PER_NODE, limit)
    layer = _make_layer(network)
    nodes = kernels.Nodes(*(np.zeros(layers * size, dtype) for dtype in (np.uint8, np.int32, np.int32)))
    back, ahead = (_make_search(_LIST) for _ in range(2))
    lacks = np.zeros(size, dtype=np.uint8)
    lacks[cells] = 1
    ends = kernels.Ends(
        read_only(network.hops[cells].astype(np.int64) * size + cells),
        read_only(network.value[cells].astype(np.int64)),
        lacks,
        np.empty(layers * (size - network.first_destination), dtype=np.int64),
        np.zeros(size, dtype=np.int32),
        np.empty(size, dtype=np.int32),
    )
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.LEVEL] = -1
    state[kernels.SIDE] = crowd.AHEAD
    # There is a quicker way to go on where steps cost the same.
    patience = 1 / 16 if network.has_equal_steps else 1
    while True:
        if singly:
            status = single.serve_singly(layer, nodes, ahead, ends, state, _BUDGET)
        else:
            status = crowd.search(layer, nodes, back, ahead, ends, state, _BUDGET)
        if progress:
            progress(int(state[kernels.SERVED]), cells.size)
        if status == kernels.DONE:
            return Flow(network, ends.start, nodes.flow, int(state[kernels.TOTAL]) * network.unit)
        # Nodes visited for one robot, and for all.
        one, every = int(state[kernels.SPENT]), int(state[kernels.VISITS])
        if singly and (one > patience * nodes.flow.size or every > 4 * nodes.flow.size):
            return None
        if status == kernels.LIST_FULL:
            needed = int(state[kernels.OPEN_GOALS])
            log_bytes = max(back.log.nbytes, ahead.log.nbytes)
            check_memory(network, cells, layers, layers * size * BYTES_PER_NODE + 3 * log_bytes, limit)
            back, ahead = _with_room(back, needed), _with_room(ahead, 0)
        elif status == kernels.LAYERS_FULL:
            more = max(8, layers // 2)
            check_memory(network, cells, layers + more, (layers + more) * size * BYTES_PER_NODE, limit)
            nodes = kernels.Nodes(*(_grown(array, array.size // layers * more) for array in nodes))
            ends = ends._replace(goals=_grown(ends.goals, ends.goals.size // layers * more))
            layers += more
        elif status == kernels.LEVELS_FULL:
            raise TooLargeError(
                f"costs above {kernels.MOST_LEVEL} units for a robot cannot be searched; choose a smaller waiting_cost"
            )


def _make_layer(network: Network) -> Any:
    from trihex.optimum.kernels import residual as kernels

    capacity = network.scenario.destination_capacity
    return kernels.Layer(
        network.out_arcs,
        network.in_arcs,
        network.hops,
        network.order,
        network.is_vertex,
        network.first_destination,
        255 if capacity is None else min(capacity, 255),
        network.base,
        int(np.gcd.reduce(network.out_arcs[:, :, 3], axis=None)) or kernels.MARK,
    )


def _make_search(length: int) -> Any:
    from trihex.optimum.kernels import residual as kernels

    state = np.zeros(kernels.SEARCH_STATE_SIZE, dtype=np.int64)
    state[kernels.CURRENT], state[kernels.SHORT] = kernels.NONE, kernels.MARK
    return kernels.Search(np.empty((length, 8), dtype=np.int64), state, np.empty(kernels.LISTS, dtype=np.int64))


def _with_room(search: Any, needed: int) -> Any:
    """Return a search with a longer log if that is nearly full, or shorter than is `needed`."""
    from trihex.optimum.kernels import residual as kernels

    if 2 * max(search.state[kernels.LOGGED], needed) < len(search.log):
        return search
    return search._replace(log=np.concatenate([search.log, np.empty_like(search.log)]))


def _meet_seldom(network: Network, cells: NDArray[np.int64]) -> bool:
    """Tell whether robots are hardly held up at the destinations, in each step of which so many arrive and no more."""
    distance = network.value[cells].astype(np.int64)
    index = np.arange(cells.size)
    doors = _doors(network)
    # The latest of the slots that robots before may have taken; robots are in ascending order of value.
    arrival = np.maximum.accumulate(distance // network.base - index // doors) + index // doors
    held_up = int(np.maximum(arrival * network.base - distance, 0).sum())
    return held_up < _SELDOM * int(distance.sum())


def _doors(network: Network) -> int:
    """Return how many robots can arrive in a step, at most."""
    return max(1, int(network.room.sum()))


def _grown(array: NDArray[Any], more: int) -> NDArray[Any]:
    """Return a copy with room for `more` entries; the new ones are 0."""
    grown = np.zeros(array.size + more, dtype=array.dtype)
    grown[: array.size] = array
    return grown


def _least_layers(network: Network, cells: NDArray[np.int64]) -> int:
    """Return a lower bound on the last arrival: so many robots enter the destinations in a step and no more."""
    hops = np.sort(network.hops[cells])
    behind = np.arange(cells.size)[::-1]
    return int((hops + behind // _doors(network)).max(initial=0)) + 1


def check_memory(network: Network, cells: NDArray[np.int64], layers: int, need: int, limit: int) -> None:
    """Refuse what needs more bytes than the limit."""
    if need > limit:
        raise TooLargeError(
            f"the optimum for {cells.size} robots needs at least {need / GIB:.1f} GiB ({layers} steps of "
            f"{network.node_count} cells and vertices), more than memory_limit, {limit / GIB:.1f} GiB; plan fewer "
            f"robots, a smaller area, or use planner 'fcost' and a lower bound"
        )
