"""Dependencies: which robot may leave for which waypoint only after which other, so that a plan needs no clock."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, check_as_fast
from trihex.errors import PlanError, check_type
from trihex.kernels.codes import WAIT
from trihex.plans.plan import Plan
from trihex.plans.rows import cells_of_rows, steps_of_actions
from trihex.plans.turns import in_turn
from trihex.record import Record, counted, read_only

Ints = NDArray[np.int64]

_NEVER = np.iinfo(np.int64).max
# Waypoints looked at in one call of the kernel, some 0.1 s.
_BUDGET = 5_000_000


@dataclass(frozen=True, eq=False)
class Dependencies(Record):
    """The waypoints of all robots, and which of them must have been reached before a robot may leave for another.

    Robots that keep to it may drive at any speed and stop anywhere: what a robot owns while it moves (two cells, a
    lattice vertex, a place in a destination) it owns alone. None waits for ever, unless it is part of a ring.

    Waypoints are the cells of a robot without its waits, from 0, where it starts. They are numbered robot by robot:
    waypoint i of robot r is ``first_waypoint[r] + i``.

    Parameters
    ----------
    plan : Plan
    first_waypoint : int64 array, shape (robots + 1,)
    cell_of_waypoint, step_of_waypoint : int64 arrays
        Its cell, and the step (tick) in which the plan reaches it.
    waits : int64 array, shape (dependencies, 4)
        Robot, waypoint, other, other's waypoint: `robot` may leave for that waypoint only when `other` has reached its
        own. None of them is implied by the others.
    implied : int
        How many more there were that these imply.
    rings : tuple of int64 arrays, shape (robots in the ring, 2)
        Robots and waypoints of those that wait for each other in a circle: in the plan they all move at once, which
        without a common clock they cannot. There are none where following is forbidden.
    """

    plan: Plan
    first_waypoint: Ints
    cell_of_waypoint: Ints
    step_of_waypoint: Ints
    waits: Ints
    implied: int
    rings: tuple[Ints, ...]

    def __post_init__(self) -> None:
        check_type("plan", self.plan, Plan)
        for name in ("first_waypoint", "cell_of_waypoint", "step_of_waypoint", "waits"):
            self._set(name, read_only(getattr(self, name)))

    def in_words(self) -> str:
        """Return how many robots, waypoints, dependencies and rings there are."""
        robots, waypoints = self.first_waypoint.size - 1, self.cell_of_waypoint.size
        counts = [counted(robots, "robot"), counted(waypoints, "waypoint"), f"{len(self.waits)} dependencies"]
        return ", ".join([*counts, *([counted(len(self.rings), "ring")] if self.rings else [])])

    @cached_property
    def sentence(self) -> str:
        """Whether robots need a common clock, in a sentence."""
        if self.plan.scenario.following == "forbid":
            return "Nobody enters a cell that is still being left: safe at any speed, with any stops."
        rings = "This plan has none, so it is safe at any speed, with any stops."
        if self.rings:
            one = ", ".join(str(robot) for robot in self.rings[0][:8, 0].tolist())
            rings = f"This plan has {len(self.rings)}, such as that of robots {one}: its dependencies wait in a circle."
        return f"Robots follow each other closely; rings of robots that all move at once need a common clock. {rings}"


@dataclass(frozen=True)
class _Waypoints:
    """Waypoints by number, and what robots do with them; half ticks are whole numbers, tick t is 2t."""

    robot: Ints
    cell: Ints
    step: Ints
    start: Ints  # the waypoint with which its robot starts
    begin: Ints  # the half tick in which the move to it begins; -1 for starts, as for the next two
    middle: Ints
    end: Ints
    vertex: Ints  # the lattice vertex that the move to it passes, which others may not; -1 if none

    @cached_property
    def is_start(self) -> NDArray[np.bool_]:
        return np.asarray(self.start == np.arange(self.start.size))

    @cached_property
    def is_last(self) -> NDArray[np.bool_]:
        return np.append(self.is_start[1:], True)


def check_orderable(scenario: Scenario) -> None:
    """Raise PlanError unless the order of a plan is all that its rules ask for: a flow is a rule of times."""
    check_as_fast(scenario, "an order of who waits for whom")
    if scenario.has_flows:
        raise PlanError("dependencies tell who waits for whom, not for how long: doors must have no flow")


def make_dependencies(plan: Plan) -> Dependencies:
    """Return who must wait for whom, so that a plan can be executed at any speed.

    A robot may begin a move when whoever owned the cell that it enters before, or the lattice vertex that it passes,
    has reached the next waypoint; and a destination that takes c robots at a time, when one of those c is inside.

    Parameters
    ----------
    plan : Plan
        A safe one.

    Raises
    ------
    PlanError
        If two robots own one thing at one time, a robot goes where it cannot, or on from a destination, or one jumps.

    Examples
    --------
    >>> from trihex import Area, Scenario, make_plan
    >>> area = Area("hexagonal", [[0, 0, 0, 0]])
    >>> scenario = Scenario(area, destinations=(3, 0), robots=[(0, 0), (1, 0)], following="forbid")
    >>> dependencies = make_dependencies(make_plan(scenario))
    >>> dependencies, dependencies.waits
    (Dependencies(2 robots, 7 waypoints, 2 dependencies), array([[0, 1, 1, 1],
           [0, 2, 1, 2]]))
    """
    check_type("plan", plan, Plan)
    if plan.jumps.size:
        raise PlanError("a plan in which robots jump has no dependencies")
    check_orderable(plan.scenario)
    points = _waypoints_of(plan)
    _check_moves(plan, points)
    is_inside = np.isin(points.cell, plan.scenario.destinations)
    goes_on = np.flatnonzero(is_inside & ~points.is_last)
    if goes_on.size:
        raise PlanError(f"dependencies need a safe plan; robot {points.robot[goes_on[0]]} goes on from a destination")
    pairs = [_visits(plan, points, is_inside), _passings(plan, points), _entries(plan, points, is_inside)]
    later, earlier = np.concatenate(pairs, axis=1)
    differs = points.robot[later] != points.robot[earlier]
    rings = _rings(points, *pairs[0])
    size = points.cell.size
    keys = np.unique(later[differs] * size + earlier[differs])
    later, earlier = np.divmod(keys, max(1, size))
    kept = _kept(points, later, earlier)
    later, earlier = later[kept], earlier[kept]
    waits = [points.robot[later], later - points.start[later], points.robot[earlier], earlier - points.start[earlier]]
    first = np.append(np.flatnonzero(points.is_start), size)
    implied = int(kept.size - later.size)
    return Dependencies(plan, first, points.cell, points.step, np.stack(waits, axis=1), implied, rings)


def _check_moves(plan: Plan, points: _Waypoints) -> None:
    """Raise PlanError if a robot goes where no rule lets it go, such as out of the area."""
    layout, moves = plan.scenario.area.layout, np.flatnonzero(~points.is_start)
    site = layout.cell_to_site(points.cell[moves - 1])
    is_open = plan.scenario.moves[np.clip(site, 0, layout.size - 1)] >> plan.actions[plan.actions != WAIT] & 1
    if not is_open.all():
        wrong = moves[np.argmin(is_open)]  # of its robot the first, so up to there cells are right
        when = f"{plan.scenario.step_word} {points.step[wrong]}"
        raise PlanError(f"dependencies need a safe plan; up to {when} robot {points.robot[wrong]} goes where it cannot")


def _waypoints_of(plan: Plan) -> _Waypoints:
    scenario, layout = plan.scenario, plan.scenario.area.layout
    first_row = plan.first_action + np.arange(plan.first_action.size)
    is_action = np.ones(first_row[-1], dtype=bool)
    is_action[first_row[:-1]] = False
    action = np.full(is_action.size, WAIT, dtype=np.uint8)
    action[is_action] = plan.actions
    step = np.zeros(is_action.size, dtype=np.int64)
    step[is_action] = steps_of_actions(plan)
    kept = ~is_action | (action != WAIT)
    robot = np.repeat(np.arange(scenario.robot_count), np.diff(first_row))[kept]
    cell, step, action = cells_of_rows(plan, first_row)[kept], step[kept], action[kept]
    start = np.flatnonzero(~is_action[kept])[robot]
    duration = plan.duration_of_action[action].astype(np.int64)
    is_start = ~is_action[kept]
    begin, middle, end = (np.where(is_start, -1, 2 * step - part * duration) for part in (2, 1, 0))
    vertex = np.full(cell.size, -1, dtype=np.int64)
    passes = np.flatnonzero((action >= scenario.first_vertex_move) & (action != WAIT))
    site = layout.cell_to_site(cell[passes - 1])
    vertex[passes] = site + layout.vertex_of_direction[site & 1, action[passes]]
    return _Waypoints(robot, cell, step, start, begin, middle, end, vertex)


def _refuse(plan: Plan, points: _Waypoints, one: int, other: int, words: str) -> PlanError:
    both = f"{points.robot[one]} and {points.robot[other]}"
    when = f"{plan.scenario.step_word} {max(points.step[one], points.step[other])}"
    return PlanError(f"dependencies need a safe plan; up to {when} robots {both} {words}")


def _visits(plan: Plan, points: _Waypoints, is_inside: NDArray[np.bool_]) -> tuple[Ints, Ints]:
    """Return moves, and the waypoints that whoever owned the cell before must have reached."""
    forbids = plan.scenario.following == "forbid"
    at = np.flatnonzero(~is_inside)
    came = (points.begin if forbids else points.middle)[at]
    after = np.where(points.is_last[at], 0, at + 1)
    went = np.where(points.is_last[at], _NEVER, (points.end if forbids else points.middle)[after])
    is_free, last, first = in_turn(came, went, points.cell[at])
    if not is_free.all():
        wrong = int(np.argmin(is_free))
        one, other = int(at[first[wrong]]), int(at[last[wrong]])
        where = plan.scenario.area.name_of_cell(int(points.cell[other]))
        raise _refuse(plan, points, one, other, f"are both in {where}")
    return at[last], after[first]


def _passings(plan: Plan, points: _Waypoints) -> tuple[Ints, Ints]:
    """Return moves, and those that passed the same lattice vertex before."""
    at = np.flatnonzero(points.vertex >= 0)
    is_free, last, first = in_turn(points.begin[at], points.end[at], points.vertex[at])
    if not is_free.all():
        wrong = int(np.argmin(is_free))
        raise _refuse(plan, points, int(at[first[wrong]]), int(at[last[wrong]]), "pass one lattice vertex")
    return at[last], at[first]


def _entries(plan: Plan, points: _Waypoints, is_inside: NDArray[np.bool_]) -> tuple[Ints, Ints]:
    """Return moves into destinations, and those that must have ended before: the first to end goes first."""
    capacity = plan.scenario.entry_limit
    at = np.flatnonzero(is_inside & ~points.is_start)
    if not 0 < capacity < at.size:
        return at[:0], at[:0]
    came = (points.begin if plan.scenario.following == "forbid" else points.middle)[at]
    is_free, last, first = in_turn(came, points.end[at], points.cell[at], capacity)
    if not is_free.all():
        wrong = int(np.argmin(is_free))
        words = f"are more than the {counted(capacity, 'robot')} that enter a destination at a time"
        raise _refuse(plan, points, int(at[first[wrong]]), int(at[last[wrong]]), words)
    return at[last], at[first]


def _rings(points: _Waypoints, later: Ints, earlier: Ints) -> tuple[Ints, ...]:
    """Return the rings of robots that enter the cell of the next just when that one leaves it."""
    at_once = (points.middle[later] == points.middle[earlier]) & (later != earlier)
    follows = np.arange(points.cell.size)
    ends = np.zeros(points.cell.size, dtype=bool)
    follows[later[at_once]] = earlier[at_once]
    ends[follows == np.arange(follows.size)] = True
    goal = follows.copy()
    for _ in range(int(at_once.sum()).bit_length()):  # everyone goes on twice as far each time, and ends up in a ring
        goal = goal[goal]
    left = set(goal[~ends[goal]].tolist())
    rings = []
    while left:
        ring = [min(left)]
        while (follower := int(follows[ring[-1]])) != ring[0]:
            ring.append(follower)
        left -= set(ring)
        own = np.array(ring)
        rings.append(read_only(np.stack([points.robot[own], own - points.start[own]], axis=1)))
        if len(ring) == 2:
            one, other = points.robot[own].tolist()
            raise PlanError(f"dependencies need a safe plan; robots {one} and {other} exchange cells")
    return tuple(rings)


def _kept(points: _Waypoints, later: Ints, earlier: Ints) -> NDArray[np.bool_]:
    """Return which dependencies the others do not imply; they are sorted by `later`."""
    from trihex.kernels.signatures import given
    from trihex.plans.kernels import implied as kernels

    size = points.cell.size
    kept = np.ones(later.size, dtype=bool)
    waiting = given(
        kernels.Waiting,
        first=np.searchsorted(later, np.arange(size + 1)),
        earlier=earlier,
        start=points.start,
        moment=points.middle,
        kept=kept,
        seen=np.full(size, -1, dtype=np.int64),
        stack=np.empty(size, dtype=np.int64),
    )
    waypoint = 0
    while waypoint < size:
        waypoint = kernels.drop_implied(waiting, waypoint, _BUDGET)
    return kept
