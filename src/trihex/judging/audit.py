"""Audit: the judge of a plan, which knows the rules but no planner.

Everything is found anew from the barriers, the rules and the actions: neither ``Scenario.moves`` nor any field of a
planner is looked at, so that a fault there is found here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trihex.errors import PlanError, check_type, check_whole
from trihex.judging.conflict import STOPS, Conflict, conflict_from
from trihex.judging.reach import is_reachable
from trihex.judging.starts import conflicts_of_start_times, conflicts_of_starts
from trihex.judging.stepwise import judged_by_steps
from trihex.judging.timed import judged_by_ticks
from trihex.plans import Plan
from trihex.record import Record, counted


@dataclass(frozen=True, eq=False)
class Audit(Record):
    """What the judge found in a plan.

    Parameters
    ----------
    plan : Plan
    conflicts : tuple of Conflict
        The first of them by step; as many as were asked for.
    conflict_count : int
        How many there are in all. In each step a robot gives rise to at most one conflict of a kind; where many
        robots meet, each is charged with the parked one or the one of the smallest number.
    """

    plan: Plan
    conflicts: tuple[Conflict, ...]
    conflict_count: int

    def in_words(self) -> str:
        """Return how many conflicts there are, and the first."""
        first = f", the first: {self.conflicts[0]}" if self.conflicts else ""
        return counted(self.conflict_count, "conflict") + first

    @property
    def is_clean(self) -> bool:
        """Whether the plan breaks no rule."""
        return self.conflict_count == 0


def audit_plan(plan: Plan, limit: int = 100, *, progress: Callable[[int, int], None] | None = None) -> Audit:
    """Judge `plan` by the rules of its scenario, in O(1) for each robot and step.

    Robots are followed as the actions say, whatever they break, until they enter a destination or leave the area.

    Where moves last longer than a step, or following is forbidden, it is judged who owns each cell and lattice vertex
    in each half tick. ``step`` of a conflict is then the tick, from 1, in which the later of the two begins to own what
    the other owns; each time that a robot comes to a place it gives rise to at most one conflict of a kind there, and
    is charged with the one that stays the longest of those that came before.

    Parameters
    ----------
    plan : Plan
    limit : int
        How many conflicts to describe; all are counted.
    progress : callable, optional
        Called with (actions judged, actions in all).

    Returns
    -------
    Audit

    Examples
    --------
    >>> from trihex import Area, Scenario
    >>> from trihex.plans.plan import plan_from_lists
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0), (1, 0)])
    >>> east, west = 1, 3
    >>> print(audit_plan(plan_from_lists(scenario, [[east, east], [west, east, east]])).conflicts[0])
    step 1: robots 0 and 1 exchange cells (0, 0) and (1, 0)
    """
    check_type("plan", plan, Plan)
    check_whole("limit", limit, 0, None, PlanError)
    judged = judged_by_steps if plan.scenario.is_stepwise else judged_by_ticks
    found, count, stopped, last = judged(plan, limit, progress)
    at_start = np.concatenate([conflicts_of_starts(plan.scenario), conflicts_of_start_times(plan)])
    found, count = np.concatenate([at_start, found]), count + len(at_start)
    is_clear = ~plan.scenario.area.is_barrier(plan.scenario.robots[stopped])
    stopped, last = stopped[is_clear], last[is_clear]
    if stopped.size:
        could = is_reachable(plan.scenario, plan.scenario.robots[stopped])
        rows = np.full((np.count_nonzero(could), found.shape[1]), -1, dtype=np.int32)
        rows[:, 0], rows[:, 2] = STOPS, stopped[could]
        rows[:, [1, 4]] = last[could]
        found, count = np.concatenate([found, rows]), count + len(rows)
    order = np.lexsort((found[:, 3], found[:, 2], found[:, 0], found[:, 1]))[:limit]
    return Audit(plan, tuple(conflict_from(plan.scenario, row) for row in found[order]), count)
