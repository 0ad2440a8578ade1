"""Mouths: the nodes that robots on their way to a destination have to pass, for each destination its own."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from trihex.areas import ways_into_destinations
from trihex.bounds.demand import Demand
from trihex.bounds.throats import ThroatSearch
from trihex.record import Record


@dataclass(frozen=True, eq=False)
class Mouths(Record):
    """What robots must pass on their way to each destination.

    Parameters
    ----------
    headways : list of int64 arrays
        Of each destination: how many ticks there are at least between two robots at each node of its mouth.
    is_inside : bool array
        Whether each robot of the demand starts between a mouth and its destination, so that it need not pass.
    """

    headways: list[NDArray[np.int64]] = field(repr=False)
    is_inside: NDArray[np.bool_]

    def places(self, window: int) -> NDArray[np.int64]:
        """Return how many robots pass each mouth in so many ticks at most."""
        return np.array([(-(-window // headways)).sum() for headways in self.headways], dtype=np.int64)


def find_mouths(demand: Demand, most_looks: int = 3_000_000) -> Mouths:
    """Choose for each destination what lets in the fewest: itself, the ways into it, or the throat around them.

    After about `most_looks` no more throats are looked for.
    """
    nodes, scenario = demand.nodes, demand.scenario
    sites = scenario.area.layout.cell_to_site(scenario.destinations)
    kinds = (False,) if scenario.is_stepwise else (False, True)
    ways = [ways_into_destinations(scenario, by_cells=by_cells) for by_cells in kinds]
    search = ThroatSearch(demand)
    is_inside = np.zeros(scenario.area.layout.size, dtype=bool)
    headways = []
    for i in range(sites.size):
        choices = [nodes.queue_headways(one[i, one[i] >= 0]) for one in ways]
        if scenario.destination_capacity is not None or nodes.doors_apart[sites[i]]:
            choices.append(nodes.queue_headways(sites[i : i + 1]))
        best = min(choices, key=_rate)
        if best.size > 1 and search.looks < most_looks:
            throat = search.find(i, ways[0][i, ways[0][i] >= 0])
            if throat is not None and _rate(nodes.queue_headways(throat.nodes)) < _rate(best):
                best = nodes.queue_headways(throat.nodes)
                is_inside[throat.inside] = True
        headways.append(best)
    return Mouths(headways, is_inside[demand.sites])


def _rate(headways: NDArray[np.int64]) -> float:
    """Return how many robots pass in a tick, in the long run."""
    return float((1 / headways).sum())
