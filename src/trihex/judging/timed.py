"""Timed: a plan judged by who owns what, where moves last or following is forbidden."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from trihex.areas import Scenario
from trihex.judging.law import make_law, make_places
from trihex.judging.stepwise import Judged, Progress, found_in, make_deeds, make_findings
from trihex.plans import Plan

if TYPE_CHECKING:
    from trihex.judging.kernels.owners import Movers, Owners

# About 0.1 s of work between two looks at the keyboard.
_BUDGET = 20_000_000


def judged_by_ticks(plan: Plan, limit: int, progress: Progress) -> Judged:
    """Return the conflicts of a plan, whatever the clock and the rule of its scenario."""
    from trihex.judging.kernels import timed as kernels

    law, movers, owners = make_law(plan.scenario), _make_movers(plan.scenario), _make_owners(plan.scenario)
    deeds, findings = make_deeds(plan), make_findings(limit)
    clock = np.zeros(2, dtype=np.int64)
    start = plan.scenario.area.layout.cell_to_site(plan.scenario.robots)
    kernels.begin(start, law, deeds, movers, owners, findings, clock)
    while clock[kernels.ACTIVE]:
        kernels.judge(law, deeds, movers, owners, findings, clock, _BUDGET)
        if progress is not None:
            done = movers.coming.sum(dtype=np.int64) if clock[kernels.ACTIVE] else plan.actions.size
            progress(int(done), plan.actions.size)
    stopped = np.flatnonzero((movers.due < 0) & (movers.due != kernels.GONE))
    last = np.stack([~movers.due[stopped] // 2, movers.target[stopped]], axis=1)
    return Judged(*found_in(findings), stopped, last)


def _make_movers(scenario: Scenario) -> Movers:
    """Return room for what the judge knows of each robot."""
    from trihex.judging.kernels.owners import Movers

    return Movers(*np.zeros((len(Movers._fields), scenario.robot_count), dtype=np.int32))


def _make_owners(scenario: Scenario) -> Owners:
    """Return what lies at each site, and that nobody has come anywhere yet."""
    from trihex.judging.kernels.owners import Owners

    size = scenario.area.layout.size
    vertices = size if scenario.forbids_crossing else 0
    return Owners(
        make_places(scenario),
        holder=np.full(size, -1, dtype=np.int32),
        until=np.zeros(size, dtype=np.int32),
        vertex_holder=np.full(vertices, -1, dtype=np.int32),
        vertex_until=np.zeros(vertices, dtype=np.int32),
    )
