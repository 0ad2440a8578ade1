"""When doors let robots in, slot by slot, as the rule is told in words."""

from fractions import Fraction
from math import floor


def doors_of(scenario):
    """Return (cells ascending, flow) of each door, and of each other destination whose capacity is a fraction."""
    doors = [(sorted(door.cells.tolist()), door.flow) for door in scenario.doors]
    if isinstance(scenario.destination_capacity, Fraction):
        known = {cell for cells, _ in doors for cell in cells}
        doors += [([c], scenario.destination_capacity) for c in scenario.destinations.tolist() if c not in known]
    return doors


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
