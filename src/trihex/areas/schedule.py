"""Schedule: in which steps how many robots may enter each cell that is a door."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.door import Door
from trihex.areas.layout import Layout
from trihex.record import Record, read_only

if TYPE_CHECKING:
    from trihex.kernels.doors import Doors

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Schedule(Record):
    """When cells may be entered: up to step t by ``(rate * t + phase) // period`` robots.

    Of a door with k cells and a flow of p / q the first robot is let in by the first cell, the next one by the second,
    and so on in turn; the j-th of its cells, from 0, has rate p, period q * k and phase q * (k - 1 - j). So no cell
    needs another one to know when it opens, and a plan for doors is still a flow.

    Parameters
    ----------
    cells, rate, period, phase : int64 arrays
    """

    cells: Ints
    rate: Ints
    period: Ints
    phase: Ints

    def openings(self, steps: ArrayLike) -> Ints:
        """Return how many robots may enter each cell in some steps, from 1; shape (cells, steps)."""
        step = np.asarray(steps, dtype=np.int64).reshape(1, -1)
        rate, period, phase = (column[:, None] for column in (self.rate, self.period, self.phase))
        return np.asarray((rate * step + phase) // period - (rate * (step - 1) + phase) // period)

    def openings_at(self, cells: Ints, steps: Ints) -> Ints:
        """Return how many robots may enter some of the cells, by their places here, each in steps of its own.

        The last axis of `steps` is that of the cells.
        """
        rate, period, phase = self.rate[cells], self.period[cells], self.phase[cells]
        return np.asarray((rate * steps + phase) // period - (rate * (steps - 1) + phase) // period)

    def of_cells(self, cells: NDArray[np.integer]) -> Schedule:
        """Return the same for those of its cells that are among some."""
        chosen = np.isin(self.cells, cells)
        return Schedule(*(read_only(column[chosen]) for column in (self.cells, self.rate, self.period, self.phase)))

    def for_kernels(self, layout: Layout) -> Doors:
        """Return `Doors` as kernels know them."""
        from trihex.kernels.doors import Doors
        from trihex.kernels.signatures import given

        number = np.zeros(layout.size if self.cells.size else 1, dtype=np.int32)
        if self.cells.size:
            number[layout.cell_to_site(self.cells)] = np.arange(1, self.cells.size + 1)
        doors: Doors = given(Doors, number=number, rate=self.rate, period=self.period, phase=self.phase)
        return doors


def schedule_of(
    doors: Sequence[Door], destinations: Ints, capacity: int | Fraction | None, entered: NDArray[np.bool_]
) -> Schedule:
    """Return the schedule of doors, and of all other destinations if their capacity is a fraction.

    Destinations of a door that nobody can enter, as all around them are destinations or barriers, take no turns;
    ``entered`` tells of each destination whether anybody can.
    """
    inner = destinations[~entered]
    own = list(doors)
    if isinstance(capacity, Fraction):
        left = np.setdiff1d(destinations, np.concatenate([np.empty(0, np.int64), *(door.cells for door in doors)]))
        own += [Door(left[i : i + 1], capacity) for i in range(left.size)]
    columns = [np.empty((4, 0), dtype=np.int64)]
    for door in own:
        cells, (rate, period) = np.setdiff1d(door.cells, inner), door.flow.as_integer_ratio()
        cells = cells if cells.size else door.cells
        count = cells.size
        turn = np.arange(count - 1, -1, -1)
        columns.append(np.stack(np.broadcast_arrays(cells, rate, period * count, period * turn)))
    return Schedule(*(read_only(np.ascontiguousarray(column)) for column in np.concatenate(columns, axis=1)))
