"""Stepwise: a plan judged step by step, where every move lasts one and others may move up at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.judging.law import make_law, make_places
from trihex.plans import Plan

if TYPE_CHECKING:
    from trihex.judging.kernels.deeds import Deeds
    from trihex.judging.kernels.findings import Findings
    from trihex.judging.kernels.meetings import JudgedRobots, Places

# About 0.1 s of work between two looks at the keyboard.
_BUDGET = 4_000_000
Progress = Callable[[int, int], None] | None


class Judged(NamedTuple):
    """What a walk through a plan has found."""

    rows: NDArray[np.int32]  # the first conflicts, as the kernels write them
    total: int  # how many there are in all
    stopped: NDArray[np.int64]  # robots that stop short of a destination
    last: NDArray[np.int64]  # in which step, and at which site


def judged_by_steps(plan: Plan, limit: int, progress: Progress) -> Judged:
    """Return the conflicts of a plan whose scenario is stepwise."""
    from trihex.judging.kernels import audit as kernels
    from trihex.judging.kernels.meetings import PARKED

    law, robots, places = make_law(plan.scenario), _make_robots(plan.scenario), _make_places(plan.scenario)
    deeds, findings = make_deeds(plan), make_findings(limit)
    clock = np.zeros(2, dtype=np.int64)
    start = plan.scenario.area.layout.cell_to_site(plan.scenario.robots)
    kernels.begin(start, deeds, robots, places, findings, clock)
    while clock[kernels.ACTIVE]:
        kernels.judge(law, deeds, robots, places, findings, clock, _BUDGET)
        if progress is not None:
            done = np.minimum(np.diff(plan.first_action), clock[kernels.STEP]).sum()
            progress(int(done), plan.actions.size)
    stopped = np.flatnonzero(robots.came_from == PARKED)
    last = np.stack([np.diff(plan.first_action)[stopped], robots.site[stopped]], axis=1)
    return Judged(*found_in(findings), stopped, last)


def make_deeds(plan: Plan) -> Deeds:
    """Return the actions of a plan, as the judge's kernels take them."""
    from trihex.judging.kernels.deeds import Deeds
    from trihex.kernels.signatures import given

    jump_at, jump_to = plan.jump_tables
    deeds: Deeds = given(Deeds, action=plan.actions, first=plan.first_action, jump_at=jump_at, jump_to=jump_to)
    return deeds


def make_findings(limit: int) -> Findings:
    """Return room for so many conflicts."""
    from trihex.judging.kernels.findings import Findings
    from trihex.kernels.signatures import given

    rows = np.full((max(limit, 0), 8), -1, dtype=np.int32)
    findings: Findings = given(Findings, row=rows, total=np.zeros(1, dtype=np.int64))
    return findings


def found_in(findings: Findings) -> tuple[NDArray[np.int32], int]:
    """Return the conflicts that were kept, and how many there are in all."""
    total = int(findings.total[0])
    return np.asarray(findings.row)[:total], total


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
