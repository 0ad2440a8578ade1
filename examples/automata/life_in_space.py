"""Life 5766 in three dimensions: born of six, kept alive by five to seven of 26 neighbours; a glider two cells thick.

The rule is the one of C. Bays ("Candidates for the Game of Life in Three Dimensions", Complex Systems 1, 1987), in
which two copies of a pattern of Conway's, one above the other, often behave as it does on squares.
"""

from itertools import product

import numpy as np

import trihex as th

AROUND = [offset for offset in product((-1, 0, 1), repeat=3) if any(offset)]


def life_5766(own, neighbours):
    alive = neighbours.sum(axis=0)
    return (alive == 6) | (own == 1) & ((alive == 5) | (alive == 7))


automaton = th.CellularAutomaton(AROUND, states=2, rule=life_5766)
start = np.zeros((6, 10, 10), dtype=int)  # [z, y, x]
start[2:4, 1:4, 1:4] = [[0, 1, 0], [0, 0, 1], [1, 1, 1]]
for number, states in enumerate(automaton.generations(start, limit=12)):
    layers = [z for z in range(6) if states[z].any()]
    if number % 4 == 0:
        print(f"generation {number}: {states.sum()} cells in the layers {layers}; layer 2:")
        print("\n".join("".join(".#"[state] for state in row) for row in states[2]))
