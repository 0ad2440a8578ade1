"""Throats: where the surroundings of one destination are narrower than the ways into it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.demand import Demand
from trihex.record import Record

# How far around a destination its throat is looked for, in cells.
_RADIUS = 12
_ROOM = 1 << 30


@dataclass(frozen=True, eq=False)
class Throat(Record):
    """Nodes that robots from outside of a window around a destination have to pass, a least cut.

    Parameters
    ----------
    nodes : int64 array
    inside : int64 array
        Sites of the window from which the destination can be reached without passing them.
    """

    nodes: NDArray[np.int64]
    inside: NDArray[np.int64]


class ThroatSearch:
    """Searches for throats, which share their arrays.

    Units of flow are sent from the ways into a destination to whatever lies outside of the window. Moves can be made
    either way, so as many nodes as there are units part the one from the other; taken are those next to the ways.
    """

    def __init__(self, demand: Demand) -> None:
        from trihex.bounds.kernels.units import Units, UnitSearch

        scenario, layout, count = demand.scenario, demand.scenario.area.layout, demand.nodes.count
        self.layout, self.sites = layout, layout.cell_to_site(scenario.destinations)
        self.xy = np.stack(scenario.area.cell_to_xy(scenario.destinations), axis=1)
        self.has_vertices = scenario.forbids_crossing
        # Where moves through a vertex last differently, it is not known how far it is from there.
        vertex_moves = scenario.duration_of_direction[scenario.first_vertex_move :]
        self.is_possible = np.unique(vertex_moves).size <= 1
        if not self.is_possible:
            return
        # Outside, and at other destinations, units end; those have room there. Away from destinations is on their way.
        self.is_end = np.ones(layout.size, dtype=bool)
        away = (-demand.nodes.steps_of_site).astype(np.int32)
        self.graph = demand.nodes.graph._replace(steps=away)
        room = np.full(layout.size, _ROOM, dtype=np.int32)
        room[self.sites] = 0
        onward, source_of = np.full((2, count), -1, dtype=np.int32)
        self.units = Units(room=room, onward=onward, source_of=source_of)
        seen, parent, stack, trail = np.zeros((4, 2 * count), dtype=np.int32)
        ahead = np.empty(layout.offset_of_direction.shape[1], dtype=np.int32)
        state = np.zeros(6, dtype=np.int64)
        self.search = UnitSearch(seen=seen, parent=parent, stack=stack, trail=trail, ahead=ahead, state=state)

    @property
    def looks(self) -> int:
        """How many looks have been taken."""
        from trihex.bounds.kernels.units import LOOKS

        return int(self.search.state[LOOKS]) if self.is_possible else 0

    def find(self, destination: int, ways: NDArray[np.int64]) -> Throat | None:
        """Return the throat around a destination, if it is narrower than the `ways` into it."""
        from trihex.bounds.kernels import units as kernels
        from trihex.kernels.signatures import given

        if not self.is_possible:
            return None
        sites, search, before = self._window(destination), self.search, self.search.state[kernels.SENT]
        around = self._around(destination)
        inner = np.setdiff1d(sites, self.sites)
        self.is_end[inner] = False
        self.units.room[inner] = 0
        graph = given(type(self.graph), *self.graph._replace(is_destination=self.is_end))
        robot = 0
        while robot < ways.size:  # it returns after every failure
            robot = kernels.send_units(ways.astype(np.int32), robot, graph, self.units, search, _ROOM)
            search.state[kernels.FAILED] = 0
        sent = int(search.state[kernels.SENT] - before)
        is_in, is_out = (search.seen[2 * around + side] == kernels.DEAD for side in range(2))
        starts = ways[(self.units.source_of[ways] == ways) & (search.seen[2 * ways] != kernels.DEAD)]
        # Destinations are entered by some units, and left by none.
        nodes = np.concatenate([np.setdiff1d(around[is_in & ~is_out], self.sites), starts])
        inside = around[is_in & is_out]
        self._clear(around, inner)
        return Throat(nodes, inside[inside < self.layout.size]) if 0 < sent < ways.size else None

    def _window(self, destination: int, margin: int = 0) -> NDArray[np.int64]:
        """Return the sites of the window around a destination, with a margin that may lie outside of the area."""
        x, y = self.xy[destination]
        radius = _RADIUS + margin
        columns = np.arange(max(x - radius, -margin), min(x + radius + 1, self.layout.width + margin))
        rows = np.arange(max(y - radius, -margin), min(y + radius + 1, self.layout.height + margin))
        return (self.layout.origin + rows[:, None] * self.layout.pitch + columns).reshape(-1)

    def _around(self, destination: int) -> NDArray[np.int64]:
        """Return all nodes that units from a destination may have come to: those of the window and next to it."""
        sites = self._window(destination, margin=2)
        sites = sites[(sites >= 0) & (sites < self.layout.size)]
        return np.concatenate([sites, self.layout.size + sites]) if self.has_vertices else sites

    def _clear(self, around: NDArray[np.int64], inner: NDArray[np.int64]) -> None:
        """Leave no trace."""
        self.is_end[inner] = True
        self.units.room[inner] = _ROOM
        self.units.onward[around] = self.units.source_of[around] = -1
        self.search.seen[2 * around] = self.search.seen[2 * around + 1] = 0
