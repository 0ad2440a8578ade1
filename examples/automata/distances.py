"""The distance rule of the paper on hexagons: each generation, up to the N-scheme (its Figures 7 and 9)."""

import trihex as th
from trihex.fields import OBSTACLE
from trihex.kernels.codes import NOT_REACHED

AREA = [".......", ".BBBB..", ".B..B..", ".B.B...", "......."]
DESTINATION = (2, 2)

barriers = [[letter == "B" for letter in row] for row in AREA]
scenario = th.Scenario(th.Area("hexagonal", barriers), destinations=[DESTINATION])
letters = {OBSTACLE: "B", NOT_REACHED: "."}
for number, states in enumerate(th.distance_generations(scenario)):
    print(f"generation {number}")
    for row in states.tolist():
        print("".join(f"{letters.get(state, state):>4}" for state in row))
