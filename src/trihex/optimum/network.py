"""Network: one time layer of the time-expanded graph in which a plan is a flow."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import gcd

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.record import Record, read_only

OBJECTIVES = ("time", "steps")
TO_GOAL = 16


@dataclass(frozen=True, eq=False)
class Network(Record):
    """Nodes and arcs of one layer: cells that reach a destination, lattice vertices if crossing is forbidden, goals.

    A robot waits, crosses an edge, or enters a lattice vertex within the step and leaves it into the next step; since
    every node takes one robot a step, nobody crosses anybody. Nodes are numbered cells first, destinations last. Layer
    u holds each node at step u - hops: robots on their way to the destination stay in one layer, so that they and the
    searches for them touch memory in few places. Node i of layer u has the index ``u * node_count + i``.

    Costs are reduced, that is cost + value of the head - value of the tail >= 0, in units of their greatest common
    divisor.

    Parameters
    ----------
    scenario : Scenario
    site_of_node : ndarray of int32
        Site of each cell and destination, number of each lattice vertex.
    cell_count, vertex_count : int
    unit : int
        What all costs are multiples of.
    base : int
        What each step costs at least, in units.
    hops : ndarray of int32, shape (nodes,)
        Least number of steps to a destination.
    value : ndarray of int32, shape (nodes,)
        Least cost to a destination, in units.
    out_arcs, in_arcs : ndarray of int32, shape (nodes, most arcs + 1, 6)
        Of each arc that leaves or enters a node: what to add to the index to get the other node (0: no more arcs), its
        reduced cost, its place among the arcs of the other node (plus `TO_GOAL` where it leads to a destination), and
        what it costs beyond `base` a step; the other node and how many layers on it is. In descending order of reduced
        cost.
    """

    scenario: Scenario
    site_of_node: NDArray[np.int32]
    cell_count: int
    vertex_count: int
    unit: int
    base: int
    hops: NDArray[np.int32]
    value: NDArray[np.int32]
    out_arcs: NDArray[np.int32]
    in_arcs: NDArray[np.int32]

    @property
    def node_count(self) -> int:
        """Nodes in a layer."""
        return int(self.site_of_node.size)

    @property
    def first_destination(self) -> int:
        """Nodes that are no destinations."""
        return self.cell_count + self.vertex_count

    @cached_property
    def is_vertex(self) -> NDArray[np.bool_]:
        """Whether each node is a lattice vertex."""
        node = np.arange(self.node_count)
        return read_only((node >= self.cell_count) & (node < self.first_destination))

    @cached_property
    def order(self) -> NDArray[np.int32]:
        """All nodes, so that arcs within a layer go forward."""
        return read_only(np.lexsort((self.is_vertex, -self.hops)).astype(np.int32))

    @cached_property
    def room(self) -> NDArray[np.int64]:
        """How many robots get into each destination in a step."""
        arcs = np.count_nonzero(self.in_arcs[self.first_destination :, :, 0], axis=1)
        return read_only(np.minimum(arcs, self.scenario.destination_capacity or arcs))

    @property
    def has_equal_steps(self) -> bool:
        """Whether every step costs the same, so that it only matters when robots arrive."""
        return self.base == 1 and not self.out_arcs[:, :, 3].any()

    @cached_property
    def node_of_site(self) -> NDArray[np.int32]:
        """Node of each site that is a cell or a destination, -1 elsewhere."""
        node = np.full(self.scenario.area.layout.size, -1, dtype=np.int32)
        for nodes in (np.arange(self.cell_count), np.arange(self.first_destination, self.node_count)):
            node[self.site_of_node[nodes]] = nodes
        return read_only(node)


def make_network(n_scheme: NScheme, objective: str = "time") -> Network:
    """Make the network of a scenario whose costs are those of t_r ("time") or 1 a step ("steps")."""
    scenario = n_scheme.scenario
    tessellation, layout = scenario.area.tessellation, scenario.area.layout
    hops_of_site = _hops(n_scheme)
    if objective == "steps":
        distance, waiting_cost = hops_of_site, 1
        cost_of_direction = np.ones(tessellation.direction_count, dtype=np.int64)
    else:
        distance, waiting_cost = n_scheme.distance_of_site, scenario.waiting_cost
        cost_of_direction = tessellation.cost_of_direction.astype(np.int64)
    unit = gcd(waiting_cost, *cost_of_direction.tolist())

    reached = np.flatnonzero(n_scheme.distance_of_site != NOT_REACHED)
    cells, goals = reached[distance[reached] > 0], reached[distance[reached] == 0]
    through_vertex = tessellation.edge_count if scenario.crossing == "forbid" else tessellation.direction_count
    pairs = _cells_at_vertices(scenario, np.concatenate([cells, goals]), through_vertex, cost_of_direction)
    vertices = np.unique(pairs[:, 1])
    sites = np.concatenate([cells, vertices, goals])
    first_goal = cells.size + vertices.size
    node = np.full(layout.size, -1, dtype=np.int64)
    node[cells], node[goals] = np.arange(cells.size), np.arange(first_goal, sites.size)
    at, vertex = node[pairs[:, 0]], cells.size + np.searchsorted(vertices, pairs[:, 1])

    hops, value = (np.zeros(sites.size, dtype=np.int64) for _ in range(2))
    for array, of_site, least in ((hops, hops_of_site, 1), (value, distance, 0)):
        array[:] = NOT_REACHED
        array[node[reached]] = of_site[reached]
        np.minimum.at(array, vertex, array[at] + least)

    is_cell = at < first_goal
    arcs = [
        *_moves(scenario, cells, node, through_vertex, cost_of_direction),
        _arcs(np.arange(cells.size), np.arange(cells.size), waiting_cost, 1),
        _arcs(at[is_cell], vertex[is_cell], pairs[is_cell, 2], 0),
        _arcs(vertex, at, 0, 1),
    ]
    tail, head, cost, steps = np.concatenate(arcs).T
    reduced = (cost + value[head] - value[tail]) // unit
    base = min(waiting_cost, *cost_of_direction.tolist())
    is_vertex = np.zeros(sites.size, dtype=np.int64)
    is_vertex[cells.size : first_goal] = 1
    extra = (cost - base * (steps + is_vertex[head] - is_vertex[tail])) // unit
    row = steps + hops[head] - hops[tail]
    offset = row * sites.size + head - tail
    place_out, place_in = _places(tail, -reduced), _places(head, -reduced)
    return Network(
        scenario,
        read_only(sites.astype(np.int32)),
        cells.size,
        vertices.size,
        unit,
        base // unit,
        read_only(hops.astype(np.int32)),
        read_only((value // unit).astype(np.int32)),
        _table(
            sites.size, tail, place_out, offset, reduced, place_in + TO_GOAL * (head >= first_goal), extra, head, row
        ),
        _table(sites.size, head, place_in, -offset, reduced, place_out, extra, tail, -row),
    )


def _hops(n_scheme: NScheme) -> NDArray[np.int32]:
    """Return the least number of steps from each site to a destination."""
    from trihex.optimum.kernels.paths import fill_hops

    scenario = n_scheme.scenario
    layout = scenario.area.layout
    hops = np.full(layout.size, NOT_REACHED, dtype=np.int32)
    queue = np.empty(scenario.area.free_count, dtype=np.int32)
    fill_hops(layout.cell_to_site(scenario.destinations), layout.offset_of_direction, scenario.moves, hops, queue)
    return hops


def _cells_at_vertices(
    scenario: Scenario, sites: NDArray[np.int64], first: int, cost: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return rows (site, lattice vertex, least cost) for the vertices that robots pass to or from each site.

    Serves every corner rule: of two cells around a vertex that both have an open move through it, any two have one
    between them, unless they share an edge. For "no-squeeze" that is so because such cells belong to one run of three
    or more free cells, and no second such run has room around the vertex.
    """
    rows = [np.empty((0, 3), dtype=np.int64)]
    for k in range(first, cost.size):
        own = sites[(scenario.moves[sites] >> k & 1).astype(bool)]
        vertex = own + scenario.area.layout.vertex_of_direction[own & 1, k]
        rows.append(np.stack([own, vertex, np.full(own.size, cost[k])], axis=1))
    every = np.concatenate(rows)
    every = every[np.lexsort(every.T[::-1])]
    is_first = np.ones(len(every), dtype=bool)
    is_first[1:] = (np.diff(every[:, :2], axis=0) != 0).any(axis=1)
    return every[is_first]


