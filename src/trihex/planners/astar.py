"""Planner `astar`: cooperative A*, robot by robot in order of distance, each past the ways of those before it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import check_as_fast
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.planners.recording import Progress
from trihex.planners.reservations import Reservations
from trihex.plans import Plan


def plan_astar(n_scheme: NScheme, *, memory_limit: int | None = None, progress: Progress | None = None) -> Plan:
    """Plan by cooperative A*, the comparison of the paper: no robot makes way for one that is planned later.

    Robots are planned in order of their distance. Each takes its cheapest way in space and time past the ways of those
    before it, which it leaves as they are. They may lead over the start of a robot that is planned later; if that one
    finds no way out in time, all is planned again, and starts of later robots are taboo. Then nobody ever stands in
    its way before it is its turn, nor on any of its shortest ways, because it is nearer than those that come after it;
    so in the worst case it waits until all before it have arrived, and there is always a plan. Nobody is
    led where a robot stands until its start time.

    Parameters
    ----------
    n_scheme : NScheme
    memory_limit : int, optional
        In bytes, of the table of what is reserved: one for each cell and step, and another where crossing is forbidden.
        Default: 80 % of what is available.
    progress : callable, optional
        Called with (robots planned, robots that can arrive).

    Raises
    ------
    TooLargeError
        If the table would take more than `memory_limit`.
    """
    scenario = n_scheme.scenario
    check_as_fast(scenario, "planner 'astar'")
    site = scenario.area.layout.cell_to_site(scenario.robots)
    distance = n_scheme.distance_of_site[site]
    going = np.flatnonzero((distance != NOT_REACHED) & (distance != 0))
    going = going[np.argsort(distance[going], kind="stable")]
    ways, start_times = None, scenario.start_times[going]
    for respects_starts in (False, True):
        reservations = Reservations(n_scheme, memory_limit)
        if going.size:
            reservations.make_room(reservations.least_steps(int(distance[going[-1]])) + 1)
        ways = _find_ways(reservations, site[going], start_times, respects_starts, progress)
        if ways is not None:
            break
    if ways is None:
        raise RuntimeError("a robot found no way although all respected the starts of those after them")
    length = np.zeros(scenario.robot_count, dtype=np.int64)
    length[going] = [way.size for way in ways]
    way_of_robot = dict(zip(going.tolist(), ways, strict=True))
    actions = [way_of_robot[robot] for robot in sorted(way_of_robot)]
    flat = np.concatenate(actions) if actions else np.empty(0, dtype=np.uint8)
    return Plan(scenario, flat, np.append(0, np.cumsum(length)), planner="astar")


def _find_ways(
    reservations: Reservations,
    starts: NDArray[np.int32],
    start_times: NDArray[np.int64],
    respects_starts: bool,
    progress: Progress | None,
) -> list[NDArray[np.uint8]] | None:
    """Return the actions of each robot, or None if one finds no way."""
    is_shut = np.zeros(reservations.distance.size if respects_starts else 0, dtype=bool)
    if respects_starts:
        is_shut[starts] = True
    for robot in np.flatnonzero(start_times).tolist():
        reservations.hold(starts[robot], start_times[robot])
    ways = []
    if progress is not None:
        progress(0, starts.size)
    for count, (start, start_time) in enumerate(zip(starts.tolist(), start_times.tolist(), strict=True)):
        if respects_starts:
            is_shut[start] = False
        way = reservations.find_way(start, start_time, is_shut)
        if way is None:
            return None
        reservations.reserve(start, way)
        ways.append(way)
        if progress is not None and count % 16 == 15:
            progress(count + 1, starts.size)
    return ways
