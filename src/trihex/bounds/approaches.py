"""Approaches: how far robots are from each destination that might be worth the way."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.demand import Demand
from trihex.bounds.gates import Survey
from trihex.record import Record


@dataclass(frozen=True, eq=False)
class Approaches(Record):
    """Which robots may go to which destination, and what it takes them at least.

    Parameters
    ----------
    robots : list of int32 arrays
        Of each destination: robots of the demand, the nearest first.
    lengths : list of int32 arrays
        How far it is for each of them: ticks from when it may begin to move, or what else the moves were said to take.
    detour : int
        For any other robot the way there is longer than to its nearest destination by more than this.
    visits : int
        How many nodes have been visited.
    """

    robots: list[NDArray[np.int32]] = field(repr=False)
    lengths: list[NDArray[np.int32]] = field(repr=False)
    detour: int
    visits: int


def find_approaches(demand: Demand, detour: int) -> Approaches:
    """Search around each destination, as far as no other is nearer by more than `detour` ticks."""
    return _look_around(demand, Survey(demand, np.empty(0, dtype=np.int32), detour=detour))


def find_cheap_approaches(demand: Demand, cost: NDArray[np.int32], least: NDArray[np.int32], detour: int) -> Approaches:
    """Do the same in terms of `cost` of each direction, where `least` is that to the nearest destination by site."""
    from trihex.bounds.kernels.nodes import NodeGraph
    from trihex.kernels.signatures import given

    line = np.searchsorted(np.unique(cost), cost).astype(np.int32)
    values = demand.nodes.graph._replace(steps=least, duration=cost, line=line)._asdict()
    graph: NodeGraph = given(NodeGraph, **values)
    return _look_around(demand, Survey(demand, np.empty(0, dtype=np.int32), graph, detour))


def _look_around(demand: Demand, survey: Survey) -> Approaches:
    robots, lengths, visits = [], [], 0
    for site in demand.scenario.area.layout.cell_to_site(demand.scenario.destinations):
        (_, _, near, length), _ = survey.look(-1, np.array([site], dtype=np.int32))
        robots.append(near)
        lengths.append(length)
        visits += survey.visits
    return Approaches(robots, lengths, int(survey.found.detour), visits)
