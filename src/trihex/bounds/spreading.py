"""Spreading: each destination has a queue of its own, and robots that would wait long go to another one."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.areas import check_as_fast
from trihex.bounds.approaches import Approaches, find_approaches, find_cheap_approaches
from trihex.bounds.bound import LowerBound
from trihex.bounds.costs import left_field, shares
from trihex.bounds.demand import Demand, make_demand
from trihex.bounds.mouths import Mouths, find_mouths
from trihex.bounds.queueing import Tolls, find_tolls
from trihex.bounds.rhythm import entry_headways, queue_up
from trihex.errors import check_type
from trihex.fields import NScheme

# How many moves farther than to the nearest destination robots may go, at first; twice as far again and again, as long
# as some might wait longer.
_DETOUR = 32
# Nodes that may be visited by all searches together, and looks at robots in queues.
_MOST_VISITS = 40_000_000
_MOST_LOOKS = 100_000_000


def queue_bound(n_scheme: NScheme) -> LowerBound:
    """Find the least sum of times if robots hinder each other only at the mouths of the destinations.

    Each destination is entered by so many robots in a step and no more: its capacity, the ways into it, or the throat
    around them; whoever would have to queue there may walk to another one.

    Examples
    --------
    >>> from trihex import Area, Scenario, make_n_scheme
    >>> area = Area("square", [[0] * 12])
    >>> queue_bound(make_n_scheme(Scenario(area, [0, 11], [1, 2, 3, 4]))).value
    100
    """
    check_type("n_scheme", n_scheme, NScheme)
    check_as_fast(n_scheme.scenario, "the queue bound")
    demand = make_demand(n_scheme)
    if demand.sites.size == 0:
        return LowerBound("queue", 0)
    mouths = find_mouths(demand)
    approaches, tolls = _queue_up(demand, mouths)
    return LowerBound("queue", max(_least_cost(n_scheme, demand, mouths, approaches, one) for one in tolls))


def _queue_up(demand: Demand, mouths: Mouths) -> tuple[Approaches, list[Tolls]]:
    """Return approaches that are wide enough, and the tolls for windows as wide as each headway there is."""
    widths: list[int] = np.unique(np.concatenate(mouths.headways)).tolist()
    steps = np.sort(demand.steps)
    queued = steps.copy()
    queue_up(queued, entry_headways(demand.nodes))
    # So long some wait even if all destinations were one.
    detour = max(_DETOUR * int(demand.scenario.duration_of_direction.min()), int((queued - steps).max()))
    visits = 0
    while True:
        approaches = find_approaches(demand, detour)
        visits += approaches.visits
        looks, starts = _MOST_LOOKS // len(widths), demand.start_times
        tolls = [
            find_tolls(approaches, starts, mouths.is_inside, mouths.places(width), width, looks) for width in widths
        ]
        is_held_up = [_pays(demand, mouths, approaches, one) == _farther(demand, approaches, one) for one in tolls]
        may_gain = all(held_up[~mouths.is_inside].any() for held_up in is_held_up)
        if not may_gain or visits + 4 * approaches.visits > _MOST_VISITS:
            return approaches, tolls
        detour *= 2


def _farther(demand: Demand, approaches: Approaches, tolls: Tolls) -> NDArray[np.int64]:
    """Return what robots pay at least at destinations to which no way is known."""
    return tolls.pays_anywhere(demand.steps + approaches.detour + 1)


def _pays(
    demand: Demand, mouths: Mouths, approaches: Approaches, tolls: Tolls, left: _Left | None = None
) -> NDArray[np.int64]:
    """Return how many ticks each robot pays at least, tolls included; or what they and what is `left` cost."""
    share = 1 if left is None else left.share
    pays = share * np.where(mouths.is_inside, demand.steps, _farther(demand, approaches, tolls))
    if left is not None:
        pays += left.nearest
    for mouth, (robots, lengths) in enumerate(zip(approaches.robots, approaches.lengths, strict=True)):
        pays_here = share * tolls.pays(mouth, lengths + demand.start_times[robots])
        if left is not None:
            pays_here += left.at_mouth(mouth)[robots]
        pays[robots] = np.minimum(pays[robots], pays_here)
    return pays


def _least_cost(n_scheme: NScheme, demand: Demand, mouths: Mouths, approaches: Approaches, tolls: Tolls) -> int:
    """Return what all robots pay at least, in costs, less the tolls."""
    ticks = _pays(demand, mouths, approaches, tolls)
    if demand.scenario.clock == "costs":
        return int(ticks.sum()) - tolls.total
    # The share that is best if what is left is that on the way to the nearest destination. All that a move costs it is
    # seldom, and then robots may go anywhere along the cheapest moves.
    choices = shares(demand.scenario)
    cheapest = int(demand.scenario.area.tessellation.cost_of_direction.min())
    longest = int((ticks - demand.steps).max())
    parts = [
        _Left(n_scheme, demand, approaches, longest, share)
        for share in choices
        if share < cheapest or len(choices) == 1
    ]
    left = max(parts, key=lambda left: left.share * (int(ticks.sum()) - tolls.total) + int(left.nearest.sum()))
    pays = _pays(demand, mouths, approaches, tolls, left)
    waits = (demand.scenario.waiting_cost - left.share) * int(demand.start_times.sum())
    return int(pays.sum()) + waits - left.share * tolls.total


class _Left:
    """What is left of the costs of robots on their way to each destination, once each step is charged a share."""

    def __init__(self, n_scheme: NScheme, demand: Demand, approaches: Approaches, longest: int, share: int) -> None:
        self.demand, self.steps, self.longest, self.share = demand, approaches, longest, share
        self.cost = demand.scenario.area.tessellation.cost_of_direction - np.int32(share)
        self.is_equal = bool((self.cost == self.cost[0]).all())
        self.field = None if self.is_equal else left_field(n_scheme, share)
        at_robots = demand.nodes.steps_of_site[demand.sites] if self.field is None else self.field[demand.sites]
        #: Of each robot on its way to the nearest destination.
        self.nearest = at_robots.astype(np.int64) * self.scale

    @property
    def scale(self) -> int:
        """What a unit of length of the approaches costs."""
        return int(self.cost[0]) if self.is_equal else 1

    @cached_property
    def approaches(self) -> Approaches:
        """How much is left, by destination."""
        if self.field is None:
            return self.steps
        return find_cheap_approaches(self.demand, self.cost, self.field, self.longest * int(self.cost.max()))

    def at_mouth(self, mouth: int) -> NDArray[np.int64]:
        """Return the least that is left for each robot if it goes to this destination."""
        left = self.nearest + (self.approaches.detour + 1) * self.scale
        left[self.approaches.robots[mouth]] = self.approaches.lengths[mouth].astype(np.int64) * self.scale
        return left
