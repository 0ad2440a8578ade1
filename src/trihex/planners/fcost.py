"""Planner `fcost`: the paper's planner, which weighs a longer way against waiting."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError, check_choice
from trihex.plan import Plan
from trihex.planners.greedy import plan_greedy
from trihex.planners.recording import BUDGET, Recording
from trihex.schemes import NOT_REACHED, NScheme, make_d_scheme

RULES = ("best", "paper", "queue", "aside")
Progress = Callable[[int, int], None]


class Branches(NamedTuple):
    """The forest of shortest ways: each cell's branch and its slot, which numbers (branch, steps to its end)."""

    directions: NDArray[np.uint16]
    branch_of_site: NDArray[np.int32]
    slot_of_site: NDArray[np.int32]
    first_slot: NDArray[np.int64]


def plan_fcost(n_scheme: NScheme, *, rule: str = "best", progress: Progress | None = None) -> Plan:
    """Plan by the least Fcost = v + V + w_t * c (section IV of the paper), step by step.

    In each step the robots are asked in order of their distance. The nearest of each branch of the D-scheme descends;
    any other takes the free direction of least Fcost, and waits where the best direction, though taken, promises less.

    Parameters
    ----------
    n_scheme : NScheme
    rule : {"best", "paper", "queue", "aside"}
        What c is. "paper": the number of other robots whose shortest path meets the path that starts with a direction
        (same cell, same step). "queue": the length of the line that they have formed when the robot gets there, and a
        robot that would wait may step to a cell no farther away if that costs no more. "aside": the same, and a
        blocked robot always steps to such a cell unless it has just left it. "best": plans by the latter two and by
        greedy descent, and keeps the plan of the least total time.
    progress : callable, optional
        Called with (robots arrived, robots that can arrive), of one rule after the other.
    """
    check_choice("rule", rule, RULES, PlanError)
    branches = _grow(n_scheme)
    if rule != "best":
        return _planned(n_scheme, rule, branches, progress)
    plans = [_planned(n_scheme, one, branches, progress) for one in ("aside", "queue")]
    best = min([*plans, plan_greedy(n_scheme, progress=progress)], key=lambda plan: plan.total_time)
    return replace(best, planner="fcost")


def _grow(n_scheme: NScheme) -> Branches:
    from trihex.kernels import fcost as kernels

    layout = n_scheme.scenario.area.layout
    distance = n_scheme.distance_of_site
    cells = np.flatnonzero((distance != NOT_REACHED) & (distance != 0)).astype(np.int32)
    branch, steps = np.zeros(layout.size, dtype=np.int32), np.zeros(layout.size, dtype=np.int32)
    order = cells[np.argsort(distance[cells], kind="stable")]
    directions = make_d_scheme(n_scheme).directions_of_site
    kernels.grow_branches(order, distance, directions, layout.offset_of_direction, branch, steps)
    last_sites, branch[cells] = np.unique(branch[cells], return_inverse=True)
    depth = np.zeros(last_sites.size, dtype=np.int64)
    np.maximum.at(depth, branch[cells], steps[cells])
    # One slot more than steps at both ends: nobody stands at 0, and a detour may come from beyond the last.
    first_slot = np.concatenate([[0], np.cumsum(depth + 2)])
    steps[cells] += first_slot[branch[cells]].astype(np.int32)
    return Branches(directions, branch, steps, first_slot)


def _planned(n_scheme: NScheme, rule: str, branches: Branches, progress: Progress | None) -> Plan:
    from trihex.kernels import fcost as kernels

    scenario = n_scheme.scenario
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    site = layout.cell_to_site(scenario.robots)
    distance = n_scheme.distance_of_site
    going = np.flatnonzero((distance[site] != NOT_REACHED) & (distance[site] != 0)).astype(np.int32)
    forbids, capacity = scenario.crossing == "forbid", scenario.destination_capacity or 0
    aside = {"paper": kernels.STAY, "queue": kernels.WORTH, "aside": kernels.ALWAYS}[rule]
    counts = kernels.MEETINGS if rule == "paper" else kernels.QUEUE
    first_vertex_move = tessellation.edge_count if forbids else tessellation.direction_count
    rules = [counts, aside, scenario.waiting_cost, scenario.waiting_cost, first_vertex_move, capacity]
    occupied = np.zeros(layout.size, dtype=np.uint8)
    occupied[site[going]] = True
    count = np.bincount(branches.slot_of_site[site[going]], minlength=branches.first_slot[-1])
    recording = Recording(scenario, going.size)
    state = (
        going.copy(),
        np.empty(going.size, dtype=np.int32),
        site,
        np.full(site.size, -1, dtype=np.int32),
        occupied,
        count,
        np.zeros(count.size, dtype=np.int64),
        np.zeros(layout.size, dtype=np.int32),
        np.zeros(layout.size, dtype=np.int32),
        np.zeros(layout.size, dtype=np.int32),
        np.zeros(max(branches.first_slot.size - 1, 1), dtype=np.int32),
    )
    step, active = 0, going.size
    while active:
        step, active, steps = kernels.weigh(
            np.array(rules, dtype=np.int64),
            distance,
            branches.slot_of_site,
            branches.branch_of_site,
            branches.directions,
            scenario.moves,
            layout.offset_of_direction,
            layout.vertex_of_direction,
            tessellation.cost_of_direction,
            branches.first_slot,
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