def _moves(
    scenario: Scenario, cells: NDArray[np.int64], node: NDArray[np.int64], last: int, cost: NDArray[np.int64]
) -> list[NDArray[np.int64]]:
    """Return the arcs of the directions below `last`."""
    arcs = []
    for k in range(last):
        own = cells[(scenario.moves[cells] >> k & 1).astype(bool)]
        target = own + scenario.area.layout.offset_of_direction[own & 1, k]
        arcs.append(_arcs(node[own], node[target], int(cost[k]), 1))
    return arcs


def _arcs(
    tail: NDArray[np.int64], head: NDArray[np.int64], cost: int | NDArray[np.int64], steps: int
) -> NDArray[np.int64]:
    return np.stack(np.broadcast_arrays(tail, head, cost, steps), axis=1)


def _places(node: NDArray[np.int64], order: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the place of each arc among those of its node, in ascending order of `order`."""
    by_node = np.lexsort((order, node))
    counts = np.bincount(node)
    place = np.empty_like(node)
    place[by_node] = np.arange(node.size) - np.repeat(np.cumsum(counts) - counts, counts)
    return place


def _table(
    nodes: int, node: NDArray[np.int64], place: NDArray[np.int64], *columns: NDArray[np.int64]
) -> NDArray[np.int32]:
    table = np.zeros((nodes, int(place.max(initial=0)) + 2, len(columns)), dtype=np.int32)
    for i, column in enumerate(columns):
        table[node, place, i] = column
    return read_only(table)
