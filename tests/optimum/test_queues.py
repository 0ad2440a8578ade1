"""What arrivals are worth, against the assignment of robots to arrivals by scipy."""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import trihex as th
from trihex.optimum import make_network, queues
from trihex.optimum.queues import room_of_slots, share_arrivals


def crowd(seed, capacity):
    """A crowd of robots on hexagons, with one destination: each step late costs one unit."""
    area = th.make_caves_area("hexagonal", 20, 20, seed=seed)
    destination = th.random_robots(area, 1, seed=seed)
    robots = th.random_robots(area, 60, seed=seed + 1, avoid=destination)
    n_scheme = th.make_n_scheme(th.Scenario(area, destination, robots, destination_capacity=capacity))
    network = make_network(n_scheme)
    node = network.node_of_site[area.layout.cell_to_site(n_scheme.scenario.robots)].astype(np.int64)
    return network, node[(node >= 0) & (network.value[node] > 0)]


@pytest.mark.parametrize("capacity", [None, 1, 2, 0.5])
def test_prices_prove_the_cheapest_assignment(capacity):
    for seed in range(4):
        network, cells = crowd(seed, capacity)
        room = room_of_slots(network, 200)
        prices, slot = share_arrivals(network, cells, room)
        assert (prices >= 0).all()
        late = np.arange(200) - network.hops[cells][:, None]
        costs = np.where(late >= 0, late, 1_000_000)
        slot_of_entry = np.repeat(np.arange(200), room[:, 0])
        robot, entry = linear_sum_assignment(costs[:, slot_of_entry])
        least = costs[robot, slot_of_entry[entry]].sum()
        paid = np.where(room[:, 0] > 0, prices[:, 0], 1_000_000)
        assert (costs[np.arange(cells.size), slot] + paid[slot] == (costs + paid).min(axis=1)).all(), seed
        assert (np.bincount(slot, minlength=200) <= room[:, 0]).all(), seed
        assert (costs + paid).min(axis=1).sum() - (prices * room).sum() == least > 0, seed


def test_where_it_is_too_much_work_arrivals_cost_nothing(monkeypatch):
    network, cells = crowd(1, 1)
    room = room_of_slots(network, 200)
    assert share_arrivals(network, cells, room).price.any()
    for most in ("_MOST_NODES", "_MOST_SLOTS"):
        with monkeypatch.context() as patch:
            patch.setattr(queues, most, 1000)
            prices, slot = share_arrivals(network, cells, room)
            assert not prices.any() and (slot < 0).all()
