"""Doors: how long robots are held up at least where cells let them in by a flow."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from trihex.areas import ways_into_destinations
from trihex.bounds.demand import Demand
from trihex.bounds.gates import robots_past

Ints = NDArray[np.int64]


def hold_up_at_exits(demand: Demand, ticks: Ints) -> None:
    """Delay sorted ticks of arrival until all destinations together let in no more in each of them than they do."""
    scenario, schedule = demand.scenario, demand.scenario.schedule
    is_exit = np.isin(schedule.cells, scenario.destinations)
    if not is_exit.any():
        return
    ways = ways_into_destinations(scenario)
    room = (ways >= 0).sum(axis=1)
    if scenario.entry_limit:
        room = np.minimum(room, scenario.entry_limit)
    order = np.argsort(scenario.destinations)
    place = order[np.searchsorted(scenario.destinations[order], schedule.cells[is_exit])]
    others, exits, most = int(room.sum() - room[place].sum()), np.flatnonzero(is_exit), np.unique(ways[ways >= 0]).size

    def entries(steps: Ints) -> Ints:
        let_in = np.minimum(schedule.openings_at(exits, steps[:, None]), room[place]).sum(axis=1)
        return np.asarray(np.repeat(steps, np.minimum(let_in + others, most)))

    _give_slots(ticks, entries)


def arrivals_past_doors(demand: Demand) -> Ints:
    """Return when robots arrive at best, ascending, if they wait only at doors that lie on their way."""
    scenario, schedule, layout = demand.scenario, demand.scenario.schedule, demand.scenario.area.layout
    steps_of_site = demand.nodes.steps_of_site
    sites = layout.cell_to_site(schedule.cells)
    doors = np.flatnonzero((steps_of_site[sites] > 0) & ~np.isin(schedule.cells, scenario.destinations))
    if doors.size == 0:
        return np.sort(demand.steps)
    is_held = robots_past(demand, sites[doors]) & ~np.isin(demand.sites, sites[doors])
    held = np.sort(demand.steps[is_held])

    def entries(ticks: Ints) -> Ints:
        # Whoever comes into a door at a tick arrives as many later, at best, as it is away from the destinations.
        ticks = ticks[:, None] - steps_of_site[sites[doors]]
        let_in = np.where(ticks > 0, np.minimum(schedule.openings_at(doors, ticks), 1), 0).sum(axis=1)
        return np.asarray(np.repeat(ticks[:, 0] + steps_of_site[sites[doors[0]]], let_in))

    _give_slots(held, entries)
    return np.sort(np.concatenate([held, demand.steps[~is_held]]))


def _give_slots(ticks: Ints, entries: Callable[[Ints], Ints]) -> None:
    """Delay sorted ticks until each has a slot of its own; ``entries(ticks)`` are the slots in those ticks, ascending.

    In order each takes the first slot that nobody before has and that is no earlier than its tick.
    """
    if ticks.size == 0:
        return
    first, span = int(ticks[0]), int(ticks[-1] - ticks[0]) + ticks.size
    slots = entries(np.arange(first, first + span))
    rank = np.arange(ticks.size)
    while True:
        place = np.maximum.accumulate(np.searchsorted(slots, ticks) - rank) + rank
        if place[-1] < slots.size:
            ticks[:] = slots[place]
            return
        slots = np.concatenate([slots, entries(np.arange(first + span, first + 2 * span))])
        span *= 2
