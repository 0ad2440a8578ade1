"""Grounds: the halls of the study of tessellations, 24 by 18 metres, as WKT: ``python -m examples.studies.grounds``."""

import random
from pathlib import Path

Ring = list[tuple[float, float]]
WIDTH, HEIGHT = 24.0, 18.0
WALL, DOOR = 0.4, 1.6


def box(x: float, y: float, width: float, height: float) -> Ring:
    """Return a rectangle with its south-west corner at (x, y)."""
    return [(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)]


def obstacles() -> list[Ring]:
    """Return 30 blocks of 0.5 to 2 metres that do not overlap."""
    chance, found = random.Random(1), []
    while len(found) < 30:
        width, height = chance.uniform(0.5, 2), chance.uniform(0.5, 2)
        x, y = chance.uniform(1, WIDTH - width - 1), chance.uniform(1, HEIGHT - height - 1)
        others = [(ring[0], ring[2]) for ring in found]
        if all(x > b[0] + 1 or x + width < a[0] - 1 or y > b[1] + 1 or y + height < a[1] - 1 for a, b in others):
            found.append([(round(px, 2), round(py, 2)) for px, py in box(x, y, width, height)])
    return found


def wall(at: float, length: float, doors: list[float], *, upright: bool) -> list[Ring]:
    """Return the pieces of a wall across the hall that doors, given by their centres, leave."""
    begin, pieces = 0.1, []
    for door in [*sorted(doors), length + DOOR / 2 - 0.1]:
        end = door - DOOR / 2
        piece = (at, begin, WALL, end - begin) if upright else (begin, at, end - begin, WALL)
        pieces.append(box(*(round(value, 2) for value in piece)))
        begin = door + DOOR / 2
    return pieces


def doors() -> list[Ring]:
    """Return two walls from south to north, with two doors each."""
    return wall(7.8, HEIGHT, [4.5, 13.5], upright=True) + wall(15.8, HEIGHT, [9.0, 16.0], upright=True)


def rooms() -> list[Ring]:
    """Return the walls of 4 by 3 rooms; all rooms have a door to the east, and some to the north."""
    rings = []
    for column in (1, 2, 3):
        rings += wall(column * 6 - WALL / 2, HEIGHT, [3.0, 9.0, 15.0], upright=True)
    for row in (1, 2):
        # In pieces between the walls that stand, so that rings do not overlap.
        for column in range(4):
            left = 0.1 if column == 0 else column * 6 + WALL / 2 + 0.01
            right = WIDTH - 0.1 if column == 3 else column * 6 + 6 - WALL / 2 - 0.01
            if (row + column) % 2:
                rings.append(box(left, row * 6 - WALL / 2, right - left, WALL))
                continue
            middle = (left + right) / 2
            rings.append(box(left, row * 6 - WALL / 2, middle - DOOR / 2 - left, WALL))
            rings.append(box(middle + DOOR / 2, row * 6 - WALL / 2, right - middle - DOOR / 2, WALL))
    return rings


def text_of(holes: list[Ring]) -> str:
    """Return the hall with its holes as WKT."""
    rings = [box(0, 0, WIDTH, HEIGHT), *holes]
    lines = ["(" + ", ".join(f"{x:g} {y:g}" for x, y in ring) + ")" for ring in rings]
    return "POLYGON (" + ",\n  ".join(lines) + ")\n"


GROUNDS = {"open": [], "obstacles": obstacles(), "rooms": rooms(), "doors": doors()}

if __name__ == "__main__":
    for name, holes in GROUNDS.items():
        Path(__file__).with_name(f"{name}.wkt").write_text(text_of(holes))
