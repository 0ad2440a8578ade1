"""Straighten: among plans of equal cost and equal arrivals one in which robots turn less."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, Tessellation, check_as_fast
from trihex.errors import PlanError, TooLargeError, check_type, check_whole
from trihex.fields import make_n_scheme
from trihex.planners.reservations import Reservations
from trihex.plans import Plan, turning_of_robot

# Turns count in hundredths of a degree.
_UNITS = 100
# States of one robot; who might be in more of them keeps its way.
_MOST_STATES = 4_000_000


def straighten(
    plan: Plan,
    *,
    rounds: int = 3,
    memory_limit: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Plan:
    """Return a plan in which each robot arrives in the same step, at no more cost, and robots turn less.

    Robot by robot, those that turn most first, each takes the straightest of its cheapest ways in space and time that
    arrives in the same step, past the ways of all others; until nothing changes, or for so many rounds. So a robot
    turns more only where that is cheaper, as it may be after a planner that makes detours.

    Parameters
    ----------
    plan : Plan
        One that keeps the rules.
    rounds : int
    memory_limit : int, optional
        In bytes, of the tables of what is reserved. Default: 80 % of what is available.
    progress : callable, optional
        Called with (robots done, robots) in each round.

    Raises
    ------
    PlanError
        If a robot does what no robot can, or if moves last or nobody may follow at once.
    TooLargeError
        If the tables would take more than `memory_limit`.

    Examples
    --------
    >>> from trihex import Area, Scenario, make_plan
    >>> scenario = Scenario(Area("square", [[0] * 4] * 4), destinations=[(3, 2)], robots=[(0, 0)])
    >>> plan = straighten(make_plan(scenario))
    >>> turning_of_robot(plan).tolist(), plan.total_time
    ([45.0], 38)
    """
    check_type("plan", plan, Plan)
    check_whole("rounds", rounds, 0, None, PlanError)
    check_straightenable(plan.scenario)
    if plan.jumps.size:
        raise PlanError("plan must keep the rules to be straightened: a robot jumps")
    ways = _Ways(plan, memory_limit)
    for _ in range(rounds):
        turning = turning_of_robot(ways.as_plan())
        order = np.argsort(-turning, kind="stable")
        changed = 0
        for done, robot in enumerate(order[turning[order] > 0].tolist(), 1):
            changed += ways.straighten(robot)
            if progress is not None and done % 16 == 0:
                progress(done, order.size)
        if not changed:
            break
    return ways.as_plan()


def check_straightenable(scenario: Scenario) -> None:
    """Raise unless plans of the scenario can be straightened: PlanError for its rules, TooLargeError for its area."""
    check_as_fast(scenario, "to straighten a plan one")
    if not scenario.is_stepwise:
        raise PlanError(
            "plan must have moves of one step, and robots that may follow at once, to be straightened, not "
            f"clock {scenario.clock!r} and following {scenario.following!r}"
        )
    headings = len(_turn_of_headings(scenario.area.tessellation))
    if scenario.area.layout.size * headings >= 2**31:
        raise TooLargeError(f"to straighten a plan an area may have some {2**31 // headings} cells at most")


class _Ways:
    """The ways of all robots, and what they take in space and time."""

    def __init__(self, plan: Plan, memory_limit: int | None) -> None:
        self.plan = plan
        self._actions = plan.actions.copy()
        layout, tessellation = plan.scenario.area.layout, plan.scenario.area.tessellation
        self._starts = layout.cell_to_site(plan.scenario.robots).tolist()
        self._reservations = Reservations(make_n_scheme(plan.scenario), memory_limit)
        self._turn = _turn_of_headings(tessellation)
        self._make_layers(1 << 12)
        self._reservations.make_room(plan.steps + 1)
        self._robots = np.flatnonzero(plan.arrived & (np.diff(plan.first_action) > 0))
        for robot in self._robots.tolist():
            self._reservations.reserve(self._starts[robot], self._way(robot))
        self._times = plan.time_of_robot

    def _way(self, robot: int) -> NDArray[np.uint8]:
        first = self.plan.first_action
        return self._actions[first[robot] : first[robot + 1]]

    def _make_layers(self, size: int) -> None:
        from trihex.kernels.signatures import given
        from trihex.planners.kernels.straight import Layers

        states = self.plan.scenario.area.layout.size * len(self._turn)
        self._layers = given(
            Layers,
            state=np.empty(size, dtype=np.int32),
            key=np.empty(size, dtype=np.int64),
            parent=np.empty(size, dtype=np.int32),
            action=np.empty(size, dtype=np.uint8),
            place=np.full(states, -1, dtype=np.int32),
        )

    def straighten(self, robot: int) -> bool:
        """Give a robot a straighter way if there is one, and tell whether it has another one now."""
        from trihex.planners.kernels import straight as kernels

        if not self.plan.arrived[robot]:
            return False
        way, start, reservations = self._way(robot), self._starts[robot], self._reservations
        reservations.unreserve(start, way)
        found, key = np.empty_like(way), kernels.LIST_FULL
        while key == kernels.LIST_FULL:
            limits = (int(self.plan.scenario.start_times[robot]), int(self._times[robot]))
            key = reservations.straighten_way(start, *limits, self._turn, self._layers, found)
            if key == kernels.LIST_FULL:
                if 2 * self._layers.state.size > _MOST_STATES:
                    break
                self._make_layers(2 * self._layers.state.size)
        is_better = key >= 0 and key < self._key_of(robot, way)
        if is_better:
            way[:] = found
        reservations.reserve(start, way)
        return is_better

    def _key_of(self, robot: int, way: NDArray[np.uint8]) -> int:
        """Return cost and turns of a way as one number, the cost first."""
        from trihex.planners.kernels.straight import COST_BIT

        one = replace(
            self.plan,
            scenario=self.plan.scenario.with_robots(self.plan.scenario.robots[robot : robot + 1]),
            actions=way,
            first_action=np.array([0, way.size]),
        )
        return (int(one.time_of_robot[0]) << COST_BIT) + round(_UNITS * float(turning_of_robot(one)[0]))

    def as_plan(self) -> Plan:
        """Return the plan as it is now."""
        return replace(self.plan, actions=self._actions.copy())


def _turn_of_headings(tessellation: Tessellation) -> NDArray[np.int32]:
    """Return by how much a robot turns from one heading to another; the last is that before its first move."""
    heading = tessellation.heading_of_direction.reshape(-1)
    change = np.abs(heading[:, None] - heading) % 360
    turns = np.zeros((heading.size + 1, heading.size + 1), dtype=np.int32)
    turns[:-1, :-1] = np.rint(_UNITS * np.minimum(change, 360 - change))
    return turns
