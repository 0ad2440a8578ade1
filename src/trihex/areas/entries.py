"""Entries: the ways into destinations, and how many robots can take them in a step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas.scenario import Scenario


def ways_into_destinations(scenario: Scenario, *, by_cells: bool = False) -> NDArray[np.int64]:
    """Return the names of the ways into each destination, each once, shape (destinations, directions); -1: none.

    A way is the neighbour that it comes from, by its site, or the vertex that it shares with others where crossing is
    forbidden, by its number + `layout.size`; `by_cells`, always the neighbour.
    """
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    sites = layout.cell_to_site(scenario.destinations)
    is_destination = np.zeros(layout.size, dtype=bool)
    is_destination[sites] = True
    k = np.arange(tessellation.direction_count)
    parity = (sites & 1)[:, None]
    neighbour = sites[:, None] + layout.offset_of_direction[parity, k]
    is_way_in = (scenario.moves[sites][:, None] >> k & 1).astype(bool) & ~is_destination[neighbour]
    name = neighbour.astype(np.int64)
    if scenario.forbids_crossing and not by_cells:
        vertex = sites[:, None] + layout.vertex_of_direction[parity, k]
        name = np.where(k >= scenario.first_vertex_move, vertex + layout.size, name)
    name = np.where(is_way_in, name, -1)
    name.sort(axis=1)
    is_new = (name >= 0) & np.diff(name, axis=1, prepend=-1).astype(bool)
    return np.where(is_new, name, -1)


def entries_per_step(scenario: Scenario) -> int:
    """Return how many robots can at most enter all destinations together in one step."""
    name = ways_into_destinations(scenario)
    ways_of_destination = (name >= 0).sum(axis=1)
    if scenario.destination_capacity is not None:
        ways_of_destination = np.minimum(ways_of_destination, scenario.entry_limit)
    return int(min(ways_of_destination.sum(), np.unique(name[name >= 0]).size))
