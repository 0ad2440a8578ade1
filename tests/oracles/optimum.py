"""The least total time of small scenarios, by integer programming over drawn cells; every rule is an inequality."""

from collections import defaultdict
from math import ceil

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import coo_array

from tests.oracles.doors import Openings
from tests.oracles.rules import Rules


def least_total_time(scenario, steps, *, count_steps=False):
    """Least sum of t_r over the robots that can arrive, if all do so within `steps` steps; None if they cannot.

    With `count_steps`, the least sum of their numbers of steps instead.
    """
    rules = Rules(scenario)
    reachable = rules.reachable()
    destinations = set(rules.places(scenario.destinations))
    times = zip(rules.places(scenario.robots), scenario.start_times.tolist(), strict=True)
    robots = {place: time for place, time in times if place in reachable and place not in destinations}
    waited = sum(robots.values()) * (1 if count_steps else scenario.waiting_cost)  # until they may go
    if not robots:
        return 0
    cost, at_most, balance, openings = [], defaultdict(list), defaultdict(list), Openings(scenario)
    for step in range(1, steps + 1):
        for cell in reachable - destinations:
            if step <= robots.get(cell, 0):
                continue
            moves = [(cell, scenario.waiting_cost), *rules.neighbours(cell)]
            for other, price in moves:
                if step <= robots.get(other, -1):
                    continue  # somebody stands there until it may go
                move = len(cost)
                cost.append(1 if count_steps else price)
                balance[cell, step - 1].append((move, -1))
                if other in destinations:
                    at_most["enter", other, step].append(move)
                else:
                    balance[other, step].append((move, 1))
                    at_most["cell", other, step].append(move)
                if other != cell:
                    at_most["door", other, step].append(move)
                    at_most["exchange", min(cell, other), max(cell, other), step].append(move)
                    vertex = rules.vertex(cell, other)
                    if scenario.crossing == "forbid" and vertex is not None:
                        at_most["vertex", vertex, step].append(move)
    limits = dict.fromkeys(at_most, 1)
    for name in at_most:
        if name[0] == "enter":
            limits[name] = ceil(scenario.destination_capacity or len(robots))
        if name[0] == "door":
            limits[name] = openings(*name[1:])
            limits[name] = len(robots) if limits[name] is None else limits[name]
    rows = [(row, move, 1) for row, moves in enumerate(at_most.values()) for move in moves]
    upper = [limits[name] for name in at_most]
    lower = [-np.inf] * len(upper)
    for (cell, step), moves in balance.items():
        if step < steps:  # who comes, or starts here, goes on
            rows += [(len(upper), move, sign) for move, sign in moves]
            upper.append(-(step == robots.get(cell, -1)))
            lower.append(upper[-1])
    left = [move for (_, step), moves in balance.items() if step == steps for move, sign in moves if sign > 0]
    rows += [(len(upper), move, 1) for move in left]  # nobody is left at the end
    upper.append(0)
    lower.append(0)
    row, column, value = (np.array(part) for part in zip(*rows, strict=True))
    matrix = coo_array((value, (row, column)), shape=(len(upper), len(cost))).tocsr()
    solved = milp(cost, constraints=LinearConstraint(matrix, lower, upper), integrality=1, bounds=Bounds(0, 1))
    if solved.status == 2:
        return None
    assert solved.status == 0, solved.message
    return waited + round(solved.fun)
