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
    def sites(self) -> NDArray[np.int32]:
        """Sites of the robots, the farthest first."""
        steps_of_site = self.nodes.steps_of_site
        sites = self.scenario.area.layout.cell_to_site(self.scenario.robots)
        sites = sites[steps_of_site[sites] > 0]
        return read_only(sites[np.argsort(-steps_of_site[sites], kind="stable")])

    @cached_property
    def steps(self) -> NDArray[np.int64]:
        """Least number of ticks of each of them, descending."""
        return read_only(self.nodes.steps_of_site[self.sites].astype(np.int64))


def make_demand(n_scheme: NScheme) -> Demand:
    """Count the ticks to the nearest destination from every site."""
    scenario = n_scheme.scenario
    if scenario.clock == "steps":
        return Demand(Nodes(scenario, steps_to_destination(scenario)))
    distance = n_scheme.distance_of_site
    return Demand(Nodes(scenario, read_only(np.where(distance == NOT_REACHED, np.int32(-1), distance))))
