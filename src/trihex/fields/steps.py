"""Steps: how many moves it takes from each site to the nearest destination, whatever they cost."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.record import read_only

# Sites looked at in one call of the kernel, a few hundredths of a second: between two calls a user can interrupt.
_BUDGET = 1_000_000


def steps_to_destination(scenario: Scenario) -> NDArray[np.int32]:
    """Return the least number of steps from each site to a destination, -1 where none can be reached."""
    from trihex.fields.kernels import steps as kernels

    layout = scenario.area.layout
    steps = np.full(layout.size, -1, dtype=np.int32)
    queue = np.empty(scenario.area.free_count, dtype=np.int32)
    head, tail = 0, scenario.destinations.size
    queue[:tail] = layout.cell_to_site(scenario.destinations)
    steps[queue[:tail]] = 0
    while head < tail:
        end = min(tail, head + _BUDGET)
        tail = kernels.count_steps(scenario.moves, layout.offset_of_direction, steps, queue, head, tail, _BUDGET)
        head = end
    return read_only(steps)
