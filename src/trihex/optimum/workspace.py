"""Workspace: what searches for a flow work on; it grows as they need room."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.memory import GIB, limit_or_default
from trihex.optimum.doors import shut_doors
from trihex.optimum.network import Network

# Bytes for each node of a layer: flow and a bound.
_BYTES_PER_NODE = 5
# Length of the logs of the searches at first.
_LOG = 1 << 12
# Layers beyond the last that is needed whatever the robots do.
SPARE_LAYERS = 8


class Workspace:
    """Layers, logs and state of the searches for paths of robots that start in `cells`, in ascending order of value.

    Its parts are tuples for the kernels, see `trihex.optimum.kernels.residual`.

    Parameters
    ----------
    network : Network
    cells : ndarray of int64
        Node where each robot starts.
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.
    """

    def __init__(self, network: Network, cells: NDArray[np.int64], memory_limit: int | None) -> None:
        from trihex.kernels.signatures import given
        from trihex.optimum.kernels import residual as kernels
        from trihex.optimum.kernels.flow_byte import START

        self.network, self.cells = network, cells
        self.limit = limit_or_default(memory_limit)
        self.layers = least_layers(network, cells) + SPARE_LAYERS
        self._check_memory(self.layers)
        size = self.layers * network.node_count
        self.layer = layer_of(network)
        self.nodes = kernels.FlowNodes(np.zeros(size, np.uint8), np.zeros(size, np.int32))
        if network.scenario.has_start_times:  # else nobody comes to where robots start
            for nodes in (start_nodes(network, cells), held_nodes(network, cells)):
                self.nodes.flow[nodes] = START << 4
        shut_doors(network, self.nodes.flow, 0)
        self.search = kernels.FlowSearch(
            np.empty((_LOG, kernels.LOG_COLUMNS), dtype=np.int64),
            np.full(kernels.SEARCH_STATE_SIZE, kernels.NONE, dtype=np.int64),
            np.empty(kernels.LISTS, dtype=np.int64),
        )
        self.search.state[kernels.LOGGED] = 0
        self.ends = given(
            kernels.FlowEnds, start=start_nodes(network, cells), value=network.value[cells].astype(np.int64)
        )
        self.state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        self.state[kernels.LEVEL] = kernels.NONE

    def make_room(self, status: int) -> None:
        """Make room for what a search ended for; refuse it if there is none."""
        from trihex.optimum.kernels import residual as kernels

        if status == kernels.LIST_FULL:
            log: Any = self.search.log
            self._check_memory(self.layers, 3 * log.nbytes)
            self.search = self.search._replace(log=np.concatenate([log, np.empty_like(log)]))
        elif status == kernels.LAYERS_FULL:
            more = max(8, self.layers // 2)
            self._check_memory(self.layers + more)
            added = more * self.network.node_count
            self.nodes = kernels.FlowNodes(*(longer(array, added) for array in self.nodes))
            shut_doors(self.network, self.nodes.flow, self.layers)
            self.layers += more
        elif status == kernels.LEVELS_FULL:
            raise TooLargeError(
                f"costs above {kernels.MOST_LEVEL} units for a robot cannot be searched; choose a smaller waiting_cost"
            )

    def _check_memory(self, layers: int, log_bytes: int = 0) -> None:
        need = layers * self.network.node_count * _BYTES_PER_NODE + log_bytes
        check_memory(self.network, self.cells, layers, need, self.limit)


def layer_of(network: Network) -> Any:
    """Return `Layer` as kernels know it."""
    from trihex.kernels.signatures import given
    from trihex.optimum.kernels.residual import Layer

    return given(
        Layer,
        out=network.out_arcs,
        into=network.in_arcs,
        first_goal=network.first_destination,
        capacity=network.capacity,
    )


def check_memory(network: Network, cells: NDArray[np.int64], layers: int, need: int, limit: int) -> None:
    """Refuse what needs more bytes than the limit."""
    if need > limit:
        scenario = network.scenario
        frame, least = scenario.area.frame, scenario.entry_limit
        is_free = least and (frame is None or frame.robot_radius == 0)  # else robots would overlap there
        wider = f", a destination_capacity above {least}" if is_free else ""
        raise TooLargeError(
            f"the optimum for {cells.size} robots needs at least {need / GIB:.1f} GiB ({layers} steps of "
            f"{network.node_count} cells and vertices), more than memory_limit, {limit / GIB:.1f} GiB; plan fewer "
            f"robots, a smaller area{wider}, or use planner 'fcost' and a lower bound"
        )


def start_nodes(network: Network, cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the index of the node of each robot in step 0, or when it may go."""
    return (network.hops[cells] + network.start_time[cells]) * network.node_count + cells


def held_nodes(network: Network, cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the index of all nodes in which robots stand until they may go, but for those of `start_nodes`.

    Nobody enters one of them, nor the node where the robot goes: each has the mark of a start, from which no flow can
    be turned back.
    """
    times = network.start_time[cells]
    step = np.arange(times.sum()) - np.repeat(np.cumsum(times) - times, times)
    nodes: NDArray[np.int64] = (np.repeat(network.hops[cells], times) + step) * network.node_count
    return nodes + np.repeat(cells, times)


def most_entries(network: Network) -> float:
    """Return how many robots can arrive in a step, at most.

    Unlike `trihex.areas.entries_per_step` this counts a cell or vertex between two destinations for each of them: a
    little too many, which only decides how a plan is found. With the exact count some plans become others, as good.
    """
    if network.scenario.has_flows:
        return _entries_by_flows(network)
    return max(1, int(network.room.sum()))


def _entries_by_flows(network: Network) -> float:
    """Return how many robots can arrive in a step in the long run, where some destinations let them in by a flow."""
    schedule, entries = network.scenario.schedule, network.room.astype(np.float64)
    nodes = network.node_of_site[network.scenario.area.layout.cell_to_site(schedule.cells)]
    is_goal = nodes >= network.first_destination
    goals = nodes[is_goal] - network.first_destination
    entries[goals] = np.minimum(entries[goals], (schedule.rate / schedule.period)[is_goal])
    return float(max(entries.sum(), 1e-6))


def least_layers(network: Network, cells: NDArray[np.int64]) -> int:
    """Return a lower bound on the last arrival: so many robots enter the destinations in a step and no more."""
    hops = np.sort(network.hops[cells] + network.start_time[cells])
    behind = np.arange(cells.size)[::-1]
    return int((hops + behind // most_entries(network)).max(initial=0)) + 1


def longer(array: NDArray[Any], more: int) -> NDArray[Any]:
    """Return a copy with room for `more` entries; the new ones are 0."""
    longer = np.zeros(array.size + more, dtype=array.dtype)
    longer[: array.size] = array
    return longer
