"""Nodes: places that but one robot may pass at a time.

A *node* is a site, or ``size + vertex`` for a lattice vertex, where crossing is forbidden; `size` is the number of
sites. A move from a site that passes such a vertex leads to the vertex first, then on to the site behind it.
"""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, IN_U16, TABLE_I32, declared


class NodeGraph(NamedTuple):
    """Which nodes can be entered from which."""

    steps: IN_I32  # from each site to the nearest destination, in ticks; -1: none can be reached
    is_destination: IN_BOOL  # of each site
    moves: IN_U16  # of each site: bit k is set where direction k may be taken
    offset: TABLE_I32  # what a direction adds to a site, by parity of the site
    vertex: TABLE_I32  # likewise the lattice vertex that it passes
    ring: IN_I32  # what to add to a vertex for the sites around it
    via: IN_U16  # of each of these sites: the moves that pass the vertex, in the bits of `moves`
    first_vertex_move: types.int64  # directions from this one on lead to a vertex
    duration: IN_I32  # of each direction: how many ticks a move lasts
    line: IN_I32  # of each direction: which of all different durations that is
    vertex_duration: types.int64  # of the shortest move that passes a vertex
    vertex_line: types.int64  # which of the durations that is


NODE_GRAPH = declared(NodeGraph)


@HELPER
def way_count(node, graph):
    """Return how many ways `node_ahead` has to be asked for."""
    return len(graph.ring) if node >= len(graph.moves) else graph.offset.shape[1]


@HELPER
def is_open(node, k, graph):
    """Tell whether the k-th way from a node is open, in the one direction and the other."""
    size = len(graph.moves)
    if node >= size:
        return graph.moves[node - size + graph.ring[k]] & graph.via[k] != 0
    return graph.moves[node] >> k & 1 != 0


@HELPER
def node_ahead(node, k, graph):
    """Return the node to which the k-th way from a node leads, and from which it leads here."""
    size = len(graph.moves)
    if node >= size:
        return node - size + graph.ring[k]
    if k >= graph.first_vertex_move:
        return size + node + graph.vertex[node & 1, k]
    return node + graph.offset[node & 1, k]


@HELPER
def site_behind(node, k, graph):
    """Return the site to which the k-th way from a node leads in the end."""
    if node >= len(graph.moves):
        return node - len(graph.moves) + graph.ring[k]
    return node + graph.offset[node & 1, k]
