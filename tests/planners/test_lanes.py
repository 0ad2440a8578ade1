"""Lanes: as many as OR-tools' maximum flow, of its least cost, from the same robots, and without a cell in common."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from ortools.graph.python.max_flow import SimpleMaxFlow
from ortools.graph.python.min_cost_flow import SimpleMinCostFlow

import trihex as th
from tests.oracles.rules import Rules
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.planners.lanes import make_lanes


class Graph:
    """Arcs between drawn cells, each of which carries one unit, as does each vertex that nobody may cross."""

    def __init__(self, scenario):
        rules = Rules(scenario)
        self.numbers, self.arcs = {"end": 0}, []
        self.goals = set(rules.places(scenario.destinations))
        reachable = rules.reachable()
        self.robots = [cell for cell in rules.places(scenario.robots) if cell in reachable - self.goals]
        capacity = scenario.destination_capacity or 1000
        for goal in self.goals:
            self.add(("in", goal), "end", capacity, 0)
        vertices = set()
        for cell in reachable - self.goals:
            self.add(("in", cell), ("out", cell), 1, 0)
            for other, cost in rules.neighbours(cell):
                vertex = rules.vertex(cell, other)
                if vertex is None or scenario.crossing == "allow":
                    self.add(("out", cell), ("in", other), 1, cost)
                else:
                    vertices |= {("enter", vertex)}
                    self.add(("out", cell), ("enter", vertex), 1, cost)
                    self.add(("leave", vertex), ("in", other), 1, 0)
        for _, vertex in vertices:
            self.add(("enter", vertex), ("leave", vertex), 1, 0)

    def add(self, tail, head, capacity, cost):
        number = [self.numbers.setdefault(node, len(self.numbers)) for node in (tail, head)]
        self.arcs.append((*number, capacity, cost))

    def most(self, robots):
        """How many units get from these robots to the destinations."""
        flow = SimpleMaxFlow()
        for tail, head, capacity, _ in self.arcs:
            flow.add_arc_with_capacity(tail, head, capacity)
        for robot in robots:
            flow.add_arc_with_capacity(len(self.numbers), self.numbers["in", robot], 1)
        assert flow.solve(len(self.numbers), 0) == flow.OPTIMAL
        return flow.optimal_flow()

    def least_cost(self, robots):
        flow = SimpleMinCostFlow()
        for arc in self.arcs:
            flow.add_arc_with_capacity_and_unit_cost(*arc)
        for robot in robots:
            flow.set_node_supply(self.numbers["in", robot], 1)
        flow.set_node_supply(0, -len(robots))
        assert flow.solve() == flow.OPTIMAL
        return flow.optimal_cost()


def ways(lanes):
    """Cells of each lane, its beginning first, and the cells or vertices that the moves between them pass."""
    scenario = lanes.n_scheme.scenario
    area, rules = scenario.area, Rules(scenario)
    goals = set(rules.places(scenario.destinations))
    lane, found = [], []
    for cell in rules.places(area.layout.site_to_cell(lanes.sites)):
        lane.append(cell)
        (k,) = np.flatnonzero(int(lanes.d_scheme.directions[cell[1], cell[0]]) >> np.arange(16) & 1)
        dx, dy = area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(*cell)), k]
        following = (cell[0] + int(dx), cell[1] + int(dy))
        assert following in dict(rules.neighbours(cell))
        if following in goals:
            found.append([*lane, following])
            lane = []
    assert not lane
    return found


def due(distances, lanes, price):
    """When robots are there that arrive one behind the other in each of some lanes; the farthest first."""
    times = []
    for distance in sorted(distances):
        times.append(max(distance, times[-lanes] + price if len(times) >= lanes else 0))
    return times[::-1]


def chosen_robots(scenario, graph, is_choosy):
    """The robots, in order, that get a lane: there is one, and it costs no more than to wait for the lanes so far."""
    rules = Rules(scenario)
    distances = th.make_n_scheme(scenario).distance_of_cell(scenario.robots)
    distance = dict(zip(rules.places(scenario.robots), distances.tolist(), strict=True))
    price = min(scenario.waiting_cost, scenario.area.tessellation.edge_cost)
    order = sorted(graph.robots, key=lambda cell: -distance[cell])  # ties in the order of the robots
    chosen, paid = [], 0
    for i, robot in enumerate(order):
        if graph.most([*chosen, robot]) == len(chosen):
            continue
        cost = graph.least_cost([*chosen, robot]) if is_choosy else 0
        if is_choosy and chosen and cost - paid > due([distance[cell] for cell in order], len(chosen), price)[i]:
            continue
        chosen, paid = [*chosen, robot], cost
    return chosen


@pytest.mark.parametrize("is_choosy", [True, False])
@pytest.mark.parametrize("seed", range(swept(60, 12)))
def test_lanes_are_a_flow_of_least_cost_from_the_farthest_robots(seed, is_choosy):
    scenario = replace(random_scenario(120_000 + seed, sides=(3, 12)), destination_capacity=None)
    tessellation = scenario.area.tessellation
    if tessellation.costs == "euclidean" and tessellation.neighbourhood == "full":
        scenario = replace(scenario, crossing="allow")  # moves of several costs pass one vertex
    lanes = ways(make_lanes(th.make_n_scheme(scenario), all_there_are=not is_choosy))
    graph, rules = Graph(scenario), Rules(scenario)
    chosen = chosen_robots(scenario, graph, is_choosy)
    assert sorted(lane[0] for lane in lanes) == sorted(chosen)
    cost = sum(dict(rules.neighbours(a))[b] for lane in lanes for a, b in itertools.pairwise(lane))
    assert cost == graph.least_cost(chosen)


@pytest.mark.parametrize("seed", range(swept(80, 16)))
def test_lanes_share_nothing_and_all_cells_join_them(seed):
    scenario = random_scenario(130_000 + seed, sides=(3, 12))
    n_scheme = th.make_n_scheme(scenario)
    made = make_lanes(n_scheme)
    lanes, rules = ways(made), Rules(scenario)
    assert [rules.places(way) for way in made.ways] == [lane[:-1] for lane in lanes]
    cells = [cell for lane in lanes for cell in lane[:-1]]
    assert len(cells) == len(set(cells))
    vertices = [rules.vertex(a, b) for lane in lanes for a, b in itertools.pairwise(lane)]
    vertices = [vertex for vertex in vertices if vertex is not None]
    if scenario.crossing == "forbid":
        assert len(vertices) == len(set(vertices))
    ends = [lane[-1] for lane in lanes]
    assert max(map(ends.count, ends), default=0) <= (scenario.destination_capacity or 1000)
    along = {}
    for lane in lanes:
        left = 0
        for here, there in reversed(list(itertools.pairwise(lane))):
            left += dict(rules.neighbours(here))[there]
            along[here] = left
    # Bellman and Ford: what is in no lane takes the cheapest way to one, or to a destination.
    cost = dict.fromkeys(rules.places(scenario.destinations), 0) | along
    others = rules.reachable() - set(cost)
    changed = True
    while changed:
        changed = False
        for cell in others:
            least = min(cost.get(other, 10**9) + paid for other, paid in rules.neighbours(cell))
            changed |= least < cost.get(cell, 10**9)
            cost[cell] = min(least, cost.get(cell, 10**9))
    distance = made.n_scheme.distance
    assert {cell: int(distance[cell[1], cell[0]]) for cell in cost} == cost
    assert np.array_equal(distance < 2**31 - 1, n_scheme.distance < 2**31 - 1)
    check_directions(made, others, cost, rules)


def check_directions(made, cells, cost, rules):
    """Each direction of the cells leads on by one of the cheapest ways, and all of them are there."""
    tessellation = rules.scenario.area.tessellation
    for here in cells:
        bits = int(made.d_scheme.directions[here[1], here[0]])
        steps = tessellation.step_of_direction[int(tessellation.orientation_of_cell(*here))].tolist()
        ends = {(here[0] + dx, here[1] + dy) for k, (dx, dy) in enumerate(steps) if bits >> k & 1}
        assert ends == {other for other, paid in rules.neighbours(here) if cost[here] == cost[other] + paid}, here


def test_directions_beside_lanes_are_right_where_distances_differ_by_far_more_than_a_move():
    """The D-scheme compares distances in 16 bits, which tells two neighbours apart only if they are not 2^16 apart."""
    area = th.make_rooms_area(th.Tessellation("triangular", costs="euclidean"), 60, 80, seed=255)
    goals = th.random_robots(area, 2, seed=255)
    scenario = th.Scenario(area, goals, th.random_robots(area, 200, seed=256, avoid=goals))
    made = make_lanes(th.make_n_scheme(scenario), all_there_are=True)
    rules = Rules(scenario)
    in_lanes = {cell for way in made.ways for cell in rules.places(way)}
    distance = made.n_scheme.distance
    cost = {cell: int(distance[cell[1], cell[0]]) for cell in rules.reachable()}
    check_directions(made, set(cost) - in_lanes - set(rules.places(scenario.destinations)), cost, rules)


@pytest.mark.parametrize("seed", range(6))
def test_vertices_passed_at_two_costs_lead_nobody_in_circles(seed):
    """Euclidean moves through one vertex cost 1732 or 2000; entered at the least, no search came to an end."""
    area = th.make_random_area(th.Tessellation("triangular", costs="euclidean"), 24, 36, density=0.3, seed=seed)
    goal = int(np.flatnonzero(~area.barriers)[300])
    scenario = th.Scenario(area, [goal], th.random_robots(area, 100, seed=seed, avoid=[goal]))
    lanes = ways(make_lanes(th.make_n_scheme(scenario), all_there_are=True))
    graph = Graph(scenario)
    assert len(lanes) == graph.most(graph.robots)


def test_two_robots_pass_a_bend_of_a_corridor_of_two_cells_in_one_step():
    """All shortest ways go round the inner corner; lanes do not, and the crowd arrives sooner."""
    barriers = np.ones((24, 24), dtype=bool)
    barriers[2:4, 2:22] = barriers[2:22, 20:22] = barriers[20:22, 2:22] = False
    area = th.Area("hexagonal", barriers)
    robots = [(x, y) for y in (2, 3) for x in range(2, 22)]
    scenario = th.Scenario(area, [(2, 20), (2, 21)], robots)
    assert len(ways(make_lanes(th.make_n_scheme(scenario)))) == 2
    last = {rule: th.make_plan(scenario, "fcost", rule=rule).steps for rule in ("aside", "lanes")}
    assert last["lanes"] < last["aside"]


@pytest.mark.parametrize("tessellation", [th.Tessellation("triangular", costs="euclidean"), "square"])
def test_a_heap_that_is_too_small_is_doubled_and_lanes_stay_as_they_are(tessellation, monkeypatch):
    area = th.make_random_area(tessellation, 30, 40, density=0.2, seed=3)
    goals = th.random_robots(area, 8, seed=3)
    n_scheme = th.make_n_scheme(th.Scenario(area, goals, th.random_robots(area, 150, seed=4, avoid=goals)))
    made = make_lanes(n_scheme, all_there_are=True)
    monkeypatch.setattr("trihex.planners.lanes._HEAP_SIZE", 1)
    again = make_lanes(n_scheme, all_there_are=True)
    assert made.sites.size > 100
    assert np.array_equal(made.sites, again.sites)
    assert np.array_equal(made.d_scheme.directions, again.d_scheme.directions)


@pytest.mark.parametrize("tessellation", ["triangular", "hexagonal", "square"])
@pytest.mark.parametrize("seed", range(3))
def test_no_lane_is_missed_where_destinations_touch(tessellation, seed):
    """How many can enter destinations in a step ends the search; destinations that touch share their neighbours."""
    area = th.make_random_area(tessellation, 12, 14, density=0.1, seed=seed)
    free = {(int(x), int(y)) for y, x in np.argwhere(~area.barriers)}
    goals = sorted({(x, y) for x in range(4, 8) for y in range(4, 7)} & free)
    robots = sorted(free - set(goals))[::2]
    scenario = th.Scenario(area, goals, robots)
    lanes = ways(make_lanes(th.make_n_scheme(scenario), all_there_are=True))
    graph = Graph(scenario)
    assert len(lanes) == graph.most(graph.robots)
