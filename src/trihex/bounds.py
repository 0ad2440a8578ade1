"""Bounds: total times that no plan can beat.

All bounds are sums of t_r over the robots that can arrive. What they forget, and how good they are, is told in
docs/bounds.md.

A bound on *steps* becomes one on costs so: let m be the least that a step can cost, min(w_t, cheapest move), and
0 <= u <= m. Charge u for each step; what is left of a move is its cost less u, and of a wait w_t less u, neither
negative. So t_r >= u * (steps of r) + (least sum of what is left on a way of r), for every u alike.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.record import Record
from trihex.scenario import Scenario
from trihex.schemes import NOT_REACHED, NScheme

_BUDGET = 2_000_000


@dataclass(frozen=True, eq=False)
class LowerBound(Record):
    """A total time that no plan can beat.

    Parameters
    ----------
    name : str
        How it was found: "distance", "slot", ... or "optimum" where a plan proves that it can be attained.
    value : int
    """

    name: str
    value: int


def make_lower_bound(n_scheme: NScheme, *, progress: Callable[[int, int], None] | None = None) -> LowerBound:
    """Return the best of all bounds that are quick at this size.

    Examples
    --------
    >>> from trihex import Area, make_n_scheme
    >>> scenario = Scenario(Area("hexagonal", [[0, 0, 0, 0]]), destinations=[(0, 0)], robots=[(2, 0), (3, 0)])
    >>> make_lower_bound(make_n_scheme(scenario)).value
    50
    """
    makers = (distance_bound, slot_bound)
    best = None
    for done, make in enumerate(makers):
        bound = make(n_scheme)
        if best is None or bound.value > best.value:
            best = bound
        if progress is not None:
            progress(done + 1, len(makers))
    assert best is not None
    return best


def distance_bound(n_scheme: NScheme) -> LowerBound:
    """Sum of the N-scheme's values: nobody ever waits."""
    distance = n_scheme.distance_of_cell(n_scheme.scenario.robots).astype(np.int64)
    return LowerBound("distance", int(distance[distance != NOT_REACHED].sum()))


def slot_bound(n_scheme: NScheme) -> LowerBound:
    """In each step only so many robots can enter the destinations, and none before its number of steps allows.

    The number is that of the moves that lead in: one for each neighbour, or for each lattice vertex where crossing is
    forbidden, at most the destination's capacity.
    """
    from trihex.kernels import bounds as kernels

    scenario = n_scheme.scenario
    steps = _at_robots(n_scheme, steps_field(scenario))
    slots = np.sort(steps[steps > 0]).astype(np.int64)
    return LowerBound("slot", _least_cost(n_scheme, int(kernels.queue_up(slots, entries_per_step(scenario)))))


def entries_per_step(scenario: Scenario) -> int:
    """Return how many robots can at most enter all destinations together in one step."""
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    sites = layout.cell_to_site(scenario.destinations)
    is_destination = np.zeros(layout.size, dtype=bool)
    is_destination[sites] = True
    k = np.arange(tessellation.direction_count)
    parity = (sites & 1)[:, None]
    neighbour = sites[:, None] + layout.offset_of_direction[parity, k]
    is_way_in = (scenario.moves[sites][:, None] >> k & 1).astype(bool) & ~is_destination[neighbour]
    # Each way in has a name: the neighbour it comes from, or the vertex it shares with others (numbered apart).
    name = neighbour.astype(np.int64)
    if scenario.crossing == "forbid":
        vertex = sites[:, None] + layout.vertex_of_direction[parity, k]
        name = np.where(k >= tessellation.edge_count, vertex + layout.size, name)
    name = np.where(is_way_in, name, -1)
    name.sort(axis=1)
    is_new = (name >= 0) & np.diff(name, axis=1, prepend=-1).astype(bool)
    ways_of_destination = is_new.sum(axis=1)
    if scenario.destination_capacity is not None:
        ways_of_destination = np.minimum(ways_of_destination, scenario.destination_capacity)
    return int(min(ways_of_destination.sum(), np.unique(name[name >= 0]).size))


def steps_field(scenario: Scenario) -> NDArray[np.int32]:
    """Return the least number of steps from each site to a destination, shape (layout.size,)."""
    from trihex.kernels import bounds as kernels

    layout = scenario.area.layout
    steps = np.full(layout.size, NOT_REACHED, dtype=np.int32)
    queue = np.empty(scenario.area.free_count, dtype=np.int32)
    head, tail = 0, scenario.destinations.size
    queue[:tail] = layout.cell_to_site(scenario.destinations)
    steps[queue[:tail]] = 0
    while head < tail:
        end = min(tail, head + _BUDGET)
        tail = kernels.count_steps(scenario.moves, layout.offset_of_direction, steps, queue, head, tail, _BUDGET)
        head = end
    return steps


def _at_robots(n_scheme: NScheme, field: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return the values of `field` at the robots that can arrive."""
    scenario = n_scheme.scenario
    values = field[scenario.area.layout.cell_to_site(scenario.robots)].astype(np.int64)
    return np.asarray(values[values != NOT_REACHED])


def _least_cost(n_scheme: NScheme, steps: int) -> int:
    """Return what robots must pay in all that need `steps` steps in all."""
    scenario = n_scheme.scenario
    cost = scenario.area.tessellation.cost_of_direction
    return max(share * steps + _rest(n_scheme, cost - np.int32(share)) for share in _shares(scenario))


def _shares(scenario: Scenario) -> Iterable[int]:
    """Return what to charge for each step, see the top of the file."""
    cost = scenario.area.tessellation.cost_of_direction
    most = int(min(scenario.waiting_cost, cost.min()))
    if (cost == cost[0]).all():
        return [most]
    # Two edge moves in place of a vertex move cost 2 e - v more and take a step more.
    dearer = {int(2 * cost.min() - other) for other in cost}
    return sorted({share for share in (most, most * 4 // 5, *dearer) if 0 < share <= most} or {most})


def _rest(n_scheme: NScheme, cost: NDArray[np.int32]) -> int:
    """Return the sum over robots of the least sum of `cost` on the way to a destination."""
    from trihex.kernels import bounds as kernels

    scenario = n_scheme.scenario
    layout = scenario.area.layout
    if (cost == cost[0]).all():
        return distance_bound(n_scheme).value * int(cost[0]) // scenario.area.tessellation.edge_cost
    least = np.full(layout.size, NOT_REACHED, dtype=np.int32)
    queue = np.empty(scenario.area.free_count + 1, dtype=np.int32)
    is_queued = np.zeros(layout.size, dtype=bool)
    state = np.array([0, scenario.destinations.size])
    queue[: state[1]] = layout.cell_to_site(scenario.destinations)
    least[queue[: state[1]]] = 0
    while state[1]:
        kernels.spread_costs(scenario.moves, layout.offset_of_direction, cost, least, queue, is_queued, state, _BUDGET)
    return int(_at_robots(n_scheme, least).sum())
