"""Check a certificate: `check_certificate.py AREA PLAN CERTIFICATE` accepts only what proves that no plan is better.

AREA is a .map or letters, PLAN an .npz and CERTIFICATE a .csv, as `trihex plan` with --planner optimal, --out PLAN and
--certificate CERTIFICATE writes them. Why what is accepted is proven: docs/optimum.md, "For a sceptic".
"""

import sys
from functools import reduce
from pathlib import Path

import numpy as np

WAIT, MOST, FAR = 255, 10**6, 1 << 50  # MOST of tolls, costs, steps, robots; no sum overflows or comes near to FAR
# (dx, dy) of each direction, across edges first, in even and odd columns, or where triangles point north and south. The
# others pass a lattice vertex, CORNERS, that has the position of the first cell of AROUND, a circle of those around it.
EVEN, ODD = [(0, -1), (1, -1), (1, 0), (0, 1), (-1, 0), (-1, -1)], [(0, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0)]
SQUARE = [(0, -1), (1, 0), (0, 1), (-1, 0), (1, -1), (1, 1), (-1, 1), (-1, -1)]
NORTH = [(1, 0), (-1, 0), (0, 1), (2, 0), (-2, 0), (1, -1), (-1, -1), (1, 1), (-1, 1), (0, -1), (2, 1), (-2, 1)]
STEPS = {"hexagonal": (EVEN, ODD), "square": (SQUARE, SQUARE), "triangular": (NORTH, [(x, -y) for x, y in NORTH])}
SHARED = [(1, 1), (-1, 1), (0, 0), (0, 0), (1, 1), (-1, 1), (0, 0), (1, 1), (-1, 1)]
CORNERS = {"square": [[(1, 0), (1, 1), (0, 1), (0, 0)]] * 2, "triangular": [SHARED, [(x, 1 - y) for x, y in SHARED]]}
AROUND = [(0, 0), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]  # the first four on squares
PAST_VERTICES = {"hexagonal": [], "square": [1414] * 4, "triangular": [1732] * 6 + [2000] * 3}  # euclidean costs


def demand(rule, message):
    """Reject what breaks a rule."""
    if not rule:
        raise ValueError(message)


def make_moves(plan, shape, count, edges):
    """Return by cell the targets of moves and, last, of waiting (a cell more: barriers), and vertices passed or -1."""
    (height, width), walls = plan["barriers"].shape, np.pad(plan["barriers"], 3, constant_values=True)
    y, x = np.divmod(np.arange(height * width, dtype=np.int32), width)
    odd = (x if shape == "hexagonal" else x + y) % 2
    target = np.full((count + 1, x.size + 1), x.size, dtype=np.int32)
    target[-1, :-1] = np.where(plan["barriers"].reshape(-1), x.size, y * width + x)
    via = np.full_like(target, -1) if count > edges else np.broadcast_to(np.int32(-1), target.shape)
    for k, turned in ((k, turned) for k in range(count) for turned in range(2)):
        dx, dy = step = STEPS[shape][turned][k]
        own = np.flatnonzero((odd == turned) & ~walls[y + 3, x + 3] & ~walls[y + dy + 3, x + dx + 3])
        if k >= edges:
            vx, vy = CORNERS[shape][turned][k - edges]
            ring = [(a + vx, b + vy) for a, b in AROUND[: 4 if shape == "square" else 6]]
            i, j = sorted((ring.index((0, 0)), ring.index(step)))
            free = np.array([~walls[y[own] + b + 3, x[own] + a + 3] for a, b in ring])
            one, other = free[i + 1 : j].all(axis=0), free[:i].all(axis=0) & free[j + 1 :].all(axis=0)
            own = own[one & other if plan["corners"] == "no-cut" else one | other | (plan["corners"] == "allow")]
            via[k, own] = (y[own] + vy) * (width + 2) + x[own] + vx + 1
        target[k, own] = (y[own] + dy) * width + x[own] + dx
    return target, via


def cheapest(pays, target, cost, tolls):
    """Return what robots pay at least for a step, the tolls of vertices, and what they pay after it."""
    ways = zip(target, cost, tolls, strict=True)
    return reduce(np.minimum, (pays[there] + (price + toll) for there, price, toll in ways))


def replay(plan, target, via, cost, goals, can_arrive):
    """Return the sum of costs; reject a plan in which robots do what they must not, or fail to arrive."""
    actions, first, cell = plan.pop("actions"), plan["first_action"], plan["robots"].copy()
    capacity, length, wait, total = int(plan["destination_capacity"]) or cell.size, np.diff(first), len(target) - 1, 0
    demand([one.dtype for one in (actions, first, cell)] == [np.uint8, np.int64, np.int64], "numbers must be whole")
    demand(first.size == cell.size + 1 and first[0] == 0 and first[-1] == actions.size, "actions must fit the robots")
    demand((length >= 0).all() and np.unique(cell).size == cell.size, "robots must start in cells of their own")
    demand(((cell >= 0) & (target[-1, cell] == cell)).all(), "robots must start in free cells")
    is_goal = np.isin(np.arange(target.shape[1]), goals)
    demand(((length > 0) == can_arrive[cell] & ~is_goal[cell]).all(), "just those must move who can arrive")
    for step in range(1, int(length.max(initial=0)) + 1):
        here = np.flatnonzero((length >= step) | ~can_arrive[cell])  # the others have left
        before, action, going = cell[here], np.full(here.size, wait), length[here] >= step
        action[going] = actions[first[here[going]] + step - 1]
        demand(((action < wait) | (action == WAIT) | ~going).all(), "there must be such directions")
        action = np.minimum(action, wait)
        now, passed = target[action, before], via[action, before]
        demand((now < is_goal.size - 1).all(), "robots must go to free cells, and no way that is closed")
        cell[here], total = now, total + int(cost[action[going]].sum())
        arrives = is_goal[now]
        demand((arrives == (length[here] == step)).all(), "robots must leave in a destination, with their last action")
        demand(np.bincount(now[~arrives], minlength=1).max() <= 1, "a cell must hold one robot")
        demand(plan["crossing"] == "allow" or np.bincount(passed + 1)[1:].max(initial=0) <= 1, "robots must not cross")
        demand(np.bincount(now[arrives], minlength=1).max() <= capacity, "a destination takes only so many")
        ways = np.minimum(before, now).astype(np.int64) * is_goal.size + np.maximum(before, now)
        demand(np.unique(ways).size == ways.size, "robots must not exchange cells")
    return total


