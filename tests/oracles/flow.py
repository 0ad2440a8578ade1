"""Least total time and earliest last arrival by flows that OR-tools finds in the graph of cells and steps.

Every cell takes one robot a step, every vertex one that crosses there, at half the cost of the move on either side; so
moves of different costs through one vertex, and exchanges where waiting costs more than a move, are beyond this oracle.
"""

from collections import defaultdict
from math import ceil

from ortools.graph.python.max_flow import SimpleMaxFlow
from ortools.graph.python.min_cost_flow import SimpleMinCostFlow

from tests.oracles.doors import Openings
from tests.oracles.rules import Rules


class Graph:
    """Arcs (tail, head, capacity, twice the cost) between numbered nodes, the nodes robots start at, and the end."""

    def __init__(self, scenario, steps, count_steps=False):
        self.numbers = defaultdict(lambda: len(self.numbers))
        self.arcs = []
        rules = Rules(scenario)
        reachable, self.goals = rules.reachable(), set(rules.places(scenario.destinations))
        self.openings = Openings(scenario)
        self.crossing = scenario.crossing == "forbid"
        times = zip(rules.places(scenario.robots), scenario.start_times.tolist(), strict=True)
        robots = {place: time for place, time in times if place in reachable - self.goals}
        self.starts = [self.numbers["in", *start] for start in robots.items()]
        self.start_times = robots
        self.end = self.numbers["end"]
        wait = 1 if count_steps else scenario.waiting_cost
        moves = [
            (cell, other, rules.vertex(cell, other), 1 if count_steps else cost)
            for cell in reachable - self.goals
            for other, cost in rules.neighbours(cell)
        ]
        for step in range(1, steps + 1):
            for cell in reachable - self.goals:
                if step <= robots.get(cell, 0):
                    continue  # a robot stands there until it may go
                self.add(("in", cell, step - 1), ("out", cell, step), 1, 0)
                self.add(("out", cell, step), ("in", cell, step), 1, 2 * wait)
                if self.openings(cell, step) is not None:
                    self.add(("door", cell, step), ("in", cell, step), self.openings(cell, step), 0)
            for goal in self.goals:
                limits = (self.openings(goal, step), ceil(scenario.destination_capacity or max(len(robots), 1)))
                self.add(("in", goal, step), "end", min(limit for limit in limits if limit is not None), 0)
            self.add_moves(moves, step)

    def add(self, tail, head, capacity, cost):
        self.arcs.append((self.numbers[tail], self.numbers[head], capacity, cost))

    def entered(self, cell, step):
        """Return the node to which moves into a cell lead."""
        is_door = cell not in self.goals and self.openings(cell, step) is not None
        return ("door" if is_door else "in", cell, step)

    def add_moves(self, moves, step):
        through = [move for move in moves if self.crossing and move[2] is not None]
        for cell, other, vertex, cost in moves:
            if not self.crossing or vertex is None:
                self.add(("out", cell, step), self.entered(other, step), 1, 2 * cost)
        for vertex in {move[2] for move in through}:
            self.add(("enter", vertex, step), ("leave", vertex, step), 1, 0)
        for cell, vertex, cost in {(cell, vertex, cost) for cell, _, vertex, cost in through}:
            self.add(("out", cell, step), ("enter", vertex, step), 1, cost)
        for other, vertex, cost in {(other, vertex, cost) for _, other, vertex, cost in through}:
            self.add(("leave", vertex, step), self.entered(other, step), 1, cost)


def least_total_time(scenario, steps, *, count_steps=False):
    """Least sum of t_r, or of steps, over the robots that can arrive, if all do so within `steps` steps; or None.

    What robots wait until they may go is part of it.
    """
    graph = Graph(scenario, steps, count_steps)
    waited = sum(graph.start_times.values()) * (1 if count_steps else scenario.waiting_cost)
    flow = SimpleMinCostFlow()
    for arc in graph.arcs:
        flow.add_arc_with_capacity_and_unit_cost(*arc)
    for start in graph.starts:
        flow.set_node_supply(start, 1)
    flow.set_node_supply(graph.end, -len(graph.starts))
    return waited + flow.optimal_cost() // 2 if flow.solve() == flow.OPTIMAL else None


def most_arrivals(scenario, steps):
    """Greatest number of robots that can arrive within `steps` steps."""
    graph = Graph(scenario, steps)
    flow = SimpleMaxFlow()
    source = graph.numbers["source"]
    for tail, head, capacity, _ in graph.arcs:
        flow.add_arc_with_capacity(tail, head, capacity)
    for start in graph.starts:
        flow.add_arc_with_capacity(source, start, 1)
    assert flow.solve(source, graph.end) == flow.OPTIMAL
    return flow.optimal_flow()
