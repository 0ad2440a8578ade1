"""Layers: maps of a plan or a run that a page lays over its cells, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import seconds_per_step
from trihex.plans import Motion, make_density_map, make_waiting_map
from trihex.viewer.bundle import Bundle

_MOST_CELLS = 2**22  # of an area whose maps lie in the page itself: 8 bytes a cell and map


class Layer(NamedTuple):
    """A map: what it is called, what it tells, in which unit, and what makes it."""

    label: str
    hint: str
    #: Of a value, where cells have no size and where they are in metres; ``{step}`` is "step" or "tick".
    unit: str
    unit_in_metres: str
    #: A value for each cell, 0 where there is nothing to tell; of barriers, too.
    make: Callable[[Motion], NDArray[Any]]
    #: Kernels that it takes, by keys of `trihex.kernels.needs.KERNELS_OF`.
    uses: tuple[str, ...] = ("waypoints", "ticks")


def _time_lost(motion: Motion) -> NDArray[Any]:
    area = motion.scenario.area
    return make_waiting_map(motion) * (1.0 if area.frame is None else seconds_per_step(area))


#: All of them: one more is a line.
LAYERS = {
    "waiting": Layer("Time lost", "How long robots stood here, all together.", "{step}s lost", "s lost", _time_lost),
    "density": Layer("Crowding", "Robots here, in the mean.", "robots", "robots a square metre", make_density_map),
}


def layer_choices() -> dict[str, dict[str, str]]:
    """Return what a page offers."""
    return {name: {"label": layer.label, "hint": layer.hint} for name, layer in LAYERS.items()}


def make_layer(name: str, motion: Motion) -> Bundle:
    """Return the layer called `name` as the answer to a page."""
    return Bundle({"unit": _unit_of(name, motion)}, {"values": _values_of(name, motion)})


def with_layers(bundle: Bundle, motion: Motion) -> Bundle:
    """Return the bundle of a page that has nobody to ask, with all layers."""
    if motion.scenario.area.cell_count > _MOST_CELLS:
        return bundle
    arrays = {f"layer_{name}": _values_of(name, motion) for name in LAYERS}
    units = {name: {"unit": _unit_of(name, motion)} for name in LAYERS}
    return Bundle({**bundle.header, "layers": units}, {**bundle.arrays, **arrays})


def _unit_of(name: str, motion: Motion) -> str:
    layer, scenario = LAYERS[name], motion.scenario
    unit = layer.unit if scenario.area.frame is None else layer.unit_in_metres
    return unit.format(step=scenario.step_word)


def _values_of(name: str, motion: Motion) -> NDArray[np.float64]:
    return np.asarray(LAYERS[name].make(motion), dtype=np.float64).reshape(-1)
