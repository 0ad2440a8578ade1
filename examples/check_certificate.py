"""Check a certificate: `check_certificate.py AREA PLAN CERTIFICATE` accepts only what proves that no plan is better.

AREA is a .map or letters, PLAN an .npz and CERTIFICATE a .csv, as `trihex plan` with --planner optimal, --out PLAN and
--certificate CERTIFICATE writes them. Why what is accepted is proven: docs/optimum.md, "For a sceptic".
"""

import sys
from functools import reduce
from pathlib import Path

import numpy as np

WAIT = 255  # any other action is the number of a direction
FAR = 1 << 50  # steps that nobody takes, above all sums of tolls
MOST = 10**6  # of tolls, steps and robots in a destination; no sum below overflows
# (dx, dy) of each direction in even and odd columns of hexagons, for triangles that point north and south.
EVEN, ODD = ((0, -1), (1, -1), (1, 0), (0, 1), (-1, 0), (-1, -1)), ((0, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0))
NORTH, SOUTH, SQUARE = ((1, 0), (-1, 0), (0, 1)), ((1, 0), (-1, 0), (0, -1)), ((0, -1), (1, 0), (0, 1), (-1, 0))
SHAPES = {"hexagonal": (EVEN, ODD), "square": (SQUARE, SQUARE), "triangular": (NORTH, SOUTH)}


def demand(rule, message):
    """Reject what breaks a rule."""
    if not rule:
        raise ValueError(message)


def read_barriers(path):
    """Return the barriers of an area, True or False for each row and column."""
    lines = Path(path).read_text().splitlines()
    if lines[0].startswith("type"):  # a header of four lines
        return np.array([[letter in "@OTW" for letter in line] for line in lines[4:] if line])
    return np.array([[letter in "B#" for letter in line] for line in lines if line])


def make_neighbours(barriers, shape):
    """Return the neighbour of each cell in each direction and, last, itself; an extra cell, the last, for barriers."""
    height, width = barriers.shape
    y, x = np.divmod(np.arange(height * width, dtype=np.int32), width)
    odd = (x if shape == "hexagonal" else x + y) % 2
    rows = []
    for even_step, odd_step in zip(*SHAPES[shape], strict=True):
        dx, dy = (np.where(odd, odd_step[i], even_step[i]).astype(np.int32) for i in range(2))
        inside = (x + dx >= 0) & (x + dx < width) & (y + dy >= 0) & (y + dy < height)
        rows.append(np.where(inside, (y + dy) * width + x + dx, height * width))
    table = np.full((len(rows) + 1, height * width + 1), height * width, dtype=np.int32)
    table[:, :-1] = [*rows, y * width + x]
    table[np.append(barriers.reshape(-1), True)[table]] = height * width
    return table


def steps_to_destination(neighbours, goals):
    """Return the least number of steps from each cell to a destination, `FAR` where there is no way."""
    steps = np.full(neighbours.shape[1], FAR)
    steps[goals] = 0
    near = np.asarray(goals)
    while near.size:  # moves can be made either way
        found = np.unique(neighbours[:-1, near])
        found = found[(steps[found] == FAR) & (found < steps.size - 1)]
        steps[found] = steps[near[0]] + 1
        near = found
    return steps


def replay(plan, neighbours, goals, hops):
    """Return the sum of arrival steps; reject a plan in which robots do what they must not, or fail to arrive."""
    actions, first, cell = plan["actions"], plan["first_action"], plan["robots"].copy()
    capacity, length = int(plan["destination_capacity"]), np.diff(first)
    demand([one.dtype for one in (actions, first, cell)] == [np.uint8, np.int64, np.int64], "numbers must be whole")
    demand(first.size == cell.size + 1 and first[0] == 0 and first[-1] == actions.size, "actions must fit the robots")
    demand((length >= 0).all() and np.unique(cell).size == cell.size, "robots must start in cells of their own")
    demand(((cell >= 0) & (neighbours[-1, cell] == cell)).all(), "robots must start in free cells")
    is_goal = np.zeros(neighbours.shape[1], dtype=bool)
    is_goal[goals] = True
    demand(((length > 0) == (hops[cell] < FAR) & ~is_goal[cell]).all(), "just those must move who can arrive")
    for step in range(1, int(length.max(initial=0)) + 1):
        here = np.flatnonzero((length >= step) | (hops[cell] == FAR))  # the others have left
        going = length[here] >= step
        before, action = cell[here], np.full(here.size, WAIT)
        action[going] = actions[first[here[going]] + step - 1]
        demand(((action < len(neighbours) - 1) | (action == WAIT)).all(), "there must be such directions")
        now = neighbours[np.where(action == WAIT, len(neighbours) - 1, action), before]
        demand((now < is_goal.size - 1).all(), "robots must go to free cells")
        cell[here] = now
        arrives = is_goal[now]
        demand((arrives == (length[here] == step)).all(), "robots must leave in a destination, with their last action")
        demand(np.bincount(now[~arrives], minlength=1).max() <= 1, "a cell must hold one robot")
        if capacity:
            demand(np.bincount(now[arrives], minlength=1).max() <= capacity, "a destination takes only so many")
        was_at = np.full(is_goal.size, -1)
        was_at[before] = np.arange(here.size)
        other = was_at[now]
        swapped = (other >= 0) & (now != before) & (now[other] == before)
        demand(not swapped.any(), "robots must not exchange cells")
    return int(length.sum())


