"""When doors let robots in, slot by slot, as the rule is told in words."""

from fractions import Fraction
from math import floor


def doors_of(scenario):
    """Return (cells ascending, flow) of each door, and of each other destination whose capacity is a fraction."""
    from tests.oracles.rules import Rules  # which needs this file

    rules, ends = Rules(scenario), set(scenario.destinations.tolist())
    doors = []
    for door in scenario.doors:
        cells = [cell for cell in sorted(door.cells.tolist()) if cell not in ends or _can_be_entered(rules, cell, ends)]
        doors.append((cells or sorted(door.cells.tolist()), door.flow))
    if isinstance(scenario.destination_capacity, Fraction):
        known = {cell for door in scenario.doors for cell in door.cells.tolist()}
        doors += [([c], scenario.destination_capacity) for c in scenario.destinations.tolist() if c not in known]
    return doors


def _can_be_entered(rules, cell, ends):
    """Tell whether robots come into a destination from a cell that is none."""
    width = rules.area.width
    return any(y * width + x not in ends for (x, y), _ in rules.neighbours((cell % width, cell // width)))


class Openings:
    """How many robots each cell lets in in each step; None where it is no door."""

    def __init__(self, scenario):
        self.width = scenario.area.width
        self.doors = {cell: (cells, flow) for cells, flow in doors_of(scenario) for cell in cells}

    def __call__(self, place, step):
        cell = place[1] * self.width + place[0]
        if cell not in self.doors:
            return None
        cells, flow = self.doors[cell]
        slots = range(floor(flow * (step - 1)), floor(flow * step))
        return sum(cells[slot % len(cells)] == cell for slot in slots)
