"""Conway's Life: squares with eight neighbours; a glider crosses a torus."""

import numpy as np

import trihex as th


def life(own, neighbours):
    alive = neighbours.sum(axis=0)
    return (alive == 3) | (own == 1) & (alive == 2)


automaton = th.CellularAutomaton("square", states=2, rule=life, boundary="periodic")
start = np.zeros((8, 16), dtype=int)
start[1:4, 1:4] = [[0, 1, 0], [0, 0, 1], [1, 1, 1]]
for number, states in enumerate(automaton.generations(start, limit=12)):
    if number % 4 == 0:
        print(f"generation {number}")
        print("\n".join("".join(".#"[state] for state in row) for row in states))
