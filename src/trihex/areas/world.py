"""World: where barriers and destinations are now, as they come and go."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.places import numbers_from
from trihex.areas.scenario import Scenario
from trihex.errors import ScenarioError

_NONE = np.empty(0, dtype=np.int32)


class World:
    """Barriers and destinations of a scenario, changed in place.

    Parameters
    ----------
    scenario : Scenario
        The world at the beginning; its robots play no part.

    Attributes
    ----------
    blocked : ndarray of bool
        Where nobody can stand: barriers and the padding, for each site.
    destinations : set of int
        Numbers of the cells that are destinations.

    Examples
    --------
    >>> from trihex import Area
    >>> world = World(Scenario(Area("square", [[0, 0, 1]]), destinations=[(0, 0)]))
    >>> sites = world.change(freed=[2], opened=[2], closed=[0])
    >>> world.barriers.tolist(), world.destinations
    ([[False, False, False]], {2})
    """

    def __init__(self, scenario: Scenario) -> None:
        self.area, self.layout = scenario.area, scenario.area.layout
        self.blocked = self.area.make_blocked()
        self.destinations: set[int] = set(scenario.destinations.tolist())

    @property
    def barriers(self) -> NDArray[np.bool_]:
        """Where barriers are now, a view of shape (height, width)."""
        return self.layout.cells_of(self.blocked)  # type: ignore[return-value]

    @property
    def destination_cells(self) -> NDArray[np.int64]:
        """Numbers of the cells that are destinations now, ascending."""
        return np.array(sorted(self.destinations), dtype=np.int64)

    def is_barrier(self, cell: int) -> bool:
        """Tell whether a cell, a place (x, y) or a number, is a barrier; raises AreaError if it lies outside."""
        return bool(self.barriers[divmod(int(numbers_from(self.area, cell)), self.area.width)])

    def check(
        self, blocked: NDArray[np.int64], freed: NDArray[np.int64], opened: NDArray[np.int64], closed: NDArray[np.int64]
    ) -> None:
        """Raise ScenarioError if a change would make a cell two things at once; parameters as for `change`."""
        barred, cleared, new, old = (set(cells.tolist()) for cells in (blocked, freed, opened, closed))
        remain = (self.destinations - old) | new if old or new else self.destinations
        for one, other, words in (
            (barred, cleared, "be blocked and freed at once"),
            (new, old, "be opened and closed at once"),
            (barred, remain, "be blocked while it is a destination"),
        ):
            both = one & other
            if both:
                raise ScenarioError(f"a cell must not {words}: {self.area.name_of_cell(min(both))}")
        for cell in sorted(new - cleared):
            if self.is_barrier(cell):
                raise ScenarioError(f"a destination must be a free cell; {self.area.name_of_cell(cell)} is a barrier")

    def change(
        self, blocked: ArrayLike = (), freed: ArrayLike = (), opened: ArrayLike = (), closed: ArrayLike = ()
    ) -> dict[str, NDArray[np.int32]]:
        """Change the world, unchecked; return the sites of what changes, by name.

        Parameters
        ----------
        blocked, freed : arrays of cell numbers
            Cells that become barriers, and barriers that become free.
        opened, closed : the same
            Cells that become destinations, and destinations that become ordinary cells.
        """
        named = {"blocked": blocked, "freed": freed, "opened": opened, "closed": closed}
        cells = {name: np.asarray(own, dtype=np.int64) for name, own in named.items()}
        # Most changes are of one kind; to find the sites of no cells takes as long as to find that of one.
        sites = {name: self.layout.cell_to_site(own) if own.size else _NONE for name, own in cells.items()}
        self.blocked[sites["blocked"]] = True
        self.blocked[sites["freed"]] = False
        self.destinations.difference_update(cells["closed"].tolist())
        self.destinations.update(cells["opened"].tolist())
        return sites
