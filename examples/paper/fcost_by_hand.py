"""Fcost(x, y, d) = v(d) + V(x, y, d) + w_t c(x, y, d) of one robot, counted as the paper says, slowly.

c counts the other robots whose shortest path meets the path that begins with d: both are in one cell after the same
number of steps. Of tied best directions a path takes the first one.
"""

from examples.drawing import bare, folder_from_arguments, save
from examples.paper.configurations import scenario_from

import trihex as th

YARD = scenario_from(["......", "b....D", "c.....", "a....."], "hexagonal")


def shortest_path(d_scheme: th.DScheme, cell: int) -> list[int]:
    """Return the cells of the shortest path from `cell` to a destination, both included."""
    area = d_scheme.n_scheme.scenario.area
    path = [cell]
    while d_scheme.n_scheme.distance_of_cell(path[-1]) > 0:
        x, y = area.cell_to_xy(path[-1])
        k = int(d_scheme.directions[int(y), int(x)])
        step = area.tessellation.step_of_direction[
            int(area.tessellation.orientation_of_cell(x, y)), (k & -k).bit_length() - 1
        ]
        path.append(int(area.xy_to_cell(x + step[0], y + step[1])))
    return path


def fcost_of_directions(scenario: th.Scenario, robot: int) -> dict[str, tuple[int, int, int, int]]:
    """Return (v, V, c, Fcost) for each direction that is open to a robot at its start, by the name of the direction."""
    area, tessellation = scenario.area, scenario.area.tessellation
    n_scheme = th.make_n_scheme(scenario)
    d_scheme = th.make_d_scheme(n_scheme)
    others = [shortest_path(d_scheme, int(cell)) for i, cell in enumerate(scenario.robots) if i != robot]
    cell = int(scenario.robots[robot])
    x, y = (int(place) for place in area.cell_to_xy(cell))
    orientation = int(tessellation.orientation_of_cell(x, y))
    moves = int(area.layout.cells_of(scenario.moves)[y, x])
    table = {}
    for k, name in enumerate(tessellation.direction_names[orientation]):
        if moves >> k & 1:
            dx, dy = tessellation.step_of_direction[orientation, k]
            neighbour = int(area.xy_to_cell(x + dx, y + dy))
            path = [cell, *shortest_path(d_scheme, neighbour)]
            # The destination takes any number of robots: nobody meets there.
            meetings = sum(
                any(own == other for own, other in zip(path[1:-1], path_of_other[1:-1], strict=False))
                for path_of_other in others
            )
            v, rest = int(tessellation.cost_of_direction[k]), int(n_scheme.distance_of_cell(neighbour))
            table[name] = (v, rest, meetings, v + rest + scenario.waiting_cost * meetings)
    return table


def figures() -> dict[str, th.Picture]:
    """Return the figure by the name of its file."""
    return {"fcost_by_hand.svg": bare(th.picture_of_area(YARD, width=330))}


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
