"""Schemes: how far every cell is from the nearest destination (N-scheme), and which way leads there (D-scheme)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Scenario, cells_from, numbers_from
from trihex.errors import ScenarioError, check_type
from trihex.fields import ways
from trihex.fields.fresh import BLOCK, make_directions
from trihex.fields.living import LivingField
from trihex.fields.settling import needs_moves, settle
from trihex.kernels.codes import NOT_REACHED
from trihex.record import Record, counted, read_only

_BUDGET = 1 << 16  # cells settled in one call of a kernel, about 1 ms


@dataclass(frozen=True, eq=False)
class NScheme(Record):
    """The least cost from each cell to the nearest destination, the fixed point of the automaton (section 3.1).

    Parameters
    ----------
    scenario : Scenario
    distance_of_site : ndarray of int32, shape (layout.size,)
        In the unit of the cost table; `NOT_REACHED` at barriers, in the padding, and where no destination can be
        reached.
    horizon : int
        All distances below it are known; it is `NOT_REACHED`, and so all are, unless the scheme was made for the
        robots only. Cells at the horizon or beyond count as not reached.
    """

    scenario: Scenario
    distance_of_site: NDArray[np.int32]
    horizon: int = NOT_REACHED

    def in_words(self) -> str:
        """Return the area, how many cells are reached, and how far the farthest is."""
        reached = self.distance_of_site[self.distance_of_site != NOT_REACHED]
        far = f"{counted(reached.size, 'cell')} reached, the farthest at {reached.max(initial=0)}"
        return f"{self.scenario.area.in_words()}, {far}"

    @cached_property
    def distance(self) -> NDArray[np.int32]:
        """Distance of each cell, a read-only view of shape (height, width)."""
        return self.scenario.area.layout.cells_of(self.distance_of_site)  # type: ignore[return-value]

    @cached_property
    def farthest(self) -> int:
        """The largest distance of a cell from which a destination is reached."""
        return int(self.distance.max(initial=0, where=self.distance != NOT_REACHED))

    def distance_of_cell(self, cells: ArrayLike) -> NDArray[np.int32]:
        """Return the distance of cells, places (x, y) or numbers; AreaError if one lies outside.

        Examples
        --------
        >>> from trihex import Area
        >>> n_scheme = make_n_scheme(Scenario(Area("square", [[0, 0, 0]]), destinations=[(0, 0)]))
        >>> int(n_scheme.distance_of_cell((2, 0))), n_scheme.distance_of_cell([1, 2]).tolist()
        (20, [10, 20])
        """
        area = self.scenario.area
        return np.asarray(self.distance_of_site[area.layout.cell_to_site(numbers_from(area, cells))])

    @cached_property
    def generations(self) -> int:
        """Number of generations of the synchronous automaton that change something, the last of them to this scheme.

        It is the largest number of moves that a cell needs at the least to attain its distance. Found when first
        asked for, in time O(b); the fast kernel does not work in generations.
        """
        from trihex.fields.kernels import generations as kernels
        from trihex.kernels.signatures import given

        layout, tessellation = self.scenario.area.layout, self.scenario.area.tessellation
        queue = np.empty(self.scenario.area.free_count, dtype=np.int32)
        state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        state[kernels.TAIL] = state[kernels.GENERATION_END] = self.scenario.destinations.size
        queue[: state[kernels.TAIL]] = layout.cell_to_site(self.scenario.destinations)
        settled = given(
            kernels.SettledField,
            distance=self.distance_of_site,
            moves=self.scenario.moves,
            offset=layout.offset_of_direction,
            cost=tessellation.cost_of_direction,
        )
        search = given(kernels.BreadthSearch, state=state, queue=queue, is_seen=self.distance_of_site == 0)
        while state[kernels.AT] < state[kernels.TAIL]:
            kernels.count_generations(settled, search, _BUDGET)
        return int(state[kernels.GENERATION])

    @cached_property
    def unreachable_robots(self) -> NDArray[np.int64]:
        """Robots, ascending by number, that cannot arrive at any destination."""
        return read_only(np.flatnonzero(self.distance_of_cell(self.scenario.robots) == NOT_REACHED).astype(np.int64))

    def updated(self, *, blocked: ArrayLike = (), freed: ArrayLike = (), destinations: ArrayLike = ()) -> NScheme:
        """Return the N-scheme of the scenario with other barriers or destinations, repaired, not made afresh.

        Equal to a fresh one cell by cell. Beside copying the arrays, the work is in proportion to the cells that
        change; where even the copies are too slow, use `trihex.fields.living.LivingField`, which changes in place.

        Parameters
        ----------
        blocked, freed : sequences of (x, y), or arrays of cell numbers
            Cells that become barriers, and barriers that become free. What is so already stays so.
        destinations : the same, optional
            All destinations from now on. Default: as before.

        Raises
        ------
        ScenarioError
            If a destination or a robot would stand on a barrier, a cell is to be blocked and freed at once, or this
            N-scheme is known up to a horizon only.

        Examples
        --------
        >>> from trihex import Area
        >>> n_scheme = make_n_scheme(Scenario(Area("square", [[0, 0, 0], [0, 1, 0]]), destinations=[(2, 1)]))
        >>> n_scheme.updated(blocked=[(1, 0)]).distance.tolist()[1]
        [2147483647, 2147483647, 0]
        """
        return _updated(self, None, blocked, freed, destinations)[0]


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

    def in_words(self) -> str:
        """Return the area, and how many cells have a best direction."""
        cells = counted(int(np.count_nonzero(self.directions_of_site)), "cell")
        return f"{self.n_scheme.scenario.area.in_words()}, {cells} with directions"

    @cached_property
    def directions(self) -> NDArray[np.uint16]:
        """Directions of each cell, a read-only view of shape (height, width)."""
        return self.n_scheme.scenario.area.layout.cells_of(self.directions_of_site)  # type: ignore[return-value]

    @cached_property
    def unit_vectors(self) -> NDArray[np.float64]:
        """Vector (east, south) of length 1 along the first best direction of each cell, shape (height, width, 2).

        (0, 0) where there is no direction. A flow field, as games call it.
        """
        return read_only(ways.unit_vectors(self.n_scheme.scenario.area.tessellation, self.directions))

    def direction_of_cell(self, cells: ArrayLike) -> NDArray[np.int64]:
        """Return the first of the best directions of cells, places (x, y) or numbers; -1 where there is none.

        Examples
        --------
        >>> from trihex import Area
        >>> scenario = Scenario(Area("square", [[0, 0, 1, 0]]), destinations=[(0, 0)])
        >>> d_scheme = make_d_scheme(make_n_scheme(scenario))
        >>> d_scheme.direction_of_cell([0, 1, 3]).tolist(), d_scheme.next_cell([0, 1, 3]).tolist()
        ([-1, 3, -1], [0, 0, 3])
        """
        return ways.direction_of_cell(self.n_scheme.scenario.area, self.directions, cells)

    def next_cell(self, cells: ArrayLike) -> NDArray[np.int64]:
        """Return the numbers of the cells to which the first best directions of cells lead.

        It is the cell itself at a destination, and where no destination can be reached.
        """
        return ways.next_cell(self.n_scheme.scenario.area, self.directions, cells)

    def names_of_cell(self, cell: ArrayLike) -> tuple[str, ...]:
        """Return the names of the best directions of a cell, a place (x, y) or a number."""
        area = self.n_scheme.scenario.area
        x, y = area.cell_to_xy(cell)
        names = area.tessellation.direction_names[int(area.tessellation.orientation_of_cell(x, y))]
        bits = int(self.directions[int(y), int(x)])
        return tuple(name for k, name in enumerate(names) if bits >> k & 1)

    def updated(self, *, blocked: ArrayLike = (), freed: ArrayLike = (), destinations: ArrayLike = ()) -> DScheme:
        """Return the D-scheme of the scenario with other barriers or destinations, see `NScheme.updated`."""
        n_scheme, directions = _updated(self.n_scheme, self.directions_of_site, blocked, freed, destinations)
        return DScheme(n_scheme, read_only(cast("NDArray[np.uint16]", directions)))


def make_n_scheme(
    scenario: Scenario, *, robots_only: bool = False, progress: Callable[[int, int], None] | None = None
) -> NScheme:
    """Compute the N-scheme of `scenario`, in time and memory O(b), b the number of cells.

    Parameters
    ----------
    scenario : Scenario
    robots_only : bool
        Stop as soon as the distance of every robot is known. Cells as near as the farthest robot then have their
        distance, farther ones may be `NOT_REACHED`: enough to follow shortest paths from every robot, but not to let
        robots step aside into cells farther from a destination. See `NScheme.horizon`.
    progress : callable, optional
        Called with (cells settled, free cells) now and then.

    Raises
    ------
    ScenarioError
        If a cell is farther than 2 000 000 000 from every destination and yet can be reached.

    Notes
    -----
    The fixed point does not depend on the order of updates; here cells are settled in the order of their distance,
    each once: see `trihex.fields.kernels.buckets`.

    Examples
    --------
    >>> from trihex import Area
    >>> make_n_scheme(Scenario(Area("square", [[0, 0, 0], [1, 1, 0]]), destinations=[(0, 0)])).distance.tolist()
    [[0, 10, 20], [2147483647, 2147483647, 24]]
    """
    from trihex.fields.kernels import front as kernels

    check_type("scenario", scenario, Scenario)
    distance = _nothing_reached(scenario)
    horizon = _settle(scenario, distance, robots_only, progress)
    for start in range(0, distance.size, BLOCK):
        kernels.finish(distance[start : start + BLOCK], horizon)
    if progress is not None:
        progress(scenario.area.free_count, scenario.area.free_count)
    return NScheme(scenario, read_only(distance), horizon)


def _nothing_reached(scenario: Scenario) -> NDArray[np.int32]:
    """Return a padded array as the kernel wants it: 0 at destinations, `NOT_REACHED`, and -1 where nobody can go."""
    from trihex.fields.kernels import front as kernels

    layout = scenario.area.layout
    distance = np.empty(layout.size, dtype=np.int32)
    distance[: layout.origin] = distance[layout.origin + layout.height * layout.pitch :] = -1
    rows = max(1, BLOCK // layout.pitch)
    for y in range(0, layout.height, rows):
        barriers = scenario.area.barriers[y : y + rows]
        kernels.prepare(barriers, layout.origin + y * layout.pitch, layout.pitch, distance)
    distance[layout.cell_to_site(scenario.destinations)] = 0
    return distance


def _settle(
    scenario: Scenario,
    distance: NDArray[np.int32],
    robots_only: bool,
    progress: Callable[[int, int], None] | None,
) -> int:
    """Settle `distance`, all of it or until the robots' are known, and return the horizon."""
    area, layout = scenario.area, scenario.area.layout
    sites = layout.cell_to_site(scenario.destinations)
    waiting, done = layout.cell_to_site(scenario.robots), 0

    def look(horizon: int) -> bool:
        nonlocal waiting, done
        if robots_only:
            waiting = waiting[distance[waiting] >= horizon]
        if progress is not None:
            done = min(done + _BUDGET, area.free_count)
            progress(done, area.free_count)
        return robots_only and waiting.size == 0

    moves = scenario.moves if needs_moves(area.tessellation, scenario.corners) else None
    return settle(distance, layout, moves, sites, np.zeros_like(sites), look)


