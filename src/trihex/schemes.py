"""Schemes: how far every cell is from the nearest destination (N-scheme), and which way leads there (D-scheme)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.record import Record, read_only
from trihex.scenario import Scenario

NOT_REACHED = 2**31 - 1


@dataclass(frozen=True, eq=False)
class NScheme(Record):
    """The least cost from each cell to the nearest destination, the fixed point of the automaton (section 3.1).

    Parameters
    ----------
    scenario : Scenario
    distance_of_site : ndarray of int32, shape (layout.size,)
        In the unit of the cost table; `NOT_REACHED` at barriers, in the padding, and where no destination can be
        reached.
    """

    scenario: Scenario
    distance_of_site: NDArray[np.int32]

    @cached_property
    def distance(self) -> NDArray[np.int32]:
        """Distance of each cell, a read-only view of shape (height, width)."""
        return self.scenario.area.layout.cells_of(self.distance_of_site)  # type: ignore[return-value]

    def distance_of_cell(self, cells: ArrayLike) -> NDArray[np.int32]:
        """Return the distance of cells given by number."""
        sites = self.scenario.area.layout.cell_to_site(np.asarray(cells, dtype=np.int64))
        return np.asarray(self.distance_of_site[sites])

    @cached_property
    def unreachable_robots(self) -> NDArray[np.int64]:
        """Robots, ascending by number, that cannot arrive at any destination."""
        return read_only(np.flatnonzero(self.distance_of_cell(self.scenario.robots) == NOT_REACHED).astype(np.int64))


@dataclass(frozen=True, eq=False)
class DScheme(Record):
    """The directions in which each cell's least cost to a destination is attained, all tied ones (section 3.2).

    Parameters
    ----------
    n_scheme : NScheme
    directions_of_site : ndarray of uint16, shape (layout.size,)
        Bit k is set where direction k is one of the best; 0 at destinations, barriers, in the padding, and where no
        destination can be reached.
    """

    n_scheme: NScheme
    directions_of_site: NDArray[np.uint16]

    @cached_property
    def directions(self) -> NDArray[np.uint16]:
        """Directions of each cell, a read-only view of shape (height, width)."""
        return self.n_scheme.scenario.area.layout.cells_of(self.directions_of_site)  # type: ignore[return-value]

    def names_of_cell(self, cell: int) -> tuple[str, ...]:
        """Return the names of the best directions of a cell given by number."""
        area = self.n_scheme.scenario.area
        x, y = area.cell_to_xy(cell)
        names = area.tessellation.direction_names[int(area.tessellation.orientation_of_cell(x, y))]
        bits = int(self.directions[int(y), int(x)])
        return tuple(name for k, name in enumerate(names) if bits >> k & 1)


def make_n_scheme(scenario: Scenario) -> NScheme:
    """Compute the N-scheme of `scenario`.

    Examples
    --------
    >>> from trihex import Area
    >>> make_n_scheme(Scenario(Area("square", [[0, 0, 0], [1, 1, 0]]), destinations=[(0, 0)])).distance.tolist()
    [[0, 10, 20], [2147483647, 2147483647, 24]]
    """
    from trihex.kernels import fields as kernels

    area = scenario.area
    layout = area.layout
    distance = np.full(layout.size, NOT_REACHED, dtype=np.int32)
    kernels.spread(
        layout.cell_to_site(scenario.destinations),
        layout.offset_of_direction,
        area.tessellation.cost_of_direction,
        scenario.moves,
        distance,
        np.empty(area.free_count + 1, dtype=np.int32),
        np.zeros(layout.size, dtype=np.uint16),
    )
    return NScheme(scenario, read_only(distance))


def make_d_scheme(n_scheme: NScheme) -> DScheme:
    """Compute the D-scheme that belongs to an N-scheme, in time O(b).

    Examples
    --------
    >>> from trihex import Area
    >>> n_scheme = make_n_scheme(Scenario(Area("square", [[0, 0, 0], [1, 1, 0]]), destinations=[(0, 0)]))
    >>> make_d_scheme(n_scheme).names_of_cell(5)
    ('NW',)
    """
    from trihex.kernels import fields as kernels

    scenario = n_scheme.scenario
    layout = scenario.area.layout
    directions = np.zeros(layout.size, dtype=np.uint16)
    kernels.fill_directions(
        n_scheme.distance_of_site,
        scenario.moves,
        layout.offset_of_direction,
        scenario.area.tessellation.cost_of_direction,
        layout.origin,
        layout.origin + layout.height * layout.pitch,
        directions,
    )
    return DScheme(n_scheme, read_only(directions))
