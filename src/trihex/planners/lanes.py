"""Lanes: ways from the farthest robots to the destinations that share no cell, and how all other cells join them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, entries_per_step
from trihex.fields import DScheme, NScheme, Wave, make_d_scheme, renew_directions
from trihex.kernels.codes import NOT_REACHED
from trihex.record import Record, read_only

_BUDGET = 1_000_000  # nodes visited in one call of a kernel
_ANY_NUMBER = 1 << 40
_HEAP_SIZE = 1024  # of the first heap; one that is too small is doubled


@dataclass(frozen=True, eq=False)
class Lanes(Record):
    """A forest over all cells that is as wide as the area allows.

    Shortest ways share cells: where a corridor of two cells bends, all of them go round the inner corner, and one robot
    passes in each step where two could. A *lane* is a way to a destination that shares no cell (nor, where nobody may
    cross, a lattice vertex) with any other lane. Every other cell joins the lanes and destinations by a shortest way.

    Parameters
    ----------
    n_scheme : NScheme
        With what it costs along the forest in place of the least distances.
    d_scheme : DScheme
        Its directions; one only in each cell of a lane.
    sites : ndarray of int32
        Sites of the lanes, lane by lane, each from its beginning to its end.
    """

    n_scheme: NScheme
    d_scheme: DScheme
    sites: NDArray[np.int32]

    @property
    def ways(self) -> list[NDArray[np.int64]]:
        """Cells of each lane, by number, without its destination."""
        layout, bits = self.n_scheme.scenario.area.layout, self.d_scheme.directions_of_site[self.sites]
        k = np.log2(np.maximum(bits, 1)).astype(np.int64)
        following = self.sites + layout.offset_of_direction[self.sites & 1, k]
        ends = np.flatnonzero(np.isin(following, layout.cell_to_site(self.n_scheme.scenario.destinations))) + 1
        return np.split(layout.site_to_cell(self.sites), ends)[:-1]


def make_lanes(
    n_scheme: NScheme,
    *,
    all_there_are: bool = False,
    most_visits: int = _ANY_NUMBER,
    catchment_of_site: NDArray[np.int32] | None = None,
    patience: int = _ANY_NUMBER,
) -> Lanes:
    """Make lanes from the robots, the farthest first, and let all other cells join them.

    The farthest robot gets the cheapest way to a destination. Each next one gets a lane if there is any, if need be by
    leading earlier lanes elsewhere, and so that all together cost least: a flow of least cost in which each cell
    carries one (Ford and Fulkerson 1962). So behind any narrow place there are as many lanes as robots can pass it in a
    step.
    A lane is left out where its detour costs more than the wait that it saves: if robots arrived one behind the other
    in the lanes so far, the nearest first, this one would be there sooner.

    Parameters
    ----------
    n_scheme : NScheme
        Destinations may have a price in place of distance 0; it counts as part of a lane.
    all_there_are : bool
        Make lanes that are not worth their detours as well.
    most_visits : int
        Look for no more lanes after visits to so many nodes, each of which takes about a quarter of a microsecond.
    catchment_of_site : ndarray of int32, optional
        Numbers of parts of the area that lanes do not leave; each part has lanes of its own, as many as are worth it.
    patience : int
        After so many robots in turn without a lane nobody else of a catchment is tried.
    """
    from trihex.planners.kernels.laying import Laid, lay

    scenario = n_scheme.scenario
    layout, goals = scenario.area.layout, scenario.area.layout.cell_to_site(scenario.destinations)
    along, direction = np.full(layout.size, NOT_REACHED, dtype=np.int32), np.zeros(layout.size, dtype=np.uint16)
    along[goals] = n_scheme.distance_of_site[goals]
    moves, sites = scenario.moves.copy(), np.empty(scenario.area.free_count, dtype=np.int32)
    laid = Laid(moves=moves, distance=along, direction=direction, sites=sites)
    catchment = np.zeros(layout.size, dtype=np.int32) if catchment_of_site is None else catchment_of_site
    demand = _demand(n_scheme, catchment, all_there_are, most_visits, patience)
    count = lay(demand, *_linked(n_scheme, catchment, demand), laid)
    sites = sites[:count].copy()
    Wave(scenario, moves, along).lowered(np.concatenate([goals, sites]))
    forest = replace(n_scheme, distance_of_site=read_only(along))
    directions = make_d_scheme(forest).directions_of_site.copy()
    # Beside a lane or a destination, and nowhere else, distances may differ by more than a move, which the D-scheme
    # takes for granted.
    renew_directions(scenario, np.concatenate([goals, sites]), scenario.moves, along, directions)
    directions[sites] = direction[sites]
    directions[goals] = 0
    along[goals] = 0  # only now: what has been paid for an exit is no way
    return Lanes(forest, DScheme(forest, read_only(directions)), read_only(sites))


def _demand(
    n_scheme: NScheme, catchment: NDArray[np.int32], all_there_are: bool, most_visits: int, patience: int
) -> Any:
    """Return who is to get a lane, as kernels know it."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels import lanes, residual

    scenario, starts = n_scheme.scenario, _starts(n_scheme, catchment)
    places = scenario.headway // int(scenario.duration_of_direction.min())
    first = np.append(0, np.cumsum(np.bincount(catchment[starts], minlength=1))).astype(np.int64)
    return given(
        lanes.LaneDemand,
        starts=starts,
        first=first,
        found=np.zeros(first.size - 1, dtype=np.int64),
        due=np.full(starts.size, residual.NOBODY - 1, dtype=np.int64),
        price=-1 if all_there_are else price_of_waiting(scenario) * places,
        most_visits=most_visits,
        patience=patience,
        most_lanes=entries_per_step(scenario),
        capacity=scenario.entry_limit,
    )


