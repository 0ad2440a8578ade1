"""Earliest arrivals: as many robots as possible after each step, by the plan of fewest steps where it is affordable."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trihex.areas import Scenario
from trihex.bounds import EarliestArrivals, arrivals_bound
from trihex.errors import TooLargeError, check_type, check_whole
from trihex.planners.registry import make_plan

# Robots x free cells up to which the optimum is looked for: some seconds.
MOST_EXACT = 2_000_000


def make_earliest_arrivals(
    scenario: Scenario, *, most_exact: int = MOST_EXACT, progress: Callable[[int, int], None] | None = None
) -> EarliestArrivals:
    """Return the least possible arrivals: no plan has more robots at their destinations after any step.

    The least sum of arrival steps is one of a flow, and a flow that has it has the most arrivals by *every* step (Gale,
    1959): so the plan of ``optimal`` with ``objective="steps"`` is the curve itself. Where that would take long it is
    bounded (`arrivals_bound`), and no plan may attain it; so it is where moves last or nobody may follow at once.

    Parameters
    ----------
    scenario : Scenario
    most_exact : int
        Robots times free cells up to which the optimum is looked for.
    progress : callable, optional
        Called with (robots served, robots).

    Examples
    --------
    >>> from trihex import Area
    >>> scenario = Scenario(Area("square", [[0, 0, 0, 0]]), destinations=[(0, 0)], robots=[(1, 0), (3, 0)])
    >>> earliest = make_earliest_arrivals(scenario)
    >>> earliest.name, earliest.steps.tolist(), earliest.curve(4).tolist()
    ('optimum', [1, 3], [0, 1, 1, 2, 2])
    """
    check_type("scenario", scenario, Scenario)
    check_whole("most_exact", most_exact, 0, None, TooLargeError)
    if scenario.robot_count * scenario.area.free_count > most_exact or not scenario.is_stepwise:
        return arrivals_bound(scenario)
    try:
        plan = make_plan(scenario, "optimal", objective="steps", progress=progress)
    except TooLargeError:
        return arrivals_bound(scenario)
    return EarliestArrivals("optimum", np.sort(plan.arrival_step_of_robot[plan.arrived]))
