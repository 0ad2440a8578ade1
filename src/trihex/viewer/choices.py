"""Choices: what a page offers in its menus, read from the registries."""

from __future__ import annotations

from typing import Any

from trihex.areas import (
    CLOCKS,
    CORNERS,
    COSTS,
    CROSSINGS,
    FOLLOWINGS,
    GENERATORS,
    NEIGHBOURHOODS,
    TESSELLATIONS,
    Tessellation,
)
from trihex.planners import PLANNERS, options_of
from trihex.viewer.exports import EXPORTS
from trihex.viewer.folder import SUFFIXES
from trihex.viewer.hints import planner_hints
from trihex.viewer.layers import layer_choices


def choices() -> dict[str, Any]:
    """Return the names of tessellations, rules, generators, planners with their options, and files to open and save."""
    kinds = [Tessellation(name, neighbourhood) for name in TESSELLATIONS for neighbourhood in NEIGHBOURHOODS]
    return {
        "steps": {f"{kind.name} {kind.neighbourhood}": kind.step_of_direction.tolist() for kind in kinds},
        "names": {f"{kind.name} {kind.neighbourhood}": kind.direction_names for kind in kinds},
        "tessellations": TESSELLATIONS,
        "neighbourhoods": NEIGHBOURHOODS,
        "costs": COSTS,
        "crossings": CROSSINGS,
        "corners": CORNERS,
        "clocks": CLOCKS,
        "followings": FOLLOWINGS,
        "generators": ["empty", *GENERATORS],
        "planners": {name: options_of(name) for name in PLANNERS},
        "hints": planner_hints(),
        "layers": layer_choices(),
        "exports": {what: {"suffixes": suffixes, "needs": needs} for what, (suffixes, needs) in EXPORTS.items()},
        "suffixes": SUFFIXES,
    }
