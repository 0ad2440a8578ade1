"""A judge of runs that writes down who owns what in each half tick; slow, and for small areas.

As `tests.oracles.owners`, for a world that changes: a move into what is a destination when it begins, or opens before
it ends, enters that; who leaves the area owns nothing any more; who breaks down ends its move where following is
allowed, and owns nothing but barriers where it is not. That barriers meet nobody is judged, too.
"""

from collections import defaultdict

from tests.oracles.owners import ticks_of_move
from tests.oracles.rules import Rules
from trihex.kernels.codes import UNDERWAY
from trihex.running import ARRIVED, BROKEN, LEFT


class Owners:
    """Who owns each cell, vertex and destination in each half tick of a run."""

    def __init__(self, run):
        self.run, self.scenario, self.rules = run, run.scenario, Rules(run.scenario)
        self.width, self.forbids = run.scenario.area.width, run.scenario.following == "forbid"
        self.cells, self.entries, self.vertices = (defaultdict(set) for _ in range(3))
        self.mistakes = []
        self.goals = [set(cells.tolist()) for _, cells in run.worlds()]
        self.opened = {(o.event.step, cell) for o in run.occurrences if o.is_accepted for cell in o.opened}
        for robot in range(run.robots.size):
            self.follow(robot)

    def write(self, book, place, begin, end, robot):
        """Write down that a robot owns a place, unless it has left or become a barrier."""
        state, ended = self.run.state_of_robot[robot], int(self.run.ended[robot])
        if state == LEFT or (state == BROKEN and self.forbids):
            end = min(end, 2 * ended)
        for half_tick in range(begin, min(end, 2 * self.run.steps + 2)):
            book[place, half_tick].add(robot)

    def follow(self, robot):
        run, joined, ended = self.run, int(self.run.joined[robot]), int(self.run.ended[robot])
        last = run.steps if ended < 0 else ended
        at, tick = int(run.robots[robot]), joined
        while tick < last:
            action = int(run.actions[tick, robot])
            if action >= UNDERWAY:
                if action == UNDERWAY:
                    self.mistakes.append(("time", robot, tick))
                self.write(self.cells, at, 2 * tick, 2 * tick + 2, robot)
                tick += 1
                continue
            here, tessellation = (at % self.width, at // self.width), self.scenario.area.tessellation
            dx, dy = tessellation.step_of_direction[int(tessellation.orientation_of_cell(*here)), action].tolist()
            there = here[0] + dx, here[1] + dy
            to, lasts = there[1] * self.width + there[0], ticks_of_move(self.scenario, here, there)
            if set(run.actions[tick + 1 : min(last, tick + lasts), robot].tolist()) - {UNDERWAY}:
                self.mistakes.append(("time", robot, tick))
            self.write(self.cells, at, 2 * tick, 2 * tick + (2 if self.forbids else 1) * lasts, robot)
            begin, end = 2 * tick + (0 if self.forbids else lasts), 2 * (tick + lasts)
            opens = [2 * (s - 1) for s, cell in self.opened if cell == to and tick < s - 1 < tick + lasts]
            entry = 2 * tick if to in self.goals[tick] else min(opens, default=None)
            if entry is None:
                self.write(self.cells, to, begin, end, robot)
            else:
                self.write(self.cells, to, begin, entry, robot)
                self.write(self.entries, to, max(begin, entry), end, robot)
            vertex = self.rules.vertex(here, there)
            if vertex is not None and self.scenario.crossing == "forbid":
                self.write(self.vertices, vertex, 2 * tick, end, robot)
            at, tick = to, tick + lasts
        if ended < 0 and tick <= run.steps:
            self.write(self.cells, at, 2 * tick, 2 * run.steps + 2, robot)
        on_the_spot = run.state_of_robot[robot] == ARRIVED and (ended + 1, at) in self.opened
        if run.state_of_robot[robot] == ARRIVED and ended > joined and tick != ended and not on_the_spot:
            self.mistakes.append(("arrival", robot, tick))


def breaches(run):
    """Return what breaks the rules: (kind, place or robot, half tick)."""
    owners = Owners(run)
    found = list(owners.mistakes)
    for (cell, half_tick), robots in owners.cells.items():
        if len(robots | owners.entries.get((cell, half_tick), set())) > 1:
            found.append(("cell", cell, half_tick))
    capacity = run.scenario.destination_capacity or run.robots.size
    found += [("capacity", *key) for key, robots in owners.entries.items() if len(robots) > capacity]
    found += [("crossing", *key) for key, robots in owners.vertices.items() if len(robots) > 1]
    walls = [barriers.reshape(-1) for barriers, _ in run.worlds()]
    for (cell, half_tick), robots in [*owners.cells.items(), *owners.entries.items()]:
        wall = half_tick // 2 < run.steps and walls[half_tick // 2][cell]
        whole = [r for r in robots if run.state_of_robot[r] != BROKEN]
        leaving_a_wreck = wall and run.scenario.following == "allow" and (run.state_of_robot == BROKEN).any()
        if wall and whole and not leaving_a_wreck:
            found.append(("barrier", cell, half_tick))
    return sorted(found, key=str)
