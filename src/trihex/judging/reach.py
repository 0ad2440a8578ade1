"""Reach: from where a lone robot gets to a destination, as the judge finds it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.judging.law import make_law, make_places

# About 0.1 s of work between two looks at the keyboard.
_BUDGET = 4_000_000


def is_reachable(scenario: Scenario, cells: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Tell for each cell whether a lone robot gets from there to a destination."""
    from trihex.judging.kernels import reach as kernels
    from trihex.kernels.signatures import given

    area, layout = scenario.area, scenario.area.layout
    start, place, law = layout.cell_to_site(cells), make_places(scenario), make_law(scenario)
    search = given(
        kernels.Flood,
        mark=np.full(layout.size, kernels.UNKNOWN, dtype=np.uint8),
        queue=np.empty(area.free_count + scenario.destinations.size, dtype=np.int32),  # these may be barriers
        state=np.zeros(5, dtype=np.int64),
    )
    while search.state[kernels.NEXT] < start.size:
        kernels.flood(start, place, law, search, _BUDGET)
    return np.asarray(search.mark[start] == kernels.OPEN)
