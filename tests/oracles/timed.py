"""The least total time where moves last, by integer programming over drawn cells and half ticks; for small areas.

Every rule of the model is an inequality: at each half tick a cell has one owner at most, a lattice vertex (where
crossing is forbidden) one, a destination as many as its capacity, and of two opposite moves that begin at once one is
made. Durations are found from the drawing. `python -m tests.oracles.gaps` prints how near our bounds come.
"""

from collections import defaultdict
from dataclasses import replace
from functools import cached_property
from heapq import heapify, heappop, heappush
from math import ceil

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import coo_array

from tests.oracles.doors import Openings
from tests.oracles.rules import Rules
from trihex.kernels.codes import WAIT
from trihex.plans.plan import plan_from_lists

TICKS = {
    ("square", "paper"): {1.0: 5, 1.414: 7},
    ("square", "euclidean"): {1.0: 7, 1.414: 10},
    ("triangular", "paper"): {1.0: 5, 1.732: 7, 2.0: 7},
    ("triangular", "euclidean"): {1.0: 4, 1.732: 7, 2.0: 8},
}


def with_time(scenario, clock, following):
    """Return a scenario with another clock; what waiting costs is as is usual there."""
    return replace(scenario, clock=clock, following=following, waiting_cost=1 if clock == "costs" else None)


