"""Oracle: moves and distances from drawn polygons alone; it shares no table of neighbours with trihex.

Two cells are neighbours if their polygons share corners: two of them make an edge, one a vertex. What stands round a
vertex is found by the angles at which the cells lie about it. Cells outside the area are drawn, too, as barriers.
"""

from collections import defaultdict
from itertools import combinations
from math import atan2, hypot

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra


class PolygonGraph:
    """The open moves of an area: `moves[x, y]` is a dict of the cells (x, y) they lead to, with their costs."""

    def __init__(self, tessellation, barriers, corners="allow"):
        self.barriers = np.asarray(barriers, dtype=bool)
        self.height, self.width = self.barriers.shape
        self.moves = defaultdict(dict)
        cells_at = defaultdict(list)
        centre = {}
        for y in range(-2, self.height + 2):
            for x in range(-3, self.width + 3):
                polygon = tessellation.polygon_of_cell(x, y)
                centre[x, y] = polygon.mean(axis=0)
                for corner in polygon:
                    cells_at[tuple(np.round(corner, 6))].append((x, y))
        shared = defaultdict(list)
        for corner, cells in cells_at.items():
            for one, other in combinations(cells, 2):
                if self.is_free(one) and self.is_free(other):
                    shared[one, other].append(corner)
        for (one, other), at in shared.items():
            assert len(at) <= 2
            is_vertex = len(at) == 1
            if is_vertex and (
                tessellation.neighbourhood == "edge" or not self.is_open(one, other, at[0], cells_at, centre, corners)
            ):
                continue
            if tessellation.costs == "paper":
                cost = 14 if is_vertex else 10
            else:
                cost = round(1000 * hypot(*(centre[one] - centre[other])))
            self.moves[one][other] = self.moves[other][one] = cost

    def is_free(self, cell):
        x, y = cell
        return 0 <= x < self.width and 0 <= y < self.height and not self.barriers[y, x]

    def is_open(self, one, other, corner, cells_at, centre, corners):
        """Tell whether the rule `corners` lets a robot pass the vertex `corner` from `one` to `other`."""
        around = sorted(cells_at[corner], key=lambda cell: atan2(*(centre[cell] - corner)))
        i, j = sorted((around.index(one), around.index(other)))
        ways = around[i + 1 : j], around[j + 1 :] + around[:i]
        clear = [all(self.is_free(cell) for cell in way) for way in ways]
        return {"allow": True, "no-squeeze": any(clear), "no-cut": all(clear)}[corners]

    def distance(self, destinations):
        """Return the least cost from each cell to the nearest destination (x, y), inf where there is none."""
        arcs = [
            (x + y * self.width, u + v * self.width, c) for (x, y), to in self.moves.items() for (u, v), c in to.items()
        ]
        tails, heads, costs = np.array(arcs, dtype=np.int64).reshape(-1, 3).T
        size = self.height * self.width
        graph = csr_array((costs.astype(float), (tails, heads)), shape=(size, size))
        sources = [x + y * self.width for x, y in destinations]
        return dijkstra(graph, indices=sources, min_only=True).reshape(self.height, self.width)

    def best(self, distance, cell):
        """Return the cells to which the best moves from `cell` lead."""
        x, y = cell
        if not np.isfinite(distance[y, x]):
            return set()
        return {(u, v) for (u, v), cost in self.moves[cell].items() if distance[v, u] + cost == distance[y, x]}

    def generations(self, destinations):
        """Return how many updates of all cells at once change something, until none does."""
        value = np.full((self.height, self.width), np.inf)
        for x, y in destinations:
            value[y, x] = 0
        for count in range(value.size + 1):
            before = value.copy()
            for (x, y), to in self.moves.items():
                value[y, x] = min([before[y, x]] + [before[v, u] + cost for (u, v), cost in to.items()])
            if np.array_equal(before, value):
                return count
        raise AssertionError("the automaton did not come to rest")
