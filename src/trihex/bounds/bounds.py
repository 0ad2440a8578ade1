"""Bounds: total times that no plan can beat.

All bounds are sums of t_r over the robots that can arrive. What they forget, and how good they are, is told in
docs/bounds.md.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from trihex.areas import check_as_fast
from trihex.bounds.bound import LowerBound
from trihex.bounds.costs import least_cost, sum_of_distances, waits_before_starts
from trihex.bounds.cuts import Cut, find_cuts
from trihex.bounds.demand import Demand, make_demand
from trihex.bounds.doors import arrivals_past_doors, hold_up_at_exits
from trihex.bounds.gates import GateNetwork, make_gate_network
from trihex.bounds.meetings import find_meeting_nodes
from trihex.bounds.queues import queue_past_cuts
from trihex.bounds.rhythm import entry_headways, queue_up
from trihex.bounds.serving import least_arrivals
from trihex.bounds.spreading import queue_bound
from trihex.errors import PlanError, check_type, check_whole
from trihex.fields import NScheme

# What the cut bound may cost: ways into the destinations times nodes, sites visited by all searches, slots in memory
# (some 50 bytes each), looks at slots. Together some seconds at worst, a fraction of what a plan of that size costs.
_MOST_SENT = 100_000_000
_MOST_VISITS = 30_000_000
_VISITS_PER_ROBOT = 3000  # few robots on a large area: 14 gates in place of 33 leave the bound within 0.001 %
_MOST_SLOTS = 5_000_000
_MOST_LOOKS = 50_000_000
_MOST_CELLS = 10_000_000  # the queue bound visits each several times; it takes 5 s at 13 million, a million robots
_MOST_SHIFTS = 5  # of the windows of gates, where they are longer than a step


def make_lower_bound(n_scheme: NScheme, *, progress: Callable[[int, int], None] | None = None) -> LowerBound:
    """Return the best of all bounds that are quick at this size.

    Examples
    --------
    >>> from trihex import Area, Scenario, make_n_scheme
    >>> scenario = Scenario(Area("hexagonal", [[0, 0, 0, 0]]), destinations=[(0, 0)], robots=[(2, 0), (3, 0)])
    >>> make_lower_bound(make_n_scheme(scenario)).value
    50
    """
    check_type("n_scheme", n_scheme, NScheme)
    makers = [distance_bound, slot_bound, cut_bound]
    scenario = n_scheme.scenario
    if scenario.has_slowness:
        makers = [distance_bound]
    elif scenario.destinations.size > 1 and scenario.area.free_count <= _MOST_CELLS:
        makers.append(queue_bound)
    bounds = []
    for make in makers:
        bounds.append(make(n_scheme))
        if progress is not None:
            progress(len(bounds), len(makers))
    return max(bounds, key=lambda bound: bound.value)


def distance_bound(n_scheme: NScheme) -> LowerBound:
    """Sum of the N-scheme's values: nobody ever waits but until its start time."""
    check_type("n_scheme", n_scheme, NScheme)
    scenario = n_scheme.scenario
    return LowerBound("distance", sum_of_distances(n_scheme) + scenario.waiting_cost * waits_before_starts(n_scheme))


def slot_bound(n_scheme: NScheme) -> LowerBound:
    """In each step only so many robots can enter the destinations, and none before its number of steps allows.

    The number is that of the moves that lead in: one for each neighbour, or for each lattice vertex where crossing is
    forbidden, at most the destination's capacity. Where moves last or nobody may follow at once, so many in a headway.
    """
    check_type("n_scheme", n_scheme, NScheme)
    check_as_fast(n_scheme.scenario, "the slot bound")
    demand = make_demand(n_scheme)
    slots = np.sort(demand.steps)
    queue_up(slots, entry_headways(demand.nodes))
    hold_up_at_exits(demand, slots)
    return LowerBound("slot", least_cost(n_scheme, int(slots.sum())))


