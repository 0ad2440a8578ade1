"""Living field: distances and moves that follow a world which changes, repaired in place."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Scenario, World, cells_from
from trihex.errors import ScenarioError
from trihex.fields.wave import Wave
from trihex.kernels.codes import NOT_REACHED


class Repair(NamedTuple):
    """What a change of the world did to the field: how many cells were raised, lowered, and looked at anew.

    Attributes
    ----------
    raised : int
        Cells that lost their last support; some of them are then lowered to a new distance.
    lowered : int
        Cells that were given a new distance, beside those that lost it for good.
    sites : int32 array
        The sites concerned, some of them twice: all whose distance, moves or best directions may have changed.
    """

    raised: int
    lowered: int
    sites: NDArray[np.int32]

    @property
    def touched(self) -> int:
        """Cells that were given a new distance or none, an upper bound of those that differ."""
        return self.raised + self.lowered


class LivingField:
    """The N-scheme, and if wanted the D-scheme, of a scenario whose barriers and destinations change.

    Changed in place, unlike records: at 16 million cells, to copy one takes longer than most repairs by a factor of a
    hundred. `trihex.fields.schemes.NScheme.updated` is the same as a function of records.

    Parameters
    ----------
    scenario : Scenario
        The world at the beginning; its robots play no part.
    distance_of_site : ndarray of int32
        As in the N-scheme of `scenario`; copied.
    directions_of_site : ndarray of uint16, optional
        As in its D-scheme; copied. If left out, no directions are kept.

    Attributes
    ----------
    distance_of_site, directions_of_site, moves : ndarray
        As in `NScheme`, `DScheme` and `Scenario`, at any time equal to those made afresh. Views of them, such as
        `distance`, show every change.

    Examples
    --------
    >>> from trihex import Area, make_n_scheme
    >>> scenario = Scenario(Area("square", [[0, 0, 0], [0, 1, 0]]), destinations=[(2, 1)])
    >>> field = LivingField(scenario, make_n_scheme(scenario).distance_of_site)
    >>> field.change(freed=[(1, 1)]).lowered
    2
    >>> field.distance.tolist()
    [[24, 14, 10], [20, 10, 0]]
    """

    def __init__(
        self,
        scenario: Scenario,
        distance_of_site: NDArray[np.int32],
        directions_of_site: NDArray[np.uint16] | None = None,
    ) -> None:
        self.scenario = scenario
        self.area, self.layout = scenario.area, scenario.area.layout
        self.distance_of_site = distance_of_site.copy()
        self.directions_of_site = None if directions_of_site is None else directions_of_site.copy()
        self.moves = scenario.moves.copy()
        self.world = World(scenario)
        self._corners = _corners_of(scenario)
        self._wave = Wave(scenario, self.moves, self.distance_of_site)

    @property
    def distance(self) -> NDArray[np.int32]:
        """Distance of each cell now, a view of shape (height, width)."""
        return self.layout.cells_of(self.distance_of_site)  # type: ignore[return-value]

    @property
    def blocked(self) -> NDArray[np.bool_]:
        """Where nobody can stand now: barriers and the padding, for each site."""
        return self.world.blocked

    @property
    def barriers(self) -> NDArray[np.bool_]:
        """Where barriers are now, a view of shape (height, width)."""
        return self.world.barriers

    @property
    def destinations(self) -> set[int]:
        """Numbers of the cells that are destinations now."""
        return self.world.destinations

    def change(
        self, *, blocked: ArrayLike = (), freed: ArrayLike = (), opened: ArrayLike = (), closed: ArrayLike = ()
    ) -> Repair:
        """Change the world and repair the field, in time proportional to the number of cells that change.

        Parameters
        ----------
        blocked, freed : sequences of (x, y), or arrays of cell numbers
            Cells that become barriers, and barriers that become free. What is so already stays so.
        opened, closed : the same
            Cells that become destinations, and destinations that become ordinary cells. The last may go, too.

        Raises
        ------
        ScenarioError
            If a cell is to be two things at once: blocked and freed, or a barrier and a destination.
        """
        named = {"blocked": blocked, "freed": freed, "opened": opened, "closed": closed}
        cells = {name: cells_from(self.area, given, name, ScenarioError) for name, given in named.items()}
        self.world.check(**cells)
        return self._repair(self.world.change(**cells))

    def _repair(self, site: dict[str, NDArray[np.int32]]) -> Repair:
        from trihex.fields.kernels.changing import renew_moves

        distance = self.distance_of_site
        changed = np.concatenate(list(site.values()))
        around = np.empty(changed.size * (self.area.tessellation.direction_count + 1), dtype=np.int32)
        renew_moves(changed, self.blocked, self._corners, self.moves, around)
        gone = np.concatenate([site["blocked"], site["closed"]])
        gone = gone[distance[gone] != NOT_REACHED]
        distance[gone] = NOT_REACHED
        raised = np.concatenate([gone, self._wave.raised(around)])

        distance[site["opened"]] = 0
        concerned = np.concatenate([raised, around])
        best = self._wave.best_of(concerned)
        is_better = best < distance[concerned]
        better, best = concerned[is_better], best[is_better]
        distance[better] = best
        lowered = self._wave.lowered(np.concatenate([better, site["opened"]]))

        sites = np.concatenate([concerned, lowered])
        if self.directions_of_site is not None:
            self._wave.renew_directions(sites, self.directions_of_site)
        return Repair(raised.size, lowered.size, sites)


def _corners_of(scenario: Scenario) -> Any:
    """Return when moves are open, as the kernel knows it."""
    from trihex.kernels.corners import CornerRule
    from trihex.kernels.signatures import given

    layout = scenario.area.layout
    return given(
        CornerRule,
        offset=layout.offset_of_direction,
        vertex=layout.vertex_of_direction,
        ring=layout.ring_of_vertex,
        edge_count=scenario.area.tessellation.edge_count,
        rule=scenario.corner_rule,
    )
