"""Generations: the automaton at work, its changes on their way to the page while more of them are made."""

from __future__ import annotations

from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import TooLargeError
from trihex.fields import distance_generations
from trihex.viewer.bundle import Bundle
from trihex.viewer.call import TICK, Call
from trihex.viewer.compiling import prepare_for

# The automaton looks at all neighbours of all cells in every generation.
MAX_AUTOMATON_CELLS = 2**20


def send_generations(scenario: Scenario, call: Call) -> Bundle:
    """Send the changes of each generation, how many cells change, which, and to what; return the last of them."""
    if scenario.area.cell_count > MAX_AUTOMATON_CELLS:
        raise TooLargeError(
            f"generations are shown one by one in areas of at most {MAX_AUTOMATON_CELLS} cells, not "
            f"{scenario.area.cell_count}; the N-scheme itself is shown in any"
        )
    prepare_for(call, "generations")
    counts: list[int] = []
    cells: list[NDArray[np.int32]] = []
    values: list[NDArray[np.int32]] = []
    last_sent, before = monotonic(), None
    number = -1
    for states in distance_generations(scenario):
        number += 1
        call.check()
        if before is not None:
            changed = np.flatnonzero(states != before)
            counts.append(changed.size)
            cells.append(changed.astype(np.int32))
            values.append(states.reshape(-1)[changed].astype(np.int32))
        before = states
        if monotonic() - last_sent > TICK and counts:
            call.part({}, _joined(counts, cells, values))
            counts, cells, values, last_sent = [], [], [], monotonic()
    return Bundle({"generations": number}, _joined(counts, cells, values))


def _joined(
    counts: list[int], cells: list[NDArray[np.int32]], values: list[NDArray[np.int32]]
) -> dict[str, NDArray[Any]]:
    nothing = np.empty(0, dtype=np.int32)
    return {
        "counts": np.array(counts, dtype=np.int32),
        "cells": np.concatenate([nothing, *cells]),
        "values": np.concatenate([nothing, *values]),
    }
