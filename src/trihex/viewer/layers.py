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


class Values(NamedTuple):
    """What a map tells of each cell, of barriers, too; 0 where there is nothing to tell."""

    of_cell: NDArray[Any]
    unit: str
    #: Whether they are seconds, so that many of them are told as minutes.
    are_seconds: bool = False


class Layer(NamedTuple):
    """A map: what it is called, what it tells, and what makes it."""

    label: str
    hint: str
    make: Callable[[Any, Progress], Values]
    #: Kernels that it takes, by keys of `trihex.kernels.needs.KERNELS_OF`.
    uses: tuple[str, ...]
    #: Whether only the best plan has it, and it takes a while, so that pages without a server do not.
    is_of_optimum: bool = False
    #: What is said of a cell, {} in place of the amount; "": amount and unit.
    sentence: str = ""


def _time_lost(motion: Motion, _: Progress) -> Values:
    area = motion.scenario.area
    if area.frame is None:
        return Values(make_waiting_map(motion), f"{motion.scenario.step_word}s lost")
    return Values(make_waiting_map(motion) * seconds_per_step(area), "s lost")


def _crowding(motion: Motion, _: Progress) -> Values:
    unit = "robots" if motion.scenario.area.frame is None else "robots a square metre"
    return Values(make_density_map(motion), unit)


def _prices(kind: str, words: str) -> Callable[[Plan, Progress], Values]:
    """Return what makes the map of the prices of a kind."""

    def make(plan: Plan, progress: Progress) -> Values:
        prices = make_prices(plan, kinds=kind, progress=progress)
        values, seconds = np.maximum(0, prices.price_of_cell(kind)), prices.seconds_per_unit()
        if seconds is None:
            return Values(values, f"time units {words}")
        return Values(values * seconds, f"s {words}", are_seconds=True)

    return make


_ROWS, _OPTIMA = ("waypoints", "ticks"), ("optimal", "prices")
_SAVED, _DOOR = "opening this wall saves {} for all together", "a destination here saves {} for all together"
_LOST = "closing this cell costs {} for all together"
#: All of them: one more is a line.
LAYERS = {
    "waiting": Layer("Time lost", "How long robots stood here, all together.", _time_lost, _ROWS),
    "density": Layer("Crowding", "Robots here, in the mean.", _crowding, _ROWS),
    "walls": Layer(
        "Price of walls", "What each wall costs all robots.", _prices("barrier", "saved if open"), _OPTIMA, True, _SAVED
    ),
    "chokes": Layer(
        "Worth of passages", "What narrow places are worth.", _prices("choke", "lost if closed"), _OPTIMA, True, _LOST
    ),
    "door": Layer(
        "Best next door",
        "The wall that had better be an exit.",
        _prices("door", "saved by a door"),
        _OPTIMA,
        True,
        _DOOR,
    ),
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
    layer = LAYERS[name]
    values = layer.make(motion, progress)
    header = {"unit": values.unit, "sentence": layer.sentence, "are_seconds": values.are_seconds}
    return Bundle(header, {"values": np.asarray(values.of_cell, dtype=np.float64).reshape(-1)})


def with_layers(bundle: Bundle, motion: Motion) -> Bundle:
    """Return the bundle of a page that has nobody to ask, with all layers that it offers."""
    if motion.scenario.area.cell_count > _MOST_CELLS:
        return bundle
    layers = {name: make_layer(name, motion) for name in layer_choices(is_alone=True)}
    arrays = {f"layer_{name}": layer.arrays["values"] for name, layer in layers.items()}
    told = {name: layer.header for name, layer in layers.items()}
    return Bundle({**bundle.header, "layers": told}, {**bundle.arrays, **arrays})
