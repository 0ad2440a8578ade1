"""Robots that execute a plan with dependencies, each at its own pace: `python executor.py plan.dependencies.json`.

It reads nothing but that file (docs/formats.md) and needs nothing but Python. A robot leaves for its next waypoint as
soon as the others that it waits for have reached theirs. How fast it then drives, and where it stops, is drawn.
"""

import argparse
import csv
import heapq
import json
import random
import sys
from math import hypot


class Execution:
    """Robots on their way from waypoint to waypoint.

    `pace(robot, waypoint, seconds)` tells how a robot drives to a waypoint that takes so many seconds at full speed:
    for how long it stops before it leaves, and pairs (seconds, share of the way behind it), the last share being 1.
    """

    def __init__(self, plan, pace):
        self.speed, self.pace = plan["speed"], pace
        self.arrives = [robot["arrives"] for robot in plan["robots"]]
        self.waypoints = [[(point["x"], point["y"]) for point in robot["waypoints"]] for robot in plan["robots"]]
        self.at = [0] * len(self.waypoints)  # the last waypoint that each has reached
        self.times = [[0.0] for _ in self.waypoints]  # when it has reached each
        self.tracks = [[(0.0, *points[0])] for points in self.waypoints]  # rows (seconds, x, y)
        self.missing = {}  # for each (robot, waypoint) those (other, waypoint) that must still be reached
        self.waiting = {}  # for each (other, waypoint) those (robot, waypoint) that wait for it
        for robot, waypoint, other, reached in plan["dependencies"]:
            self.missing.setdefault((robot, waypoint), set()).add((other, reached))
            self.waiting.setdefault((other, reached), []).append((robot, waypoint))
        self.arrivals = []  # (seconds, robot), a queue of when those on their way reach their next waypoint
        self.now = 0.0

    def run(self):
        """Let all robots drive until none is on its way any more."""
        for robot in range(len(self.waypoints)):
            self.leave(robot)
        while self.arrivals:
            self.now, robot = heapq.heappop(self.arrivals)
            self.at[robot] += 1
            self.times[robot].append(self.now)
            here = robot, self.at[robot]
            self.leave(robot)
            for other, waypoint in self.waiting.get(here, ()):
                self.missing[other, waypoint].remove(here)
                if waypoint == self.at[other] + 1:
                    self.leave(other)
        for robot, rows in enumerate(self.tracks):  # who does not arrive stays in the world
            if not self.arrives[robot] or self.is_stuck(robot):
                rows.append((max(self.now, rows[-1][0]), *rows[-1][1:]))
        return self

    def leave(self, robot):
        """Let a robot leave for its next waypoint, if it has one and may."""
        waypoint = self.at[robot] + 1
        if waypoint == len(self.waypoints[robot]) or self.missing.get((robot, waypoint)):
            return
        (x, y), (to_x, to_y) = self.waypoints[robot][waypoint - 1 : waypoint + 1]
        stop, pieces = self.pace(robot, waypoint, hypot(to_x - x, to_y - y) / self.speed)
        time = self.now + stop
        self.tracks[robot].append((time, x, y))
        for seconds, share in pieces:
            time += seconds
            self.tracks[robot].append((time, x + share * (to_x - x), y + share * (to_y - y)))
        heapq.heappush(self.arrivals, (time, robot))

    def is_stuck(self, robot):
        """Whether a robot has waypoints left; once nobody is on its way, it waits for ever."""
        return self.at[robot] + 1 < len(self.waypoints[robot])

    def stuck(self):
        """Return (robot, its waypoint, other, other's waypoint) of those that wait for ever."""
        left = [(robot, at + 1) for robot, at in enumerate(self.at) if self.is_stuck(robot)]
        return [(*here, *there) for here in left for there in sorted(self.missing.get(here, ()))]


def random_pace(rng, slowest=0.1, stops=3, longest=50.0):
    """Return a pace: speeds drawn from `slowest` to 1, at most so many stops on the way, as long as so many ways."""

    def pace(robot, waypoint, seconds):
        pieces, begun = [], 0.0
        for share in (*sorted(rng.random() for _ in range(rng.randint(0, stops))), 1.0):
            pieces.append(((share - begun) * seconds / rng.uniform(slowest, 1), share))
            if share < 1:
                pieces.append((seconds * longest ** rng.random() if longest else 0.0, share))
            begun = share
        return (seconds * longest * rng.random() ** 4 if rng.random() < 0.3 else 0.0), pieces

    return pace


def write_tracks(tracks, path):
    """Write where each robot is when, a row for each change of speed."""
    with open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["robot", "t", "x", "y"])
        rows.writerows((robot, *row) for robot, own in enumerate(tracks) for row in own)


def main():
    """Execute the plan of the command line; exit with 1 if robots wait for ever, with 2 if there is no such plan."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plan", help="a .dependencies.json")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--slowest", type=float, default=0.1, help="least speed, a share of the greatest")
    parser.add_argument("--stops", type=int, default=3, help="at most, on the way from one waypoint to the next")
    parser.add_argument("--longest", type=float, default=50.0, help="stop, in times of such a way at full speed")
    parser.add_argument("--tracks", help="CSV to write: robot,t,x,y")
    options = parser.parse_args()
    try:
        with open(options.plan, encoding="utf-8") as file:
            plan = json.load(file)
        if plan["format"] != "trihex plan with dependencies" or plan["version"] != 1:
            raise ValueError("no plan with dependencies of version 1")
    except (OSError, ValueError, KeyError, TypeError) as error:
        parser.error(f"{options.plan}: must be a plan with dependencies: {error!r}")
    pace = random_pace(random.Random(options.seed), options.slowest, options.stops, options.longest)
    execution = Execution(plan, pace).run()
    print(plan["sentence"])
    ends = {robot: rows[-1][0] for robot, rows in enumerate(execution.tracks)}
    home = [robot for robot in sorted(ends, key=ends.get) if execution.arrives[robot] and not execution.is_stuck(robot)]
    for robot in home:
        planned = plan["robots"][robot]["waypoints"][-1]["earliest"]
        print(f"robot {robot} arrives after {ends[robot]:.1f} s, {planned:.1f} s in the plan")
    for robot, waypoint, other, reached in execution.stuck():
        print(f"robot {robot} may not leave for waypoint {waypoint}: robot {other} does not reach its {reached}")
    print(f"{len(home)} of {len(ends)} robots arrive")
    if options.tracks:
        write_tracks(execution.tracks, options.tracks)
    return 1 if execution.stuck() else 0


if __name__ == "__main__":
    sys.exit(main())
