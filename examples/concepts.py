"""Figures that explain the words of the library: one small room with a door, from its barriers to its report."""

from dataclasses import replace

import numpy as np
from examples.drawing import bare, folder_from_arguments, save, side_by_side

import trihex as th
from trihex.pictures.palette import MOVING, WAITING
from trihex.pictures.scene import Discs, Lines, Texts, centres_of
from trihex.planners import make_plan

ROOM = [
    "a...B......",
    "b...B......",
    "c........D.",
    "d...B......",
    "e...B......",
]


def room() -> th.Scenario:
    """Return the scenario of all figures: five robots, a wall with a door, a destination."""
    barriers = [[letter == "B" for letter in row] for row in ROOM]
    return th.Scenario(th.Area("hexagonal", barriers, "room"), [(9, 2)], [(0, y) for y in range(5)])


def picture_of_step(plan: th.Plan, step: int, width: int) -> th.Picture:
    """Return a picture of the robots before a step, coloured by their sets in it, and of the moves they make."""
    cells = list(plan.cells_by_step())
    sets = plan.sets_at(step)
    base = bare(th.picture_of_area(plan.scenario.with_robots([]), width=width)).scene
    marks = list(base.marks)
    for robots, colour in ((sets.filled, MOVING), (sets.waiting, WAITING)):
        x, y = centres_of(plan.scenario.area, cells[step - 1][robots])
        words = tuple("abcdefghijklmnopqrstuvwxyz"[robot] for robot in robots)
        size = round(0.42 * base.scale)
        marks += [Discs(x, y, 0.34, colour), Texts(x, y, words, size, (255, 255, 255))] if robots.size else []
        # A robot that enters a destination has no cell after the step: its action tells where it goes.
        for robot in robots if colour is MOVING else ():
            here = int(cells[step - 1][robot])
            there = int(cells[step][robot])
            there = there if there >= 0 else int(plan.last_cell_of_robot[robot])
            ends = np.stack(centres_of(plan.scenario.area, np.array([here, there])), axis=-1)
            way = ends[1] - ends[0]
            marks.append(Lines((np.stack([ends[0] + 0.36 * way, ends[0] + 0.62 * way]),), 2.5, colour))
    named = (("filled", sets.filled), ("waiting", sets.waiting), ("final", sets.final))
    title = f"Step {step}: " + ", ".join(f"{name} {_letters(robots)}" for name, robots in named)
    return th.Picture(replace(base, marks=tuple(marks), title=title))


def _letters(robots: np.ndarray) -> str:
    return "".join("abcdefghijklmnopqrstuvwxyz"[robot] for robot in robots) or "-"


def figures() -> dict[str, str | th.Picture]:
    """Return the figures by the names of their files."""
    scenario = room()
    n_scheme = th.make_n_scheme(scenario)
    plan = make_plan(scenario, "greedy")
    triangle = th.Scenario(scenario.area.with_tessellation("triangular"), scenario.destinations, scenario.robots)
    square = th.Scenario(scenario.area.with_tessellation("square"), scenario.destinations, scenario.robots)
    one_map = [
        bare(th.picture_of_area(record, width=width), record.area.tessellation.name)
        for record, width in ((triangle, 380), (scenario, 420), (square, 330))
    ]
    return {
        "concepts_area.svg": bare(th.picture_of_area(scenario, width=460)),
        "concepts_n_scheme.svg": bare(th.picture_of_n_scheme(n_scheme, width=460)),
        "concepts_d_scheme.svg": bare(th.picture_of_d_scheme(th.make_d_scheme(n_scheme), width=460)),
        "concepts_plan.svg": bare(th.picture_of_plan(plan, width=460)),
        "concepts_sets.svg": side_by_side([picture_of_step(plan, step, 400) for step in (1, 4, 9, 11)], 2),
        "concepts_tessellations.svg": side_by_side(one_map, 2),
    }


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
