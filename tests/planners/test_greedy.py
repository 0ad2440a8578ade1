"""Planner `greedy` against a slow reading of its rule that asks everybody in every step, so that nobody sleeps."""

from collections import Counter

import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.planners import make_plan


class SlowGreedy:
    """Robots of one region, step by step, with sets and dictionaries."""

    def __init__(self, scenario):
        self.scenario = scenario
        self.layout, self.tessellation = scenario.area.layout, scenario.area.tessellation
        self.distance = th.make_n_scheme(scenario).distance_of_site
        self.ends = set(self.layout.cell_to_site(scenario.destinations).tolist())
        starts = self.layout.cell_to_site(scenario.robots).tolist()
        self.place = {r: at for r, at in enumerate(starts) if 0 < self.distance[at] < 2**31 - 1}
        self.order = sorted(self.place, key=lambda r: (self.distance[starts[r]], starts[r]))
        self.actions = [[] for _ in starts]
        self.asleep = set()

    def ways(self, robot):
        """Yield (direction, cell, lattice vertex or None) of each best move of a robot, occupied or not."""
        at = self.place[robot]
        for k, cost in enumerate(self.tessellation.cost_of_direction):
            to = at + int(self.layout.offset_of_direction[at & 1, k])
            if self.scenario.moves[at] >> k & 1 and self.distance[to] + cost == self.distance[at]:
                is_barred = self.scenario.crossing == "forbid" and k >= self.tessellation.edge_count
                yield k, to, at + int(self.layout.vertex_of_direction[at & 1, k]) if is_barred else None

    def has_room(self, to, vertex):
        """Whether a cell that nobody stands on may be entered now, by way of this vertex."""
        capacity = self.scenario.destination_capacity
        return vertex not in self.passed and (capacity is None or to not in self.ends or self.entered[to] < capacity)

    def go(self, robot, k, to, vertex):
        """Let a robot move and then others move up."""
        left = self.place.pop(robot)
        self.moved.add(robot)
        self.asleep.discard(robot)
        self.actions[robot].append(k)
        if vertex is not None:
            self.passed.add(vertex)
        if to in self.ends:
            self.entered[to] += 1
        else:
            self.place[robot] = to
        self.move_up(left)

    def move_up(self, hole):
        """Let the first robot that can move into the hole do so, if any waits for it."""
        wanting = [
            (robot, way)
            for robot in self.order
            if robot in self.place and robot not in self.moved
            for way in self.ways(robot)
            if way[1] == hole
        ]
        able = [(robot, way) for robot, way in wanting if self.has_room(*way[1:])]
        waiting = {robot for robot, _ in wanting} & (self.asked | self.slept)
        self.asleep -= waiting - {robot for robot, _ in able}
        if able and waiting:
            self.go(able[0][0], *able[0][1])

    def step(self):
        """Let each robot move or wait."""
        self.moved, self.asked, self.passed, self.entered = set(), set(), set(), Counter()
        self.slept = frozenset(self.asleep)
        going = [robot for robot in self.order if robot in self.place]
        for robot in going:
            if robot in self.moved:
                continue
            held = set(self.place.values())
            free = [way for way in self.ways(robot) if way[1] not in held]
            able = [way for way in free if self.has_room(*way[1:])]
            if robot in self.slept:
                assert not able, "a sleeping robot could have moved"
            elif able:
                self.go(robot, *able[0])
            else:
                self.asked.add(robot)
                self.asleep |= set() if free else {robot}
        for robot in going:
            if robot not in self.moved:
                self.actions[robot].append(255)


@pytest.mark.parametrize("seed", range(swept(70, 20)))
def test_plan_is_that_of_the_slow_reading(seed):
    scenario = random_scenario(310_000 + seed, sides=(4, 11))
    slow = SlowGreedy(scenario)
    while slow.place:
        slow.step()
    plan = make_plan(scenario, "greedy")
    first = plan.first_action
    assert [plan.actions[first[r] : first[r + 1]].tolist() for r in range(scenario.robot_count)] == slow.actions
