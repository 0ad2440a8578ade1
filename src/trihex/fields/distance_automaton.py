"""Distance automaton: the automaton whose generations end in the N-scheme (section III of the paper)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trihex.areas import CORNERS, Scenario, Tessellation, tessellation_from
from trihex.errors import AutomatonError, check_choice, check_type
from trihex.fields.automaton import CellularAutomaton, States
from trihex.kernels.codes import NOT_REACHED

# States of the distance rule beside the distances. The paper writes obstacles as 1, which no sum of moves can be.
OBSTACLE = 1


def make_distance_automaton(tessellation: Tessellation | str, corners: str = "allow") -> CellularAutomaton:
    """Make the automaton whose generations end in the distances to the destinations (section III of the paper).

    An obstacle (`OBSTACLE`, 1) keeps its state. Any other cell becomes the least of its own value and each neighbour's
    value plus the cost of the move between them, if `corners` leaves that move open. The boundary is an obstacle.

    Parameters
    ----------
    tessellation : Tessellation or str
        Its neighbourhood is A; its costs are those of the moves.
    corners : {"allow", "no-squeeze", "no-cut"}
        As in `Scenario`. All cells round a vertex are neighbours, so the corner rules are local rules, too.

    Examples
    --------
    >>> automaton = make_distance_automaton("square")
    >>> automaton.run([[0, 1, NOT_REACHED], [NOT_REACHED, NOT_REACHED, NOT_REACHED]]).configuration
    array([[ 0,  1, 28],
           [10, 14, 24]])
    """
    tessellation = tessellation_from(tessellation)
    check_choice("corners", corners, CORNERS, AutomatonError)
    cost = tessellation.cost_of_direction.reshape(-1, 1, 1)
    if cost.min() == OBSTACLE:
        raise AutomatonError(f"clock must be 'steps', not {tessellation.clock!r}: obstacles are 1, and so are moves")
    sides = [] if corners == "allow" else _sides_of_corner(tessellation)

    def rule(own: States, neighbours: States) -> States:
        closed = neighbours == OBSTACLE
        bends = []
        for direction, one_side, other_side in sides:
            one, other = closed[one_side].any(axis=0), closed[other_side].any(axis=0)
            bends.append((direction, one & other if corners == "no-squeeze" else one | other))
        for direction, is_shut in bends:  # only now that `closed` need not tell obstacles any more
            closed[direction] |= is_shut
        neighbours += cost
        np.copyto(neighbours, NOT_REACHED, where=closed)
        nearest = np.minimum(own, neighbours.min(axis=0))
        return np.where(own == OBSTACLE, OBSTACLE, nearest)

    return CellularAutomaton(tessellation, range(NOT_REACHED + 1), rule, boundary=OBSTACLE)  # type: ignore[arg-type]


def make_distance_configuration(scenario: Scenario) -> States:
    """Make generation 0 of the distance rule: destinations 0, obstacles 1, all other cells `NOT_REACHED`."""
    check_type("scenario", scenario, Scenario)
    area = scenario.area
    states = np.where(area.barriers, np.int64(OBSTACLE), np.int64(NOT_REACHED))
    states.reshape(-1)[scenario.destinations] = 0
    return states


def distance_generations(scenario: Scenario, limit: int | None = None) -> Iterator[States]:
    """Yield the generations of the distance rule on a scenario, up to its N-scheme (Figures 7 and 9 of the paper).

    In generation g a cell holds the least cost of a path of at most g moves to a destination.

    Examples
    --------
    >>> from trihex import Area, Scenario
    >>> scenario = Scenario(Area("hexagonal", [[0, 0, 1, 0]]), destinations=[(0, 0)])
    >>> [g.tolist() for g in distance_generations(scenario)]
    [[[0, 2147483647, 1, 2147483647]], [[0, 10, 1, 2147483647]]]
    """
    check_type("scenario", scenario, Scenario)
    automaton = make_distance_automaton(scenario.area.tessellation, scenario.corners)
    return automaton.generations(make_distance_configuration(scenario), limit)


def _sides_of_corner(tessellation: Tessellation) -> list[tuple[int, list[int], list[int]]]:
    """Return for each vertex move its direction, and the directions of the cells on either way round the vertex.

    The lists of the two orientations are mirror images of each other, so that one answer serves both.
    """
    layout = tessellation.layout(8, 8)  # large enough to keep offsets apart; its tables tell what lies where
    directions = {int(offset): k for k, offset in enumerate(layout.offset_of_direction[0])}
    sides = []
    for k in range(tessellation.edge_count, tessellation.direction_count):
        ring = [int(offset) for offset in layout.vertex_of_direction[0, k] + layout.ring_of_vertex]
        here = ring.index(0)
        way = [directions[offset] for offset in ring[here + 1 :] + ring[:here]]
        there = way.index(k)
        sides.append((k, way[:there], way[there + 1 :]))
    return sides
