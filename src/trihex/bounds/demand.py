"""Demand: the robots of a scenario that have to be led to destinations."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.bounds.nodes import Nodes
from trihex.fields import NScheme, steps_to_destination
from trihex.kernels.codes import NOT_REACHED
from trihex.record import Record, read_only


@dataclass(frozen=True, eq=False)
class Demand(Record):
    """The robots that can arrive and have not yet.

    Parameters
    ----------
    nodes : Nodes
        The places that their ways pass.
    """

    nodes: Nodes

    @property
    def scenario(self) -> Scenario:
        """The scenario."""
        return self.nodes.scenario

    @cached_property
    def _robots(self) -> NDArray[np.int64]:
        """Their numbers, those first that arrive last if nobody is in the way."""
        steps = self.nodes.steps_of_site[self.scenario.area.layout.cell_to_site(self.scenario.robots)]
        robots = np.flatnonzero(steps > 0)
        return robots[np.argsort(-(steps + self.scenario.start_times)[robots], kind="stable")]

    @cached_property
    def sites(self) -> NDArray[np.int32]:
        """Sites of the robots, the farthest first, by `steps`."""
        return read_only(self.scenario.area.layout.cell_to_site(self.scenario.robots[self._robots]))

    @cached_property
    def start_times(self) -> NDArray[np.int64]:
        """After how many ticks each of them may begin to move."""
        return read_only(self.scenario.start_times[self._robots])

    @cached_property
    def steps(self) -> NDArray[np.int64]:
        """Least number of ticks in which each of them can arrive, descending."""
        own = self.nodes.steps_of_site[self.sites] * self.scenario.slowness[self._robots]
        return read_only(own + self.start_times)


def make_demand(n_scheme: NScheme) -> Demand:
    """Count the ticks to the nearest destination from every site."""
    scenario = n_scheme.scenario
    if scenario.clock == "steps":
        return Demand(Nodes(scenario, steps_to_destination(scenario)))
    distance = n_scheme.distance_of_site
    return Demand(Nodes(scenario, read_only(np.where(distance == NOT_REACHED, np.int32(-1), distance))))
