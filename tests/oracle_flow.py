"""The least total time of a scenario as a flow of least cost that OR-tools finds in the graph of cells and steps."""

from collections import defaultdict

from ortools.graph.python.min_cost_flow import SimpleMinCostFlow

from tests.oracle_rules import Rules


def least_total_time(scenario, steps, *, count_steps=False):
    """Least sum of t_r, or of steps, over the robots that can arrive, if all do so within `steps` steps.

    Every cell takes one robot a step, every vertex one that crosses there, at half the cost of the move on either
    side; so moves of different costs through one vertex, and exchanges where waiting costs more than a move, are
    beyond this oracle.
    """
    rules = Rules(scenario)
    reachable = rules.reachable()
    destinations = set(rules.places(scenario.destinations))
    robots = [place for place in rules.places(scenario.robots) if place in reachable and place not in destinations]
    numbers = defaultdict(lambda: len(numbers))
    flow = SimpleMinCostFlow()

    def arc(tail, head, capacity, cost):
        flow.add_arc_with_capacity_and_unit_cost(numbers[tail], numbers[head], capacity, cost)

    for step in range(1, steps + 1):
        vertices = set()
        for cell in reachable - destinations:
            arc(("in", cell, step - 1), ("out", cell, step - 1), 1, 0)
            arc(("out", cell, step - 1), ("in", cell, step), 1, 2 if count_steps else 2 * scenario.waiting_cost)
            for other, price in rules.neighbours(cell):
                cost = 2 if count_steps else 2 * price
                vertex = rules.vertex(cell, other) if scenario.crossing == "forbid" else None
                if vertex is None:
                    arc(("out", cell, step - 1), ("in", other, step), 1, cost)
                else:
                    vertices |= {(vertex, cell, other, cost // 2)}
        for side, place in ((1, "enter"), (2, "leave")):
            for vertex, cell, cost in {(v[0], v[side], v[3]) for v in vertices}:
                if side == 1:
                    arc(("out", cell, step - 1), (place, vertex, step), 1, cost)
                else:
                    arc((place, vertex, step), ("in", cell, step), 1, cost)
        for vertex in {v[0] for v in vertices}:
            arc(("enter", vertex, step), ("leave", vertex, step), 1, 0)
        for goal in destinations:
            arc(("in", goal, step), "end", scenario.destination_capacity or len(robots), 0)
    for robot in robots:
        flow.set_node_supply(numbers["in", robot, 0], 1)
    flow.set_node_supply(numbers["end"], -len(robots))
    if flow.solve() != flow.OPTIMAL:
        return None
    return flow.optimal_cost() // 2
