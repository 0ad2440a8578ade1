"""Network: one time layer of the time-expanded graph in which a plan is a flow."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import gcd
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Scenario
from trihex.fields import NScheme, steps_to_destination
from trihex.kernels.codes import NOT_REACHED
from trihex.optimum.passages import Passages, make_passages
from trihex.record import Record, read_only

OBJECTIVES = ("time", "steps")
# How many robots may arrive in a step where there is no limit; as a byte of flow it is not that of a start.
_ANY_NUMBER = 100


@dataclass(frozen=True, eq=False)
class Network(Record):
    """Nodes and arcs of one layer: cells that reach a destination, lattice vertices if crossing is forbidden, goals.

    A robot waits, crosses an edge, or enters a lattice vertex within the step and leaves it into the next step; since
    every node takes one robot a step, nobody crosses anybody. Whoever enters a cell that is a door passes its *gate* in
    the same way: that is shut in some steps, while a robot may stay in the cell. Nodes are numbered cells first, then
    vertices, gates, and destinations. Layer u holds each node at step u - hops: robots on their way to the destination
    stay in one layer, so that they and the searches for them touch memory in few places. Node i of layer u has the
    index ``u * node_count + i``.

    Costs are reduced, that is cost + value of the head - value of the tail >= 0, in units of their greatest common
    divisor.

    Parameters
    ----------
    scenario : Scenario
    site_of_node : ndarray of int32
        Site of each cell and destination, number of each lattice vertex, site of the cell behind each gate.
    cell_count, vertex_count, gate_count : int
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
        reduced cost, its place among the arcs of the other node, and what it costs beyond `base` a step; the other node
        and how many layers on it is. In descending order of reduced cost.
    """

    scenario: Scenario
    site_of_node: NDArray[np.int32]
    cell_count: int
    vertex_count: int
    gate_count: int
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
        return self.cell_count + self.vertex_count + self.gate_count

    @cached_property
    def is_vertex(self) -> NDArray[np.bool_]:
        """Whether each node is a lattice vertex, or a gate."""
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
        return read_only(np.minimum(arcs, self.scenario.entry_limit or arcs))

    @property
    def capacity(self) -> int:
        """How many robots get into a destination in a step, no more than fit into a byte; none has more neighbours."""
        return min(self.scenario.entry_limit or _ANY_NUMBER, _ANY_NUMBER)

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

    @cached_property
    def gate_of_node(self) -> NDArray[np.int64]:
        """The gate of each node, itself where it has none."""
        gate, gates = np.arange(self.node_count), np.arange(self.cell_count + self.vertex_count, self.first_destination)
        gate[self.node_of_site[self.site_of_node[gates]]] = gates
        return read_only(gate)

    @cached_property
    def start_time(self) -> NDArray[np.int64]:
        """For each node where a robot starts the step after which it may go, 0 for all others."""
        scenario, time = self.scenario, np.zeros(self.node_count, dtype=np.int64)
        node = self.node_of_site[scenario.area.layout.cell_to_site(scenario.robots)]
        time[node[node >= 0]] = scenario.start_times[node >= 0]
        return read_only(time)


class _Prices(NamedTuple):
    """What robots pay in the end."""

    distance_of_site: NDArray[np.int32]
    of_direction: NDArray[np.int64]
    of_waiting: int

    @property
    def unit(self) -> int:
        """What all are multiples of."""
        return gcd(self.of_waiting, *self.of_direction.tolist())

    @property
    def least(self) -> int:
        """What a step costs at least."""
        return min(self.of_waiting, int(self.of_direction.min()))


class _Arcs(NamedTuple):
    """Arcs of a layer: nodes at both ends, cost, and how many steps later a robot is at the head."""

    tail: NDArray[np.int64]
    head: NDArray[np.int64]
    cost: NDArray[np.int64]
    steps: NDArray[np.int64]


def make_network(n_scheme: NScheme, objective: str = "time") -> Network:
    """Make the network of a scenario whose costs are those of t_r ("time") or 1 a step ("steps")."""
    scenario = n_scheme.scenario
    hops_of_site = steps_to_destination(scenario)
    prices = _prices(n_scheme, hops_of_site, objective)

    sites = np.flatnonzero(n_scheme.distance_of_site != NOT_REACHED)
    is_cell = hops_of_site[sites] > 0
    cells, goals = sites[is_cell], sites[~is_cell]
    passages = make_passages(scenario, sites, prices.distance_of_site, prices.of_direction)
    doors = np.flatnonzero(np.isin(cells, scenario.area.layout.cell_to_site(scenario.schedule.cells)))
    site_of_node = np.concatenate([cells, passages.vertices, cells[doors], goals])
    first_gate = cells.size + passages.vertices.size
    first_goal = first_gate + doors.size
    node = np.full(scenario.area.layout.size, -1, dtype=np.int64)
    node[cells], node[goals] = np.arange(cells.size), np.arange(first_goal, site_of_node.size)

    hops = hops_of_site[site_of_node].astype(np.int64)
    hops[cells.size : first_gate] = NOT_REACHED
    np.minimum.at(hops, cells.size + passages.vertex, hops_of_site[passages.site] + 1)
    value = prices.distance_of_site[site_of_node].astype(np.int64)
    value[cells.size : first_gate] = passages.distance
    hops[first_gate:first_goal] += 1
    value[first_gate:first_goal] = value[doors]

    arcs = _past_gates(_make_arcs(scenario, cells, node, passages, prices), doors, first_gate)
    return Network(
        scenario,
        read_only(site_of_node.astype(np.int32)),
        cells.size,
        passages.vertices.size,
        doors.size,
        prices.unit,
        prices.least // prices.unit,
        read_only(hops.astype(np.int32)),
        read_only((value // prices.unit).astype(np.int32)),
        *_make_tables(arcs, hops, value, slice(cells.size, first_goal), prices),
    )


def _prices(n_scheme: NScheme, hops_of_site: NDArray[np.int32], objective: str) -> _Prices:
    tessellation = n_scheme.scenario.area.tessellation
    if objective == "steps":
        return _Prices(hops_of_site, np.ones(tessellation.direction_count, dtype=np.int64), 1)
    cost = tessellation.cost_of_direction.astype(np.int64)
    return _Prices(n_scheme.distance_of_site, cost, n_scheme.scenario.waiting_cost)


def _make_arcs(
    scenario: Scenario, cells: NDArray[np.int64], node: NDArray[np.int64], passages: Passages, prices: _Prices
) -> _Arcs:
    """Make all arcs: moves that pass no vertex or one that others may pass too, waiting, into and out of vertices."""
    layout = scenario.area.layout
    arcs: list[tuple[ArrayLike, ...]] = []
    for k in range(scenario.first_vertex_move):
        own = cells[(scenario.moves[cells] >> k & 1).astype(bool)]
        target = own + layout.offset_of_direction[own & 1, k]
        arcs.append((node[own], node[target], prices.of_direction[k], 1))
    waiting = np.arange(cells.size)
    at, vertex = node[passages.site], cells.size + passages.vertex
    enters = at < cells.size  # a robot in a destination stays there
    arcs += [
        (waiting, waiting, prices.of_waiting, 1),
        (at[enters], vertex[enters], passages.enter[enters], 0),
        (vertex, at, passages.leave, 1),
    ]
    return _Arcs(*np.concatenate([np.stack(np.broadcast_arrays(*columns), axis=1) for columns in arcs]).T)


def _past_gates(arcs: _Arcs, doors: NDArray[np.int64], first_gate: int) -> _Arcs:
    """Let arcs into cells that are doors, but for those of waiting, lead to their gates within the step, and on."""
    gate = np.full(int(arcs.head.max(initial=-1)) + 1, -1, dtype=np.int64)
    gate[doors] = np.arange(first_gate, first_gate + doors.size)
    is_past = (gate[arcs.head] >= 0) & (arcs.tail != arcs.head)
    onward = (gate[doors], doors, np.zeros_like(doors), np.ones_like(doors))
    changed = (arcs.tail, np.where(is_past, gate[arcs.head], arcs.head), arcs.cost, arcs.steps - is_past)
    return _Arcs(*(np.concatenate(both) for both in zip(changed, onward, strict=True)))


def _make_tables(
    arcs: _Arcs, hops: NDArray[np.int64], value: NDArray[np.int64], vertices: slice, prices: _Prices
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Make the tables of arcs out of and into each node."""
    tail, head, cost, steps = arcs
    size = hops.size
    # A robot in a vertex has paid for the step that it is in.
    begun = np.zeros(size, dtype=np.int64)
    begun[vertices] = 1
    reduced = (cost + value[head] - value[tail]) // prices.unit
    extra = (cost - prices.least * (steps + begun[head] - begun[tail])) // prices.unit
    row = steps + hops[head] - hops[tail]
    offset = row * size + head - tail
    place_out, place_in = _places(tail, -reduced), _places(head, -reduced)
    return (
        _table(size, tail, place_out, offset, reduced, place_in, extra, head, row),
        _table(size, head, place_in, -offset, reduced, place_out, extra, tail, -row),
    )


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
