"""Needs: which kernels each use of trihex takes, so that they can be compiled before the work begins."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

_FIELD = ("fields.front",)
_DIRECTIONS = (*_FIELD, "areas.moves", "fields.directions")
_REPAIR = (*_DIRECTIONS, "fields.repair", "fields.changing")
_GREEDY = (*_DIRECTIONS, "planners.greedy", "planners.cells", "planners.rows", "plans.replay")
_FCOST = (
    *_GREEDY,
    *_REPAIR,
    "planners.fcost",
    "planners.slots",
    "planners.lanes",
    "planners.laying",
    "planners.catchments",
)
_TIMELY = (*_DIRECTIONS, "planners.timely", "planners.tick_rows", "planners.slots", "plans.replay")
_ASTAR = (*_FIELD, "areas.moves", "planners.astar", "planners.estimates", "planners.reservations", "plans.replay")
_OPTIMUM = (*_FIELD, "areas.moves", "fields.steps", "optimum.paths", "optimum.single", "plans.replay")
_BOUND = ("areas.moves", "fields.steps", "bounds.cuts", "bounds.gates", "bounds.meetings", "bounds.serving")
_EXECUTION = (*_REPAIR, "running.stepping", "running.lines")

#: What each use needs, by names of modules: "fields.front" is ``trihex.fields.kernels.front``. Every module that holds
#: kernels is here, so that all can be compiled beforehand (none that holds helpers alone: it would never count as
#: compiled); shapes of fields have kernels of their own, `field_kernels`.
KERNELS_OF: dict[str, tuple[str, ...]] = {
    "n_scheme": _FIELD,
    "d_scheme": _DIRECTIONS,
    "greedy": _GREEDY,
    "fcost": _FCOST,
    "fcost_mending": ("planners.mending",),  # where not all steps cost the same
    "astar": _ASTAR,
    "timely greedy": _TIMELY,
    "timely fcost": (*_TIMELY, *_REPAIR, "planners.lanes", "planners.laying"),
    "optimal": _OPTIMUM,  # and, where robots crowd, one of two more: `trihex.planners.uses_of`
    "optimal_crowd": (
        *_OPTIMUM,
        "optimum.lowering",
        "optimum.queueing",
        "optimum.queues",
        "optimum.serving",
        "optimum.tolled",
    ),
    "optimal_earliest": (*_OPTIMUM, *_FCOST, "optimum.earliest", "optimum.laid", "optimum.turns"),
    "certificate": (
        *_FIELD,
        "areas.moves",
        "fields.steps",
        "optimum.fair",
        "optimum.laid",
        "optimum.tolls",
        "plans.replay",
    ),
    "prices": (
        *_OPTIMUM,
        *("bounds.cuts", "optimum.doors", "optimum.earliest", "optimum.laid", "optimum.late"),
        *("optimum.opening", "optimum.tolls", "optimum.variation"),
    ),
    "straight": (*_ASTAR, "planners.straight"),
    "audit": ("judging.audit", "plans.replay"),
    "timely audit": ("judging.timed", "plans.replay"),
    "bound": (*_BOUND, "bounds.mouths", "bounds.steps", "bounds.units"),
    "slot_bound": ("fields.steps", "bounds.steps"),
    "execution": _EXECUTION,
    "trial": (*_EXECUTION, "running.sensing"),
    "dependencies": ("areas.moves", "plans.implied", "plans.rows", "plans.replay"),
    "order": ("running.passing", "plans.replay"),
    "picture": ("pictures.raster", "plans.replay"),
    "timely picture": ("pictures.raster", "plans.ticks"),
    "table": ("formats.table_text",),
    "archive": ("formats.escape",),
    "area": ("areas.caves", "areas.mazes", "areas.coverage", "areas.regions"),
    "generations": ("fields.generations",),
    "page": ("plans.playback",),
    "waypoints": ("plans.rows",),
    "ticks": ("plans.ticks",),
    "reach": ("judging.reach",),
}


def use_of(name: str, is_stepwise: bool) -> str:
    """Return the key of `KERNELS_OF` for a planner or judge: some have others where time is not in steps alone."""
    timely = f"timely {name}"
    return name if is_stepwise or timely not in KERNELS_OF else timely


@dataclass(frozen=True)
class Kernels:
    """Kernels that are compiled together: those of a module, or what a function of it makes for some arguments.

    Parameters
    ----------
    module : str
    function : str
    arguments : str
        As JSON; lists become tuples.
    """

    module: str
    function: str = ""
    arguments: str = "[]"

    def load(self) -> list[Any]:
        """Import or make them, and return them; what is not on disk is compiled."""
        module = import_module(self.module)
        if not self.function:
            return [thing for thing in vars(module).values() if hasattr(thing, "py_func")]
        arguments = [tuple(one) if isinstance(one, list) else one for one in json.loads(self.arguments)]
        return [getattr(module, self.function)(*arguments)]


def kernels_of(uses: Iterable[str | Kernels]) -> list[Kernels]:
    """Return what some uses need, each once.

    Parameters
    ----------
    uses : iterable
        Keys of `KERNELS_OF` (one that is not there needs none), or kernels themselves.
    """
    found: dict[Kernels, None] = {}
    for use in uses:
        if isinstance(use, Kernels):
            found[use] = None
            continue
        for name in KERNELS_OF.get(use, ()):
            package, module = name.split(".")
            found[Kernels(f"trihex.{package}.kernels.{module}")] = None
    return list(found)
