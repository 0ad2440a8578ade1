"""Rule 110, an automaton in one dimension: a cell looks at itself, at its left and at its right neighbour."""

import trihex as th


def rule(own, neighbours):
    left, right = neighbours
    return 110 >> (4 * left + 2 * own + right) & 1


automaton = th.CellularAutomaton([-1, 1], states=2, rule=rule)
for row in automaton.generations([0] * 47 + [1], limit=24):
    print("".join(" #"[state] for state in row))
