"""A Life on hexagons, 3,5/2: born of two neighbours, kept alive by three or five; a wheel that turns in 12 generations.

The rule is the one that C. Bays proposed for hexagons ("A Note on the Game of Life in Hexagonal and Pentagonal
Tessellations", Complex Systems 15, 2005).
"""

import numpy as np

import trihex as th


def hexagonal_life(own, neighbours):
    alive = neighbours.sum(axis=0)
    return np.where(own == 1, (alive == 3) | (alive == 5), alive == 2)


automaton = th.CellularAutomaton("hexagonal", states=2, rule=hexagonal_life)
start = np.zeros((10, 12), dtype=int)
for x, y in [(7, 3), (3, 4), (7, 4), (4, 6), (6, 6)]:
    start[y, x] = 1
generations = list(automaton.generations(start, limit=12))
for number in (0, 1, 2, 12):
    print(f"generation {number}: {generations[number].sum()} cells")
    for row in generations[number]:  # odd columns lie half a cell lower: two lines of text for one row
        print("  ".join(".#"[state] for state in row[::2]))
        print(" ", "  ".join(".#"[state] for state in row[1::2]))