def make_d_scheme(n_scheme: NScheme) -> DScheme:
    """Compute the D-scheme that belongs to an N-scheme, in time O(b).

    Examples
    --------
    >>> from trihex import Area
    >>> n_scheme = make_n_scheme(Scenario(Area("square", [[0, 0, 0], [1, 1, 0]]), destinations=[(0, 0)]))
    >>> make_d_scheme(n_scheme).names_of_cell(5)
    ('NW',)
    """
    check_type("n_scheme", n_scheme, NScheme)
    scenario = n_scheme.scenario
    moves = None if scenario.corners == "allow" else scenario.moves
    directions = make_directions(n_scheme.distance_of_site, scenario.area.layout, moves)
    return DScheme(n_scheme, read_only(directions))


def _updated(
    n_scheme: NScheme,
    directions: NDArray[np.uint16] | None,
    blocked: ArrayLike,
    freed: ArrayLike,
    destinations: ArrayLike,
) -> tuple[NScheme, NDArray[np.uint16] | None]:
    """Return the N-scheme and the directions of a changed scenario."""
    if n_scheme.horizon != NOT_REACHED:
        raise ScenarioError("an N-scheme made for the robots only cannot be updated: make it without robots_only")
    scenario = n_scheme.scenario
    area, own = scenario.area, scenario.destinations
    given = cells_from(area, destinations, "destinations", ScenarioError)
    wanted = given if given.size else own
    blocked, freed = (cells_from(area, c, n, ScenarioError) for c, n in ((blocked, "blocked"), (freed, "freed")))
    field = LivingField(scenario, n_scheme.distance_of_site, directions)
    field.change(blocked=blocked, freed=freed, opened=np.setdiff1d(wanted, own), closed=np.setdiff1d(own, wanted))
    changed = replace(scenario, area=replace(area, barriers=field.barriers), destinations=wanted)
    object.__setattr__(changed, "moves", read_only(field.moves))  # the cached property, found already
    return NScheme(changed, read_only(field.distance_of_site)), field.directions_of_site
