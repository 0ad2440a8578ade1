"""Cooperative A*: each robot's time against a plain Dijkstra past those before it, memory, starts in the way."""

from heapq import heappop, heappush
from itertools import pairwise

import numpy as np
import pytest

import trihex as th
from tests.oracles.timed import with_time
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.planners import make_plan
from trihex.planners.estimates import Estimates
from trihex.planners.reservations import Reservations

GOAL = 2  # where the state of a search has the last node of the way


def least_time(scenario, start, others):
    """Least cost from a site to a destination past `others`: lists of (sites by step, directions by step)."""
    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    destinations = set(layout.cell_to_site(scenario.destinations).tolist())
    edges = tessellation.edge_count
    taken, steps_of, passed, entered = set(), set(), set(), {}
    for sites, directions in others:
        for step, (one, other) in enumerate(pairwise(sites), start=1):
            steps_of.add((one, other, step))
            if directions[step - 1] != 255 and directions[step - 1] >= edges:
                passed.add((one + int(layout.vertex_of_direction[one & 1, directions[step - 1]]), step))
            if other in destinations:
                entered[other, step] = entered.get((other, step), 0) + 1
        taken |= {(site, step) for step, site in enumerate(sites) if site not in destinations}
    heap, seen = [(0, 0, start)], set()
    while heap:
        cost, step, site = heappop(heap)
        if site in destinations:
            return cost
        if (site, step) in seen:
            continue
        seen.add((site, step))
        if (site, step + 1) not in taken:
            heappush(heap, (cost + scenario.waiting_cost, step + 1, site))
        for k in range(tessellation.direction_count):
            if not scenario.moves[site] >> k & 1:
                continue
            to = site + int(layout.offset_of_direction[site & 1, k])
            via = (site + int(layout.vertex_of_direction[site & 1, k]), step + 1)
            if (to, step + 1) in taken or (to, site, step + 1) in steps_of:
                continue
            if k >= edges and scenario.crossing == "forbid" and via in passed:
                continue
            capacity = scenario.destination_capacity
            if to in destinations and capacity and entered.get((to, step + 1), 0) >= capacity:
                continue
            heappush(heap, (cost + int(tessellation.cost_of_direction[k]), step + 1, to))
    return None


@pytest.mark.parametrize("seed", range(swept(40, 10)))
def test_each_robot_takes_its_cheapest_way_past_those_before_it(seed):
    scenario = random_scenario(60_000 + seed, sides=(3, 7), most_filled=0.5, waiting_costs=(None, 3, 15, 40))
    n_scheme = th.make_n_scheme(scenario)
    plan = make_plan(scenario, "astar", n_scheme=n_scheme)
    layout = scenario.area.layout
    others = []
    for robot in np.argsort(n_scheme.distance_of_cell(scenario.robots), kind="stable"):
        if not plan.arrived[robot] or plan.arrival_step_of_robot[robot] == 0:
            continue
        directions = plan.actions[plan.first_action[robot] : plan.first_action[robot + 1]].tolist()
        sites = [int(layout.cell_to_site(scenario.robots[[robot]])[0])]
        assert plan.time_of_robot[robot] == least_time(scenario, sites[0], others)
        for k in directions:
            sites.append(sites[-1] + (0 if k == 255 else int(layout.offset_of_direction[sites[-1] & 1, k])))
        others.append((sites, directions))


@pytest.mark.parametrize(("clock", "following"), [("steps", "allow"), ("costs", "allow"), ("costs", "forbid")])
def test_what_searches_have_learned_makes_no_way_dearer(monkeypatch, clock, following):
    """Each search is done twice, first as if it were the first of all."""
    find_way, learned = Reservations.find_way, []

    def find_twice(self, start, start_time, is_shut):
        kept, self._estimates = self._estimates, Estimates(self._terrain)
        find_way(self, start, start_time, is_shut)
        alone, self._estimates = self._nodes.cost[self._state[GOAL]], kept
        way = find_way(self, start, start_time, is_shut)
        assert way is None or self._nodes.cost[self._state[GOAL]] == alone
        learned.append((kept.tables.learned.max(initial=0), kept.tables.longer.max(initial=0)))
        return way

    monkeypatch.setattr(Reservations, "find_way", find_twice)
    monkeypatch.setattr("trihex.planners.estimates._PATIENCE", 0)
    for seed in range(swept(60, 15)):
        scenario = random_scenario(70_000 + seed, sides=(6, 14), most_filled=0.7, waiting_costs=(None,))
        scenario = with_time(scenario, clock, following)
        plan = make_plan(scenario, "astar")
        assert th.audit_plan(plan).is_clean
    assert np.all(np.max(learned, axis=0) > 0)


def test_who_finds_no_way_out_has_all_planned_anew():
    """No robot before it leaves the first one time to step aside; so ways over later starts are given up."""
    found = 0
    for seed in range(200):
        scenario = random_scenario(90_000 + seed, sides=(2, 6), most_filled=1.0)
        n_scheme = th.make_n_scheme(scenario)
        plan = make_plan(scenario, "astar", n_scheme=n_scheme)
        assert plan.arrived.sum() == scenario.robot_count - n_scheme.unreachable_robots.size
        told = []
        make_plan(scenario, "astar", n_scheme=n_scheme, progress=lambda *done, told=told: told.append(done))
        found += sum(done == 0 for done, _ in told) > 1
    assert found


def test_what_would_not_fit_is_refused_in_one_line():
    area = th.Area("hexagonal", np.zeros((50, 50), bool))
    scenario = th.Scenario(area, [(0, 0)], [(49, 49), (48, 48)])
    assert make_plan(scenario, "astar", memory_limit=1 << 20).arrived.all()
    with pytest.raises(
        th.TooLargeError, match=r"reservations would take 0.0 GiB \(\d+ steps of \d+ cells\), more than"
    ):
        make_plan(scenario, "astar", memory_limit=100_000)


def test_lists_of_a_search_grow():
    """One way round a wall that fills all cells in front of it first: some thousand nodes."""
    barriers = np.zeros((60, 60), bool)
    barriers[:, 30] = True
    barriers[0, 30] = False
    area = th.Area("square", barriers)
    robots = [(29, y) for y in range(20, 32)]
    scenario = th.Scenario(area, [(40, 30)], robots, destination_capacity=1)
    plan = make_plan(scenario, "astar")
    assert th.audit_plan(plan).is_clean
    assert plan.total_time <= make_plan(scenario, "greedy").total_time
