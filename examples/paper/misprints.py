"""The misprints of the paper's rules: each one built as printed, and the cells in which it goes wrong.

A rule is a list of terms (dx, dy, cost): a cell becomes the least of its own value and, for each term, the value of the
cell that lies (dx, dy) away plus the cost.
"""

from collections.abc import Sequence

import numpy as np
from examples.drawing import folder_from_arguments, labelled, save, side_by_side
from examples.paper.configurations import scenario_from

import trihex as th
from trihex.fields import OBSTACLE
from trihex.kernels.codes import NOT_REACHED
from trihex.pictures.palette import DESTINATION

Term = tuple[int, int, int]
Terms = tuple[Term, ...]

# Section 4.1, with the misprints put right: p2 to p13 in the order of the paper, for a triangle that points north.
TRIANGLE_NORTH: Terms = (
    (0, 1, 10),
    (-1, 1, 14),  # p3; printed as (-1, -1), which repeats p7
    (-2, 1, 14),
    (-2, 0, 14),
    (-1, 0, 10),
    (-1, -1, 14),
    (0, -1, 14),
    (1, -1, 14),
    (1, 0, 10),
    (1, 1, 14),
    (2, 1, 14),
    (2, 0, 14),  # p13; printed without + 14
)
# Section 4.2, p2 to p7, for a hexagon of an odd column.
HEXAGON_ODD: Terms = ((-1, 0, 10), (0, -1, 10), (1, 0, 10), (-1, 1, 10), (0, 1, 10), (1, 1, 10))
HEXAGON_EVEN: Terms = ((-1, -1, 10), (0, -1, 10), (1, -1, 10), (-1, 0, 10), (0, 1, 10), (1, 0, 10))

YARD = scenario_from(["..B......", ".....D...", "..BB.....", "a....B..."], "triangular")
HEXAGONAL_YARD = scenario_from(["...B...", ".B...D.", ".BB....", "a......"], "hexagonal")


def mirrored(terms: Terms) -> Terms:
    """Return the terms with north and south exchanged: the rule of a triangle that points south."""
    return tuple((dx, -dy, cost) for dx, dy, cost in terms)


def without(terms: Terms, *left_out: Term) -> Terms:
    return tuple(term for term in terms if term not in left_out)


RULE = (TRIANGLE_NORTH, mirrored(TRIANGLE_NORTH))
HEXAGON_RULE = (HEXAGON_EVEN, HEXAGON_ODD)
P3 = without(TRIANGLE_NORTH, (-1, 1, 14))
P13 = (*without(TRIANGLE_NORTH, (2, 0, 14)), (2, 0, 0))
NARROW = tuple(term for term in TRIANGLE_NORTH if abs(term[0]) < 2)
SWAPPED = tuple((dx, dy, 24 - cost) for dx, dy, cost in TRIANGLE_NORTH)
# What is printed, by what it is called in the errata.
PRINTED = {
    "p3": (P3, mirrored(P3)),
    "p13": (P13, mirrored(P13)),
    "range": (NARROW, mirrored(NARROW)),
    "one orientation": (TRIANGLE_NORTH, TRIANGLE_NORTH),
    "swapped costs": (SWAPPED, mirrored(SWAPPED)),
}


def automaton_of(
    tessellation: str, rules: Sequence[Terms], *, obstacles_are_distances: bool = False
) -> th.CellularAutomaton:
    """Make the automaton of two lists of terms, one for each orientation of a cell.

    Parameters
    ----------
    tessellation : str
    rules : two lists of terms
        Triangles that point north and south; hexagons of even and odd columns.
    obstacles_are_distances : bool
        Whether a cell takes the 1 of an obstacle for a distance, as the formula says when it is read to the letter.
    """
    offsets = [[term[:2] for term in terms] for terms in rules]
    cost = np.array([[term[2] for term in terms] for terms in rules])

    def rule(own, neighbours):
        y, x = np.ogrid[: own.shape[0], : own.shape[1]]
        orientation = th.Tessellation(tessellation).orientation_of_cell(x, y)
        is_closed = neighbours == NOT_REACHED
        if not obstacles_are_distances:
            is_closed |= neighbours == OBSTACLE
        candidates = neighbours + np.moveaxis(cost[orientation], -1, 0)
        nearest = np.where(is_closed, NOT_REACHED, candidates).min(axis=0)
        return np.where(own == OBSTACLE, OBSTACLE, np.minimum(own, nearest))

    return th.CellularAutomaton(offsets, range(NOT_REACHED + 1), rule, boundary=NOT_REACHED, tessellation=tessellation)


def fixed_point(scenario: th.Scenario, rules: Sequence[Terms], **reading: bool) -> np.ndarray:
    """Return the last generation of a rule on a scenario."""
    automaton = automaton_of(scenario.area.tessellation.name, rules, **reading)
    return automaton.run(th.make_distance_configuration(scenario)).configuration


def wrong_cells(
    scenario: th.Scenario, rules: Sequence[Terms], **reading: bool
) -> dict[tuple[int, int], tuple[int, int]]:
    """Return the cells (x, y) whose last value is wrong, with that value and the right one."""
    right, states = th.make_n_scheme(scenario).distance, fixed_point(scenario, rules, **reading)
    wrong = np.argwhere(~scenario.area.barriers & (states != right))
    return {(int(x), int(y)): (int(states[y, x]), int(right[y, x])) for y, x in wrong}


def picture_of_wrong(scenario: th.Scenario, rules: Sequence[Terms], title: str, **reading: bool) -> th.Picture:
    """Return a picture of the last generation of a rule; cells with a wrong value are red."""
    states, wrong = fixed_point(scenario, rules, **reading), wrong_cells(scenario, rules, **reading)
    free = [(int(x), int(y)) for y, x in np.argwhere(~scenario.area.barriers)]
    words = {(x, y): "-" if states[y, x] == NOT_REACHED else str(states[y, x]) for x, y in free}
    colours = dict.fromkeys(wrong, (255, 176, 160))
    x, y = scenario.area.cell_to_xy(scenario.destinations[0])
    colours[int(x), int(y)] = DESTINATION
    return labelled(scenario.area, words, colours, title=title, scale=46, size=15)


def figures() -> dict[str, str]:
    """Return the figures by the names of their files."""
    titles = {
        "p3": "p3 as printed",
        "p13": "p13 as printed",
        "range": "k from -1 to 1",
        "one orientation": "One orientation for all",
        "swapped costs": "14 across edges, 10 through vertices",
    }
    triangles = [picture_of_wrong(YARD, RULE, "The rule put right")]
    triangles += [picture_of_wrong(YARD, PRINTED[key], title) for key, title in titles.items()]
    triangles.append(picture_of_wrong(YARD, RULE, "Obstacles taken for distances", obstacles_are_distances=True))
    hexagons = [
        picture_of_wrong(HEXAGONAL_YARD, HEXAGON_RULE, "The rule for both columns"),
        picture_of_wrong(HEXAGONAL_YARD, (HEXAGON_ODD, HEXAGON_ODD), "The printed one for all"),
    ]
    return {"misprints_triangles.svg": side_by_side(triangles, 2), "misprints_hexagons.svg": side_by_side(hexagons, 2)}


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
