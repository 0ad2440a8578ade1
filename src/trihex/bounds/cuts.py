"""Chokes: where robots on their way must pass one by one.

A *node* is a site, or ``layout.size + vertex`` for a lattice vertex, where the scenario lets but one robot pass it in a
step.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import steps_to_destination
from trihex.record import Record, read_only

_BUDGET = 1_000_000
_ALL_CUTS = 12


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

    def sites_around(self, vertex: int) -> NDArray[np.int32]:
        """Return the sites from which a move passes the lattice vertex with this number."""
        sites = vertex + self.scenario.area.layout.ring_of_vertex
        return np.asarray(sites[(self.scenario.moves[sites] & self.scenario.area.layout.via_of_ring) > 0])


def make_crowd(scenario: Scenario) -> Crowd:
    """Count the steps to the nearest destination from every site."""
    return Crowd(scenario, steps_to_destination(scenario))


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


def find_cuts(crowd: Crowd, most_searches: int, most_looks: int = 5_000_000) -> list[Cut]:
    """Return least cuts for the farthest robots, for ever more of them; each lies nearer to the destinations.

    A unit of flow is sent from each robot in turn, the farthest first. Before one that can be sent while the one before
    could not, and at the end, all tried so far are parted from the destinations by a cut of as many nodes as units were
    sent. Of all such cuts the one taken is the nearest to the destinations.

    Parameters
    ----------
    crowd : Crowd
    most_searches : int
        How many cuts to look for, at least 1. If there are more, some are left out, but not that for all robots.
    most_looks : int
        After about so many looks, and three at each node, no more units are sent; the last cut is then for the farthest
        robots only. (With many destinations the last units go far before they find room: 4 s for 50 of them on
        512 x 512 cells.)
    """
    return _Flow(crowd).cuts(max(most_searches, 1), most_looks + 3 * crowd.node_count)


class _Flow:
    """The flow from which `find_cuts` reads the cuts."""

    def __init__(self, crowd: Crowd) -> None:
        scenario, layout = crowd.scenario, crowd.scenario.area.layout
        self.crowd = crowd
        self.destinations = layout.cell_to_site(scenario.destinations)
        self.room = np.zeros(layout.size, dtype=np.int32)
        most = np.iinfo(np.int32).max
        self.room[self.destinations] = most if scenario.destination_capacity is None else scenario.destination_capacity
        self.onward, self.source_of = np.full((2, crowd.node_count), -1, dtype=np.int32)
        self.ahead = np.empty(2 * layout.offset_of_direction.shape[1] + 1, dtype=np.int32)
        self.queue = np.empty(2 * crowd.node_count, dtype=np.int32)
        self.graph = (
            scenario.moves,
            layout.offset_of_direction,
            layout.vertex_of_direction,
            layout.ring_of_vertex,
            crowd.scenario.area.layout.via_of_ring,
            scenario.area.tessellation.edge_count,
            crowd.has_vertices,
            crowd.is_destination,
        )

    def cuts(self, most_searches: int, most_looks: int) -> list[Cut]:
        """Send all units and look for cuts on the way."""
        from trihex.bounds.kernels import cuts as kernels

        robots, robot, tried = self.crowd.sites.size, 0, 0
        state = np.zeros(4, dtype=np.int64)
        seen, parent, stack = np.zeros((3, 2 * self.crowd.node_count), dtype=np.int32)
        cuts: list[Cut] = []
        while robot < robots and state[kernels.LOOKS] < most_looks:
            robot = kernels.send_units(
                self.crowd.sites,
                robot,
                self.crowd.steps_of_site,
                *self.graph,
                self.room,
                self.onward,
                self.source_of,
                seen,
                parent,
                stack,
                self.queue,
                self.ahead,
                state,
                _BUDGET,
            )
            if state[kernels.FAILED] and robot < robots:
                # As many as the ways into one destination; beyond that only where many more robots are behind.
                if len(cuts) + 1 < most_searches and (len(cuts) < _ALL_CUTS or robot > 1.5 * tried):
                    cuts, tried = [*cuts, *self.cut(robot)], robot
                state[kernels.FAILED] = 0
        return [*cuts, *self.cut(robot)]

    def cut(self, robot: int) -> list[Cut]:
        """Return the cut nearest to the destinations that parts robots ``0..robot - 1`` from them, if it parts any."""
        from trihex.bounds.kernels import cuts as kernels

        leads_on = np.zeros(2 * self.crowd.node_count, dtype=bool)
        roots = 2 * self.destinations[self.room[self.destinations] > 0]
        leads_on[roots] = True
        head, tail = 0, roots.size
        self.queue[:tail] = roots
        while head < tail:
            end = min(tail, head + _BUDGET)
            tail = kernels.search_back(*self.graph, self.onward, leads_on, self.queue, head, tail, _BUDGET)
            head = end
        is_in, is_out = leads_on[::2], leads_on[1::2]
        full = self.destinations[~is_in[self.destinations]]
        nodes = np.concatenate([np.flatnonzero(is_out & ~is_in), full]).astype(np.int32)
        behind = np.flatnonzero(~is_in[self.crowd.sites[:robot]])
        capacity = self.crowd.scenario.destination_capacity or 1
        return [Cut(nodes, nodes.size + full.size * (capacity - 1), behind)] if behind.size else []


def find_crowded_nodes(crowd: Crowd, most: int, most_looks: int = 3_000_000) -> NDArray[np.int32]:
    """Return up to `most` nodes where most robots meet if all take some shortest way without regard to the others.

    If that took more than about `most_looks` steps, evenly chosen robots stand for all.
    """
    from trihex.bounds.kernels import cuts as kernels

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
