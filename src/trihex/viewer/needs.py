"""Needs: what must be compiled before the desk shows a record, draws robots or judges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from trihex.areas import Area, Scenario
from trihex.fields import field_kernels
from trihex.formats import Draft
from trihex.kernels.needs import Kernels, use_of
from trihex.planners import uses_of
from trihex.plans import Plan
from trihex.running import Run

Record = Area | Scenario | Draft | Plan | Run
Needs = Sequence[str | Kernels]


def needs_of(record: Record) -> Needs:
    """Return what is needed to show a record."""
    if isinstance(record, Plan):
        return (*judging_of(record.scenario), _field_of(record.scenario))
    if isinstance(record, Draft) and record.random_count is not None:
        return needs_of_draw(record)
    return needs_of_report(record.scenario) if isinstance(record, Run) else ()


def judging_of(scenario: Scenario) -> tuple[str, ...]:
    """Return what is needed to judge a plan, to play it, and to tell how good it is at once."""
    return "n_scheme", use_of("audit", scenario.is_stepwise), "page", "slot_bound"


def needs_of_draw(draft: Draft) -> Needs:
    """Return what is needed to draw robots: where there are destinations, they are drawn where they can arrive."""
    if draft.destinations is None or not draft.destinations.size:
        return ()
    return "n_scheme", _field_of(replace(draft, random_count=None).complete())


def needs_of_report(scenario: Scenario) -> Needs:
    """Return what is needed to judge a run, beside a plan with full knowledge."""
    audit = use_of("audit", scenario.is_stepwise)
    return (*uses_of("fcost", scenario), audit, "bound", _field_of(scenario))


def _field_of(scenario: Scenario) -> Kernels:
    return field_kernels(scenario.area.tessellation, scenario.corners)
