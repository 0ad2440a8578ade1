"""Entries: how many robots can enter destinations in a step, counted by trying all ways in."""

from itertools import product

import numpy as np
import pytest

import trihex as th
from trihex.areas import CORNERS, TESSELLATIONS, entries_per_step


def most_entries(scenario):
    """Return the most robots that can enter, found by trying every choice of one neighbour, or none, for each way."""
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    ends = layout.cell_to_site(scenario.destinations).tolist()
    ways = []  # (destination, neighbour, vertex or None)
    for end in ends:
        for k in range(tessellation.direction_count):
            neighbour = end + int(layout.offset_of_direction[end & 1, k])
            if scenario.moves[end] >> k & 1 and neighbour not in ends:
                is_through_vertex = k >= tessellation.edge_count and scenario.crossing == "forbid"
                vertex = end + int(layout.vertex_of_direction[end & 1, k]) if is_through_vertex else None
                ways.append((end, neighbour, vertex))
    best = 0
    for chosen in product((False, True), repeat=len(ways)):
        used = [way for way, is_used in zip(ways, chosen, strict=True) if is_used]
        vertices = [vertex for _, _, vertex in used if vertex is not None]
        if len({neighbour for _, neighbour, _ in used}) < len(used) or len(set(vertices)) < len(vertices):
            continue
        capacity = scenario.destination_capacity
        if capacity is None or all([end for end, _, _ in used].count(e) <= capacity for e in ends):
            best = max(best, len(used))
    return best


@pytest.mark.parametrize("capacity", [None, 1, 2])
@pytest.mark.parametrize("crossing", ["forbid", "allow"])
@pytest.mark.parametrize("name", TESSELLATIONS)
def test_one_destination_is_entered_by_as_many_as_rules_allow(name, crossing, capacity):
    for seed in range(6):
        rng = np.random.default_rng(seed)
        barriers = rng.random((5, 7)) < 0.35
        barriers[2, 3] = False
        scenario = th.Scenario(
            th.Area(name, barriers),
            [(3, 2)],
            crossing=crossing,
            corners=CORNERS[seed % 3],
            destination_capacity=capacity,
        )
        assert entries_per_step(scenario) == most_entries(scenario)


def test_neighbouring_destinations_share_what_leads_to_them():
    area = th.Area("square", np.zeros((3, 4), dtype=bool))
    for name in (th.Tessellation("square", "edge"), th.Tessellation("hexagonal")):
        scenario = th.Scenario(area.with_tessellation(name), [(1, 1), (2, 1)])
        assert entries_per_step(scenario) >= most_entries(scenario)  # an upper bound where destinations compete
