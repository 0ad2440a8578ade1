"""Lanes: ways from the farthest robots to the destinations that share no cell, and how all other cells join them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import DScheme, NScheme, Wave, make_d_scheme, renew_directions
from trihex.kernels.codes import NOT_REACHED
from trihex.record import Record, read_only

_BUDGET = 1_000_000


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
        ends = np.flatnonzero(self.n_scheme.distance_of_site[following] == 0) + 1
        return np.split(layout.site_to_cell(self.sites), ends)[:-1]


def make_lanes(n_scheme: NScheme, *, all_there_are: bool = False, most_visits: int = 1 << 62) -> Lanes:
    """Make lanes from the robots, the farthest first, and let all other cells join them.

    The farthest robot gets the cheapest way to a destination. Each next one gets a lane if there is any, if need be by
    leading earlier lanes elsewhere, and so that all together cost least: a flow of least cost in which each cell
    carries one (Ford and Fulkerson 1962). So behind any choke there are as many lanes as robots can pass it in a step.
    A lane is left out where its detour costs more than the wait that it saves: if robots arrived one behind the other
    in the lanes so far, the nearest first, this one would be there sooner.

    Parameters
    ----------
    n_scheme : NScheme
    all_there_are : bool
        Make lanes that are not worth their detours as well.
    most_visits : int
        Look for no more lanes after visits to so many nodes, each of which takes about a quarter of a microsecond.
    """
    from trihex.planners.kernels import lanes as kernels

    scenario = n_scheme.scenario
    layout, cost = scenario.area.layout, scenario.area.tessellation.cost_of_direction
    starts, nodes = _linked(n_scheme, all_there_are, most_visits)
    along, direction = np.full(layout.size, NOT_REACHED, dtype=np.int32), np.zeros(layout.size, dtype=np.uint16)
    goals = layout.cell_to_site(scenario.destinations)
    along[goals] = 0
    moves, sites = scenario.moves.copy(), np.empty(scenario.area.free_count, dtype=np.int32)
    count = kernels.lay(starts, layout.offset_of_direction, cost, nodes, moves, along, direction, sites)
    sites = sites[:count].copy()
    Wave(scenario, moves, along).lowered(np.concatenate([goals, sites]))
    forest = replace(n_scheme, distance_of_site=read_only(along))
    directions = make_d_scheme(forest).directions_of_site.copy()
    # Beside a lane, and nowhere else, distances may differ by more than a move, which the D-scheme takes for granted.
    renew_directions(scenario, sites, scenario.moves, along, directions)
    directions[sites] = direction[sites]
    return Lanes(forest, DScheme(forest, read_only(directions)), read_only(sites))


def _linked(n_scheme: NScheme, all_there_are: bool, most_visits: int) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return the sites of robots, the farthest first, and the nodes of `kernels.lanes` with all lanes."""
    from trihex.planners.kernels import lanes as kernels

    scenario, distance = n_scheme.scenario, n_scheme.distance_of_site
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    starts = layout.cell_to_site(scenario.robots)
    starts = starts[(distance[starts] != NOT_REACHED) & (distance[starts] > 0)]
    starts = starts[np.argsort(-distance[starts], kind="stable")]
    forbids = scenario.crossing == "forbid" and layout.ring_of_vertex.size > 0
    first_vertex_move = tessellation.edge_count if forbids else tessellation.direction_count
    entrances = _entrances(scenario, first_vertex_move)
    price = -1 if all_there_are else price_of_waiting(scenario)
    rules = np.array([first_vertex_move, scenario.destination_capacity or 0, entrances, price], dtype=np.int64)
    nodes = np.zeros((layout.size * (1 + forbids), kernels.COLUMNS), dtype=np.int32)
    seen, level = np.empty(len(nodes), dtype=np.int32), np.empty(len(nodes), dtype=np.int32)
    due = np.full(starts.size, kernels.NOBODY - 1, dtype=np.int64)
    ends, state = np.zeros(layout.size, dtype=np.int32), np.zeros(3, dtype=np.int64)
    graph = (layout.offset_of_direction, layout.vertex_of_direction, layout.ring_of_vertex, layout.via_of_ring)
    while state[kernels.TRIED] < starts.size and state[kernels.FOUND] < entrances and most_visits > 0:
        before = state[kernels.VISITED]
        kernels.link(
            *(rules, starts, scenario.moves, distance, *graph, tessellation.cost_of_direction),
            *(nodes, ends, due, seen, level, state, min(_BUDGET, most_visits)),
        )
        most_visits -= int(state[kernels.VISITED] - before)
    return starts, nodes


def price_of_waiting(scenario: Scenario) -> int:
    """Return what a step of waiting in a line costs: w_t, but no more than to go to and fro instead."""
    return min(scenario.waiting_cost, int(scenario.area.tessellation.cost_of_direction.min()))


def _entrances(scenario: Scenario, first_vertex_move: int) -> int:
    """Return how many robots can enter destinations in one step at most."""
    layout = scenario.area.layout
    goals = layout.cell_to_site(scenario.destinations)
    moves = np.arange(scenario.area.tessellation.direction_count)
    is_open = scenario.moves[goals, None] >> moves & 1 > 0
    # Nobody shares an edge; but several moves may pass one vertex.
    through = np.where(moves < first_vertex_move, -1 - moves, goals[:, None] + layout.vertex_of_direction[goals & 1])
    ways = [np.unique(row[is_there]).size for row, is_there in zip(through, is_open, strict=True)]
    return int(np.minimum(ways, scenario.destination_capacity or max(ways, default=0)).sum())
