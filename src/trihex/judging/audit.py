"""Audit: the judge of a plan, which knows the rules but no planner.

Everything is found anew from the barriers, the rules and the actions: neither ``Scenario.moves`` nor any field of a
planner is looked at, so that a fault there is found here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import PlanError, check_type, check_whole
from trihex.judging.conflict import STOPS, Conflict, conflict_from
from trihex.judging.law import make_law, make_places
from trihex.judging.reach import is_reachable
from trihex.judging.starts import conflicts_of_starts
from trihex.plans import Plan
from trihex.record import Record, counted

if TYPE_CHECKING:
    from trihex.judging.kernels.meetings import JudgedRobots, Places

# About 0.1 s of work between two looks at the keyboard.
_BUDGET = 4_000_000


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
    found, count, site, stopped = _judged(plan, limit, progress)
    at_start = conflicts_of_starts(plan.scenario)
    found, count = np.concatenate([at_start, found]), count + len(at_start)
    stopped = stopped[~plan.scenario.area.is_barrier(plan.scenario.robots[stopped])]
    if stopped.size:
        could = stopped[is_reachable(plan.scenario, plan.scenario.robots[stopped])]
        rows = np.full((could.size, found.shape[1]), -1, dtype=np.int32)
        rows[:, 0], rows[:, 1] = STOPS, np.diff(plan.first_action)[could]
        rows[:, 2], rows[:, 4] = could, site[could]
        found, count = np.concatenate([found, rows]), count + could.size
    order = np.lexsort((found[:, 3], found[:, 2], found[:, 0], found[:, 1]))[:limit]
    return Audit(plan, tuple(conflict_from(plan.scenario, row) for row in found[order]), count)


def _judged(
    plan: Plan, limit: int, progress: Callable[[int, int], None] | None
) -> tuple[NDArray[np.int32], int, NDArray[np.int32], NDArray[np.int64]]:
    """Return the first conflicts as rows, the number of all, last sites, and who stops short of a destination."""
    from trihex.judging.kernels import audit as kernels
    from trihex.judging.kernels.deeds import Deeds
    from trihex.judging.kernels.findings import Findings
    from trihex.judging.kernels.meetings import PARKED
    from trihex.kernels.signatures import given

    law, robots, places = make_law(plan.scenario), _make_robots(plan.scenario), _make_places(plan.scenario)
    jump_at, jump_to = plan.jump_tables
    deeds = given(Deeds, action=plan.actions, first=plan.first_action, jump_at=jump_at, jump_to=jump_to)
    rows = np.full((max(limit, 0), 8), -1, dtype=np.int32)
    findings = given(Findings, row=rows, total=np.zeros(1, dtype=np.int64))
    clock = np.zeros(2, dtype=np.int64)
    start = plan.scenario.area.layout.cell_to_site(plan.scenario.robots)
    kernels.begin(start, deeds, robots, places, findings, clock)
    while clock[kernels.ACTIVE]:
        kernels.judge(law, deeds, robots, places, findings, clock, _BUDGET)
        if progress is not None:
            done = np.minimum(np.diff(plan.first_action), clock[kernels.STEP]).sum()
            progress(int(done), plan.actions.size)
    count = int(findings.total[0])
    return rows[:count], count, robots.site, np.flatnonzero(robots.came_from == PARKED)


def _make_robots(scenario: Scenario) -> JudgedRobots:
    """Return room for what the judge knows of each robot."""
    from trihex.judging.kernels.meetings import JudgedRobots

    site, came_from, rank, active, ended = np.zeros((5, scenario.robot_count), dtype=np.int32)
    passed = np.full(scenario.robot_count, -1, dtype=np.int32)
    return JudgedRobots(site, came_from, passed, rank, active, ended)


def _make_places(scenario: Scenario) -> Places:
    """Return what lies at each site, and that nobody has passed a vertex yet."""
    from trihex.judging.kernels.meetings import Places

    vertices = scenario.area.layout.size if scenario.forbids_crossing else 0
    return Places(make_places(scenario), np.zeros(vertices, dtype=np.int32))
