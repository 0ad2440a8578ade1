"""Show: a plan as a page plays it, one byte for each robot and step, with its report and its curves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from trihex.areas import Scenario
from trihex.errors import TooLargeError
from trihex.fields import NScheme
from trihex.formats import draft_of
from trihex.judging import Conflict, Report
from trihex.plans import make_playback
from trihex.viewer.bundle import Bundle
from trihex.viewer.document import document_of, ground_of

MAX_ACTIONS = 2**29
_MOST_CONFLICTS = 20


def show_plan(report: Report, n_scheme: NScheme, name: str = "") -> Bundle:
    """Return the document of a plan and all that is needed to play it.

    Raises
    ------
    TooLargeError
        If a page could not hold it.
    """
    plan, scenario = report.plan, report.plan.scenario
    if plan.actions.size > MAX_ACTIONS:
        raise TooLargeError(f"the viewer plays at most {MAX_ACTIONS} robot steps, not {plan.actions.size}")
    draft = draft_of(scenario)
    (document, arrays), (ground, beneath) = document_of(draft), ground_of(draft)
    playback = make_playback(plan, n_scheme)
    jump_at, jump_to = plan.jump_tables
    header: dict[str, Any] = {
        "document": document,
        "ground": ground,
        "plan": name,
        "summary": report.as_dict(),
        "conflicts": told_conflicts(report.audit.conflicts),
        "steps": plan.steps,
        "step_seconds": report.step_seconds,
        **told_layout(scenario),
    }
    curves = {"spent": playback.spent.astype(np.float64), "least_total": playback.least_total.astype(np.float64)}
    counts = {name: getattr(playback, name).astype(np.int32) for name in ("moving", "waiting", "arrived")}
    arrays = {
        **arrays,
        **beneath,
        **{f"{name}_by_step": curve for name, curve in {**curves, **counts}.items()},
        "actions": plan.actions,
        "first_action": plan.first_action.astype(np.int32),
        **({"slowness": scenario.slowness.astype(np.int32)} if scenario.has_slowness else {}),
        "has_arrived": plan.arrived.astype(np.uint8),
        "jump_at": np.minimum(jump_at, 2**31 - 1).astype(np.int32),
        "jump_to": jump_to,
        "distance": n_scheme.distance,
    }
    return Bundle(header, arrays)


def told_conflicts(conflicts: Sequence[Conflict]) -> list[dict[str, Any]]:
    """Return the first conflicts as the page shows them."""
    return [{"step": conflict.step, "text": str(conflict)} for conflict in conflicts[:_MOST_CONFLICTS]]


def told_layout(scenario: Scenario) -> dict[str, Any]:
    """Return where actions lead and what they cost."""
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    return {
        "edge_cost": tessellation.edge_cost,
        "layout": {
            "origin": layout.origin,
            "pitch": layout.pitch,
            "offsets": layout.offset_of_direction.tolist(),
            "costs": tessellation.cost_of_direction.tolist(),
            "durations": tessellation.duration_of_direction.tolist(),
            "names": tessellation.direction_names,
        },
    }
