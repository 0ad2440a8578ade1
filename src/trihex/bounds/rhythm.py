"""Rhythm: how soon robots can pass some nodes one after another, if two pass the same node a headway apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import entries_per_step, ways_into_destinations
from trihex.bounds.nodes import Nodes

_MOST_MULTIPLES = 4  # of a headway that are looked at; longer times say hardly more


def queue_up(ticks: NDArray[np.int64], headways: NDArray[np.int64]) -> None:
    """Delay sorted `ticks` until they can be those in which nodes with these `headways` are passed.

    In any t ticks a node with headway h is passed ceil(t / h) times at most. So if that makes k for all nodes, the
    passage k places after another is at least t ticks later.
    """
    from trihex.bounds.kernels import steps as kernels

    spans = np.unique(np.unique(headways)[:, None] * np.arange(1, _MOST_MULTIPLES + 1))
    if (headways == headways[:1]).all():
        spans = headways[:1]  # its multiples follow
    places = -(-spans[:, None] // headways).sum(axis=1)
    kernels.queue_up(ticks, places, spans)


def entry_headways(nodes: Nodes) -> NDArray[np.int64]:
    """Return the headways of the nodes by which robots enter the destinations, those that let in the fewest in the end.

    They are the edge neighbours and vertices, or all neighbours (on squares where nobody may follow a vertex is free
    again sooner than the one cell before it), or, where that lets in fewer, a destination itself.
    """
    scenario = nodes.scenario
    if scenario.is_stepwise:
        return np.ones(entries_per_step(scenario), dtype=np.int64)
    choices = []
    for by_cells in (False, True):
        choices += _entry_choices(nodes, ways_into_destinations(scenario, by_cells=by_cells))
    return min(choices, key=lambda headways: float((1 / headways).sum()))


def _entry_choices(nodes: Nodes, ways: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Return the headways of ways into all destinations, and of those into some, of the others as nodes themselves."""
    scenario, choices = nodes.scenario, [nodes.headways(np.unique(ways[ways >= 0]))]
    if scenario.destination_capacity is not None:
        sites = scenario.area.layout.cell_to_site(scenario.destinations)
        headway = np.where(ways >= 0, nodes.headways(np.maximum(ways, 0).reshape(-1)).reshape(ways.shape), 2**30)
        entry = nodes.headways(sites)
        is_less = scenario.entry_limit / entry[0] <= (1 / headway).sum(axis=1)
        rest = np.unique(ways[~is_less])
        choices.append(np.concatenate([nodes.headways(sites[is_less]), nodes.headways(rest[rest >= 0])]))
    return choices
