"""Planner `greedy`: robots descend the D-scheme, nearest first, and wait where they are blocked."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trihex.plan import Plan
from trihex.planners.recording import BUDGET, Recording
from trihex.schemes import NOT_REACHED, NScheme, make_d_scheme


def plan_greedy(n_scheme: NScheme, *, progress: Callable[[int, int], None] | None = None) -> Plan:
    """Plan by greedy descent of the distance, a baseline of the paper (section 5).

    In each step the robots are asked in order of their distance. Each takes the first of its tied best directions that
    is free, and waits if there is none. It never steps aside, so it is blind to congestion; yet in every step some
    robot comes nearer, so every robot that can arrive does.

    Parameters
    ----------
    n_scheme : NScheme
    progress : callable, optional
        Called with (robots arrived, robots that can arrive).
    """
    from trihex.kernels import planning as kernels

    scenario = n_scheme.scenario
    area = scenario.area
    layout, tessellation = area.layout, area.tessellation
    sites = layout.cell_to_site(scenario.robots)
    distance = n_scheme.distance_of_site[sites]
    going = np.flatnonzero((distance != NOT_REACHED) & (distance != 0))
    going = going[np.argsort(distance[going], kind="stable")]
    cells = make_d_scheme(n_scheme).directions_of_site.copy()
    cells[sites[going]] |= kernels.OCCUPIED
    cells[layout.cell_to_site(scenario.destinations)] = kernels.DESTINATION
    costs, queue_of_direction = np.unique(tessellation.cost_of_direction, return_inverse=True)
    forbids = scenario.crossing == "forbid"
    capacity = scenario.destination_capacity or 0
    recording = Recording(scenario, going.size)
    state = (
        np.zeros(layout.size if forbids else 0, dtype=np.int32),
        np.zeros(layout.size if capacity else 1, dtype=np.int32),
        np.zeros(layout.size if capacity else 1, dtype=np.int32),
        np.stack([sites[going], going.astype(np.int32), distance[going], cells[sites[going]] & kernels.DIRECTIONS]),
        np.empty((4 * (costs.size + 1), going.size), dtype=np.int32),
    )
    step, active = 0, going.size
    while active:
        step, active, steps = kernels.descend(
            cells,
            layout.offset_of_direction,
            layout.vertex_of_direction,
            tessellation.cost_of_direction,
            queue_of_direction.astype(np.int64) + 1,
            kernels.FIRST_OF_BITS,
            tessellation.edge_count if forbids else tessellation.direction_count,
            capacity,
            step,
            active,
            BUDGET,
            *state,
            *recording.new_log(),
            recording.arrival,
        )
        recording.keep(steps)
        if progress:
            progress(going.size - active, going.size)
    return recording.make_plan("greedy")
