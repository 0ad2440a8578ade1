"""Bounds of several destinations: queues at mouths, throats around them, and robots that walk to another one."""

from dataclasses import replace

import numpy as np
from scipy.optimize import linear_sum_assignment

import trihex as th
from tests.bounds.test_bounds import EDGES, values, world
from tests.oracles import flow
from tests.oracles.optimum import least_total_time
from tests.oracles.rules import Rules
from tests.strategies import random_scenario, with_random_doors, with_start_times
from tests.sweeps import swept
from trihex.areas import ways_into_destinations
from trihex.bounds import spreading, throats
from trihex.bounds.approaches import find_approaches
from trihex.bounds.demand import make_demand
from trihex.bounds.mouths import find_mouths
from trihex.bounds.queueing import Tolls, find_tolls


def queued(scenario):
    return th.queue_bound(th.make_n_scheme(scenario)).value


def with_destinations(seed, most=6, **limits):
    """Return a random scenario with up to so many destinations."""
    scenario, rng = random_scenario(seed, **limits), np.random.default_rng(seed)
    free = np.flatnonzero(~scenario.area.barriers)
    return replace(scenario, destinations=rng.choice(free, min(free.size, rng.integers(1, most + 1)), replace=False))


TWO_ENDS = world("##r##... D..rr..D ##r##...", EDGES)


def test_each_destination_has_a_queue_of_its_own():
    # Three are 3 steps from the west, which takes one robot a step; one of them is 4 steps from the east, where a
    # fourth goes, too: 3 + 4 and 3 + 4.
    distance, slot, _ = values(TWO_ENDS)
    assert (distance, slot, queued(TWO_ENDS)) == (120, 120, 140)
    assert least_total_time(TWO_ENDS, 20) == 140


def test_many_destinations_are_bound_by_their_mouths():
    area = th.make_random_area("hexagonal", 128, 128, density=0.2, seed=1)
    free = np.random.default_rng(1).permutation(np.flatnonzero(~area.barriers))
    scenario = th.Scenario(area, free[:24], free[24:1524])
    least = th.make_plan(scenario, "optimal").total_time
    report = th.make_report(th.make_plan(scenario, "fcost"))
    assert report.lower_bound_name == "queue"
    assert max(values(scenario)) < 0.96 * least < 0.97 * least < report.lower_bound <= least


def test_a_capacity_is_a_mouth():
    scenario = world("rDr.... ....rDr rD....r", EDGES, destination_capacity=1)
    # The first and the third destination are one apart, and each takes one robot a step.
    assert values(scenario)[0] < queued(scenario) == least_total_time(scenario, 20)


def test_a_throat_is_a_mouth(monkeypatch):
    scenario = world("rrr#... rrr..D. rrr#...", EDGES)
    assert queued(scenario) == values(scenario)[1] == 420  # the window is larger than the area: four ways in
    monkeypatch.setattr(throats, "_RADIUS", 3)
    assert queued(scenario) == values(scenario)[2] == 630  # the door between the rooms
    inside = scenario.with_robots([*scenario.robots, 13, 20])
    assert queued(inside) == 660  # who starts in the room does not pass


def test_robots_that_cannot_arrive_or_have_arrived_cost_nothing():
    scenario = th.Scenario(th.Area("hexagonal", [[0, 0, 0, 1, 0, 1, 0]]), [0, 4], [0, 2, 6])
    assert queued(scenario) == 20
    assert queued(scenario.with_robots([0])) == queued(scenario.with_robots([6])) == 0


def test_throats_part_a_destination_from_all_outside(monkeypatch):
    found = 0
    for seed in range(swept(40, 20)):
        monkeypatch.setattr(throats, "_RADIUS", 1 + seed % 4)
        scenario = replace(with_destinations(seed, sides=(6, 12)), crossing="allow")
        demand, rules, area = make_demand(th.make_n_scheme(scenario)), Rules(scenario), scenario.area
        search = throats.ThroatSearch(demand)
        for i, ways in enumerate(ways_into_destinations(scenario)):
            throat = search.find(i, ways[ways >= 0])
            if throat is None:
                continue
            found += 1
            assert 0 < throat.nodes.size == np.unique(throat.nodes).size < np.count_nonzero(ways >= 0)
            nodes = set(rules.places(area.layout.site_to_cell(throat.nodes)))
            stack = rules.places(scenario.destinations[i : i + 1])
            (x, y), *_ = stack
            seen = nodes | set(rules.places(scenario.destinations))
            inside = set()
            while stack:
                new = {other for other, _ in rules.neighbours(stack.pop())} - seen
                seen |= new
                inside |= new
                stack += new
            assert all(max(abs(x - a), abs(y - b)) <= throats._RADIUS for a, b in inside), seed
            assert inside == set(rules.places(area.layout.site_to_cell(throat.inside))), seed
    assert found > 1


