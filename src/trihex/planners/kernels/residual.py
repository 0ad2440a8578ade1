"""The residual graph of lanes: where a way may lead that lets lanes so far go elsewhere.

A node that carries a lane is entered against it only. Nodes are sites, and size + number of a lattice vertex where
nobody may cross. Each has a *value*: what a way from it costs at least, at first the distance, of a vertex the least of
those around it. Values rise as lanes are found, so that no residual arc costs less than what it comes nearer (Edmonds
and Karp 1972): its *reduced* cost is >= 0. For that a vertex is entered at the cost of the dearest move through it
(which matters for euclidean triangles only). What is not touched stays 0, in arrays as in memory: nodes in arrays are
given + 1.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import APART, HELPER, IN_I32, IN_U16, OUT_I32, TABLE_I32, declared

NOBODY = 1 << 30  # value of nodes from which nobody can reach a destination any more
# Columns of the nodes: the node before and after on a lane (+ 1), what the lane paid to come here; the value (+ 1); the
# number of the search that has seen the node, at which reduced cost, from which node and entering which (+ 1).
BEFORE, AFTER, PAID, VALUE, SEARCH, REDUCED, PARENT, ENTERED = range(8)
COLUMNS = 8
BEGIN = -1  # in BEFORE: here a lane begins
# What functions return: no node, no cost.
NOWHERE = np.int64(-1)
NOTHING = np.int64(0)


class Streets(NamedTuple):
    """Where lanes may lead, and what that costs."""

    moves: IN_U16  # bits of the directions that may be taken from a site
    distance: IN_I32  # of a site, what it costs at least to get to a destination
    catchment: IN_I32  # of a site: lanes keep to the catchment where they begin
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    vertex: TABLE_I32  # what it adds to get the lattice vertex passed
    ring: IN_I32  # what to add to the number of a vertex to get the sites around it
    via: IN_U16  # bits of the moves that pass the vertex, from each site of the ring
    cost: IN_I32  # of each direction
    toll: types.int64  # what it costs to enter a vertex: the most that a move costs
    first_vertex_move: types.int64  # from this direction on, vertices are passed that others may not pass


class LaneNetwork(NamedTuple):
    """The lanes so far, and what searches know."""

    node: types.Array(types.int32, 2, "C")  # a row for each node, see above
    ends: OUT_I32  # how many lanes end in a destination, by site; -1 elsewhere
    seen: OUT_I32  # nodes that a search has seen; room for all
    level: OUT_I32  # stack of the nodes that are as near as the one under way; room for all


STREETS, NETWORK = declared(Streets), declared(LaneNetwork)


@APART
def _first_value(node, streets):
    """Return what a way from a node to a destination costs at least, as long as there are no lanes."""
    size = len(streets.moves)
    if node < size:
        return min(np.int64(streets.distance[node]), NOBODY)
    least = np.int64(NOBODY)
    for i in range(len(streets.ring)):
        site = node - size + streets.ring[i]
        if streets.moves[site] & streets.via[i]:
            least = min(least, np.int64(streets.distance[site]))
    return least


@HELPER
def value_of(node, streets, network):
    """Return the value of a node, which is found when it is first asked for."""
    if network.node[node, VALUE] == 0:
        network.node[node, VALUE] = 1 + _first_value(node, streets)
    return np.int64(network.node[node, VALUE]) - 1


@HELPER
def arc_of(node, i, streets):
    """Return where arc `i` of a node leads, if anywhere, and what it costs. Arc -1 stays, to lead back from here."""
    if i < 0:
        return node, NOTHING
    size = len(streets.moves)
    if node >= size:
        site = node - size + streets.ring[i]
        return (site if streets.moves[site] & streets.via[i] else NOWHERE), NOTHING
    if not streets.moves[node] >> i & 1:
        return NOWHERE, NOTHING
    if i >= streets.first_vertex_move:
        return size + node + streets.vertex[node & 1, i], streets.toll
    return node + streets.offset[node & 1, i], np.int64(streets.cost[i])


@HELPER
def node_entered(target, is_back, network):
    """Return to which node one gets who enters `target`, if anywhere, and what that adds to the cost."""
    before = np.int64(network.node[target, BEFORE])
    if before > 0:  # a lane passes there: back along it
        return before - 1, -np.int64(network.node[target, PAID])
    if before == BEGIN or is_back:
        return NOWHERE, NOTHING
    return target, NOTHING


@HELPER
def mark(node, search, reduced, parent, entered, network):
    """Note how a search got to a node."""
    network.node[node, SEARCH] = search
    network.node[node, REDUCED] = reduced
    network.node[node, PARENT] = parent + 1
    network.node[node, ENTERED] = entered + 1


@HELPER
def _cost(node, target, streets):
    """Return what it costs to get from a node to the next one."""
    size = len(streets.moves)
    if node >= size:
        return NOTHING
    if target >= size:
        return streets.toll
    least = np.int64(NOBODY)
    for k in range(len(streets.cost)):
        if streets.moves[node] >> k & 1 and node + streets.offset[node & 1, k] == target:
            least = min(least, np.int64(streets.cost[k]))
    return least


@HELPER
def change_lanes(path, streets, network):
    """Lead lanes along the path that was found, from its last node back to the start, where the new lane begins."""
    nodes, node = network.node, path.last
    nodes[node, AFTER] = path.goal + 1
    while True:
        parent, entered = np.int64(nodes[node, PARENT]) - 1, np.int64(nodes[node, ENTERED]) - 1
        if parent < 0:
            nodes[entered, BEFORE] = BEGIN
            return
        if entered == parent:  # back along the lane through the node, which passes there no more
            nodes[parent, BEFORE] = nodes[parent, AFTER] = 0
        else:
            nodes[parent, AFTER], nodes[entered, BEFORE] = entered + 1, parent + 1
            nodes[entered, PAID] = _cost(parent, entered, streets)
        node = parent
