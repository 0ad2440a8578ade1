"""Arrivals bound: how many robots can have arrived after each step, in any plan."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.bounds.cuts import find_cuts
from trihex.bounds.demand import make_demand
from trihex.bounds.doors import arrivals_past_doors, hold_up_at_exits
from trihex.bounds.queues import queue_past_cuts
from trihex.bounds.rhythm import entry_headways
from trihex.errors import check_type
from trihex.fields import make_n_scheme
from trihex.record import Record, read_only

# As in `bounds`: what finding cuts may cost.
_MOST_SENT = 100_000_000
_MOST_VISITS = 30_000_000


@dataclass(frozen=True, eq=False)
class EarliestArrivals(Record):
    """What no plan can beat: not more robots have arrived after any step.

    Parameters
    ----------
    name : str
        "cut": robots wait only where they must pass the narrowest places; "distance": nowhere, as where they have
        slowness; "optimum": a plan attains it at all steps.
    steps : int64 array
        Ascending; the i-th robot to arrive, whoever it is, arrives in this step (tick) at best. Robots that cannot
        arrive have none.
    """

    name: str
    steps: NDArray[np.int64]

    def __post_init__(self) -> None:
        self._set("steps", read_only(np.ascontiguousarray(self.steps, dtype=np.int64)))

    def curve(self, steps: int) -> NDArray[np.int64]:
        """Return how many robots can have arrived after step 0, 1, ..., `steps`."""
        return np.searchsorted(self.steps, np.arange(steps + 1), side="right")


def arrivals_bound(scenario: Scenario) -> EarliestArrivals:
    """Bound the arrivals by the distances, the ways into the destinations and nested least cuts.

    Where robots pass a cut, only as many as it is wide pass in a step, or in a headway where moves last or nobody may
    follow at once; so of those behind it the i-th that arrives does so no earlier than if they queued there.

    Examples
    --------
    >>> from trihex import Area
    >>> scenario = Scenario(Area("hexagonal", [[0, 0, 0, 0]]), destinations=[(0, 0)], robots=[(2, 0), (3, 0), (0, 0)])
    >>> arrivals_bound(scenario).steps.tolist()
    [0, 2, 3]
    """
    check_type("scenario", scenario, Scenario)
    demand = make_demand(make_n_scheme(scenario))
    there = np.zeros(np.count_nonzero(np.isin(scenario.robots, scenario.destinations)), dtype=np.int64)
    if scenario.has_slowness:
        return EarliestArrivals("distance", np.append(there, np.sort(demand.steps)))
    entries = entry_headways(demand.nodes)
    cuts = []
    if entries.size * demand.nodes.count <= _MOST_SENT:
        cuts = find_cuts(demand, most_searches=_MOST_VISITS // (4 * scenario.area.free_count) + 1)
    queued = np.sort(queue_past_cuts(demand, cuts, entries))
    if scenario.has_flows:
        np.maximum(queued, arrivals_past_doors(demand), out=queued)
        hold_up_at_exits(demand, queued)
    return EarliestArrivals("cut", np.append(there, queued))
