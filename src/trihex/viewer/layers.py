"""Layers: maps of a plan or a run that a page lays over its cells, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import seconds_per_step
from trihex.plans import Motion, Plan, make_density_map, make_waiting_map
from trihex.prices import make_prices
from trihex.viewer.bundle import Bundle

_MOST_CELLS = 2**22  # of an area whose maps lie in the page itself: 8 bytes a cell and map

Progress = Callable[[int, int], None]


class Layer(NamedTuple):
    """A map: what it is called, what it tells, in which unit, and what makes it."""

    label: str
    hint: str
    #: Of a value, where cells have no size and where they are in metres; ``{step}`` is "step" or "tick".
    unit: str
    unit_in_metres: str
    #: A value for each cell, of barriers, too; 0 where there is nothing to tell.
    make: Callable[[Any, Progress], NDArray[Any]]
    #: Kernels that it takes, by keys of `trihex.kernels.needs.KERNELS_OF`.
    uses: tuple[str, ...]
    #: Whether only the best plan has it, and it takes a while, so that pages without a server do not.
    is_of_optimum: bool = False


def _time_lost(motion: Motion, _: Progress) -> NDArray[Any]:
    area = motion.scenario.area
    return make_waiting_map(motion) * (1.0 if area.frame is None else seconds_per_step(area))


def _crowding(motion: Motion, _: Progress) -> NDArray[Any]:
    return make_density_map(motion)


def _walls(plan: Plan, progress: Progress) -> NDArray[Any]:
    return np.maximum(0, make_prices(plan, kinds=("barrier",), progress=progress).price_of_cell("barrier"))


def _chokes(plan: Plan, progress: Progress) -> NDArray[Any]:
    return np.maximum(0, make_prices(plan, kinds=("choke",), progress=progress).price_of_cell("choke"))


_ROWS, _OPTIMA = ("waypoints", "ticks"), ("optimal", "prices")
_SAVED, _LOST = "time units saved if open", "time units lost if closed"
#: All of them: one more is a line.
LAYERS = {
    "waiting": Layer(
        "Time lost", "How long robots stood here, all together.", "{step}s lost", "s lost", _time_lost, _ROWS
    ),
    "density": Layer("Crowding", "Robots here, in the mean.", "robots", "robots a square metre", _crowding, _ROWS),
    "walls": Layer("Price of walls", "What each wall costs all robots.", _SAVED, _SAVED, _walls, _OPTIMA, True),
    "chokes": Layer("Worth of passages", "What narrow places are worth.", _LOST, _LOST, _chokes, _OPTIMA, True),
}


def layer_choices(*, is_alone: bool = False) -> dict[str, dict[str, Any]]:
    """Return what a page offers; one that has nobody to ask offers no maps that take long."""
    return {
        name: {"label": layer.label, "hint": layer.hint, "is_of_optimum": layer.is_of_optimum}
        for name, layer in LAYERS.items()
        if not (is_alone and layer.is_of_optimum)
    }


def make_layer(name: str, motion: Motion, progress: Progress = lambda done, total: None) -> Bundle:
    """Return the layer called `name` as the answer to a page."""
    layer, scenario = LAYERS[name], motion.scenario
    unit = layer.unit if scenario.area.frame is None else layer.unit_in_metres
    values = np.asarray(layer.make(motion, progress), dtype=np.float64).reshape(-1)
    return Bundle({"unit": unit.format(step=scenario.step_word)}, {"values": values})


def with_layers(bundle: Bundle, motion: Motion) -> Bundle:
    """Return the bundle of a page that has nobody to ask, with all layers that it offers."""
    if motion.scenario.area.cell_count > _MOST_CELLS:
        return bundle
    layers = {name: make_layer(name, motion) for name in layer_choices(is_alone=True)}
    arrays = {f"layer_{name}": layer.arrays["values"] for name, layer in layers.items()}
    told = {name: layer.header for name, layer in layers.items()}
    return Bundle({**bundle.header, "layers": told}, {**bundle.arrays, **arrays})
