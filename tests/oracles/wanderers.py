"""Robots that wander, one after the other, to where nobody will be: a planner that is slow, random and right.

It knows the rules of owners alone: who owns a cell, a lattice vertex or a destination, from which half tick on and up
to which (see `tests.oracles.owners`), and shares no code with trihex but the names of directions.
"""

from collections import defaultdict, deque

import numpy as np

from tests.oracles.owners import EVER, ticks_of_move
from tests.oracles.rules import Rules
from trihex.kernels.codes import WAIT
from trihex.plans import plan_from_lists


class Wanderers:
    """The robots of a scenario that can arrive, where they are, and what is owned from when to when."""

    def __init__(self, scenario, seed):
        self.scenario, self.rules, self.rng = scenario, Rules(scenario), np.random.default_rng(seed)
        self.far = self.distances()
        self.owned = defaultdict(list)  # (begin, end) of each thing, all of them of different robots
        starts = self.rules.places(scenario.robots)
        self.actions = [[] for _ in starts]
        self.free_at = {}  # at which tick robots are next at a centre
        self.place = dict(enumerate(starts))
        for robot, cell in enumerate(starts):
            if self.far.get(cell, 0) > 0:
                self.free_at[robot] = 0
            if self.far.get(cell, -1) != 0:
                self.owned["cell", cell].append((0, EVER))
        self.directions = self.directions_by_step()

    def distances(self):
        """How many moves a lone robot needs from each cell."""
        far = dict.fromkeys(self.rules.places(self.scenario.destinations), 0)
        queue = deque(far)
        while queue:
            cell = queue.popleft()
            for other, _ in self.rules.neighbours(cell):
                if other not in far:
                    far[other] = far[cell] + 1
                    queue.append(other)
        return far

    def directions_by_step(self):
        steps = self.scenario.area.tessellation.step_of_direction.tolist()
        return [{tuple(step): k for k, step in enumerate(own)} for own in steps]

    def is_free(self, thing, begin, end, most=1):
        """Whether fewer than `most` own a thing in some of the half ticks begin .. end - 1."""
        return sum(begin < until and since < end for since, until in self.owned[thing]) < most

    def try_move(self, robot, target, tick):
        """Let a robot begin a move if the rules allow it."""
        here, forbids = self.place[robot], self.scenario.following == "forbid"
        ticks = ticks_of_move(self.scenario, here, target) * int(self.scenario.slowness[robot])
        vertex = self.rules.vertex(here, target)
        begin, middle, end = 2 * tick, 2 * tick + ticks, 2 * (tick + ticks)
        comes, leaves = (begin, end) if forbids else (middle, middle)
        is_goal = self.far[target] == 0
        if is_goal:
            thing, until, most = ("destination", target), end, self.scenario.destination_capacity or 10**6
        else:
            thing, until, most = ("cell", target), EVER, 1
        passes = vertex is not None and self.scenario.crossing == "forbid"
        if not self.is_free(thing, comes, until, most):
            return False
        if passes and not self.is_free(("vertex", vertex), begin, end):
            return False
        self.owned[thing].append((comes, until))
        if passes:
            self.owned["vertex", vertex].append((begin, end))
        own = self.owned["cell", here]
        own[:] = [(since, leaves if until == EVER else until) for since, until in own if until > begin]
        side = int(self.scenario.area.tessellation.orientation_of_cell(*here))
        self.actions[robot].append(self.directions[side][target[0] - here[0], target[1] - here[1]])
        self.place[robot] = target
        self.free_at[robot] = tick + ticks
        if is_goal:
            del self.free_at[robot]
        return True

    def act(self, robot, tick):
        """Let a robot at a centre go on: mostly to where it is nearer, at times anywhere, or wait."""
        ways = sorted(cell for cell, _ in self.rules.neighbours(self.place[robot]))
        self.rng.shuffle(ways)
        if self.rng.random() < 0.8:
            ways.sort(key=self.far.get)
        if self.rng.random() < 0.9 and any(self.try_move(robot, way, tick) for way in ways[:3]):
            return
        self.actions[robot].append(WAIT)
        self.free_at[robot] = tick + 1

    def plan(self, most_ticks):
        """Return the plan, None if not all are home by then."""
        for tick in range(most_ticks):
            if not self.free_at:
                return plan_from_lists(self.scenario, self.actions)
            here = [robot for robot, free in self.free_at.items() if free == tick]
            self.rng.shuffle(here)
            for robot in sorted(here, key=lambda robot: self.far[self.place[robot]] * (robot % 2)):
                self.act(robot, tick)
        return None


def wandering_plan(scenario, seed, most_ticks=2000):
    """Return a random plan of `scenario` that keeps all rules, None if not all are home after `most_ticks`."""
    return Wanderers(scenario, seed).plan(most_ticks)
