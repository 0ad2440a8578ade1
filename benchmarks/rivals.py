"""Rivals: libraries that find the flow through cells and steps that is the least plan, given as arrays.

Each gets the step of the last arrival for nothing, and only what it takes to solve is counted.
"""

from collections.abc import Callable
from time import process_time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import trihex as th
from trihex.optimum import make_network


class Flow(NamedTuple):
    """Robots that flow from where they start to one node, 0, through arcs."""

    arcs: NDArray[np.int64]  # (tail, head, capacity, cost)
    starts: NDArray[np.int64]  # the node of each robot
    unit: int  # of the costs, in that of the total time

    @property
    def node_count(self) -> int:
        """Number of nodes."""
        return int(max(self.arcs[:, :2].max(), self.starts.max())) + 1


def flow_of(n_scheme: th.NScheme, steps: int) -> Flow:
    """Return the flow of all robots, which can arrive, through the graph of cells and steps up to `steps`."""
    network = make_network(n_scheme)
    robots, size = n_scheme.scenario.robot_count, network.node_count
    tail, place = np.nonzero(network.out_arcs[:, :, 0])
    _, reduced, _, _, head, rows = network.out_arcs[tail, place].T.astype(np.int64)
    cost = reduced + network.value[tail] - network.value[head]
    goals = np.arange(network.first_destination, size)
    parts = []
    # Node i of layer u is entered at 2 (u * nodes + i) + 1 and left at one more.
    for layer in range(steps + 1):
        own = np.flatnonzero(network.hops[: network.first_destination] <= layer)
        enter = 2 * (layer * size + own) + 1
        parts.append(np.stack([enter, enter + 1, *np.broadcast_arrays(1, np.zeros_like(own))], axis=1))
        is_open = (network.hops[tail] <= layer) & (layer + rows <= steps)
        leave, into = 2 * (layer * size + tail) + 2, 2 * ((layer + rows) * size + head) + 1
        parts.append(np.stack(np.broadcast_arrays(leave, into, 1, cost), axis=1)[is_open])
        ends = 2 * (layer * size + goals) + 1
        parts.append(np.stack(np.broadcast_arrays(ends, 0, robots, 0), axis=1))
    cells = network.node_of_site[n_scheme.scenario.area.layout.cell_to_site(n_scheme.scenario.robots)]
    starts = 2 * (network.hops[cells].astype(np.int64) * size + cells) + 1
    arcs = np.concatenate(parts)
    # Nodes that no arc has would cost some of the rivals time.
    nodes, own = np.unique(np.concatenate([[0], arcs[:, 0], arcs[:, 1], starts]), return_inverse=True)
    own = own[1:].astype(np.int64)
    assert nodes[0] == 0
    arcs[:, 0], arcs[:, 1] = own[: len(arcs)], own[len(arcs) : 2 * len(arcs)]
    return Flow(arcs, own[2 * len(arcs) :], network.unit)


def by_or_tools(flow: Flow) -> tuple[float, int]:
    """Return CPU seconds and least total time by cost scaling."""
    from ortools.graph.python.min_cost_flow import SimpleMinCostFlow

    solver = SimpleMinCostFlow()
    solver.add_arcs_with_capacity_and_unit_cost(*(np.ascontiguousarray(column) for column in flow.arcs.T))
    solver.set_nodes_supplies(np.append(flow.starts, 0), np.append(np.ones_like(flow.starts), -flow.starts.size))
    begin = process_time()
    assert solver.solve() == solver.OPTIMAL
    return process_time() - begin, solver.optimal_cost() * flow.unit


def by_lemon(flow: Flow) -> tuple[float, int]:
    """Return CPU seconds and least total time by LEMON's network simplex."""
    from pylmcf import Graph

    arcs = flow.arcs[np.lexsort((flow.arcs[:, 1], flow.arcs[:, 0]))]
    count = flow.node_count
    graph = Graph(count, arcs[:, 0].astype(np.int32), arcs[:, 1].astype(np.int32))
    supply = np.bincount(flow.starts, minlength=count)
    supply[0] -= flow.starts.size
    graph.set_node_supply(supply)
    graph.set_edge_capacities(np.ascontiguousarray(arcs[:, 2]))
    graph.set_edge_costs(np.ascontiguousarray(arcs[:, 3]))
    begin = process_time()
    graph.solve()
    return process_time() - begin, graph.total_cost() * flow.unit


def most_by_maxflow(flow: Flow) -> tuple[float, int]:
    """Return CPU seconds and how many robots can arrive, by PyMaxflow (Boykov and Kolmogorov's augmenting paths)."""
    import maxflow

    count = flow.node_count
    graph = maxflow.GraphInt(count, len(flow.arcs))
    graph.add_nodes(count)
    tail, head, capacity = (np.ascontiguousarray(column) for column in flow.arcs[:, :3].T)
    graph.add_edges(tail, head, capacity, np.zeros_like(capacity))
    for node in flow.starts.tolist():
        graph.add_tedge(node, 1, 0)
    graph.add_tedge(0, 0, flow.starts.size)
    begin = process_time()
    most = graph.maxflow()
    return process_time() - begin, int(most)


RIVALS: dict[str, Callable[[Flow], tuple[float, int]]] = {"OR-tools": by_or_tools, "LEMON": by_lemon}
