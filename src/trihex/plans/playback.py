"""Playback: the curves of a plan, step by step, that a page shows beside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.errors import check_type
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.plans.plan import Plan, actions_of
from trihex.record import Record, read_only

Counts = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Playback(Record):
    """What all robots of a plan do, for each step 0, 1, ..., ``plan.steps``; all arrays have that shape.

    Parameters
    ----------
    plan : Plan
    moving, waiting : int64 arrays
        Robots that are moving, and that wait, in the step (the queue); those that never arrive and do nothing are
        neither.
    arrived : int64 array
        Robots that have arrived by the end of the step.
    spent : int64 array
        Time spent by then by the robots that arrive; the last entry is the total time.
    least_total : int64 array
        Time spent, and what the robots need from where they are if nothing stands in their way: less the plan cannot
        take any more. It rises from the sum of the distances to the total time.
    """

    plan: Plan
    moving: Counts
    waiting: Counts
    arrived: Counts
    spent: Counts
    least_total: Counts


def make_playback(plan: Plan, n_scheme: NScheme) -> Playback:
    """Add up the steps of `plan`; `n_scheme` is that of its scenario.

    Examples
    --------
    >>> from trihex import Area, Scenario, make_n_scheme, make_plan
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0), (1, 0)])
    >>> playback = make_playback(make_plan(scenario, "greedy"), make_n_scheme(scenario))
    >>> playback.moving, playback.arrived, playback.least_total
    (array([0, 2, 1]), array([0, 1, 2]), array([30, 30, 30]))
    """
    from trihex.kernels.signatures import given
    from trihex.plans.kernels import playback as kernels

    check_type("plan", plan, Plan)
    check_type("n_scheme", n_scheme, NScheme)

    scenario, layout = plan.scenario, plan.scenario.area.layout
    start = layout.cell_to_site(scenario.robots)
    moving, waiting, arriving, spent, lost = np.zeros((5, plan.steps + 1), dtype=np.int64)
    kernels.count_steps(
        start,
        actions_of(plan),
        scenario.area.tessellation.cost_of_direction,
        scenario.waiting_cost,
        plan.duration_of_action,
        plan.arrived,
        n_scheme.distance_of_site,
        given(kernels.StepSums, moving=moving, waiting=waiting, arriving=arriving, spent=spent, lost=lost),
    )
    ahead = n_scheme.distance_of_site[start].astype(np.int64)
    lost[0] += (ahead * scenario.slowness)[plan.arrived & (ahead != NOT_REACHED)].sum()
    arrays = (moving, waiting, np.cumsum(arriving), np.cumsum(spent), np.cumsum(lost))
    return Playback(plan, *(read_only(array) for array in arrays))
