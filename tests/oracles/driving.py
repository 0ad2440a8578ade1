"""Robots that are driven along a plan: on time, or by an adversary who chooses speeds and stops.

``python -m tests.oracles.driving`` drives random plans, lets the judge of `tests.oracles.continuous` move discs of the
greatest legal radius along them, and prints the rows of a table in docs/metric.md; it exits with 1 if there is a
contact. Nothing here knows when a plan begins a move, only who owns each thing after whom (see `tests.oracles.owners`).
"""

import argparse
import sys
from itertools import product

import numpy as np

import trihex as th
from tests.oracles.continuous import contacts_between_robots
from tests.oracles.lattice import centre_of
from tests.oracles.owners import Record
from tests.oracles.wanderers import wandering_plan
from tests.strategies import SHAPES
from trihex.areas import CLOCKS, FOLLOWINGS
from trihex.areas.clearance import least_distance
from trihex.kernels.codes import WAIT

SLOWEST = 0.1  # of the greatest speed


def centre_in_metres(plan, cell):
    frame = plan.scenario.area.frame
    x, y = centre_of(plan.scenario.area.tessellation.name, cell)
    return np.array([x, -y]) * frame.cell_size


def tracks_on_time(plan):
    """Return the rows (t, x, y) of each robot that keeps to the times of its plan; a tick is a second."""
    record = Record(plan)
    tracks, end = first_rows(plan, record), plan.steps
    for move in record.moves:
        for half_tick, cell in ((move.begin, move.start), (move.end, move.target)):
            tracks[move.robot].append((half_tick / 2, *centre_in_metres(plan, cell)))
    return closed(plan, tracks, end)


def tracks_of_adversary(plan, pace):
    """Return the rows of robots that begin a move only when who owns its things before them has done with leaving.

    `pace(move)` tells how long a robot stops before a move, and at which share of the way it is how much later: pairs
    (seconds, share), the last of them at 1.
    """
    record, ended = Record(plan), {}
    tracks, before = first_rows(plan, record), moves_before(record)
    for move in record.moves:  # who is waited for comes first in this order, as it has left before the other begins
        stop, pieces = pace(move)
        start, target = centre_in_metres(plan, move.start), centre_in_metres(plan, move.target)
        time = max([tracks[move.robot][-1][0], *(ended[other] for other in before[move])]) + stop
        tracks[move.robot].append((time, *start))
        for seconds, share in pieces:
            time += seconds
            tracks[move.robot].append((time, *(start + share * (target - start))))
        ended[move] = time
    return closed(plan, tracks, max(ended.values(), default=0.0))


def moves_before(record):
    """For each move those that must have ended: the last out of its target, into its destination, past its vertex."""
    before, last = {}, {}
    for move in record.moves:
        wanted = [("out of", move.target), ("into", move.target), ("past", move.vertex)]
        before[move] = [last[thing] for thing in wanted if thing in last]
        last["out of", move.start] = move
        if move.target in record.destinations:
            last["into", move.target] = move
        if move.vertex is not None:
            last["past", move.vertex] = move
    return before


def first_rows(plan, record):
    """Where each robot is that does not start on a destination."""
    places = enumerate(record.rules.places(plan.scenario.robots))
    return {robot: [(0.0, *centre_in_metres(plan, cell))] for robot, cell in places if cell not in record.destinations}


def closed(plan, tracks, end):
    """As arrays; robots that do not arrive stay to the end."""
    for robot, rows in tracks.items():
        if not plan.arrived[robot]:
            rows.append((max(end, rows[-1][0]), *rows[-1][1:]))
    return {robot: np.array(rows) for robot, rows in tracks.items()}


def random_pace(rng):
    """Return a pace of an adversary: speeds from 10 to 100 %, stops before and on the way."""

    def pace(move):
        pieces, share = [], 0.0
        for until in (*np.sort(rng.random(rng.integers(3))), 1.0):
            pieces.append(((until - share) / rng.uniform(SLOWEST, 1), until))
            if rng.random() < 0.3:
                pieces.append((rng.exponential(), until))
            share = until
        return rng.exponential() if rng.random() < 0.3 else 0.0, pieces

    return pace


def random_plan_in_metres(tessellation, following, seed, most_robots=30):
    """Return a random plan of robots with the greatest radius that cells of a metre allow, by planners in turn."""
    rng = np.random.default_rng(seed)
    barriers = rng.random(rng.integers(4, 11, size=2)) < 0.15
    barriers.flat[rng.integers(barriers.size)] = False
    radius = least_distance(tessellation, following=following) / 2
    area = th.Area(tessellation, barriers, frame=th.Frame(1.0, robot_radius=radius))
    free = np.flatnonzero(~barriers)
    exits = rng.choice(free, size=min(2, free.size), replace=False)
    robots = rng.choice(free, size=min(most_robots, free.size // 3), replace=False)
    scenario = th.Scenario(area, exits, robots, following=following, clock=tessellation.clock)
    planner = ("fcost", "greedy", None)[seed % 3]
    plan = th.make_plan(scenario, planner) if planner else wandering_plan(scenario, seed)
    assert plan is not None
    return plan


def nearest_and_contacts(plan, tracks):
    """Return the least distance of two centres, in metres, and how many contacts there are."""
    radius = plan.scenario.area.frame.robot_radius
    near = [distance for *_, distance in contacts_between_robots(tracks, 2 * radius)] if len(tracks) > 1 else []
    contacts = contacts_between_robots(tracks, radius) if len(tracks) > 1 else []
    return min(near, default=np.inf), len(contacts)


def drive(tessellation, following, seeds):
    """Return robots, moves, the least distance and contacts of random plans, one for each seed."""
    robots = moves = contacts = 0
    nearest = np.inf
    for seed in seeds:
        plan = random_plan_in_metres(tessellation, following, seed)
        pace = random_pace(np.random.default_rng(seed))
        tracks = tracks_of_adversary(plan, pace) if following == "forbid" else tracks_on_time(plan)
        near, touching = nearest_and_contacts(plan, tracks)
        nearest, contacts = min(nearest, near), contacts + touching
        robots, moves = robots + len(tracks), moves + int(np.count_nonzero(plan.actions != WAIT))
    return robots, moves, nearest, contacts


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.oracles.driving", description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    options = parser.parse_args()
    found = 0
    print("| cells | clock | following | robots | moves | nearest | rule | contacts |\n|" + "---|" * 8)
    for name, neighbourhood in SHAPES:
        for clock, following in product(CLOCKS, FOLLOWINGS):
            tessellation = th.Tessellation(name, neighbourhood, "euclidean", clock)
            robots, moves, nearest, contacts = drive(tessellation, following, range(options.seeds))
            found += contacts
            how = "at any speed" if following == "forbid" else "on time"
            least = least_distance(tessellation, following=following)
            cells = f"{name}, {tessellation.direction_count} | {clock} | {following}, {how}"
            print(f"| {cells} | {robots} | {moves} | {nearest:.4f} | {least:.4f} | {contacts} |", flush=True)
    sys.exit(found > 0)


if __name__ == "__main__":
    main()
