"""Fit: what robots of a radius find in a place, on cells of one kind and under one rule for following and time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil

import numpy as np
from numpy.typing import NDArray

from trihex.areas.area import Area
from trihex.areas.clearance import least_cell_size, least_distance
from trihex.areas.regions import Regions, make_regions
from trihex.areas.scenario import FOLLOWINGS
from trihex.areas.tessellation import CLOCKS, Tessellation
from trihex.record import Record

# Covers the place: from tessellation, cell size, radius and `align` to an area and the cells of its destinations, which
# may be barriers; or to None and why the place cannot be covered so.
Lay = Callable[[Tessellation, float, float, str], tuple[Area, NDArray[np.int64]] | tuple[None, str]]

_FACTOR, _TRIES, _HALVINGS = 1.25, 24, 6


@dataclass(frozen=True, eq=False)
class Fit(Record):
    """What robots find.

    Attributes
    ----------
    tessellation : Tessellation
        Its clock tells how long moves last.
    following : {"allow", "forbid"}
        Whether a robot may enter a cell in the step in which another leaves it; if not, smaller cells are enough.
    robot_radius, cell_size : float
        In metres.
    area : Area or None
        None where the place cannot be covered so; `why` then says why.
    destinations : int64 array
        Their cells; none where there are none.
    greatest_radius : float or None
        That of the largest robots, in metres, that still reach a destination from half of the free cells at least, on
        the least cells that they can have; None if there is no destination, or none so.
    why : str
    """

    tessellation: Tessellation
    following: str
    robot_radius: float
    cell_size: float
    area: Area | None
    destinations: NDArray[np.int64]
    greatest_radius: float | None = None
    why: str = ""

    @property
    def clocks(self) -> tuple[str, ...]:
        """The clocks by which all this is so: that of the tessellation, or both, "steps" and "costs"."""
        own = least_distance(self.tessellation, following=self.following)
        return tuple(
            clock
            for clock in CLOCKS
            if least_distance(replace(self.tessellation, clock=clock), following=self.following) == own
        )

    @cached_property
    def _regions(self) -> Regions | None:
        return None if self.area is None else make_regions(self.area)

    @property
    def free_count(self) -> int:
        """Number of free cells."""
        return 0 if self.area is None else self.area.free_count

    @property
    def connected_share(self) -> float:
        """Share of the free cells in the largest connected part; 0 if none is free."""
        return int(self._regions.size_of_region[0]) / self.free_count if self._regions and self.free_count else 0.0

    @property
    def reaching_share(self) -> float | None:
        """Share of the free cells from which a destination can be reached; None if there is no destination."""
        if self._regions is None or self.destinations.size == 0:
            return None
        own = np.unique(self._regions.region_of_cell.reshape(-1)[self.destinations])
        reached = int(self._regions.size_of_region[own[own >= 0]].sum())
        return reached / self.free_count if self.free_count else 0.0


def round_up_size(metres: float) -> float:
    """Return a cell size in whole tenths of a millimetre, as people write it."""
    return ceil(metres * 1e4 * (1 - 1e-9)) / 1e4


def make_fits(
    lay: Lay,
    tessellations: list[Tessellation],
    robot_radius: float | None = None,
    cell_size: float | None = None,
    align: str = "best",
) -> Iterator[Fit]:
    """Yield what fits for all `kinds_to_fit`.

    Parameters
    ----------
    lay : function
        Covers the place, see `Lay`.
    tessellations : list of Tessellation
    robot_radius, cell_size : float, optional
        In metres; one is enough: cells are as small as the radius allows, robots as large as the cells allow. With
        neither, robots are the largest that reach a destination.
    align : {"corner", "best"}
        As for `cover_aligned`; radii are searched for with "shift" in place of "best".
    """
    for tessellation, following in kinds_to_fit(tessellations):
        radius = robot_radius
        if radius is None and cell_size is not None:
            near = least_distance(tessellation, following=following)
            radius = int(cell_size * near / 2 * 1e4 * (1 + 1e-9)) / 1e4
        greatest = _greatest_radius(lay, tessellation, following, radius or 0.1, align)
        radius = greatest if radius is None else radius
        if radius is None:
            nothing = np.empty(0, dtype=np.int64)
            yield Fit(tessellation, following, 0.0, 0.0, None, nothing, None, "no robot reaches a destination")
            continue
        yield _fit(lay, tessellation, following, radius, cell_size, align, greatest)


def kinds_to_fit(tessellations: list[Tessellation]) -> list[tuple[Tessellation, str]]:
    """Return each tessellation with each rule for following; clocks of one kind and rule stand together.

    Those that differ from one before in the clock alone are left out where it changes nothing.

    Examples
    --------
    >>> kinds = kinds_to_fit([Tessellation("square", clock=clock) for clock in ("steps", "costs")])
    >>> [(tessellation.clock, following) for tessellation, following in kinds]
    [('steps', 'allow'), ('costs', 'allow'), ('steps', 'forbid')]
    """
    kinds: dict[tuple[str, str, str, str, float], tuple[Tessellation, str]] = {}
    for following in FOLLOWINGS:
        for tessellation in tessellations:
            near = least_distance(tessellation, following=following)
            own = (tessellation.name, tessellation.neighbourhood, tessellation.costs)
            kinds.setdefault((*own, following, near), (tessellation, following))
    order = {key[:3]: number for number, key in reversed(list(enumerate(kinds)))}
    return [kinds[key] for key in sorted(kinds, key=lambda key: order[key[:3]])]


def _fit(
    lay: Lay,
    tessellation: Tessellation,
    following: str,
    radius: float,
    cell_size: float | None,
    align: str,
    greatest: float | None,
) -> Fit:
    least = round_up_size(least_cell_size(tessellation, radius, following))
    size = least if cell_size is None else cell_size
    area, why, destinations = None, "", np.empty(0, dtype=np.int64)
    if size < least * (1 - 1e-9):
        why = f"cells must be at least {least:g} metres"
    else:
        found = lay(tessellation, size, radius, align)
        if found[0] is None:
            why = found[1]
        else:
            area, destinations = found[0], np.asarray(found[1], dtype=np.int64)
    return Fit(tessellation, following, radius, size, area, destinations, greatest, why)


def _greatest_radius(lay: Lay, tessellation: Tessellation, following: str, start: float, align: str) -> float | None:
    """Return the radius, in tenths of a millimetre, of the largest robots that reach a destination; None if none do.

    Found by doubling and halving: by where the grid happens to lie, a larger radius may do where a smaller does not.
    """
    align = "shift" if align == "best" else align

    def does(radius: float) -> bool | None:
        fit = _fit(lay, tessellation, following, radius, None, align, None)
        return None if fit.area is not None and fit.destinations.size == 0 else (fit.reaching_share or 0.0) >= 0.5

    low, high = 0.0, start
    for _ in range(_TRIES):
        answer = does(round(high, 4))
        if answer is None:
            return None
        if answer:
            low, high = high, high * _FACTOR
        elif low:
            break
        else:
            high /= _FACTOR
            if high < 1e-3:
                return None
    if not low:
        return None
    for _ in range(_HALVINGS):
        middle = round((low + high) / 2, 4)
        low, high = (middle, high) if does(middle) else (low, middle)
    return round(low, 4)
