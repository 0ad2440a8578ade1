"""Show run: a run as a page plays it, with the world as it was in each step."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.fields import make_n_scheme
from trihex.formats import draft_of
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.running import GOING, LEFT, Run, RunReport
from trihex.viewer.bundle import Bundle
from trihex.viewer.document import document_of, ground_of
from trihex.viewer.show import MAX_ACTIONS, told_conflicts, told_layout

_NONE = np.empty(0, dtype=np.int32)


def show_run(report: RunReport) -> Bundle:
    """Return the document of a run as it began, what changed in it, and all that is needed to play it.

    Raises
    ------
    TooLargeError
        If a page could not hold it.
    """
    run, scenario = report.run, report.run.scenario
    if run.actions.size > MAX_ACTIONS:
        raise TooLargeError(f"the viewer plays at most {MAX_ACTIONS} robot steps, not {run.actions.size}")
    draft = replace(draft_of(scenario), robots=run.robots)
    (document, arrays), (ground, beneath) = document_of(draft), ground_of(draft)
    header: dict[str, Any] = {
        "document": document,
        "ground": ground,
        "plan": "",
        "summary": {**report.as_dict(), "unreachable": int(np.sum(run.state_of_robot == GOING))},
        "conflicts": told_conflicts(report.audit.conflicts),
        "steps": run.steps,
        "step_seconds": report.step_seconds,
        **told_layout(scenario),
        "worlds": _worlds(run),
    }
    begins = _begins(run)
    first = np.concatenate([[0], np.cumsum(begins.sum(axis=0))])
    arrays |= {
        **beneath,
        **_curves(run),
        "actions": run.actions.T[begins.T],  # those of one robot after those of the other
        "first_action": first.astype(np.int32),
        "joined": run.joined.astype(np.int32),
        "has_arrived": run.arrived.astype(np.uint8),
        "has_left": (run.state_of_robot == LEFT).astype(np.uint8),
        "cut_off_since": np.where(run.state_of_robot == GOING, run.cut_off_since, -1).astype(np.int32),
        "jump_at": _NONE,
        "jump_to": _NONE,
        "distance": make_n_scheme(scenario).distance,
    }
    if run.sensor is not None:
        arrays["known_since"] = run.known_since
    return Bundle(header, arrays)


def _begins(run: Run) -> NDArray[np.bool_]:
    """Tell in which steps each robot was there and began an action, shape (steps, robots)."""
    step = np.arange(1, run.steps + 1)[:, None]
    return np.asarray((step > run.joined) & (step <= run.last_seen_of_robot) & (run.actions != UNDERWAY))


def _worlds(run: Run) -> list[dict[str, Any]]:
    """Return in which steps barriers or destinations became others, and what they became."""
    changes: list[dict[str, Any]] = []
    barriers, destinations = run.scenario.area.barriers, np.sort(run.scenario.destinations)
    for step, (new_barriers, new_destinations) in enumerate(run.worlds(), 1):
        if new_barriers is barriers and new_destinations is destinations:
            continue
        blocked, freed = (np.flatnonzero(cells) for cells in (new_barriers & ~barriers, barriers & ~new_barriers))
        if blocked.size or freed.size or not np.array_equal(new_destinations, destinations):
            cells = {"blocked": blocked, "freed": freed, "destinations": new_destinations}
            changes.append({"step": step, **{name: own.tolist() for name, own in cells.items()}})
        barriers, destinations = new_barriers, new_destinations
    return changes


def _curves(run: Run) -> dict[str, NDArray[Any]]:
    """Return for each step from 0 how many move, wait and have arrived, and what those that arrive have spent."""
    step = np.arange(1, run.steps + 1)[:, None]
    is_there = (step > run.joined) & (step <= run.last_seen_of_robot)
    cost = np.zeros(256, dtype=np.int64)
    table = run.scenario.area.tessellation.cost_of_direction
    cost[: table.size] = table
    cost[[WAIT, LATE]] = run.scenario.waiting_cost
    moving = (is_there & (run.actions < LATE)).sum(axis=1)
    spent = (cost[run.actions] * (is_there & run.arrived)).sum(axis=1)
    arrived = np.bincount(run.ended[run.arrived], minlength=run.steps + 1)
    return {
        "moving_by_step": np.append(0, moving).astype(np.int32),
        "waiting_by_step": np.append(0, is_there.sum(axis=1) - moving).astype(np.int32),
        "arrived_by_step": np.cumsum(arrived).astype(np.int32),
        "spent_by_step": np.cumsum(np.append(0, spent)).astype(np.float64),
    }
