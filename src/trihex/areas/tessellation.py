"""Tessellation: the shapes of cells, their neighbours, directions, costs, lattice vertices, centres and polygons.

This is the only file that knows shapes; everything else works on the tables made here.
x grows to the east, y to the south, (0, 0) is the north-west cell. Lengths are in edge steps: the centres of two cells
that share an edge are 1 apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.directions import RINGS, ROWS, Row
from trihex.errors import TessellationError, check_choice, check_type
from trihex.record import Record, read_only

if TYPE_CHECKING:
    from trihex.areas.layout import Layout

TESSELLATIONS = ("triangular", "hexagonal", "square")
NEIGHBOURHOODS = ("full", "edge")
COSTS = ("paper", "euclidean")

_EDGE_COST = {"paper": 10, "euclidean": 1000}
CLOCKS = ("steps", "costs")
# How many ticks moves last where they last as long as they cost, by the distance of the centres: in the proportions of
# the paper, and so that nobody is faster than on an edge. Where all moves are alike they last one tick.
_TICKS = {
    ("square", "paper"): {1: 5, sqrt(2): 7},
    ("square", "euclidean"): {1: 7, sqrt(2): 10},
    ("triangular", "paper"): {1: 5, sqrt(3): 7, 2: 7},
    ("triangular", "euclidean"): {1: 4, sqrt(3): 7, 2: 8},
}


@dataclass(frozen=True, eq=False)
class Tessellation(Record):
    """A way to cover the plane with cells, and which of them are neighbours at what cost.

    Parameters
    ----------
    name : {"triangular", "hexagonal", "square"}
    neighbourhood : {"full", "edge"}
        "full": triangular 12, hexagonal 6, square 8 neighbours; "edge": only those that share an edge (3, 6, 4).
    costs : {"paper", "euclidean"}
        "paper": 10 across an edge, 14 through a vertex (section 2.1.1 of the paper). "euclidean": the distance of the
        centres, rounded to integers on a scale where an edge step costs 1000 (square 1414; triangular 1732, 2000).
    clock : {"steps", "costs"}
        "steps": every move lasts one step. "costs": a move lasts as long as it costs, and both are counted in ticks:
        5 across an edge and 7 through a vertex; at euclidean costs 4, 7 and 8 on triangles, 7 and 10 on squares. Where
        all neighbours share an edge a move lasts one tick.

    Raises
    ------
    TessellationError
        If one of the names does not exist.

    Examples
    --------
    >>> Tessellation("triangular").cost_of_direction.tolist()
    [10, 10, 10, 14, 14, 14, 14, 14, 14, 14, 14, 14]
    >>> Tessellation("square", "edge").direction_names[0]
    ('N', 'E', 'S', 'W')
    """

    name: str
    neighbourhood: str = "full"
    costs: str = "paper"
    clock: str = "steps"

    def __post_init__(self) -> None:
        check_choice("tessellation", self.name, TESSELLATIONS, TessellationError)
        check_choice("neighbourhood", self.neighbourhood, NEIGHBOURHOODS, TessellationError)
        check_choice("costs", self.costs, COSTS, TessellationError)
        check_choice("clock", self.clock, CLOCKS, TessellationError)

    @cached_property
    def _rows(self) -> tuple[list[Row], list[Row]]:
        one, other = ROWS[self.name]
        if self.neighbourhood == "edge":
            return [row for row in one if row[4] is None], [row for row in other if row[4] is None]
        return one, other

    @cached_property
    def direction_names(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of the directions, for cells of orientation 0 and 1 (see `orientation_of_cell`)."""
        return tuple(row[2] for row in self._rows[0]), tuple(row[2] for row in self._rows[1])

    @property
    def direction_count(self) -> int:
        """Number of neighbours of a cell: 12, 8, 6, 4 or 3."""
        return len(self._rows[0])

    @cached_property
    def edge_count(self) -> int:
        """Number of neighbours that share an edge; their directions are numbered first."""
        return sum(row[4] is None for row in self._rows[0])

    @cached_property
    def step_of_direction(self) -> NDArray[np.int32]:
        """(dx, dy) of each direction, shape (2 orientations, directions, 2)."""
        return read_only(np.array([[row[:2] for row in rows] for rows in self._rows], dtype=np.int32))

    @cached_property
    def unit_vector_of_direction(self) -> NDArray[np.float64]:
        """Vector of length 1 (to the east, to the south) from centre to centre, shape (2 orientations, directions, 2).

        Examples
        --------
        >>> Tessellation("square", "edge").unit_vector_of_direction[0].tolist()
        [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]
        """
        side, step = np.arange(2)[:, None], self.step_of_direction  # cell (1, 0) is of orientation 1, but for squares
        there = np.stack(self.centre_of_cell(side + step[..., 0], step[..., 1]), axis=-1)
        here = np.stack(self.centre_of_cell(side, 0 * side), axis=-1)
        vector = there - here
        return read_only(np.round(vector / np.linalg.norm(vector, axis=-1, keepdims=True), 12) + 0.0)

    @cached_property
    def vertex_step_of_direction(self) -> NDArray[np.int32]:
        """(dx, dy) of the cell that lends its number to the lattice vertex passed, shaped as the steps; 0 on edges."""
        return read_only(np.array([[row[4] or (0, 0) for row in rows] for rows in self._rows], dtype=np.int32))

    @cached_property
    def steps_around_vertex(self) -> NDArray[np.int32]:
        """(dx, dy) of the cells around a lattice vertex, clockwise, from the cell that lends it its number."""
        ring = RINGS[self.name] if self.neighbourhood == "full" else []
        return read_only(np.array(ring, dtype=np.int32).reshape(-1, 2))

    @cached_property
    def bend_of_direction(self) -> NDArray[np.float64]:
        """From the middle of each move to the lattice vertex that it passes, in edge steps, shaped as the steps.

        0 but on triangles: their vertex moves to cells of the same orientation lead round a corner.
        """
        bends = np.zeros(self.step_of_direction.shape)
        for side in range(2):
            here = np.array(self.centre_of_cell(side, 0))
            for k in range(self.edge_count, self.direction_count):
                dx, dy = self.step_of_direction[side, k]
                # The vertex is the middle of the cells around it.
                around = self.steps_around_vertex + self.vertex_step_of_direction[side, k] + (side, 0)
                vertex = np.mean(self.centre_of_cell(around[:, 0], around[:, 1]), axis=1)
                bends[side, k] = vertex - (here + np.array(self.centre_of_cell(side + dx, dy))) / 2
        return read_only(bends)

    @cached_property
    def heading_of_direction(self) -> NDArray[np.float64]:
        """Degrees from north, clockwise, from 0 to below 360, of each move, shape (2 orientations, directions)."""
        headings = np.zeros(self.step_of_direction.shape[:2])
        for side in range(2):
            here = self.centre_of_cell(side, 0)
            steps = self.step_of_direction[side]
            there = self.centre_of_cell(side + steps[:, 0], steps[:, 1])
            headings[side] = np.degrees(np.arctan2(there[0] - here[0], here[1] - there[1])) % 360
        return read_only(np.round(headings, 9) % 360)

    @cached_property
    def duration_of_direction(self) -> NDArray[np.int32]:
        """How many ticks (steps) a move in each direction lasts, shape (directions,); the same for both orientations.

        Examples
        --------
        >>> Tessellation("square", clock="costs").duration_of_direction.tolist()
        [5, 5, 5, 5, 7, 7, 7, 7]
        """
        if self.clock == "steps" or self.edge_count == self.direction_count:
            return read_only(np.ones(self.direction_count, dtype=np.int32))
        ticks = _TICKS[self.name, self.costs]
        return read_only(np.array([ticks[row[3]] for row in self._rows[0]], dtype=np.int32))

    @cached_property
    def cost_of_direction(self) -> NDArray[np.int32]:
        """Cost of a move in each direction, shape (directions,); the same for both orientations."""
        if self.clock == "costs":
            return self.duration_of_direction
        if self.costs == "paper":
            return read_only(np.array([10 if row[4] is None else 14 for row in self._rows[0]], dtype=np.int32))
        return read_only(np.array([round(1000 * row[3]) for row in self._rows[0]], dtype=np.int32))

    @property
    def area_of_cell(self) -> float:
        """Area of a cell, in square edge steps."""
        return {"triangular": 3 * sqrt(3) / 4, "hexagonal": sqrt(3) / 2, "square": 1.0}[self.name]

    @cached_property
    def longest_move(self) -> float:
        """Greatest distance that a move covers, in edge steps: 1, sqrt(2) or 2."""
        return max(row[3] for row in self._rows[0])

    @property
    def edge_cost(self) -> int:
        """Cost of a step across an edge: 10 (paper), 1000 (euclidean), or how many ticks it lasts."""
        return int(self.duration_of_direction[0]) if self.clock == "costs" else _EDGE_COST[self.costs]

    @property
    def waiting_cost(self) -> int:
        """What a robot pays that waits one step, unless a scenario sets it: as much as for an edge; 1 for a tick."""
        return 1 if self.clock == "costs" else self.edge_cost

    @cached_property
    def longest_tick(self) -> float:
        """How far a robot may have to go in a tick, in edge steps: the greatest distance of a move by its duration."""
        ticks: list[int] = self.duration_of_direction.tolist()
        return max(row[3] / duration for row, duration in zip(self._rows[0], ticks, strict=True))

    def orientation_of_cell(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.int64]:
        """Return 0 or 1: triangles that point north or south, hexagons of even or odd columns, squares 0."""
        x, y = np.asarray(x, dtype=np.int64), np.asarray(y, dtype=np.int64)
        if self.name == "triangular":
            return np.asarray((x + y) & 1)
        return np.asarray((x & 1) + 0 * y) if self.name == "hexagonal" else 0 * (x + y)

    def centre_of_cell(self, x: ArrayLike, y: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the centre of cells (x, y), in edge steps from the north-west corner of the area, y to the south."""
        orientation = self.orientation_of_cell(x, y)
        x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
        if self.name == "triangular":  # side sqrt(3), height 1.5; the centre lies at a third of the height
            return (x + 1) * sqrt(3) / 2, 1.5 * y + 1.0 - 0.5 * orientation
        if self.name == "hexagonal":  # side 1/sqrt(3), height 1, columns 1.5 sides apart
            return (1.5 * x + 1) / sqrt(3), y + 0.5 + 0.5 * orientation
        return x + 0.5, y + 0.5

    def cell_at_point(self, px: ArrayLike, py: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return (x, y) of the cells in which points lie, the inverse of `centre_of_cell`; any integers, unbounded."""
        px, py = np.asarray(px, dtype=np.float64), np.asarray(py, dtype=np.float64)
        if self.name == "triangular":
            y = np.floor(py / 1.5)
            # In half sides from the west, at depth 0..1 below the top of its row, the slanted edges of a row are
            # across - depth = first + 2 i and across + depth = first + 2 i; each of them crossed is one cell further.
            across, depth, first = px * 2 / sqrt(3), py / 1.5 - y, (y + 1) % 2
            x = np.floor((across - depth - first) / 2) + np.floor((across + depth - first) / 2) + first
            return x.astype(np.int64), y.astype(np.int64)
        if self.name == "hexagonal":
            # A point belongs to the hexagon of the nearest centre: try the four centres around it.
            column = np.floor((px * sqrt(3) - 1) / 1.5)
            best_x = best_y = np.zeros(np.broadcast(px, py).shape)
            least = np.full(best_x.shape, np.inf)
            for x in (column, column + 1):
                y = np.round(py - 0.5 - 0.5 * (x % 2))
                cx, cy = self.centre_of_cell(x, y)
                away = (px - cx) ** 2 + (py - cy) ** 2
                best_x, best_y = np.where(away < least, x, best_x), np.where(away < least, y, best_y)
                least = np.minimum(away, least)
            return best_x.astype(np.int64), best_y.astype(np.int64)
        return np.floor(px).astype(np.int64), np.floor(py).astype(np.int64)

    def polygon_of_cell(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
        """Return the corners of cells (x, y), shape (..., corners, 2), clockwise on the page, in edge steps."""
        cx, cy = self.centre_of_cell(x, y)
        if self.name == "triangular":
            flip = 1.0 - 2.0 * self.orientation_of_cell(x, y)
            half = sqrt(3) / 2
            corners = [(0 * cx, -flip), (half * flip, 0.5 * flip), (-half * flip, 0.5 * flip)]
        elif self.name == "hexagonal":
            side = 1 / sqrt(3)
            shape = [(-0.5, -0.5), (0.5, -0.5), (1.0, 0.0), (0.5, 0.5), (-0.5, 0.5), (-1.0, 0.0)]
            corners = [(0 * cx + side * dx, 0 * cy + dy) for dx, dy in shape]
        else:
            shape = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
            corners = [(0 * cx + dx, 0 * cy + dy) for dx, dy in shape]
        return np.stack([np.stack([cx + dx, cy + dy], axis=-1) for dx, dy in corners], axis=-2)

    def extent(self, height: int, width: int) -> tuple[float, float]:
        """Return the width and the height, in edge steps, of the box around an area of height x width cells."""
        if self.name == "triangular":
            return (width + 1) * sqrt(3) / 2, 1.5 * height
        if self.name == "hexagonal":
            return (1.5 * width + 0.5) / sqrt(3), height + (0.5 if width > 1 else 0.0)
        return float(width), float(height)

    def layout(self, height: int, width: int) -> Layout:
        """Return how an area of height x width cells lies in the padded flat arrays of the kernels."""
        from trihex.areas.layout import Layout

        return Layout(self, height, width)


def tessellation_from(given: object) -> Tessellation:
    """Return a tessellation, or that of a name: the full neighbourhood at the costs of the paper."""
    if isinstance(given, str):
        return Tessellation(given)
    check_type("tessellation", given, Tessellation, str)
    return cast("Tessellation", given)