def cut_bound(
    n_scheme: NScheme, *, most_gates: int = 64, progress: Callable[[int, int], None] | None = None
) -> LowerBound:
    """Robots hinder each other at gates only: at nested least cuts, and where most shortest ways meet.

    Parameters
    ----------
    n_scheme : NScheme
    most_gates : int
        Fewer are taken where the searches from all gates would take more than about a second.
    progress : callable, optional
        Called with (robots served, robots).
    """
    check_whole("most_gates", most_gates, 0, None, PlanError)
    check_type("n_scheme", n_scheme, NScheme)
    check_as_fast(n_scheme.scenario, "the cut bound")
    return LowerBound("cut", least_cost(n_scheme, _steps_past_gates(make_demand(n_scheme), most_gates, progress)))


def _steps_past_gates(demand: Demand, most_gates: int, progress: Callable[[int, int], None] | None) -> int:
    """Return how many steps (ticks) all robots need at least in all."""
    free_cells, entries = demand.scenario.area.free_count, entry_headways(demand.nodes)
    cuts = []
    if entries.size * demand.nodes.count <= _MOST_SENT:
        cuts = find_cuts(demand, most_searches=_MOST_VISITS // (4 * free_cells) + 1)
    queued = queue_past_cuts(demand, cuts, entries)
    if demand.scenario.has_flows:
        np.maximum(queued, arrivals_past_doors(demand), out=queued)
        hold_up_at_exits(demand, queued)
    visits = min(_MOST_VISITS, _VISITS_PER_ROBOT * demand.sites.size)
    gates = _choose_gates(demand, cuts, min(most_gates, visits // free_cells))
    horizon = int(queued.max(initial=0)) * 5 // 4 + 100
    horizon = min(horizon, _MOST_SLOTS // max(gates.size, 1))
    if gates.size == 0 or horizon == 0:
        return int(queued.sum())
    network = make_gate_network(demand, gates)
    if demand.scenario.is_stepwise:
        passed = _arrivals_past_gates(demand, network, entries, horizon, _MOST_LOOKS, progress)
        return max(int(passed.sum()), int(queued.sum()))
    # At best the i-th arrival is no sooner than any of these say, and no sooner than nobody in the way would allow.
    arrivals = np.maximum(queued, np.sort(demand.steps))
    longest = int(network.gap.max())
    shifts = range(0, longest, -(-longest // _MOST_SHIFTS))
    for shift in shifts:
        looks = _MOST_LOOKS // len(shifts)
        passed = _arrivals_past_gates(demand, network, entries, horizon, looks, progress, shift)
        np.maximum(arrivals, passed, out=arrivals)
    return int(arrivals.sum())


def _arrivals_past_gates(
    demand: Demand,
    network: GateNetwork,
    entries: NDArray[np.int64],
    horizon: int,
    most_looks: int,
    progress: Callable[[int, int], None] | None,
    shift: int = 0,
) -> NDArray[np.int64]:
    """Return when the robots arrive at best, ascending, if they hinder each other at gates only."""
    served, last = least_arrivals(demand, network, horizon, most_looks, progress, shift)
    # Whoever is not served by the last tick looked at arrives later, no more at a time than can enter. But where moves
    # through one way in last longer or shorter, arrivals may be as much closer than their headway.
    duration = demand.scenario.duration_of_direction
    left = np.full(demand.sites.size - served.size, last + 1 - int(duration.max() - duration.min()))
    queue_up(left, entries)
    hold_up_at_exits(demand, left)
    return np.concatenate([served, np.maximum(left, last + 1)])


def _choose_gates(demand: Demand, cuts: list[Cut], most: int) -> NDArray[np.int32]:
    """Return up to `most` nodes: the cut for all robots, those with the longest queues, the nodes where most meet."""
    gates = _doors(demand, most // 2)
    for cut in cuts[-1:] + sorted(cuts[:-1], key=lambda cut: -cut.behind.size / cut.width):
        more = np.union1d(gates, cut.nodes)
        if more.size <= most:
            gates = more
    more_gates = min(most - gates.size, most // 2)
    return np.union1d(gates, find_meeting_nodes(demand, more_gates)) if more_gates > 3 else gates


def _doors(demand: Demand, most: int) -> NDArray[np.int32]:
    """Return the doors that robots can pass, if they are no more than so many."""
    sites = np.sort(demand.scenario.area.layout.cell_to_site(demand.scenario.schedule.cells)).astype(np.int32)
    sites = sites[demand.nodes.steps_of_site[sites] >= 0]
    is_few = demand.scenario.is_stepwise and demand.nodes.places(sites).sum() <= most
    return sites if is_few else sites[:0]
