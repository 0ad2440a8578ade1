"""The network: no path in it costs less than the distances, no move more than it does; scenarios that never ended."""

import numpy as np
import pytest

import trihex as th
from tests.oracles.optimum import least_total_time
from tests.strategies import random_scenario
from trihex.kernels.codes import NOT_REACHED
from trihex.optimum import make_network
from trihex.optimum.passages import make_passages


@pytest.mark.parametrize("objective", ["time", "steps"])
@pytest.mark.parametrize("share", range(3))
def test_no_reduced_cost_is_below_0(share, objective):
    for seed in range(share, 150, 3):
        scenario = random_scenario(seed, waiting_costs=(None, 3, 15, 40))
        network = make_network(th.make_n_scheme(scenario), objective)
        for arcs in (network.out_arcs, network.in_arcs):
            _, reduced, _, beyond, _, _ = np.moveaxis(arcs, 2, 0)
            assert reduced.min(initial=0) >= 0, seed
            assert beyond.min(initial=0) >= 0, seed


@pytest.mark.parametrize("share", range(3))
def test_to_pass_a_vertex_costs_no_more_than_the_move(share):
    met = 0
    for seed in range(share, 300, 3):
        scenario = random_scenario(seed)
        n_scheme = th.make_n_scheme(scenario)
        tessellation, layout = scenario.area.tessellation, scenario.area.layout
        cost = tessellation.cost_of_direction.astype(np.int64)
        sites = np.flatnonzero(n_scheme.distance_of_site != NOT_REACHED)
        passages = make_passages(scenario, sites, n_scheme.distance_of_site, cost)
        place = {pair: i for i, pair in enumerate(zip(passages.site, passages.vertices[passages.vertex], strict=True))}
        has_one_cost = tessellation.name != "triangular" or tessellation.costs != "euclidean"
        for site in sites:
            for k in range(scenario.first_vertex_move, cost.size):
                if scenario.moves[site] >> k & 1:
                    vertex = site + layout.vertex_of_direction[site & 1, k]
                    target = site + layout.offset_of_direction[site & 1, k]
                    pays = passages.enter[place[site, vertex]] + passages.leave[place[target, vertex]]
                    assert pays == cost[k] if has_one_cost else pays <= cost[k], seed
                    met += 1
    assert met > 500


@pytest.mark.parametrize(
    ("barriers", "destination", "robots", "waiting_cost", "least"),
    [
        ("... .#. ... ..# ...", 3, [0, 5, 14, 13, 12, 6, 10], 4000, 24464),
        (
            *("....... ....... ....... .......", 5),
            *([8, 16, 20, 11, 2, 24, 7, 23, 25, 17, 10, 26, 18, 27, 3, 19, 9, 4, 1], 300, 74892),
        ),
    ],
)
def test_a_vertex_that_serves_moves_of_two_costs(barriers, destination, robots, waiting_cost, least):
    """Through such a vertex paths once cost less than the distances, so that flows ran in circles: nobody arrived."""
    rows = [[letter == "#" for letter in row] for row in barriers.split()]
    area = th.Area(th.Tessellation("triangular", costs="euclidean"), rows)
    scenario = th.Scenario(area, [destination], robots, waiting_cost=waiting_cost)
    plan = th.make_plan(scenario, "optimal")
    assert th.audit_plan(plan).is_clean
    assert plan.optimal
    assert plan.total_time == least
    if len(robots) < 10:
        assert least == least_total_time(scenario, 8 + scenario.robot_count)