def proven(path, plan, target, via, cost, goals, pays):
    """Return what no plan can be below: the least that each robot pays, tolls included, less all tolls there are."""
    header, *lines = Path(path).read_text().splitlines()
    demand(header == "place,x,y,step,toll", "a certificate must have the columns place,x,y,step,toll")
    rows = [[("cell", "vertex").index(place), *map(int, rest)] for place, *rest in (line.split(",") for line in lines)]
    is_vertex, x, y, step, toll = np.array(rows, dtype=np.int64).reshape(-1, 5).T
    (height, width), capacity, crossing = plan["barriers"].shape, int(plan["destination_capacity"]), plan["crossing"]
    last = int(np.diff(plan["first_action"]).max(initial=0))
    inside = (x >= -is_vertex) & (x < width + is_vertex) & (y >= 0) & (y < height + is_vertex)
    inside &= (step >= 1) & (step <= last)
    demand(inside.all() and last <= MOST, f"tolls must lie in the area, and in up to {MOST} steps of the plan")
    demand(((toll >= 0) & (toll <= MOST)).all() and 0 <= capacity <= MOST, f"tolls and capacity must be up to {MOST}")
    place = np.where(is_vertex, y * (width + 2) + x + 1, y * width + x)
    payers = np.where((is_vertex == 0) & np.isin(place, goals), capacity, 1)
    demand((payers > 0).all() and (crossing == "forbid" or not is_vertex.any()), "any number of robots may pay a toll")
    demand(np.unique([is_vertex, place, step], axis=1).shape[1] == step.size, "a place must have one toll in a step")
    order, reached = np.argsort(step, kind="stable"), plan["robots"][pays[plan["robots"]] < FAR]
    begin = np.searchsorted(step[order], np.arange(last + 2))
    at_vertex = np.zeros((height + 2) * (width + 2) + 1, dtype=np.int64)  # the last one is for moves that pass none
    for now in range(last, 0, -1):
        due = order[begin[now] : begin[now + 1]]
        cells, vertices = due[is_vertex[due] == 0], due[is_vertex[due] == 1]
        pays[place[cells]] += toll[cells]
        at_vertex[place[vertices]] = toll[vertices]
        pays = cheapest(pays, target, cost, at_vertex[via] if vertices.size else np.zeros(len(via), dtype=np.int64))
        at_vertex[place[vertices]] = 0
        pays[goals] = 0  # whoever has arrived pays no more
    return sum(pays[reached].tolist()) - sum((payers * toll).tolist())


def check(area, plan_path, certificate):
    """Return in words what is proven; raise ValueError if it is not."""
    plan = dict(np.load(plan_path, allow_pickle=False))
    shape, wait = str(plan["tessellation"]), int(plan["waiting_cost"])
    past_vertices, edges = PAST_VERTICES[shape], len(STEPS[shape][0]) - len(PAST_VERTICES[shape])
    cost = [1000] * edges + past_vertices if plan["costs"] == "euclidean" else [10] * edges + [14] * len(past_vertices)
    cost = np.array([*(cost[:edges] if plan["neighbourhood"] == "edge" else cost), wait])
    timed = {"clock", "following", "doors", "start_times"} & plan.keys()
    demand(not timed and 0 <= wait <= MOST, f"nobody must wait for a time, nor at more than {MOST}")
    rows = Path(area).read_text().splitlines()
    header, walls = (4, "@OTW") if rows[0].startswith("type") else (0, "B#")
    barriers = np.array([[letter in walls for letter in row] for row in rows[header:] if row])
    demand(np.array_equal(barriers, plan["barriers"]), "the plan must be for this area")
    (target, via), goals = make_moves(plan, shape, cost.size - 1, edges), np.unique(plan["destinations"])
    demand(goals.size and goals.min() >= 0 and (target[-1, goals] == goals).all(), "destinations must be free")
    pays, before = np.where(np.isin(np.arange(target.shape[1]), goals), 0, FAR), None
    while not np.array_equal(pays, before):  # what is paid after the plan, when there are no more tolls
        before, pays = pays, np.minimum(pays, cheapest(pays, target, cost, np.zeros(len(via), dtype=np.int64)))
    total = replay(plan, target, via, cost, goals, pays < FAR)
    least = proven(certificate, plan, target, via, cost, goals, pays)
    demand(least == total, f"the plan takes {total}, the tolls prove only that none takes less than {least}")
    return f"{plan['robots'].size} robots, {goals.size} destinations, {shape}: {total} in all, and no plan takes less"


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: python check_certificate.py AREA PLAN CERTIFICATE")
    try:
        print("accepted:", check(*sys.argv[1:]))
    except Exception as error:  # a file of whatever else proves nothing
        sys.exit(f"rejected: {error}")
