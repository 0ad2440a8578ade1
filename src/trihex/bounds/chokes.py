"""Chokes: the cells of the narrowest places between robots and destinations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.cuts import find_cuts
from trihex.bounds.demand import make_demand
from trihex.errors import check_type
from trihex.fields import NScheme

# How many cuts are looked for, from that around the destinations on to ever farther ones.
_MOST_CUTS = 100


def choke_cells(n_scheme: NScheme) -> NDArray[np.int64]:
    """Return the cells, destinations left out, of nested least cuts that part robots from destinations, ascending.

    Examples
    --------
    >>> from trihex import Area, Scenario, make_n_scheme
    >>> area = Area("square", [[0, 1, 0], [0, 0, 0], [0, 1, 0]])
    >>> choke_cells(make_n_scheme(Scenario(area, destinations=[(2, 1)], robots=[(0, 0), (0, 2)])))
    array([4])
    """
    check_type("n_scheme", n_scheme, NScheme)
    scenario = n_scheme.scenario
    cuts = find_cuts(make_demand(n_scheme), most_searches=_MOST_CUTS)
    nodes = np.unique(np.concatenate([np.empty(0, dtype=np.int32), *(cut.nodes for cut in cuts)]))
    cells = scenario.area.layout.site_to_cell(nodes[nodes < scenario.area.layout.size].astype(np.int64))
    return np.setdiff1d(cells, scenario.destinations).astype(np.int64)
