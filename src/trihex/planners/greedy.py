"""Planner `greedy`: robots descend the D-scheme, nearest first, and wait where they are blocked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.fields import NScheme, make_d_scheme
from trihex.planners.crowd import make_crowd, make_ways, regions_of
from trihex.planners.recording import Progress, Recording
from trihex.planners.timely import descend_timely
from trihex.plans import Arrivals, Plan


def plan_greedy(n_scheme: NScheme, *, progress: Progress | None = None) -> Plan:
    """Plan by greedy descent of the distance, a baseline of the paper (section 5).

    In each step each robot takes the first of its tied best directions that is free, and waits if there is none; those
    are asked first that started nearest. Into a cell that is left while somebody waits for it another moves up at once.
    Nobody ever steps aside, so it is blind to congestion; yet in every step some robot comes nearer, so every robot
    that can arrive does. Destinations less than 64 columns and rows apart count as one region, and robots keep to their
    region.

    Parameters
    ----------
    n_scheme : NScheme
    progress : callable, optional
        Called with (robots arrived, robots that can arrive).
    """
    return run_greedy(n_scheme, True, progress).make_plan("greedy")


def arrivals_greedy(n_scheme: NScheme, *, progress: Progress | None = None) -> Arrivals:
    """Return the arrivals of what `plan_greedy` plans."""
    return run_greedy(n_scheme, False, progress).make_arrivals("greedy")


def run_greedy(
    n_scheme: NScheme, keeps_actions: bool, progress: Progress | None = None, limit: float = float("inf")
) -> Recording:
    """Simulate until all have arrived, or the total time is sure to be `limit` or more."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels import greedy as kernels
    from trihex.planners.kernels.cells import DESTINATION, OCCUPIED, Cells, find_regions

    scenario = n_scheme.scenario
    if not scenario.moves_by_steps:
        return descend_timely(make_d_scheme(n_scheme), keeps_actions, progress, limit)
    layout = scenario.area.layout
    destinations = layout.cell_to_site(scenario.destinations)
    flags = make_d_scheme(n_scheme).directions_of_site.copy()
    region_of_site = np.zeros(layout.size, dtype=np.int32)
    region_of_site[destinations] = regions_of(scenario) + 1
    cells, ways = given(Cells, flags=flags, region=region_of_site), make_ways(scenario)

    def regions_of_starts(starts: NDArray[np.int32]) -> NDArray[np.int64]:
        region = np.empty(starts.size, dtype=np.int32)
        find_regions(starts, cells, ways, region)
        return region.astype(np.int64) - 1

    crowd = make_crowd(n_scheme, regions_of_starts)
    flags[destinations] = DESTINATION
    flags[crowd.site_of_robot[1:]] |= np.uint16(OCCUPIED)
    asleep = np.zeros(crowd.robot.size, dtype=np.uint8)
    most = int(crowd.count_of_region.max())
    ranks = given(
        kernels.Ranks,
        site=np.empty(most, dtype=np.int32),
        first_way=np.empty(most, dtype=np.uint8),
        acted=np.empty(most, dtype=np.int8),
    )
    words = (most >> 6) + 1
    awake = given(kernels.Awake, asked=np.empty(words, dtype=np.int64), coming=np.empty(words, dtype=np.int64))
    recording = Recording(crowd, keeps_actions)
    nouns = (ways, cells, asleep, ranks, awake)
    recording.run(lambda *shared: kernels.descend(*nouns, *shared), progress, limit)
    return recording