def _linked(n_scheme: NScheme, catchment: NDArray[np.int32], demand: Any) -> tuple[Any, Any]:
    """Return the streets, and the network with all lanes, as kernels know them."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels import residual
    from trihex.planners.kernels.lanes import close_borders

    scenario = n_scheme.scenario
    layout, cost = scenario.area.layout, scenario.area.tessellation.cost_of_direction
    streets = given(
        residual.Streets,
        moves=scenario.moves,
        distance=n_scheme.distance_of_site,
        catchment=catchment,
        offset=layout.offset_of_direction,
        vertex=layout.vertex_of_direction,
        ring=layout.ring_of_vertex,
        via=layout.via_of_ring,
        cost=cost,
        toll=cost.max(),
        first_vertex_move=scenario.first_vertex_move,
    )
    count = layout.size * (1 + scenario.forbids_crossing)
    ends = np.full(layout.size, -1, dtype=np.int32)
    ends[layout.cell_to_site(scenario.destinations)] = 0
    network = given(
        residual.LaneNetwork,
        node=np.zeros((count, residual.COLUMNS), dtype=np.int32),
        ends=ends,
        seen=np.empty(count, dtype=np.int32),
        level=np.empty(count, dtype=np.int32),
    )
    if demand.found.size > 1:
        close_borders(streets, network)
    _link(demand, streets, network)
    return streets, network


def _link(demand: Any, streets: Any, network: Any) -> None:
    """Find lanes until there is nothing left to try, or as many nodes have been visited as may be."""
    from trihex.planners.kernels import lanes as kernels

    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    heap = np.empty(_HEAP_SIZE, dtype=np.int64)
    while state[kernels.TRIED] < demand.starts.size and state[kernels.FOUND] < demand.most_lanes:
        if kernels.link(demand, streets, network, heap, state, _BUDGET):
            heap = np.empty(2 * heap.size, dtype=np.int64)


def _starts(n_scheme: NScheme, catchment: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the sites of robots that have a way before them, catchment by catchment, the farthest first."""
    distance, scenario = n_scheme.distance_of_site, n_scheme.scenario
    robots = scenario.robots[~np.isin(scenario.robots, scenario.destinations)]
    starts: NDArray[np.int32] = scenario.area.layout.cell_to_site(robots)
    starts = starts[distance[starts] != NOT_REACHED]
    return starts[np.lexsort((-distance[starts], catchment[starts]))]


def price_of_waiting(scenario: Scenario) -> int:
    """Return what it costs to wait in a line for one move: w_t, but no more than to go to and fro instead."""
    shortest = int(scenario.duration_of_direction.min())
    return min(scenario.waiting_cost * shortest, int(scenario.area.tessellation.cost_of_direction.min()))
