"""Figures 6 to 9: one robot among obstacles, and the generations of the automaton up to the N-scheme and D-scheme."""

from examples.drawing import bare, folder_from_arguments, save, side_by_side
from examples.paper.configurations import scenario_from

import trihex as th
from trihex.planners import make_plan

TRIANGLES = [
    "..BB...D.",
    "..B..B...",
    "....BB...",
    "a.B...B..",
]
HEXAGONS = [
    "...B...",
    ".B.B.D.",
    ".B..B..",
    "aBB....",
    ".......",
]


def generations(scenario: th.Scenario, width: int, columns: int) -> str:
    """Return one sheet: every generation with its numbers, then the D-scheme and the way of the robot."""
    far = int(th.make_n_scheme(scenario).distance[~scenario.area.barriers].max())
    *states, last = th.distance_generations(scenario)
    titled = [(g, f"Generation {number}") for number, g in enumerate(states)]
    titled += [(last, f"Generation {len(states)}: the N-scheme")]
    pictures = [
        bare(th.picture_of_generation(scenario, g, number, far=far, width=width), title)
        for number, (g, title) in enumerate(titled)
    ]
    d_scheme = th.make_d_scheme(th.make_n_scheme(scenario))
    pictures.append(bare(th.picture_of_d_scheme(d_scheme, width=width), "D-scheme: all best moves"))
    plan = make_plan(scenario, "greedy")
    way = f"The way of a, cost {plan.total_time}"
    pictures.append(bare(th.picture_of_plan(plan, width=width), way))
    return side_by_side(pictures, columns)


def figures() -> dict[str, str | th.Picture]:
    """Return the figures by the names of their files."""
    triangles, hexagons = scenario_from(TRIANGLES, "triangular"), scenario_from(HEXAGONS, "hexagonal")
    return {
        "figure_06.svg": bare(th.picture_of_area(triangles, width=420)),
        "figure_07.svg": generations(triangles, 420, 2),
        "figure_08.svg": bare(th.picture_of_area(hexagons, width=340)),
        "figure_09.svg": generations(hexagons, 290, 3),
    }


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
