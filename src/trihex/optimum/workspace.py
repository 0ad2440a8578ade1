"""Workspace: what searches for a flow work on; it grows as they need room."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.memory import GIB, limit_or_default
from trihex.optimum.network import Network

# Bytes for each node of a layer: flow and two bounds.
_BYTES_PER_NODE = 9
# Length of the logs of the searches at first.
_LOG = 1 << 12
# How many robots may arrive in a step where there is no limit; more neighbours no destination has.
_ANY_NUMBER = 255
# Layers beyond the last that is needed whatever the robots do.
_SPARE_LAYERS = 8


class Workspace:
    """Layers, logs and state of the searches for paths of robots that start in `cells`, in ascending order of value.

    Its parts are tuples for the kernels, see `trihex.optimum.kernels.residual`.

    Parameters
    ----------
    network : Network
    cells : ndarray of int64
        Node where each robot starts.
    layers : int
        How many are needed at least.
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.
    """

    def __init__(self, network: Network, cells: NDArray[np.int64], layers: int, memory_limit: int | None) -> None:
        from trihex.optimum.kernels import levels, residual as kernels

        self.network, self.cells = network, cells
        self.limit = limit_or_default(memory_limit)
        self.layers = layers + _SPARE_LAYERS
        self._check_memory(self.layers)
        size = self.layers * network.node_count
        self.layer = _make_layer(network)
        self.nodes = kernels.FlowNodes(*(np.zeros(size, dtype) for dtype in (np.uint8, np.int32, np.int32)))
        self.back, self.ahead = (_make_search(_LOG) for _ in range(2))
        self.ends = _make_ends(network, cells, self.layers)
        self.state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        self.state[kernels.LEVEL] = kernels.NONE
        self.state[kernels.SIDE] = levels.AHEAD

    def make_room(self, status: int) -> None:
        """Make room for what a search ended for; refuse it if there is none."""
        from trihex.optimum.kernels import residual as kernels

        if status == kernels.LIST_FULL:
            needed = int(self.state[kernels.OPEN_GOALS])
            self._check_memory(self.layers, 3 * max(self.back.log.nbytes, self.ahead.log.nbytes))
            self.back, self.ahead = _with_room(self.back, needed), _with_room(self.ahead, 0)
        elif status == kernels.LAYERS_FULL:
            more = max(8, self.layers // 2)
            self._check_memory(self.layers + more)
            self.nodes = kernels.FlowNodes(*(_longer(array, array.size // self.layers * more) for array in self.nodes))
            goals = self.ends.goals
            self.ends = self.ends._replace(goals=_longer(goals, goals.size // self.layers * more))
            self.layers += more
        elif status == kernels.LEVELS_FULL:
            raise TooLargeError(
                f"costs above {kernels.MOST_LEVEL} units for a robot cannot be searched; choose a smaller waiting_cost"
            )

    def _check_memory(self, layers: int, log_bytes: int = 0) -> None:
        need = layers * self.network.node_count * _BYTES_PER_NODE + log_bytes
        check_memory(self.network, self.cells, layers, need, self.limit)


def check_memory(network: Network, cells: NDArray[np.int64], layers: int, need: int, limit: int) -> None:
    """Refuse what needs more bytes than the limit."""
    if need > limit:
        raise TooLargeError(
            f"the optimum for {cells.size} robots needs at least {need / GIB:.1f} GiB ({layers} steps of "
            f"{network.node_count} cells and vertices), more than memory_limit, {limit / GIB:.1f} GiB; plan fewer "
            f"robots, a smaller area, or use planner 'fcost' and a lower bound"
        )


def _make_layer(network: Network) -> Any:
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import residual as kernels

    return given(
        kernels.Layer,
        out=network.out_arcs,
        into=network.in_arcs,
        hops=network.hops,
        order=network.order,
        is_vertex=network.is_vertex,
        first_goal=network.first_destination,
        capacity=min(network.scenario.entry_limit or _ANY_NUMBER, _ANY_NUMBER),
        base=network.base,
        grain=int(np.gcd.reduce(network.out_arcs[:, :, kernels.EXTRA], axis=None)) or kernels.MARK,
    )


def _make_search(length: int) -> Any:
    from trihex.optimum.kernels import residual as kernels

    state = np.zeros(kernels.SEARCH_STATE_SIZE, dtype=np.int64)
    state[kernels.CURRENT], state[kernels.SHORT] = kernels.NONE, kernels.MARK
    log, heads = np.empty((length, kernels.LOG_COLUMNS), dtype=np.int64), np.empty(kernels.LISTS, dtype=np.int64)
    return kernels.FlowSearch(log, state, heads)


def _make_ends(network: Network, cells: NDArray[np.int64], layers: int) -> Any:
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import residual as kernels

    size = network.node_count
    lacks = np.zeros(size, dtype=np.uint8)
    lacks[cells] = 1
    return given(
        kernels.FlowEnds,
        start=network.hops[cells].astype(np.int64) * size + cells,
        value=network.value[cells].astype(np.int64),
        lacks=lacks,
        goals=np.empty(layers * (size - network.first_destination), dtype=np.int64),
        away=np.zeros(size, dtype=np.int32),
        queue=np.empty(size, dtype=np.int32),
    )


def _with_room(search: Any, needed: int) -> Any:
    """Return a search with a longer log if that is nearly full, or shorter than is `needed`."""
    from trihex.optimum.kernels import residual as kernels

    if 2 * max(search.state[kernels.LOGGED], needed) < len(search.log):
        return search
    return search._replace(log=np.concatenate([search.log, np.empty_like(search.log)]))


def _longer(array: NDArray[Any], more: int) -> NDArray[Any]:
    """Return a copy with room for `more` entries; the new ones are 0."""
    longer = np.zeros(array.size + more, dtype=array.dtype)
    longer[: array.size] = array
    return longer
