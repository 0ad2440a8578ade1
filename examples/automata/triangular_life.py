"""A Life on triangles with twelve neighbours, 4,5,6/4: its glider is a block of eight cells that moves along a row.

C. Bays studied such rules on triangles ("Cellular Automata in the Triangular Tessellation", Complex
Systems 8, 1994).
"""

import numpy as np

import trihex as th


def triangular_life(own, neighbours):
    alive = neighbours.sum(axis=0)
    return (alive == 4) | (own == 1) & ((alive == 5) | (alive == 6))


automaton = th.CellularAutomaton("triangular", states=2, rule=triangular_life)
start = np.zeros((6, 24), dtype=int)
start[2:4, 3:7] = 1
points_north = (np.add.outer(np.arange(6), np.arange(24)) % 2) == 0
letters = np.array([list(".."), list("VA")])  # a triangle that points south, and one that points north
for number, states in enumerate(automaton.generations(start, limit=6)):
    print(f"generation {number}")
    for row in letters[states, points_north.astype(int)]:
        print("".join(row))
