"""A judge that writes down who owns what in each half tick; slow, and for small areas.

Tick t is half tick 2t. A move from a to b that begins at tick t and lasts d owns, where following is allowed, a in the
half ticks 2t .. 2t + d - 1 and b in 2t + d .. 2t + 2d - 1; where it is forbidden both all the time; the lattice vertex
that it passes all the time; a destination as any b, but nobody owns it longer. Everything else is drawn by
`tests.oracles.rules`.
"""

from collections import defaultdict
from itertools import combinations
from math import ceil
from typing import NamedTuple

import numpy as np

from tests.oracles.doors import Openings
from tests.oracles.rules import Rules
from trihex.kernels.codes import JUMP, WAIT

EVER = 10**9
# Ticks of a move, by the distance of the centres.
TICKS = {
    ("square", "paper"): {1.0: 5, 1.41: 7},
    ("square", "euclidean"): {1.0: 7, 1.41: 10},
    ("triangular", "paper"): {1.0: 5, 1.73: 7, 2.0: 7},
    ("triangular", "euclidean"): {1.0: 4, 1.73: 7, 2.0: 8},
}


class Stay(NamedTuple):
    """A robot owns a thing in the half ticks begin .. end - 1; sorted as they begin, starts before all others."""

    begin: int
    is_later: bool
    robot: int
    end: int
    thing: tuple


class Move(NamedTuple):
    """A robot on its way from one cell to another in the half ticks begin .. end - 1."""

    begin: int
    robot: int
    end: int
    start: tuple
    target: tuple
    vertex: tuple | None


def ticks_of_move(scenario, start, target):
    """How many ticks a move between neighbours lasts."""
    tessellation = scenario.area.tessellation
    if tessellation.clock == "steps" or tessellation.neighbourhood == "edge" or tessellation.name == "hexagonal":
        return 1
    one, other = (np.array(tessellation.centre_of_cell(*cell), dtype=float) for cell in (start, target))
    return TICKS[tessellation.name, tessellation.costs][round(float(np.hypot(*(one - other))), 2)]


class Record:
    """What all robots of a plan do and own, and what is wrong with it, whoever else is there."""

    def __init__(self, plan):
        self.plan, self.scenario, self.rules = plan, plan.scenario, Rules(plan.scenario)
        self.destinations = set(self.rules.places(self.scenario.destinations))
        self.reachable = self.rules.reachable()
        self.jumps = {at: self.rules.places(np.array([to]))[0] for at, to in plan.jumps.tolist()}
        self.conflicts, self.stays, self.moves, self.entries = [], [], [], []
        self.openings = Openings(self.scenario)
        for robot, start in enumerate(self.rules.places(self.scenario.robots)):
            self.follow(robot, start)
        self.judge_entries()
        self.stays.sort()
        self.moves.sort()

    def target(self, index, action, at):
        if action == JUMP:
            return self.jumps[index]
        tessellation = self.scenario.area.tessellation
        dx, dy = tessellation.step_of_direction[int(tessellation.orientation_of_cell(*at)), action].tolist()
        return at[0] + dx, at[1] + dy

    def follow(self, robot, at):
        """Write down all that one robot does."""
        first, last = (int(i) for i in self.plan.first_action[robot : robot + 2])
        if at in self.destinations:
            if last > first:
                self.conflicts.append(("arrival", 0, (robot,), (at,)))
            return
        tick, since, is_later = 0, 0, False
        for index in range(first, last):
            action = int(self.plan.actions[index])
            if action == WAIT:
                tick += 1
                continue
            if not is_later and tick < self.scenario.start_times[robot]:
                self.conflicts.append(("start", tick + 1, (robot,), (at,)))
            to = self.target(index, action, at)
            ticks = 1 if action == JUMP else ticks_of_move(self.scenario, at, to) * int(self.scenario.slowness[robot])
            forbids = self.scenario.following == "forbid"
            self.stays.append(Stay(since, is_later, robot, 2 * tick + (2 if forbids else 1) * ticks, ("cell", at)))
            if action == JUMP:
                self.conflicts.append(("jump", tick + 1, (robot,), (at, to)))
            if not self.rules.is_inside(to):
                self.conflicts.append(("barrier", tick + 1, (robot,), (at,)))
                return
            self.judge_ground(robot, action, at, to, tick)
            vertex = None if action == JUMP else self.rules.vertex(at, to)
            self.moves.append(Move(2 * tick, robot, 2 * (tick + ticks), at, to, vertex))
            since, is_later, at = 2 * tick if forbids else 2 * tick + ticks, True, to
            tick += ticks
            if to not in self.destinations and to != self.moves[-1].start and self.openings(to, tick) == 0:
                self.conflicts.append(("capacity", tick, (robot,), (to,)))
            if to in self.destinations:
                self.entries.append((tick, robot, to))
                self.stays.append(Stay(since, True, robot, 2 * tick, ("destination", to)))
                if index + 1 < last:
                    self.conflicts.append(("arrival", tick, (robot,), (to,)))
                return
        self.stays.append(Stay(since, is_later, robot, EVER, ("cell", at)))
        if self.rules.places(self.scenario.robots)[robot] in self.reachable:
            self.conflicts.append(("arrival", tick, (robot,), (at,)))

    def judge_entries(self):
        """Judge whether doors that are destinations let in all who enter in a tick."""
        entered = defaultdict(int)
        for tick, robot, to in sorted(self.entries):
            entered[tick, to] += 1
            if self.openings(to, tick) is not None and entered[tick, to] > self.openings(to, tick):
                self.conflicts.append(("capacity", tick, (robot,), (to,)))

    def judge_ground(self, robot, action, at, to, tick):
        if self.rules.is_blocked(to):
            self.conflicts.append(("barrier", tick + 1, (robot,), (at, to)))
        elif action != JUMP and not self.rules.is_corner_open(at, to):
            self.conflicts.append(("corner", tick + 1, (robot,), (at, to)))

    def passings(self):
        """Moves as stays at the lattice vertices that they pass, if two may not pass one."""
        if self.scenario.crossing == "forbid":
            for move in self.moves:
                if move.vertex is not None:
                    yield Stay(move.begin, True, move.robot, move.end, ("vertex", move.vertex)), move

    def owners(self):
        """The stays that own each thing in each half tick, in the order in which they begin."""
        horizon = max((stay.end for stay in self.stays if stay.end < EVER), default=0) + 1
        owners = defaultdict(list)
        for stay in sorted([*self.stays, *(stay for stay, _ in self.passings())]):
            for half_tick in range(stay.begin, min(stay.end, horizon)):
                owners[stay.thing, half_tick].append(stay)
        return owners


