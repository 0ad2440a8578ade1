"""Chokes: where robots on their way must pass one by one.

A *node* is a site, or ``layout.size + vertex`` for a lattice vertex, where the scenario lets but one robot pass it in a
step.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.record import Record, read_only
from trihex.scenario import Scenario

_BUDGET = 1_000_000


@dataclass(frozen=True, eq=False)
class Crowd(Record):
    """The robots of a scenario that can arrive and have not yet, with what the kernels need to know about their ways.

    Parameters
    ----------
    scenario : Scenario
    steps_of_site : int32 array, shape (layout.size,)
        Least number of steps to a destination; -1 where none can be reached.
    """

    scenario: Scenario
    steps_of_site: NDArray[np.int32]

    @cached_property
    def sites(self) -> NDArray[np.int32]:
        """Sites of the robots, the farthest first."""
        sites = self.scenario.area.layout.cell_to_site(self.scenario.robots)
        sites = sites[self.steps_of_site[sites] > 0]
        return read_only(sites[np.argsort(-self.steps_of_site[sites], kind="stable")])

    @cached_property
    def steps(self) -> NDArray[np.int64]:
        """Least number of steps of each of them, descending."""
        return read_only(self.steps_of_site[self.sites].astype(np.int64))

    @cached_property
    def is_destination(self) -> NDArray[np.bool_]:
        """Whether each site is a destination."""
        layout = self.scenario.area.layout
        is_destination = np.zeros(layout.size, dtype=bool)
        is_destination[layout.cell_to_site(self.scenario.destinations)] = True
        return read_only(is_destination)

    @cached_property
    def has_vertices(self) -> bool:
        """Whether lattice vertices are nodes."""
        return self.scenario.crossing == "forbid" and self.scenario.area.layout.ring_of_vertex.size > 0

    @property
    def node_count(self) -> int:
        """Number of nodes."""
        return self.scenario.area.layout.size * (1 + self.has_vertices)

    @cached_property
    def via_of_ring(self) -> NDArray[np.uint16]:
        """Bits of the directions that pass a vertex, for each site of `Layout.ring_of_vertex`."""
        layout, edges = self.scenario.area.layout, self.scenario.area.tessellation.edge_count
        via = np.zeros(layout.ring_of_vertex.size, dtype=np.uint16)
        for i, offset in enumerate(layout.ring_of_vertex):
            # The numbers of vertices are even on triangles, where alone the orientation matters.
            for k in range(edges, layout.vertex_of_direction.shape[1]):
                if layout.vertex_of_direction[offset & 1, k] == -offset:
                    via[i] |= 1 << k
        return read_only(via)

    def sites_around(self, vertex: int) -> NDArray[np.int32]:
        """Return the sites from which a move passes the lattice vertex with this number."""
        sites = vertex + self.scenario.area.layout.ring_of_vertex
        return np.asarray(sites[(self.scenario.moves[sites] & self.via_of_ring) > 0])


def make_crowd(scenario: Scenario) -> Crowd:
    """Count the steps to the nearest destination from every site."""
    from trihex.kernels import bounds as kernels

    layout = scenario.area.layout
    steps = np.full(layout.size, -1, dtype=np.int32)
    queue = np.empty(scenario.area.free_count, dtype=np.int32)
    head, tail = 0, scenario.destinations.size
    queue[:tail] = layout.cell_to_site(scenario.destinations)
    steps[queue[:tail]] = 0
    while head < tail:
        end = min(tail, head + _BUDGET)
        tail = kernels.count_steps(scenario.moves, layout.offset_of_direction, steps, queue, head, tail, _BUDGET)
        head = end
    return Crowd(scenario, read_only(steps))


@dataclass(frozen=True, eq=False)
class Cut(Record):
    """Nodes that part the farthest robots from the destinations.

    Parameters
    ----------
    nodes : int32 array
        At most one robot passes each in a step; a destination among them has its capacity.
    width : int
        How many robots pass all of them together in a step at most.
    behind : int64 array
        Which robots of the crowd have to pass.
    """

    nodes: NDArray[np.int32]
    width: int
    behind: NDArray[np.int64] = field(repr=False)


def find_cuts(crowd: Crowd, most_searches: int) -> list[Cut]:
    """Return least cuts for the farthest robots, for ever more of them; each lies nearer to the destinations.

    One unit after another is sent from the farthest robot for which a search back from the destinations finds a way;
    all robots farther than that are behind a cut of as many nodes as units were sent. Of all such cuts these are the
    nearest to the destinations.

    Parameters
    ----------
    crowd : Crowd
    most_searches : int
        Stop after so many; the last cuts may be missing then.
    """
    from trihex.kernels import bounds_cut as kernels

    scenario, layout = crowd.scenario, crowd.scenario.area.layout
    destinations = layout.cell_to_site(scenario.destinations)
    room = np.zeros(layout.size, dtype=np.int32)
    room[destinations] = np.iinfo(np.int32).max
    if scenario.destination_capacity is not None:
        room[destinations] = scenario.destination_capacity
    onward = np.full(crowd.node_count, -1, dtype=np.int32)
    next_of_in, next_of_out = np.empty_like(onward), np.empty_like(onward)
    queue = np.empty(2 * crowd.node_count, dtype=np.int32)
    cuts: list[Cut] = []
    sent = np.zeros(crowd.sites.size, dtype=bool)
    for _ in range(most_searches):
        next_of_in[:] = next_of_out[:] = -1
        roots = destinations[room[destinations] > 0]
        next_of_in[roots] = kernels.ROOT
        queue[: roots.size] = 2 * roots
        state = np.array([0, roots.size])
        while state[0] < state[1]:
            kernels.search_back(
                scenario.moves,
                layout.offset_of_direction,
                layout.vertex_of_direction,
                layout.ring_of_vertex,
                crowd.via_of_ring,
                scenario.area.tessellation.edge_count,
                crowd.has_vertices,
                crowd.is_destination,
                onward,
                next_of_in,
                next_of_out,
                queue,
                state,
                _BUDGET,
            )
        is_behind = next_of_in[crowd.sites] == -1
        free = np.flatnonzero(~is_behind & ~sent)
        is_cut = (next_of_out >= 0) & (next_of_in == -1)
        full = destinations[(next_of_in[destinations] == -1)]
        nodes = np.concatenate([np.flatnonzero(is_cut), full]).astype(np.int32)
        behind = np.flatnonzero(is_behind[: free[0]] if free.size else is_behind)
        if nodes.size and behind.size:
            width = nodes.size + full.size * ((scenario.destination_capacity or 1) - 1)
            cuts.append(Cut(nodes, width, behind))
        if not free.size:
            break
        sent[free[0]] = True
        kernels.send_unit(int(crowd.sites[free[0]]), onward, next_of_in, next_of_out, room)
    return cuts


def find_crowded_nodes(crowd: Crowd, most: int, most_looks: int = 3_000_000) -> NDArray[np.int32]:
    """Return up to `most` nodes where most robots meet if all take some shortest way without regard to the others.

    If that took more than about `most_looks` steps, evenly chosen robots stand for all.
    """
    from trihex.kernels import bounds_cut as kernels

    scenario, layout = crowd.scenario, crowd.scenario.area.layout
    every = int(crowd.steps.sum()) // most_looks + 1
    sites = np.ascontiguousarray(crowd.sites[::every])
    seen, meetings = np.zeros(crowd.node_count, dtype=np.int64), np.zeros(crowd.node_count, dtype=np.int64)
    kernels.count_meetings(
        sites,
        crowd.steps_of_site,
        scenario.moves,
        layout.offset_of_direction,
        layout.vertex_of_direction,
        scenario.area.tessellation.edge_count,
        crowd.has_vertices,
        np.empty(sites.size, dtype=np.int32),
        seen,
        meetings,
        np.empty(sites.size, dtype=bool),
    )
    met = np.flatnonzero(meetings)
    return met[np.lexsort((met, -meetings[met]))][:most].astype(np.int32)
