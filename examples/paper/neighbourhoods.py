"""Figures 1 and 2: the neighbours of a triangle and of a hexagon, and what a move to each of them costs."""

from examples.drawing import folder_from_arguments, labelled, save, side_by_side

import trihex as th
from trihex.pictures.palette import MOVING

EDGE, VERTEX = (199, 233, 180), (255, 236, 170)


def neighbourhood(name: str, x: int, y: int, title: str, *, costs: bool) -> th.Picture:
    """Return a picture of cell (x, y), with the cost of the move to each neighbour or the name of its direction."""
    tessellation = th.Tessellation(name)
    area = th.Area(tessellation, [[0] * (2 * x + 1)] * 3)
    orientation = int(tessellation.orientation_of_cell(x, y))
    words, colours = {(x, y): "a"}, {(x, y): MOVING}
    for k, (dx, dy) in enumerate(tessellation.step_of_direction[orientation].tolist()):
        cost = str(tessellation.cost_of_direction[k])
        words[x + dx, y + dy] = cost if costs else tessellation.direction_names[orientation][k]
        colours[x + dx, y + dy] = EDGE if k < tessellation.edge_count else VERTEX
    scale, size = (50, 15) if name == "triangular" else (62, 18)
    return labelled(area, words, colours, title=title, scale=scale, size=size)


def draw(*, costs: bool) -> dict[str, str]:
    """Return two figures by the names of their files: with costs Figures 1 and 2, with names Figures 10 and 11."""
    first, second = ("figure_01.svg", "figure_02.svg") if costs else ("figure_10.svg", "figure_11.svg")
    triangles = [
        neighbourhood("triangular", 3, 1, "Points north", costs=costs),
        neighbourhood("triangular", 2, 1, "Points south", costs=costs),
    ]
    hexagons = [
        neighbourhood("hexagonal", 1, 1, "Odd column", costs=costs),
        neighbourhood("hexagonal", 2, 1, "Even column", costs=costs),
    ]
    return {first: side_by_side(triangles, 2), second: side_by_side(hexagons, 2)}


def figures() -> dict[str, str]:
    """Return the figures by the names of their files."""
    return draw(costs=True)


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
