"""Run plan: what robots do that are late, or have no map, as the plan that it comes to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from trihex.errors import StudyError
from trihex.fields import NScheme
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.planners import make_plan
from trihex.plans import Plan
from trihex.running import Run, Sensor, Trial, make_passing_order

_OWN = ("aside", "budget")  # what deciding step by step takes of the options of a planner


def make_run_plan(n_scheme: NScheme, planner: Mapping[str, Any]) -> Plan:
    """Return what robots do in the run that an entry of the planners asks for by `run`.

    Nothing happens in the world of a study, so what they did is a plan, and is judged and measured like any other.

    Raises
    ------
    StudyError
        If its parts do not fit each other.
    TrihexError
        As `Trial` and planners do.
    """
    scenario, wanted, options = n_scheme.scenario, planner["run"], planner["options"]
    delay, seed, sense = wanted.get("delays", 0.0), scenario.seed or 0, wanted.get("sense")
    if wanted.get("in_order"):
        if sense is not None or wanted.get("replan"):
            raise StudyError("run: robots that keep the order of a plan (in_order) neither sense nor replan")
        plan = make_plan(scenario, planner["name"], n_scheme=n_scheme, **options)
        return _plan_of(make_passing_order(plan).run(delay=delay, seed=seed))
    if others := [name for name in options if name not in _OWN]:
        raise StudyError(f"run: robots that decide step by step take the options {', '.join(_OWN)}, not {others[0]}")
    if wanted.get("line_of_sight") and sense is None:
        raise StudyError("run: line_of_sight is about what robots see: add sense")
    sensor = None if sense is None else Sensor(scenario.area.tessellation, sense, bool(wanted.get("line_of_sight")))
    replan = bool(wanted.get("replan"))
    return _plan_of(
        Trial(scenario, planner["name"], sensor=sensor, delay=delay, seed=seed, replan=replan, **options).run()
    )


def _plan_of(run: Run) -> Plan:
    """Return what robots did, to be late being to wait."""
    lengths = np.where(run.ended < 0, run.steps, run.ended)
    actions = np.where(run.actions == LATE, WAIT, run.actions).astype(np.uint8).T
    begins = (np.arange(run.steps)[None, :] < lengths[:, None]) & (actions != UNDERWAY)
    return Plan(run.scenario, actions[begins], np.append(0, np.cumsum(begins.sum(axis=1))), run.planner)
