"""Sensor: which cells a robot sees from where it stands."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Tessellation
from trihex.errors import ScenarioError, check_type
from trihex.record import Record, read_only

MOST = 100.0
_SAMPLES = 8  # points on each edge step of a line of sight


@dataclass(frozen=True, eq=False)
class Sensor(Record):
    """What a robot sees: the cells within a radius, if need be only those in a line of sight, and all its neighbours.

    Parameters
    ----------
    tessellation : Tessellation
    radius : float
        In cells, that is in edge steps from centre to centre; at 0 a robot feels its neighbours only.
    line_of_sight : bool
        Whether barriers hide what lies behind them: a cell is seen if the straight line between the centres passes no
        barrier before it.

    Raises
    ------
    ScenarioError
        If the radius is below 0 or above 100.

    Examples
    --------
    >>> Sensor(Tessellation("hexagonal"), 2).seen_dx.shape[1]
    18
    """

    tessellation: Tessellation
    radius: float
    line_of_sight: bool = False

    def __post_init__(self) -> None:
        check_type("tessellation", self.tessellation, Tessellation)
        is_number = isinstance(self.radius, int | float | np.number) and not isinstance(self.radius, bool)
        if not is_number or not 0 <= self.radius <= MOST:
            raise ScenarioError(f"sensing radius must be a number from 0 to {MOST:g}, not {self.radius!r:.80}")

    @cached_property
    def _seen(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Columns and rows to what is seen from a cell of either orientation, nearest first, padded with itself."""
        tessellation, reach = self.tessellation, int(2 * self.radius) + 3
        dy, dx = np.mgrid[-reach : reach + 1, -reach : reach + 1].reshape(2, -1)
        rows = []
        for side in range(2):
            x, y = tessellation.centre_of_cell(side + dx, dy)
            here = tessellation.centre_of_cell(side, 0)
            away = np.hypot(x - here[0], y - here[1])
            near = set(map(tuple, tessellation.step_of_direction[side].tolist()))
            is_near = np.array([step in near for step in zip(dx.tolist(), dy.tolist(), strict=True)])
            found = np.flatnonzero(((away <= self.radius + 1e-9) | is_near) & (away > 0))
            rows.append(found[np.argsort(away[found], kind="stable")])
        most = max(map(len, rows))
        table = np.zeros((2, 2, most), dtype=np.int32)
        for side, found in enumerate(rows):
            table[0, side, : found.size], table[1, side, : found.size] = dx[found], dy[found]
        return read_only(table[0]), read_only(table[1])

    @property
    def seen_dx(self) -> NDArray[np.int32]:
        """Columns from a cell to those it sees, shape (2 orientations, cells)."""
        return self._seen[0]

    @property
    def seen_dy(self) -> NDArray[np.int32]:
        """Rows from a cell to those it sees, shape (2, cells)."""
        return self._seen[1]

    @cached_property
    def rays(self) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
        """Cells between: where those of each cell begin, shape (2, cells + 1), then dx and dy of one after another."""
        first = np.zeros((2, self.seen_dx.shape[1] + 1), dtype=np.int32)
        cells: list[tuple[int, int]] = []
        for side in range(2):
            near = set(map(tuple, self.tessellation.step_of_direction[side].tolist()))
            for i, step in enumerate(zip(self.seen_dx[side].tolist(), self.seen_dy[side].tolist(), strict=True)):
                first[side, i] = len(cells)
                if self.line_of_sight and step not in near:
                    cells += self._between(side, *step)
            first[side, -1] = len(cells)
        both = np.array(cells, dtype=np.int32).reshape(-1, 2)
        return read_only(first), read_only(both[:, 0].copy()), read_only(both[:, 1].copy())

    def _between(self, side: int, dx: int, dy: int) -> list[tuple[int, int]]:
        """Return the cells that a straight line passes, nearest first, without its ends."""
        here = np.array(self.tessellation.centre_of_cell(side, 0))
        there = np.array(self.tessellation.centre_of_cell(side + dx, dy))
        share = np.linspace(0, 1, 2 + int(_SAMPLES * np.hypot(*(there - here))))[1:-1]
        x, y = self.tessellation.cell_at_point(*(here[:, None] + (there - here)[:, None] * share))
        passed = dict.fromkeys(zip((x - side).tolist(), y.tolist(), strict=True))
        return [cell for cell in passed if cell not in ((0, 0), (dx, dy))]