def test_no_queue_bound_exceeds_the_least_flow(monkeypatch):
    gained = 0
    for seed in range(swept(10, 5)):
        scenario = with_destinations(seed, sides=(4, 6), most_filled=0.7, most_robots=20)
        scenario = with_start_times(scenario, seed) if seed % 4 == 1 else scenario
        scenario = with_random_doors(scenario) if seed % 4 == 2 else scenario
        tessellation = scenario.area.tessellation
        if tessellation.costs == "euclidean" and tessellation.name == "triangular" and scenario.forbids_crossing:
            continue  # beyond the oracle
        monkeypatch.setattr(throats, "_RADIUS", (1, 2, 12)[seed % 3])
        monkeypatch.setattr(spreading, "_DETOUR", (1, 4, 64)[seed // 3 % 3])
        monkeypatch.setattr(spreading, "_MOST_VISITS", (1, 10**7)[seed % 2])
        last = scenario.area.free_count // 3 + 2 * scenario.robot_count + 40  # more steps than an optimum needs
        least = flow.least_total_time(scenario, last)
        assert queued(scenario) <= least, seed
        gained += max(values(scenario)[:2]) < queued(scenario)
    assert gained > 0


def queues(seed):
    """Return what is needed to find tolls, where detours are as long as you like."""
    scenario = replace(with_destinations(seed, most=4, sides=(3, 7), most_filled=0.8), crossing="allow")
    demand = make_demand(th.make_n_scheme(scenario))
    mouths = find_mouths(demand)
    return demand, find_approaches(demand, 1000), mouths.is_inside, mouths.places(1)


def least_assignment(demand, approaches, places):
    """Least sum of steps if each robot gets a slot of its own at a mouth, not before it can be there."""
    count = demand.sites.size
    slots = [(at, step) for at, most in enumerate(places) for step in range(1, 60) for _ in range(most)]
    cost = np.full((count, len(slots)), 10**6)
    for j, (at, step) in enumerate(slots):
        cost[approaches.robots[at][approaches.lengths[at] <= step], j] = step
    return int(cost[linear_sum_assignment(cost)].sum())


def paid(demand, approaches, is_inside, tolls):
    pays = np.where(is_inside, demand.steps, 10**6)
    for at, (robots, steps) in enumerate(zip(approaches.robots, approaches.lengths, strict=True)):
        pays[robots] = np.minimum(pays[robots], tolls.pays(at, steps))
    return int(pays.sum()) - tolls.total


def test_the_tolls_are_the_best_there_are_and_none_prove_too_much():
    held_up = 0
    for seed in range(swept(40, 20)):
        demand, approaches, is_inside, places = queues(seed)
        if demand.sites.size == 0 or is_inside.any():
            continue
        least = least_assignment(demand, approaches, places)
        tolls = find_tolls(approaches, demand.start_times, is_inside, places, 1, 10**9)
        assert paid(demand, approaches, is_inside, tolls) == least, seed
        held_up += least > demand.steps.sum()
        rng = np.random.default_rng(seed)
        label = np.maximum.accumulate(tolls.label + rng.integers(0, 3, tolls.label.shape), axis=1)
        label[:, -1] = label.shape[1] - 1
        label = np.minimum(label, label.shape[1] - 1)
        assert paid(demand, approaches, is_inside, Tolls(1, label, places)) <= least, seed
        cut_short = find_tolls(approaches, demand.start_times, is_inside, places, 1, 1)
        assert paid(demand, approaches, is_inside, cut_short) <= least, seed
    assert held_up > 1
