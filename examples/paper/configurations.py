"""Figures 3 and 4: sample configurations on hexagons and on triangles, with robots, barriers and a destination."""

from examples.drawing import bare, folder_from_arguments, save

import trihex as th

HEXAGONS = [
    "a..B....c",
    "..BB.....",
    "b.....BB.",
    "...D..B..",
    ".B.......",
    ".BB..e..d",
]
TRIANGLES = [
    "a....BB.....c",
    "....BBB......",
    "b.........BB.",
    "..BB..D...BB.",
    "..B..........",
    ".....e..B...d",
]


def scenario_from(letters: list[str], tessellation: str) -> th.Scenario:
    """Return the scenario that letters draw: `.` free, `B` a barrier, `D` a destination, small letters robots."""
    places = {letter: (x, y) for y, row in enumerate(letters) for x, letter in enumerate(row)}
    area = th.Area(tessellation, [[letter == "B" for letter in row] for row in letters])
    robots = [places[letter] for letter in sorted(places) if letter.islower()]
    return th.Scenario(area, destinations=[places["D"]], robots=robots)


def figures() -> dict[str, th.Picture]:
    """Return the figures by the names of their files."""
    hexagons, triangles = scenario_from(HEXAGONS, "hexagonal"), scenario_from(TRIANGLES, "triangular")
    return {
        "figure_03.svg": bare(th.picture_of_area(hexagons, width=480)),
        "figure_04.svg": bare(th.picture_of_area(triangles, width=560)),
    }


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