def proven_steps(tolls, plan, neighbours, goals, hops):
    """Return what no plan can be below: the least that each robot pays in steps and tolls, less all tolls there are."""
    x, y, step, toll = tolls.T
    height, width = plan["barriers"].shape
    demand(((x >= 0) & (x < width) & (y >= 0) & (y < height)).all(), "tolls must lie in the area")
    cell = y * width + x
    last, capacity = int(np.diff(plan["first_action"]).max(initial=0)), int(plan["destination_capacity"])
    demand(last <= MOST and ((step >= 1) & (step <= last)).all(), f"steps must be those of the plan, up to {MOST}")
    demand(((toll >= 0) & (toll <= MOST)).all() and 0 <= capacity <= MOST, f"tolls and capacity must be up to {MOST}")
    is_goal = np.isin(cell, goals)
    demand(capacity > 0 or not is_goal.any(), "where any number may enter, no toll can be collected")
    key = step * width * height + cell
    demand(np.unique(key).size == key.size, "a cell must have one toll in a step")
    order = np.argsort(step, kind="stable")
    begin = np.searchsorted(step[order], np.arange(last + 2))
    pays = last + hops  # from the last step on, when there are no more tolls
    for now in range(last, 0, -1):
        pays[goals] = now  # whoever enters now pays that
        due = order[begin[now] : begin[now + 1]]
        pays[cell[due]] += toll[due]
        pays = reduce(np.minimum, (pays[neighbour] for neighbour in neighbours))
    pays[goals] = 0
    robots = plan["robots"][hops[plan["robots"]] < FAR]
    return sum(pays[robots].tolist()) - sum((np.where(is_goal, capacity, 1) * toll).tolist())


def check(area, plan_path, certificate):
    """Return in words what is proven; raise ValueError if it is not."""
    with np.load(plan_path, allow_pickle=False) as archive:
        plan = {name: archive[name] for name in archive.files}
    shape, barriers = str(plan["tessellation"]), read_barriers(area)
    demand(shape == "hexagonal" or str(plan["neighbourhood"]) == "edge", "robots must move across edges only")
    cost_of_move = 10 if str(plan["costs"]) == "paper" else 1000
    demand(plan["waiting_cost"] == cost_of_move, "waiting must cost as much as a move")
    demand(not {"clock", "following"} & plan.keys(), "every move must last a step, and robots may follow at once")
    demand(np.array_equal(barriers, plan["barriers"]), "the plan must be for this area")
    neighbours, goals = make_neighbours(barriers, shape), np.unique(plan["destinations"])
    demand(goals.size and goals.min() >= 0 and (neighbours[-1, goals] == goals).all(), "destinations must be free")
    hops = steps_to_destination(neighbours, goals)
    steps = replay(plan, neighbours, goals, hops)
    header, *rows = Path(certificate).read_text().splitlines()
    demand(header == "x,y,step,toll", "a certificate must have the columns x,y,step,toll")
    tolls = np.array([[int(number) for number in row.split(",")] for row in rows], dtype=np.int64).reshape(-1, 4)
    proven = proven_steps(tolls, plan, neighbours, goals, hops)
    demand(proven == steps, f"the plan takes {steps} steps, the tolls prove only that none takes fewer than {proven}")
    return f"{plan['robots'].size} robots, {goals.size} destinations, {shape}: {steps} steps, and no plan takes fewer"


if __name__ == "__main__":
    try:
        print("accepted:", check(*sys.argv[1:]))
    except Exception as error:  # a file of whatever else proves nothing
        sys.exit(f"rejected: {error}")
