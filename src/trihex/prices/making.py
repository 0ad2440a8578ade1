"""How prices are found: first those of barriers, then those of chokes, then the best next door."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import cells_from, check_as_fast
from trihex.bounds import choke_cells
from trihex.errors import PlanError, check_choice, check_type
from trihex.fields import NScheme, make_n_scheme
from trihex.optimum import Variations, check_equal_steps
from trihex.plans import Plan
from trihex.prices.afresh import AfreshVariations
from trihex.prices.next_door import NextDoor
from trihex.prices.prices import KINDS, Prices


def make_prices(
    plan: Plan,
    *,
    kinds: Iterable[str] = KINDS,
    cells: ArrayLike | None = None,
    known: Mapping[tuple[str, int], int] | None = None,
    tell: Callable[[str, int, int], None] | None = None,
    stop: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
    n_scheme: NScheme | None = None,
    memory_limit: int | None = None,
) -> Prices:
    """Tell what each wall and each door costs all robots together: proven, and equal to optima made afresh.

    Where every step costs the same (hexagons; squares and triangles with edge neighbours; waiting like a move) slots
    of the optimum at hand are exchanged anew, see docs/optimum.md; elsewhere the optimum is made afresh for each cell
    for which the bounds do not tell that it saves nothing, which takes long.

    Parameters
    ----------
    plan : Plan
        One that is the best, whoever made it.
    kinds : iterable of {"barrier", "choke", "door"}
        What is priced.
    cells : sequence of (x, y), or cell numbers, optional
        Only these, barriers as barriers and doors, free cells as chokes. Default: all barriers, and the cells of the
        narrowest places between robots and destinations.
    known : mapping from (kind, cell) to price, optional
        What `tell` was told before.
    tell : callable, optional
        Called with kind, cell and price when a price is proven that took some work.
    stop : callable, optional
        Asked between two cells; when it says True, the rest is left unproven.
    progress : callable, optional
        Called with (cells done with, cells).
    n_scheme : NScheme, optional
        That of the scenario, if it is at hand.
    memory_limit : int, optional
        In bytes. Default: 80 % of what is available.

    Raises
    ------
    PlanError
        If the plan is not the best, or optima cannot be had or proven by these rules.
    TooLargeError
        If that would take more than `memory_limit`.

    Examples
    --------
    >>> import trihex as th
    >>> area = th.Area("square", [[0, 1, 0], [0, 1, 0], [0, 0, 0]])
    >>> area = th.Area(th.Tessellation("square", "edge"), area.barriers)
    >>> plan = th.make_plan(th.Scenario(area, destinations=[(2, 0)], robots=[(0, 0), (0, 1)]), "optimal")
    >>> prices = th.make_prices(plan)
    >>> prices.price_of_cell("barrier").tolist()
    [[-1, 60, -1], [-1, 40, -1], [-1, -1, -1]]
    """
    check_type("plan", plan, Plan)
    check_as_fast(plan.scenario, "a price")
    kinds = (kinds,) if isinstance(kinds, str) else tuple(kinds)
    for kind in kinds:
        check_choice("kinds", kind, KINDS, PlanError)
    area = plan.scenario.area
    n_scheme = n_scheme if n_scheme is not None else make_n_scheme(plan.scenario)
    if cells is None:
        asked = np.union1d(np.flatnonzero(area.barriers), choke_cells(n_scheme))
    else:
        asked = np.unique(cells_from(area, cells, "cells", PlanError))
    asked = np.setdiff1d(asked, plan.scenario.destinations)
    work = _Pricing(*_variations(plan, n_scheme, memory_limit), known or {}, tell, stop, progress)
    is_barrier = area.barriers.reshape(-1)[asked]
    barriers, chokes = asked[is_barrier], asked[~is_barrier]
    steps = (
        ("barrier", barriers, work.price_barriers),
        ("choke", chokes, work.price_chokes),
        ("door", barriers, work.price_door),
    )
    work.total = sum(those.size for kind, those, _ in steps if kind in kinds)
    for kind, those, price in steps:
        if kind in kinds:
            price(those)
    columns = zip(*sorted(work.rows, key=lambda row: (KINDS.index(row.kind), row.cell)), strict=True)
    return Prices(plan, *(columns if work.rows else [()] * len(Row._fields)))


def _variations(plan: Plan, n_scheme: NScheme, memory_limit: int | None) -> tuple[Any, AfreshVariations]:
    """Return what tells of optima with one cell changed, and what bounds them."""
    afresh = AfreshVariations(plan, n_scheme, memory_limit)
    try:
        check_equal_steps(plan.scenario)
    except PlanError:
        afresh.check(plan)
        return afresh, afresh
    return Variations(plan, n_scheme=n_scheme, memory_limit=memory_limit), afresh


class Row(NamedTuple):
    """What `Prices` hold of a cell."""

    kind: str
    cell: int
    price: int
    most: int
    robots: int
    proven: bool


class _Pricing:
    """Prices as they are found."""

    def __init__(
        self,
        variations: Any,
        bounds: AfreshVariations,
        known: Mapping[tuple[str, int], int],
        tell: Callable[[str, int, int], None] | None,
        stop: Callable[[], bool] | None,
        progress: Callable[[int, int], None] | None,
    ) -> None:
        self.variations, self.bounds, self.known = variations, bounds, known
        self.tell, self.stop, self.progress = tell, stop, progress
        self.rows: list[Row] = []
        self.done = self.total = 0

    def price_barriers(self, cells: NDArray[np.int64]) -> None:
        """Price what would be open; nearly all saves nothing."""
        cells = self._of_the_same_robots("barrier", cells)
        begun = 0
        for place, least, most in chain(self.variations.openings(cells), [(cells.size, 0, 0)]):
            for cell in cells[begun:place].tolist():
                self._add("barrier", cell, 0)
            begun = place + 1
            if begun > cells.size:
                break
            if least == most:
                self._add("barrier", int(cells[place]), least)
            else:
                self._price("barrier", int(cells[place]), self.variations.saved_if_open, least, most)

    def price_chokes(self, cells: NDArray[np.int64]) -> None:
        """Price what would be closed."""
        for cell in self._of_the_same_robots("choke", cells).tolist():
            self._price("choke", cell, self.variations.lost_if_closed)

    def price_door(self, cells: NDArray[np.int64]) -> None:
        """Find the barrier that saves most as a destination."""
        cells = self._of_the_same_robots("door", cells)
        search = NextDoor(self.bounds.area, cells, self.variations, self.bounds, self.known)
        while search.most > search.saved and not (search.needs_work and self._is_to_stop()):
            search.look(self._price_of_door)
            self._told(max(self.done, self.total - search.left))
        proven = search.most == search.saved
        if search.saved or not proven:
            self.rows.append(Row("door", search.best_or_next, search.saved, search.most, 0, proven))
        self._told(self.total)

    def _price_of_door(self, cell: int) -> int:
        """Return what a door saves, in units of time, if it is not known."""
        price = self.known.get(("door", cell))
        if price is None:
            price = self.variations.saved_by_door(cell) * self.variations.unit
            if self.tell:
                self.tell("door", cell, price)
        return price

    def _of_the_same_robots(self, kind: str, cells: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the cells that change nothing about who can arrive; tell of the others."""
        variations = self.variations
        if kind != "choke" and variations.all_arrive:
            return cells
        if kind == "choke":
            robots = np.array([variations.robots_if_closed(cell) for cell in cells.tolist()], dtype=np.int64)
        else:
            robots = variations.robots_if_opened(cells)
        changes = robots != variations.robot_count
        if kind != "door":
            for cell, more in zip(cells[changes].tolist(), robots[changes] - variations.robot_count, strict=True):
                self._add(kind, cell, 0, int(more))
        kept: NDArray[np.int64] = cells[~changes]
        return kept

    def _price(self, kind: str, cell: int, find: Callable[[int], int], least: int = 0, most: int = -1) -> None:
        """Add the row of a cell that takes some work, unless it is known or the work is to stop."""
        unit = self.variations.unit
        price = self.known.get((kind, cell))
        if price is not None:
            self._add(kind, cell, price // unit)
        elif self._is_to_stop():
            self.rows.append(Row(kind, cell, least * unit, most * unit if most >= 0 else -1, 0, False))
        else:
            price = find(cell)
            if self.tell:
                self.tell(kind, cell, price * unit)
            self._add(kind, cell, price)

    def _is_to_stop(self) -> bool:
        return self.stop is not None and self.stop()

    def _add(self, kind: str, cell: int, price: int, robots: int = 0) -> None:
        """Add a row that is proven; `price` is in units of the variations."""
        price *= self.variations.unit
        self.rows.append(Row(kind, cell, price, -1 if robots else price, robots, True))
        self._told(self.done + 1)

    def _told(self, done: int) -> None:
        """Tell how many cells are done with."""
        self.done = done
        if self.progress:
            self.progress(self.done, self.total)
