"""Directions: the neighbours of a cell of each shape, how far away they are, and which lattice vertex lies between."""

from math import sqrt

# Neighbours as (dx, dy, direction, distance of the centres, lattice vertex passed), edge neighbours first.
# The vertex is the position (dx, dy) of the cell that lends the vertex its number (see `Layout`); None on an edge.
# One list for each orientation of a cell; both list directions of equal distance at equal places.
Row = tuple[int, int, str, float, tuple[int, int] | None]
_SQUARE: list[Row] = [
    (0, -1, "N", 1, None),
    (1, 0, "E", 1, None),
    (0, 1, "S", 1, None),
    (-1, 0, "W", 1, None),
    (1, -1, "NE", sqrt(2), (1, 0)),
    (1, 1, "SE", sqrt(2), (1, 1)),
    (-1, 1, "SW", sqrt(2), (0, 1)),
    (-1, -1, "NW", sqrt(2), (0, 0)),
]
_HEXAGON_EVEN: list[Row] = [
    (0, -1, "N", 1, None),
    (1, -1, "NE", 1, None),
    (1, 0, "SE", 1, None),
    (0, 1, "S", 1, None),
    (-1, 0, "SW", 1, None),
    (-1, -1, "NW", 1, None),
]
_HEXAGON_ODD: list[Row] = [
    (0, -1, "N", 1, None),
    (1, 0, "NE", 1, None),
    (1, 1, "SE", 1, None),
    (0, 1, "S", 1, None),
    (-1, 1, "SW", 1, None),
    (-1, 0, "NW", 1, None),
]
# A triangle that points north: three neighbours meet it at its apex, three at each end of its base.
_TRIANGLE_NORTH: list[Row] = [
    (1, 0, "E", 1, None),
    (-1, 0, "W", 1, None),
    (0, 1, "S", 1, None),
    (2, 0, "EE", sqrt(3), (1, 1)),
    (-2, 0, "WW", sqrt(3), (-1, 1)),
    (1, -1, "NE", sqrt(3), (0, 0)),
    (-1, -1, "NW", sqrt(3), (0, 0)),
    (1, 1, "SE", sqrt(3), (1, 1)),
    (-1, 1, "SW", sqrt(3), (-1, 1)),
    (0, -1, "N", 2, (0, 0)),
    (2, 1, "SSE", 2, (1, 1)),
    (-2, 1, "SSW", 2, (-1, 1)),
]
# Its mirror image: north and south exchanged, apex below.
_TRIANGLE_SOUTH: list[Row] = [
    (1, 0, "E", 1, None),
    (-1, 0, "W", 1, None),
    (0, -1, "N", 1, None),
    (2, 0, "EE", sqrt(3), (1, 0)),
    (-2, 0, "WW", sqrt(3), (-1, 0)),
    (1, 1, "SE", sqrt(3), (0, 1)),
    (-1, 1, "SW", sqrt(3), (0, 1)),
    (1, -1, "NE", sqrt(3), (1, 0)),
    (-1, -1, "NW", sqrt(3), (-1, 0)),
    (0, 1, "S", 2, (0, 1)),
    (2, -1, "NNE", 2, (1, 0)),
    (-2, -1, "NNW", 2, (-1, 0)),
]
ROWS = {
    "triangular": (_TRIANGLE_NORTH, _TRIANGLE_SOUTH),
    "hexagonal": (_HEXAGON_EVEN, _HEXAGON_ODD),
    "square": (_SQUARE, _SQUARE),
}
# The cells around a lattice vertex in clockwise order, as positions relative to the cell that lends it its number.
RINGS: dict[str, list[tuple[int, int]]] = {
    "triangular": [(-1, -1), (0, -1), (1, -1), (1, 0), (0, 0), (-1, 0)],
    "hexagonal": [],
    "square": [(-1, -1), (0, -1), (0, 0), (-1, 0)],
}