def keeps_to_the_rules(plan):
    """Whether no rule is broken: in no half tick is anything owned by more than may own it."""
    record = Record(plan)
    most = {"cell": 1, "vertex": 1, "destination": ceil(plan.scenario.destination_capacity or 0) or len(record.stays)}
    for (thing, _), stays in record.owners().items():
        if len({stay.robot for stay in stays}) > most[thing[0]]:
            return False
    for one, other in combinations(record.moves, 2):
        is_opposite = one.start == other.target and one.target == other.start and one.start != one.target
        if one.robot != other.robot and is_opposite and one.begin < other.end and other.begin < one.end:
            return False
    return not record.conflicts


def longest(stays):
    """Of stays the one that ends last; of several the first."""
    return max(stays, key=lambda stay: stay.end) if stays else None


def judge(plan):
    """All conflicts of `plan`, as a sorted list of (kind, step, robots, cells).

    Who comes to what another owns is charged with the one that stays the longest of those who came before.
    """
    record = Record(plan)
    owners, found = record.owners(), list(record.conflicts)
    for stay in record.stays:
        before = [one for one in owners[stay.thing, stay.begin] if one < stay]
        if stay.thing[0] == "destination":
            if 0 < ceil(plan.scenario.destination_capacity or 0) <= len(before):
                found.append(("capacity", stay.begin // 2 + 1, (stay.robot,), (stay.thing[1],)))
        elif stay.is_later and before and longest(before).robot != stay.robot:
            both = tuple(sorted((longest(before).robot, stay.robot)))
            found.append(("cell", stay.begin // 2 + 1, both, (stay.thing[1],)))
    move_of_stay = dict(record.passings())
    for stay, move in record.passings():
        other = longest([one for one in owners[stay.thing, stay.begin] if one < stay])
        if other is not None:
            one, two = sorted((move, move_of_stay[other]), key=lambda move: move.robot)
            cells = (one.start, one.target, two.start, two.target)
            found.append(("crossing", move.begin // 2 + 1, (one.robot, two.robot), cells))
    found += exchanges(record, owners)
    return sorted(found)


def exchanges(record, owners):
    """Yield each move into a cell whose owner is on its way from there to where the move comes from."""
    is_now = record.scenario.following == "forbid"  # who comes in the same half tick comes at once, not half a move on
    for move in record.moves:
        here = [
            stay
            for stay in owners[("cell", move.target), move.begin]
            if not stay.is_later or stay.begin < move.begin or (is_now and stay.robot < move.robot)
        ]
        holder = longest(here)
        if holder is None or move.start == move.target:
            continue
        for other in record.moves:
            if other.robot != holder.robot or (other.start, other.target) != (move.target, move.start):
                continue
            if (other.begin, other.robot) < (move.begin, move.robot) and other.end > move.begin:
                one, two = sorted((other, move), key=lambda move: move.robot)
                yield "exchange", move.begin // 2 + 1, (one.robot, two.robot), (one.start, two.start)
