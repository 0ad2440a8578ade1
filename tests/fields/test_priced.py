"""Distances to destinations with prices: as Bellman and Ford find them between drawn cells."""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from tests.oracles.rules import Rules
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.fields import PricedField
from trihex.kernels.codes import NOT_REACHED


def priced_field(scenario):
    return PricedField(scenario, th.make_n_scheme(scenario).distance_of_site != NOT_REACHED)


def costs(scenario, prices):
    """What it costs from each cell to one of the destinations with a price; whoever enters any destination stays."""
    rules = Rules(scenario)
    goals = rules.places(scenario.destinations)
    cost, others = dict(zip(goals, prices, strict=True)), rules.reachable() - set(goals)
    changed = True
    while changed:
        changed = False
        for cell in others:
            least = min(cost.get(other, NOT_REACHED) + paid for other, paid in rules.neighbours(cell))
            changed |= least < cost.get(cell, NOT_REACHED)
            cost[cell] = min(least, cost.get(cell, NOT_REACHED))
    return cost, others, rules


@pytest.mark.parametrize("seed", range(swept(60, 12)))
def test_distances_and_directions_are_those_of_the_cheapest_way_and_price(seed):
    scenario = random_scenario(140_000 + seed, sides=(2, 9))
    edge = scenario.area.tessellation.edge_cost
    prices = np.random.default_rng(seed).integers(0, 100, scenario.destinations.size) * edge
    distance, directions = priced_field(scenario).directions(prices)
    cost, others, rules = costs(scenario, prices.tolist())
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    distance, directions = layout.cells_of(distance), layout.cells_of(directions)
    assert {cell: int(distance[cell[1], cell[0]]) for cell in cost} == cost
    assert np.count_nonzero(distance < NOT_REACHED) == len(cost)
    for x, y in set(cost) - others:
        assert directions[y, x] == 0
    for x, y in others:
        steps = tessellation.step_of_direction[int(tessellation.orientation_of_cell(x, y))].tolist()
        ends = {(x + dx, y + dy) for k, (dx, dy) in enumerate(steps) if int(directions[y, x]) >> k & 1}
        assert ends == {other for other, paid in rules.neighbours((x, y)) if cost[x, y] == cost[other] + paid}


@pytest.mark.parametrize("seed", range(swept(40, 8)))
def test_distances_to_some_destinations_lead_round_the_others(seed):
    scenario = random_scenario(150_000 + seed, sides=(2, 9))
    field = priced_field(scenario)
    for exit in range(scenario.destinations.size):
        distance, known = field.spread(np.array([exit]), np.array([0]))
        prices = [0 if i == exit else NOT_REACHED for i in range(scenario.destinations.size)]
        cost, others, _ = costs(scenario, prices)
        at = scenario.area.layout.cells_of(distance)
        assert known == NOT_REACHED
        assert {cell: int(at[cell[1], cell[0]]) for cell in others} == {cell: cost.get(cell, known) for cell in others}


def test_what_is_farther_than_asked_for_need_not_be_known():
    area = th.Area("hexagonal", np.zeros((60, 400), dtype=bool))
    scenario = th.Scenario(area, [(0, 30), (399, 30)])
    far, known = priced_field(scenario).spread(np.array([0]), np.array([0]), 300)
    all_of_it, _ = priced_field(replace(scenario)).spread(np.array([0]), np.array([0]))
    assert 300 < known < NOT_REACHED
    assert np.array_equal(far[all_of_it < known], all_of_it[all_of_it < known])
