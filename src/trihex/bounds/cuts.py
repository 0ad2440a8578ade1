"""Cuts: nodes through which the farthest robots have to pass on their way."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.demand import Demand
from trihex.record import Record

_BUDGET = 1_000_000
_ALL_CUTS = 12


@dataclass(frozen=True, eq=False)
class Cut(Record):
    """Nodes that part the farthest robots from the destinations.

    Parameters
    ----------
    nodes : int32 array
        At most one robot passes each at a time; a destination among them has its capacity.
    width : int
        How many robots pass all of them together at a time at most.
    behind : int64 array
        Which robots of the demand have to pass.
    """

    nodes: NDArray[np.int32]
    width: int
    behind: NDArray[np.int64] = field(repr=False)


def find_cuts(demand: Demand, most_searches: int, most_looks: int = 5_000_000) -> list[Cut]:
    """Return least cuts for the farthest robots, for ever more of them; each lies nearer to the destinations.

    A unit of flow is sent from each robot in turn, the farthest first. Before one that can be sent while the one before
    could not, and at the end, all tried so far are parted from the destinations by a cut of as many nodes as units were
    sent. Of all such cuts the one taken is the nearest to the destinations.

    Parameters
    ----------
    demand : Demand
    most_searches : int
        How many cuts to look for, at least 1. If there are more, some are left out, but not that for all robots.
    most_looks : int
        After about so many looks, and three at each node, no more units are sent; the last cut is then for the farthest
        robots only. (With many destinations the last units go far before they find room: 4 s for 50 of them on
        512 x 512 cells.)
    """
    return _Flow(demand).cuts(max(most_searches, 1), most_looks + 3 * demand.nodes.count)


class _Flow:
    """The flow from which `find_cuts` reads the cuts."""

    def __init__(self, demand: Demand) -> None:
        from trihex.bounds.kernels.units import Units, UnitSearch

        scenario, layout, count = demand.scenario, demand.scenario.area.layout, demand.nodes.count
        self.demand = demand
        self.destinations = layout.cell_to_site(scenario.destinations)
        room = np.zeros(layout.size, dtype=np.int32)
        room[self.destinations] = scenario.entry_limit or np.iinfo(np.int32).max
        onward, source_of = np.full((2, count), -1, dtype=np.int32)
        self.units = Units(room=room, onward=onward, source_of=source_of)
        seen, parent, stack, trail = np.zeros((4, 2 * count), dtype=np.int32)
        self.search = UnitSearch(
            seen=seen,
            parent=parent,
            stack=stack,
            trail=trail,
            ahead=np.empty(layout.offset_of_direction.shape[1], dtype=np.int32),
            state=np.zeros(6, dtype=np.int64),
        )

    def cuts(self, most_searches: int, most_looks: int) -> list[Cut]:
        """Send all units and look for cuts on the way."""
        from trihex.bounds.kernels import units as kernels

        sites, state, robot, tried = self.demand.sites, self.search.state, 0, 0
        cuts: list[Cut] = []
        while robot < sites.size and state[kernels.LOOKS] < most_looks:
            robot = kernels.send_units(sites, robot, self.demand.nodes.graph, self.units, self.search, _BUDGET)
            if state[kernels.FAILED] and robot < sites.size:
                # As many as the ways into one destination; beyond that only where many more robots are behind.
                if len(cuts) + 1 < most_searches and (len(cuts) < _ALL_CUTS or robot > 1.5 * tried):
                    cuts, tried = [*cuts, *self.cut(robot)], robot
                state[kernels.FAILED] = 0
        return [*cuts, *self.cut(robot)]

    def cut(self, robot: int) -> list[Cut]:
        """Return the cut nearest to the destinations that parts robots ``0..robot - 1`` from them, if it parts any."""
        from trihex.bounds.kernels import cuts as kernels
        from trihex.kernels.signatures import given

        nodes = self.demand.nodes
        leads_on = np.zeros(2 * nodes.count, dtype=bool)
        roots = 2 * self.destinations[self.units.room[self.destinations] > 0]
        leads_on[roots] = True
        queue = self.search.trail  # as long as is needed, and free for now
        head, tail = 0, roots.size
        queue[:tail] = roots
        search = given(kernels.CutSearch, leads_on=leads_on, queue=queue)
        while head < tail:
            end = min(tail, head + _BUDGET)
            tail = kernels.search_back(nodes.graph, self.units.onward, search, head, tail, _BUDGET)
            head = end
        is_in, is_out = leads_on[::2], leads_on[1::2]
        full = self.destinations[~is_in[self.destinations]]
        gates = np.concatenate([np.flatnonzero(is_out & ~is_in), full]).astype(np.int32)
        behind = np.flatnonzero(~is_in[self.demand.sites[:robot]])
        width = gates.size + full.size * (max(self.demand.scenario.entry_limit, 1) - 1)
        return [Cut(gates, width, behind)] if behind.size else []
