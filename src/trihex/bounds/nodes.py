"""Nodes: places that but one robot may pass at a time.

A *node* is a site, or ``layout.size + vertex`` for a lattice vertex, where the scenario lets but one robot pass it at a
time. A robot is *in* a cell, or in a destination, from when it has reached its centre; it passes a vertex when the move
through it ends. All times are in ticks; where the clock is "steps" these are steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.record import Record, read_only

if TYPE_CHECKING:
    from trihex.bounds.kernels.nodes import NodeGraph


@dataclass(frozen=True, eq=False)
class Nodes(Record):
    """The nodes of a scenario, with what the kernels need to know about the ways between them.

    Parameters
    ----------
    scenario : Scenario
    steps_of_site : int32 array, shape (layout.size,)
        Least number of ticks to a destination; -1 where none can be reached.
    """

    scenario: Scenario
    steps_of_site: NDArray[np.int32]

    @property
    def count(self) -> int:
        """Number of nodes."""
        return self.scenario.area.layout.size * (1 + self.scenario.forbids_crossing)

    @cached_property
    def is_destination(self) -> NDArray[np.bool_]:
        """Whether each site is a destination."""
        layout = self.scenario.area.layout
        is_destination = np.zeros(layout.size, dtype=bool)
        is_destination[layout.cell_to_site(self.scenario.destinations)] = True
        return read_only(is_destination)

    def sites_around(self, vertex: int) -> NDArray[np.int32]:
        """Return the sites from which a move passes the lattice vertex with this number."""
        layout = self.scenario.area.layout
        sites = vertex + layout.ring_of_vertex
        return np.asarray(sites[(self.scenario.moves[sites] & layout.via_of_ring) > 0])

    @property
    def vertex_duration(self) -> int:
        """How long the shortest move lasts that passes a vertex."""
        return int(self.scenario.duration_of_direction[self.scenario.first_vertex_move :].min(initial=2**30))

    def places(self, nodes: NDArray[np.integer]) -> NDArray[np.int64]:
        """Return how many robots each of `nodes` lets in at a time: one, but for destinations."""
        scenario, size = self.scenario, self.scenario.area.layout.size
        is_entry = (nodes < size) & self.is_destination[np.where(nodes < size, nodes, 0)]
        places = np.where(is_entry, max(scenario.entry_limit, 1), 1).astype(np.int64)
        if scenario.has_flows and scenario.is_stepwise:
            schedule, most = scenario.schedule, np.zeros(size, dtype=np.int64)
            most[scenario.area.layout.cell_to_site(schedule.cells)] = -(-schedule.rate // schedule.period)
            own = np.where(is_entry, most[np.where(is_entry, nodes, 0)], 0)
            places = np.where(own > 0, np.minimum(own, scenario.entry_limit or own), places)
        return places

    @cached_property
    def doors_apart(self) -> NDArray[np.int64]:
        """How many ticks at least there are between two robots that come into each site by its flow; 0 for no door.

        Not where a robot starts: it is there without coming in.
        """
        schedule, layout = self.scenario.schedule, self.scenario.area.layout
        apart = np.zeros(layout.size, dtype=np.int64)
        apart[layout.cell_to_site(schedule.cells)] = schedule.period // schedule.rate
        apart[layout.cell_to_site(self.scenario.robots)] = 0
        return read_only(apart)

    def queue_headways(self, nodes: NDArray[np.integer]) -> NDArray[np.int64]:
        """Return the same as `headways`, or how far apart doors let robots in where that is more."""
        headway, size = self.headways(nodes), self.scenario.area.layout.size
        if not self.scenario.has_flows:
            return headway
        apart = np.where(nodes < size, self.doors_apart[np.where(nodes < size, nodes, 0)], 0)
        return np.asarray(np.maximum(headway, np.repeat(apart, self.places(nodes))))

    def headways(self, nodes: NDArray[np.integer]) -> NDArray[np.int64]:
        """Return how many ticks there are at least between two robots that pass one of `nodes`.

        A destination stands for as many nodes as it lets in at a time.
        """
        scenario, is_site = self.scenario, nodes < self.scenario.area.layout.size
        headway = np.where(is_site, scenario.headway, self.vertex_duration).astype(np.int64)
        is_entry = is_site & self.is_destination[np.where(is_site, nodes, 0)]
        # From half of the move on a robot fills one of the places, where others may follow, else as long as it moves.
        headway[is_entry] = (scenario.headway + 1) // 2
        return np.repeat(headway, self.places(nodes))

    @cached_property
    def graph(self) -> NodeGraph:
        """The same for kernels."""
        from trihex.bounds.kernels.nodes import NodeGraph
        from trihex.kernels.signatures import given

        layout, duration = self.scenario.area.layout, self.scenario.duration_of_direction
        durations = np.unique(duration)
        graph: NodeGraph = given(
            NodeGraph,
            steps=self.steps_of_site,
            is_destination=self.is_destination,
            moves=self.scenario.moves,
            offset=layout.offset_of_direction,
            vertex=layout.vertex_of_direction,
            ring=layout.ring_of_vertex,
            via=layout.via_of_ring,
            first_vertex_move=self.scenario.first_vertex_move,
            duration=duration,
            line=np.searchsorted(durations, duration).astype(np.int32),
            vertex_duration=self.vertex_duration,
            vertex_line=np.searchsorted(durations, self.vertex_duration),
        )
        return graph
