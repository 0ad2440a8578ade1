"""Cells as sets of lattice points: a slow twin of the tables of tessellations that shares no code with them."""

from __future__ import annotations

from itertools import product
from math import atan2, hypot, sqrt

Cell = tuple[int, int]
# How long one unit of the integer lattice below is, in edge steps, to the east and to the south.
UNIT = {"square": (1.0, 1.0), "hexagonal": (1 / (2 * sqrt(3)), 0.5), "triangular": (sqrt(3) / 2, 1.5)}


def corners_of(name: str, cell: Cell) -> frozenset[Cell]:
    """Lattice points at the corners of a cell."""
    x, y = cell
    if name == "square":
        return frozenset({(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)})
    if name == "hexagonal":
        cx, cy = 3 * x + 2, 2 * y + 1 + x % 2
        return frozenset({(cx + dx, cy + dy) for dx, dy in [(-2, 0), (2, 0), (-1, -1), (1, -1), (-1, 1), (1, 1)]})
    if (x + y) % 2 == 0:  # points north
        return frozenset({(x + 1, y), (x, y + 1), (x + 2, y + 1)})
    return frozenset({(x + 1, y + 1), (x, y), (x + 2, y)})


def centre_of(name: str, cell: Cell) -> tuple[float, float]:
    """Centre of gravity of the corners, in edge steps."""
    corners = corners_of(name, cell)
    return tuple(sum(p[i] for p in corners) / len(corners) * UNIT[name][i] for i in (0, 1))


class Lattice:
    """Which cells of an area of height x width are neighbours, at what cost, and which corners they pass."""

    def __init__(self, name: str, neighbourhood: str, costs: str, height: int, width: int) -> None:
        self.name = name
        self.cells = list(product(range(-3, width + 3), range(-3, height + 3)))
        self.inside = {(x, y) for x, y in self.cells if 0 <= x < width and 0 <= y < height}
        self.corners = {cell: corners_of(name, cell) for cell in self.cells}
        self.cells_at: dict[Cell, set[Cell]] = {}
        for cell, corners in self.corners.items():
            for corner in corners:
                self.cells_at.setdefault(corner, set()).add(cell)
        self.cost: dict[Cell, dict[Cell, int]] = {cell: {} for cell in self.inside}
        for cell in self.inside:
            for other in {c for corner in self.corners[cell] for c in self.cells_at[corner]} - {cell}:
                shared = len(self.corners[cell] & self.corners[other])
                if other not in self.inside or (shared == 1 and neighbourhood == "edge"):
                    continue
                (ax, ay), (bx, by) = centre_of(name, cell), centre_of(name, other)
                exact = round(1000 * hypot(ax - bx, ay - by))
                self.cost[cell][other] = exact if costs == "euclidean" else {2: 10, 1: 14}[shared]

    def is_open(self, cell: Cell, other: Cell, barriers: set[Cell], rule: str) -> bool:
        """Whether the corner rule lets a robot move between two free neighbours; the outside is barrier."""
        shared = self.corners[cell] & self.corners[other]
        if len(shared) == 2 or rule == "allow":
            return True
        (corner,) = shared
        around = sorted(self.cells_at[corner], key=lambda c: self._angle(c, corner))
        first, last = sorted((around.index(cell), around.index(other)))
        is_wall = [c in barriers or c not in self.inside for c in around]
        one, other_way = any(is_wall[first + 1 : last]), any(is_wall[last + 1 :] + is_wall[:first])
        return not (one or other_way) if rule == "no-cut" else not (one and other_way)

    def _angle(self, cell: Cell, corner: Cell) -> float:
        (cx, cy), (ux, uy) = centre_of(self.name, cell), UNIT[self.name]
        return atan2(cy - corner[1] * uy, cx - corner[0] * ux)
