"""Planner `fcost`: robots weigh the open directions by Fcost = v + V + w_t * c, the planner of the paper."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trihex.errors import PlanError, check_choice
from trihex.plan import Plan
from trihex.planners.recording import BUDGET, Recording
from trihex.schemes import NOT_REACHED, NScheme, make_d_scheme

RULES = ("queue", "paper")


def plan_fcost(n_scheme: NScheme, *, progress: Callable[[int, int], None] | None = None, rule: str = "queue") -> Plan:
    """Plan by least Fcost(x, y, d) = v(d) + V(x, y, d) + w_t * c(x, y, d) (section 4.1 of the paper).

    v is the cost of the move, V the distance of the cell it leads to, c the estimated number of collisions from there.

    Parameters
    ----------
    n_scheme : NScheme
    progress : callable, optional
        Called with (robots arrived, robots that can arrive).
    rule : {"queue", "paper"}
        What c counts. "paper": the other robots whose shortest path meets (same cell, same step) the shortest path
        that starts with d. "queue": the steps that a robot on that path waits for those before it.

    Raises
    ------
    PlanError
        If there is no such rule.
    """
    from trihex.kernels import planning
    from trihex.kernels import planning_fcost as kernels

    check_choice("rule", rule, RULES, PlanError)
    scenario = n_scheme.scenario
    area = scenario.area
    layout, tessellation = area.layout, area.tessellation
    destinations = layout.cell_to_site(scenario.destinations)
    site = layout.cell_to_site(scenario.robots)
    going = np.flatnonzero(~np.isin(n_scheme.distance_of_site[site], (0, NOT_REACHED))).astype(np.int32)
    info = np.zeros((layout.size, 4), dtype=np.int32)
    info[:, 0] = n_scheme.distance_of_site
    slots = kernels.fill_tree(
        destinations,
        scenario.moves,
        make_d_scheme(n_scheme).directions_of_site,
        planning.FIRST_OF_BITS,
        layout.offset_of_direction,
        np.empty(area.free_count, dtype=np.int32),
        info,
    )
    cells = scenario.moves.copy()
    cells[site[going]] |= planning.OCCUPIED
    cells[destinations] = planning.DESTINATION
    many = np.zeros(slots + 1, dtype=np.int64)
    if rule == "paper":
        many += np.bincount(info[site[going], 3], minlength=slots + 1)
    forbids = scenario.crossing == "forbid"
    capacity = scenario.destination_capacity or 0
    recording = Recording(scenario, going.size)
    state = (
        np.zeros(layout.size if forbids else 0, dtype=np.int32),
        np.zeros(layout.size if capacity else 0, dtype=np.int64),
        np.zeros(slots + 1, dtype=np.int32),
        many,
        site,
        going.copy(),
        np.empty(going.size, dtype=np.int32),
        np.zeros(scenario.robot_count, dtype=bool),
    )
    step, active = 0, going.size
    while active:
        step, active, steps = kernels.weigh(
            cells,
            layout.offset_of_direction,
            layout.vertex_of_direction,
            tessellation.cost_of_direction,
            info,
            kernels.PAPER if rule == "paper" else kernels.QUEUE,
            scenario.waiting_cost,
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
    return recording.make_plan("fcost")
