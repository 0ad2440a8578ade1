"""Priced flow: the flow of least cost where robots crowd and moves differ in cost, from prices of arrivals."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.memory import limit_or_default
from trihex.optimum.doors import shut_doors
from trihex.optimum.flow import Flow
from trihex.optimum.network import Network
from trihex.optimum.queues import room_of_slots, share_arrivals
from trihex.optimum.workspace import (
    SPARE_LAYERS,
    check_memory,
    held_nodes,
    layer_of,
    least_layers,
    longer,
    start_nodes,
)

# Bytes for each node of a layer: flow and two prices.
_BYTES_PER_NODE = 9
# Sides of nodes that are seen between two looks at the keyboard: some 0.1 s.
_BUDGET = 500_000
# Length of the lists at first.
_LIST = 1 << 16
# For how many units to come it is told apart what is tight when, at most and at first.
_RISES, _AHEAD = 1 << 12, 16
# By how many of the least costs of a step arrivals are cheaper than if robots met nowhere else. What is too cheap is
# soon mended, what is too dear takes a search for everybody who does not come.
_REBATE = 1

# How many nodes are looked at for a robot that goes to its place in the queue.
_PATIENCE = 1 << 15


def make_flow_at_prices(
    network: Network,
    cells: NDArray[np.int64],
    *,
    progress: Callable[[int, int], None] | None = None,
    memory_limit: int | None = None,
) -> Flow:
    """Find paths of least total cost; for parameters and errors see `trihex.optimum.make_flow_singly`."""
    from trihex.optimum.kernels.prices import NEVER

    # Tolls only save time: prices that begin at 0 are fair whatever they may have been.
    for begins_with_tolls in (True, False):
        work = _PricedWork(network, cells, memory_limit)
        if work.find_paths(begins_with_tolls, progress):
            return work.flow()
    raise TooLargeError(f"costs above {NEVER} units for a robot cannot be searched; choose a smaller waiting_cost")


class _PricedWork:
    """What prices and paths are found in; it grows as they need room.

    Its parts are tuples for the kernels, see `trihex.optimum.kernels.prices`.
    """

    def __init__(self, network: Network, cells: NDArray[np.int64], memory_limit: int | None) -> None:
        from trihex.optimum.kernels import prices as kernels
        from trihex.optimum.kernels.flow_byte import START

        self.network, self.cells = network, cells
        self.limit = limit_or_default(memory_limit)
        self.layers = least_layers(network, cells) + SPARE_LAYERS
        self._check_memory(self.layers)
        size = self.layers * network.node_count
        self.graph = _slim(layer_of(network))
        self.nodes = kernels.PricedNodes(*(np.zeros(size, dtype) for dtype in (np.uint8, np.int32, np.int32)))
        self.search = _make_search(start_nodes(network, cells))
        self.nodes.flow[self.search.start] = START << 4
        self.nodes.flow[held_nodes(network, cells)] = START << 4
        self.nodes.leaving[self.search.start] = kernels.RISES
        self._open_layers(0)

    def find_paths(self, begins_with_tolls: bool, progress: Callable[[int, int], None] | None) -> bool:
        """Find the paths of all robots; return whether there are any at prices that can be written."""
        from trihex.optimum.kernels.lowering import lower_prices
        from trihex.optimum.kernels.prices import SERVED
        from trihex.optimum.kernels.residual import DONE, EXHAUSTED
        from trihex.optimum.kernels.serving import serve_at_prices

        wanted = self.lay_tolls() if begins_with_tolls else np.zeros(0, dtype=np.int64)
        status = None
        while status not in (DONE, EXHAUSTED):
            status = serve_at_prices(self.graph, self.nodes, self.search, _BUDGET)
            if progress:
                progress(int(self.search.state[SERVED]), self.cells.size)
            self.make_room(status)
        while status != EXHAUSTED:
            status = lower_prices(wanted, self.graph, self.nodes, self.search)
            if status == DONE:
                return True
            self.make_room(status)
        return False

    def flow(self) -> Flow:
        """Return the flow that was found."""
        from trihex.optimum.kernels.prices import TOTAL

        network, search = self.network, self.search
        total = int(search.state[TOTAL]) + int(network.value[self.cells].sum(dtype=np.int64))
        return Flow(network, search.start, self.nodes.flow, total * network.unit)

    def lay_tolls(self) -> NDArray[np.int64]:
        """Begin with prices at which arrivals cost a little less than they will; return nodes where tolls are due."""
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import tolled as kernels
        from trihex.optimum.kernels.prices import BITS, NEVER, TOTAL, WANTED

        network = self.network
        room = room_of_slots(network, self.layers)
        queues = share_arrivals(network, self.cells, room)
        arcs = np.count_nonzero(network.in_arcs[network.first_destination :, :, 0], axis=1)
        # Where destinations alone hold robots up, nearly all come as if they met nowhere else: no rebate there.
        is_limited = bool((room < arcs).all())
        rebate = min(_REBATE, 0) if is_limited else _REBATE
        tolls = np.minimum(np.maximum(queues.price - rebate * network.base, 0), NEVER // 4).astype(np.int32)
        tolled = given(kernels.Tolled, network.order, network.hops, network.cell_count, tolls, room < arcs)
        if tolls.any():
            for layer in range(self.layers - 1, -1, -1):
                self.search.state[TOTAL] += kernels.lay_tolls(self.graph, self.nodes, tolled, layer)
        if tolls.any() and is_limited:
            self._go_to_goals(queues.slot)
        entering = self.nodes.entering.reshape(self.layers, -1)
        is_wanted = entering & WANTED != 0
        is_wanted[:, network.first_destination :] &= entering[:, network.first_destination :] >> BITS > 0
        return np.flatnonzero(is_wanted)

    def _go_to_goals(self, slot: NDArray[np.int64]) -> None:
        """Let robots go to the arrivals that they have in the queues."""
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import queueing as kernels

        first, size = self.network.first_destination, self.network.node_count
        step, which = np.divmod(slot, size - first)
        queue = given(
            kernels.Queue,
            goal=np.where(slot >= 0, step * size + first + which, slot),
            base=self.network.base,
            patience=min(_PATIENCE, self.search.seen.size - 1),
            rest=np.empty(size, dtype=np.int64),
            key=np.empty(size, dtype=np.int64),
            waiting=np.empty(size, dtype=np.int64),
            is_waiting=np.zeros(size, dtype=np.bool_),
        )
        kernels.go_to_goals(queue, self.graph, self.nodes, self.search)

    def make_room(self, status: int) -> None:
        """Make room for what a search ended for; refuse it if there is none."""
        from trihex.optimum.kernels import residual as kernels
        from trihex.optimum.kernels.prices import PricedNodes

        if status == kernels.LIST_FULL:
            lists = {name: getattr(self.search, name) for name in self._full_lists()}
            longer_bytes = 2 * sum(array.nbytes for array in lists.values())
            self._check_memory(self.layers, sum(array.nbytes for array in self.search) + longer_bytes)
            longer_lists = {name: np.concatenate([array, np.empty_like(array)]) for name, array in lists.items()}
            self.search = self.search._replace(**longer_lists)
        elif status == kernels.LAYERS_FULL:
            more = max(8, self.layers // 4)
            self._check_memory(self.layers + more)
            added = more * self.network.node_count
            self.nodes = PricedNodes(*(longer(array, added) for array in self.nodes))
            self.layers += more
            self._open_layers(self.layers - more)

    def _full_lists(self) -> tuple[str, ...]:
        """Return the lists that a search needs longer; where nothing else is full it is what a walk has seen."""
        from trihex.optimum.kernels.prices import ARRIVALS, FILED, LISTED, VAIN

        search, state = self.search, self.search.state
        more = self.graph.out.shape[1] + self.graph.into.shape[1]
        if state[LISTED] + search.seen.size + more > search.sides.size:
            return ("sides",)
        if state[FILED] + more > len(search.filed):
            return ("filed",)
        if state[ARRIVALS] + state[VAIN] + more > search.arrivals.size:
            return ("arrivals", "vain")
        # A path that is laid may list a side for all that its walk has seen.
        return ("stack", "seen", "sides") if search.sides.size < 2 * search.seen.size + more else ("stack", "seen")

    def _open_layers(self, first: int) -> None:
        """Let paths end at the destinations of all layers from the first one on, but for doors that are shut."""
        from trihex.optimum.kernels.flow_byte import START
        from trihex.optimum.kernels.prices import BITS, NEVER, PASSED, WANTED

        shut_doors(self.network, self.nodes.flow, first)
        flow, entering, leaving = (array.reshape(self.layers, -1)[first:] for array in self.nodes)
        goals = slice(self.network.first_destination, None)
        entering[flow != 0] |= PASSED
        entering[:, goals] = np.where(flow[:, goals] < self.network.capacity, WANTED, 0)
        # Nobody leaves where robots may not go yet, or a shut door.
        leaving[(flow >= START << 4) & (leaving == 0)] = -NEVER << BITS

    def _check_memory(self, layers: int, list_bytes: int = 0) -> None:
        need = layers * self.network.node_count * _BYTES_PER_NODE + list_bytes
        check_memory(self.network, self.cells, layers, need, self.limit)


def _slim(layer: Any) -> Any:
    """Return a layer with the columns of arcs that are used here, so that the arcs of a node lie closer together."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels.residual import OFFSET, PLACE, REDUCED, Layer

    columns = slice(OFFSET, max(OFFSET, PLACE, REDUCED) + 1)
    tables = (np.ascontiguousarray(table[:, :, columns]) for table in (layer.out, layer.into))
    return given(Layer, *tables, layer.first_goal, layer.capacity)


def _make_search(start: NDArray[np.int64]) -> Any:
    """Return a search in which the robots that start there, and nothing else, begin to rise."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels import prices as kernels
    from trihex.optimum.kernels.residual import NONE

    length = max(_LIST, start.size)
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.LISTED], state[kernels.FREE] = start.size, NONE
    state[kernels.AHEAD] = state[kernels.UNTIL] = min(_AHEAD, _RISES - 1)
    search = given(
        kernels.PricedSearch,
        start=start,
        sides=np.empty(4 * length, dtype=np.int64),
        filed=np.empty((4 * length, 2), dtype=np.int64),
        heads=np.full(_RISES, NONE, dtype=np.int64),
        arrivals=np.empty(4 * length, dtype=np.int64),
        vain=np.empty(4 * length, dtype=np.int64),
        stack=np.empty((length, 4), dtype=np.int64),
        seen=np.empty(length, dtype=np.int64),
        state=state,
    )
    search.sides[: start.size] = start * 2 + kernels.LEAVING
    return search