class TimedProgram:
    """The integer program of a scenario in which all robots that can arrive do so within so many ticks.

    With `finer` = 2, moves may begin and waits end at half ticks, too, and so on.
    """

    def __init__(self, scenario, ticks, *, finer=1):
        self.scenario, self.rules, self.finer, self.end = scenario, Rules(scenario), finer, ticks * finer
        self.destinations = set(self.rules.places(scenario.destinations))
        self.reachable = self.rules.reachable()
        starts = enumerate(self.rules.places(scenario.robots))
        self.start_of_robot = {r: at for r, at in starts if at in self.reachable - self.destinations}
        times = scenario.start_times * finer
        self.may_leave = {at: int(times[r]) for r, at in self.start_of_robot.items()}
        self.moves = {at: list(self._moves_from(at)) for at in self.reachable - self.destinations}
        self.deeds, self.cost, self.limit, self.openings = [], [], {}, Openings(scenario)
        self.members, self.balance = defaultdict(list), defaultdict(list)
        self._fill()

    def _moves_from(self, at):
        """Yield (cell, cost, duration) of each move from a cell."""
        tessellation = self.scenario.area.tessellation
        for other, _ in self.rules.neighbours(at):
            polygons = [tessellation.polygon_of_cell(*cell).mean(axis=0) for cell in (at, other)]
            length = round(float(np.hypot(*(polygons[1] - polygons[0]))), 3)
            is_edge = self.rules.vertex(at, other) is None
            price = {"paper": 10 if is_edge else 14, "euclidean": round(1000 * length)}[tessellation.costs]
            duration = 1
            if tessellation.clock == "costs":
                alike = tessellation.name == "hexagonal" or tessellation.neighbourhood == "edge"
                price = duration = 1 if alike else TICKS[tessellation.name, tessellation.costs][length]
            yield other, price * self.finer, duration * self.finer

    def _spread(self, sources, part):
        """Return the least sum of costs (part 1) or durations (part 2) of moves from `sources` to each cell."""
        least = dict.fromkeys(sources, 0)
        heap = [(0, cell) for cell in sources]
        heapify(heap)
        while heap:
            value, cell = heappop(heap)
            if value > least[cell]:
                continue
            for move in self._moves_from(cell):  # symmetric
                if value + move[part] < least.get(move[0], np.inf):
                    least[move[0]] = value + move[part]
                    heappush(heap, (least[move[0]], move[0]))
        return least

    @cached_property
    def price_to_destination(self):
        """Least cost from each cell, times `finer`."""
        return self._spread(self.destinations, 1)

    def _fill(self):
        """Make a variable of each wait and move that may be of use, and the rules that hold for it."""
        soonest = self._spread(self.start_of_robot.values(), 2)
        needed = self._spread(self.destinations, 2)
        for cell, moves in self.moves.items():
            for begin in range(soonest.get(cell, self.end), self.end):
                for other, price, duration in [(cell, self.scenario.waiting_cost, 1), *moves]:
                    if other != cell and begin < self.may_leave.get(cell, 0):
                        continue  # the robot that starts there stands, and fills it
                    if begin + duration + needed[other] <= self.end:
                        self._add(cell, other, begin, price, duration)

    def _add(self, cell, other, begin, price, duration):
        deed = len(self.deeds)
        self.deeds.append((cell, other, begin, duration))
        self.cost.append(price)
        self.balance[cell, begin].append((deed, -1))
        if other not in self.destinations:
            self.balance[other, begin + duration].append((deed, 1))
        first, middle, last = 2 * begin, 2 * begin + duration, 2 * begin + 2 * duration
        if other == cell:
            self._own("cell", cell, first, last, deed)
            return
        self.members["door", other, (begin + duration) // self.finer].append(deed)
        forbids = self.scenario.following == "forbid"
        self._own("cell", cell, first, last if forbids else middle, deed)
        self._own("goal" if other in self.destinations else "cell", other, first if forbids else middle, last, deed)
        vertex = self.rules.vertex(cell, other)
        if vertex is not None and self.scenario.crossing == "forbid":
            self._own("vertex", vertex, first, last, deed)
        if other not in self.destinations:
            self.members["exchange", min(cell, other), max(cell, other), begin].append(deed)

    def _own(self, kind, place, first, last, deed):
        for half in range(first, last):
            self.members[kind, place, half].append(deed)

    def _rows(self):
        """Return the inequalities: variables with their signs, lower and upper limit of each."""
        capacity = ceil(self.scenario.destination_capacity or 0) or np.inf
        limits = {}
        for name, deeds in self.members.items():
            limit = capacity if name[0] == "goal" else 1
            if name[0] == "door":
                limit = self.openings(*name[1:])
                limit = np.inf if limit is None else limit
            if len(deeds) > limit:
                limits[tuple(deeds)] = min(
                    limit, limits.get(tuple(deeds), limit)
                )  # mostly the same as half a tick before
        rows = [([(deed, 1) for deed in deeds], -np.inf, limit) for deeds, limit in limits.items()]
        starts = set(self.start_of_robot.values())
        for (cell, time), signed in self.balance.items():
            begins = -int(time == 0 and cell in starts)
            rows.append((signed, begins, begins))
        lost = [cell for cell in starts if (cell, 0) not in self.balance]
        return rows + [([], 1, 1) for _ in lost]  # who starts there cannot arrive in time

    def _solve(self, integrality):
        if not self.start_of_robot:
            return 0.0, None
        rows = self._rows()
        if not self.deeds or any(not signed for signed, _, _ in rows):
            return None, None
        entries = [(i, deed, sign) for i, (signed, _, _) in enumerate(rows) for deed, sign in signed]
        row, column, value = np.array(entries).T
        matrix = coo_array((value.astype(float), (row, column)), shape=(len(rows), len(self.deeds))).tocsr()
        _, lower, upper = zip(*rows, strict=True)
        solved = milp(
            self.cost,
            constraints=LinearConstraint(matrix, lower, upper),
            integrality=np.full(len(self.cost), integrality),
            bounds=Bounds(0, 1),
        )
        if solved.status == 2:
            return None, None
        assert solved.status == 0, solved.message
        return solved.fun / self.finer, np.flatnonzero(solved.x > 0.5)

    def relaxed(self):
        """Return the least total time if robots could be parted; None if they cannot arrive even so."""
        return self._solve(0)[0]

    def least(self):
        """Return the least total time and the deeds of a plan that takes it; None, None if there is none."""
        total, chosen = self._solve(1)
        if total is None or chosen is None:
            return total, []
        assert abs(total * self.finer - round(total * self.finer)) < 1e-6
        return round(total * self.finer) / self.finer, [self.deeds[i] for i in chosen]

    def ticks_needed(self, total):
        """Return within how many ticks all have arrived in any plan that takes no more than `total`."""
        prices = [self.price_to_destination[at] / self.finer for at in self.start_of_robot.values()]
        least = min([self.scenario.waiting_cost, *(m[1] / m[2] for moves in self.moves.values() for m in moves)])
        return ceil((max(prices) + total - sum(prices)) / least)


def solve_timed(scenario, *, finer=1, most_ticks=10_000):
    """Return the program with ticks enough for any plan that is as good as the best; its relaxation, optimum and deeds.

    Where waiting costs nothing no number of ticks would be enough, so it must cost something.
    """
    assert scenario.waiting_cost > 0
    lone = TimedProgram(scenario, 0, finer=finer)
    if not lone.start_of_robot:
        return lone, 0.0, 0, []
    durations = lone._spread(lone.destinations, 2)
    ticks = ceil(max(durations[at] for at in lone.start_of_robot.values()) / finer) + 2 * scenario.headway
    while ticks < most_ticks:
        program = TimedProgram(scenario, ticks, finer=finer)
        total, deeds = program.least()
        if total is None:
            ticks = ticks * 3 // 2 + 1
        elif program.ticks_needed(total) > ticks:
            ticks = program.ticks_needed(total)
        else:
            return program, program.relaxed(), total, deeds
    raise AssertionError("robots that can arrive do not")


def plan_of_deeds(scenario, program, deeds):
    """Return the plan of an integer optimum, for the judge; moves by the numbers of the directions."""
    assert program.finer == 1
    tessellation = scenario.area.tessellation
    ahead = {(cell, begin): (other, duration) for cell, other, begin, duration in deeds}
    actions = [[] for _ in range(scenario.robot_count)]
    for robot, cell in program.start_of_robot.items():
        time = 0
        while cell not in program.destinations:
            other, duration = ahead[cell, time]
            side = int(tessellation.orientation_of_cell(*cell))
            steps = tessellation.step_of_direction[side].tolist()
            step = [other[0] - cell[0], other[1] - cell[1]]
            actions[robot].append(WAIT if other == cell else steps.index(step))
            cell, time = other, time + duration
    return plan_from_lists(scenario, actions, planner="integer program")
