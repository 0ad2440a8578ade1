"""The paper's planner taken literally: each robot examines its ways against the shortest ways of all the others.

Not for use: it shows the growth that section V of the paper states, and counts every comparison of two cells.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

import trihex as th
from trihex.kernels.codes import NOT_REACHED


class LiteralRun(NamedTuple):
    """Comparisons of two cells made by the end of each step, and the step in which each robot arrives."""

    comparisons: np.ndarray
    arrival_step: np.ndarray

    @property
    def steps(self) -> int:
        """K, the number of steps."""
        return len(self.comparisons)


@njit(nogil=True)
def _walk(site, next_of_site, path):
    """Write the shortest way from `site`, which it begins with; return its number of cells, the destination not one."""
    count = 0
    while next_of_site[site] != site:
        path[count] = site
        count += 1
        site = next_of_site[site]
    return count


@njit(nogil=True)
def _meetings(robot, way, first, count, ways, length_of_way, active):
    """Return how many others meet `way` from step `first` on, in one cell at one step, and how often was compared."""
    met, comparisons = 0, 0
    for other in active:
        if other == robot:
            continue
        for i in range(first, min(count, length_of_way[other])):
            comparisons += 1
            if way[i] == ways[other, i]:
                met += 1
                break
    return met, comparisons


@njit(nogil=True)
def _step(active, site, distance, next_of_site, moves, offset, cost, wait, taken, ways, length_of_way, way):
    """Let each robot, the nearest first, take the free move of least Fcost or wait; return the comparisons made."""
    comparisons = 0
    for robot in active:
        length_of_way[robot] = _walk(site[robot], next_of_site, ways[robot])
    for rank in range(len(active)):
        robot = active[rank]
        here = site[robot]
        best, best_target = NOT_REACHED, here
        for k in range(-1, len(cost)):
            if k >= 0 and not moves[here] >> k & 1:
                continue
            target = here if k < 0 else here + offset[here & 1, k]
            if k >= 0 and taken[target] and distance[target] > 0:
                continue
            way[0] = here
            count = 1 + _walk(target, next_of_site, way[1:])
            met, more = _meetings(robot, way, 1, count, ways, length_of_way, active)
            comparisons += more
            fcost = (wait if k < 0 else cost[k]) + distance[target] + wait * met
            if rank == 0 and k >= 0 and target == next_of_site[here]:
                fcost = -1  # the nearest descends, so that all robots arrive
            if fcost < best:
                best, best_target = fcost, target
        taken[here] = False
        taken[best_target] = distance[best_target] > 0
        site[robot] = best_target
    return comparisons


def run_literally(n_scheme: th.NScheme, most_steps: int = 1 << 30) -> LiteralRun:
    """Plan until all robots have arrived or `most_steps` are done."""
    scenario = n_scheme.scenario
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    distance, bits = n_scheme.distance_of_site, th.make_d_scheme(n_scheme).directions_of_site
    sites = np.arange(layout.size)
    first = np.log2(np.maximum(bits & -bits.astype(np.int32), 1)).astype(np.int64)
    next_of_site = np.where(bits > 0, sites + layout.offset_of_direction[sites & 1, first], sites).astype(np.int32)
    site = layout.cell_to_site(scenario.robots)
    active = np.flatnonzero((distance[site] > 0) & (distance[site] < NOT_REACHED))
    taken = np.zeros(layout.size, dtype=bool)
    taken[site[active]] = True
    longest = scenario.area.free_count + 2
    ways, way = np.zeros((site.size, longest), dtype=np.int32), np.zeros(longest, dtype=np.int32)
    length_of_way, arrival_step = np.zeros(site.size, dtype=np.int64), np.zeros(site.size, dtype=np.int64)
    comparisons = [0]
    while active.size and len(comparisons) <= most_steps:
        active = active[np.argsort(distance[site[active]], kind="stable")]
        made = _step(
            active, site, distance, next_of_site, scenario.moves, layout.offset_of_direction,
            tessellation.cost_of_direction, scenario.waiting_cost, taken, ways, length_of_way, way,
        )  # fmt: skip
        comparisons.append(comparisons[-1] + made)
        arrival_step[active[distance[site[active]] == 0]] = len(comparisons) - 1
        active = active[distance[site[active]] > 0]
    return LiteralRun(np.array(comparisons[1:]), arrival_step)
