"""Living field: distances, directions and moves that follow a world which changes, repaired in place."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Scenario, World, cells_from, numbers_from
from trihex.errors import ScenarioError, check_type
from trihex.fields import ways
from trihex.fields.fresh import fill_directions, fill_distances, make_directions
from trihex.fields.settling import needs_moves
from trihex.fields.wave import Wave
from trihex.kernels.codes import NOT_REACHED
from trihex.record import in_one_line

# A repair takes about as long as making the field afresh when it gives a twelfth of the cells a new distance: in
# 300 x 300 rooms a moved destination took 21 ms to repair and takes 0.9 afresh. Small repairs are never worth it.
_SHARE, _LEAST = 12, 512


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
    is_fresh : bool
        Whether the field was made afresh, because a repair would have taken longer. Then all free cells count as
        lowered.
    """

    raised: int
    lowered: int
    sites: NDArray[np.int32]
    is_fresh: bool = False

    def __repr__(self) -> str:
        return in_one_line(self)

    @property
    def touched(self) -> int:
        """Cells that were given a new distance or none, an upper bound of those that differ."""
        return self.raised + self.lowered


class LivingField:
    """The N-scheme and the D-scheme of a scenario whose barriers and destinations change.

    Changed in place, unlike records: at 16 million cells, to copy one takes longer than most repairs by a factor of a
    hundred. `trihex.fields.schemes.NScheme.updated` is the same as a function of records.

    Parameters
    ----------
    scenario : Scenario
        The world at the beginning; its robots play no part.
    distance_of_site : ndarray of int32, optional
        As in the N-scheme of `scenario`, if it is at hand; copied.
    directions_of_site : ndarray of uint16, optional
        As in its D-scheme; copied. If left out, directions are found when first asked for, and kept from then on.

    Attributes
    ----------
    distance_of_site, moves : ndarray
        As in `NScheme` and `Scenario`, at any time equal to those made afresh. Views of them, such as `distance`, show
        every change.
    directions_of_site : ndarray or None
        As in `DScheme`; None until directions are asked for.

    Examples
    --------
    >>> from trihex import Area
    >>> field = LivingField(Scenario(Area("square", [[0, 0, 0], [0, 1, 0]]), destinations=[(2, 1)]))
    >>> field.change(freed=(1, 1)).lowered
    2
    >>> field.distance.tolist()
    [[24, 14, 10], [20, 10, 0]]
    >>> field.next_cell([(0, 0), (2, 1)]).tolist()
    [1, 5]
    """

    def __init__(
        self,
        scenario: Scenario,
        distance_of_site: NDArray[np.int32] | None = None,
        directions_of_site: NDArray[np.uint16] | None = None,
    ) -> None:
        check_type("scenario", scenario, Scenario)
        self.scenario = scenario
        self.area, self.layout = scenario.area, scenario.area.layout
        self.moves = scenario.moves.copy()
        self.world = World(scenario)
        self._needs_moves = needs_moves(self.area.tessellation, scenario.corners)
        if distance_of_site is None:
            self.distance_of_site = np.empty(self.layout.size, dtype=np.int32)
            self._fill_distances()
        else:
            self.distance_of_site = self._own("distance_of_site", distance_of_site, np.int32)
        self.directions_of_site: NDArray[np.uint16] | None = None
        if directions_of_site is not None:
            self.directions_of_site = self._own("directions_of_site", directions_of_site, np.uint16)
        self._corners = _corners_of(scenario)
        self._wave = Wave(scenario, self.moves, self.distance_of_site)

    def _own(self, name: str, array: Any, dtype: Any) -> Any:
        """Return a copy of an array with an entry for each site, else raise ScenarioError."""
        if not isinstance(array, np.ndarray) or array.shape != (self.layout.size,) or array.dtype != dtype:
            raise ScenarioError(
                f"{name} must be that of an N-scheme or D-scheme of the scenario, {self.layout.size} numbers"
            )
        return array.copy()

    @property
    def distance(self) -> NDArray[np.int32]:
        """Distance of each cell now, a view of shape (height, width)."""
        return self.layout.cells_of(self.distance_of_site)  # type: ignore[return-value]

    @property
    def directions(self) -> NDArray[np.uint16]:
        """Best directions of each cell now, a view of shape (height, width), see `DScheme`."""
        if self.directions_of_site is None:
            self.directions_of_site = make_directions(
                self.distance_of_site, self.layout, self.moves if self._needs_moves else None
            )
        return self.layout.cells_of(self.directions_of_site)  # type: ignore[return-value]

    @property
    def unit_vectors(self) -> NDArray[np.float64]:
        """Vectors (east, south) along the first best directions now, see `DScheme.unit_vectors`; made anew."""
        return ways.unit_vectors(self.area.tessellation, self.directions)

    def distance_of_cell(self, cells: ArrayLike) -> NDArray[np.int32]:
        """Return the distance of cells now, see `NScheme.distance_of_cell`."""
        return np.asarray(self.distance_of_site[self.layout.cell_to_site(numbers_from(self.area, cells))])

    def direction_of_cell(self, cells: ArrayLike) -> NDArray[np.int64]:
        """Return the first of the best directions of cells now, see `DScheme.direction_of_cell`."""
        return ways.direction_of_cell(self.area, self.directions, cells)

    def next_cell(self, cells: ArrayLike) -> NDArray[np.int64]:
        """Return the numbers of the cells to go to from cells now, see `DScheme.next_cell`."""
        return ways.next_cell(self.area, self.directions, cells)

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

        Where that would take longer than to make the field afresh, as when the only destination moves, it is made
        afresh.

        Parameters
        ----------
        blocked, freed : one place (x, y), a sequence of them, or cell numbers
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
        most = self.area.free_count // _SHARE + _LEAST
        is_moved = site["closed"].size > 0 and len(self.destinations) == site["opened"].size
        if changed.size > most or (is_moved and self.area.free_count > most):  # no destination is left of those before
            return self._made_afresh(site["blocked"])
        gone = np.concatenate([site["blocked"], site["closed"]])
        gone = gone[distance[gone] != NOT_REACHED]
        distance[gone] = NOT_REACHED
        found = self._wave.raised(around, most)
        if found is None:
            return self._made_afresh(site["blocked"])
        raised = np.concatenate([gone, found])

        distance[site["opened"]] = 0
        concerned = np.concatenate([raised, around])
        best = self._wave.best_of(concerned)
        is_better = best < distance[concerned]
        better, best = concerned[is_better], best[is_better]
        distance[better] = best
        lowered = self._wave.lowered(np.concatenate([better, site["opened"]]), most)
        if lowered is None:
            return self._made_afresh(site["blocked"])

        sites = np.concatenate([concerned, lowered])
        if self.directions_of_site is not None:
            self._wave.renew_directions(sites, self.directions_of_site)
        return Repair(raised.size, lowered.size, sites)

    def _made_afresh(self, blocked: NDArray[np.int32]) -> Repair:
        """Make distances, and directions if they are kept, afresh; `blocked` are the sites of new barriers."""
        self._fill_distances()
        if self.directions_of_site is not None:
            moves = self.moves if self._needs_moves else None
            fill_directions(self.distance_of_site, self.layout, moves, self.directions_of_site)
        free = np.flatnonzero(~self.blocked).astype(np.int32)
        return Repair(blocked.size, free.size, np.concatenate([blocked, free]), is_fresh=True)

    def _fill_distances(self) -> None:
        sites = self.layout.cell_to_site(self.world.destination_cells)
        moves = self.moves if self._needs_moves else None
        fill_distances(self.distance_of_site, self.blocked, self.layout, moves, sites)


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
