"""Plan: what each robot does at each step, and what follows from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import repeat
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import PlanError, check_type, is_whole
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans.motion import Motion
from trihex.record import counted, in_one_line, read_only

if TYPE_CHECKING:
    from trihex.kernels.actions import Actions

_NO_ACTIONS = np.empty(0, dtype=np.uint8)
_NO_JUMPS = np.empty((0, 2), dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Plan(Motion):
    """The actions of all robots, one byte each, and the times that follow from them.

    Time runs in steps 1, 2, ...; in each step a robot that has not arrived makes one move or waits, and one that enters
    a destination leaves the area in that step. Where the clock of the scenario is "costs", steps are ticks: a move
    lasts ``scenario.duration_of_direction`` of them, a wait one. Robot r has the actions
    ``actions[first_action[r] : first_action[r + 1]]``; its last one brings it to its destination. A robot that cannot
    arrive, or starts on a destination, has none.

    Parameters
    ----------
    scenario : Scenario
    actions : uint8 array
        A direction number of the tessellation, or `WAIT`. A plan read from a file may hold `JUMP`.
    first_action : int64 array, shape (robots + 1,)
    planner : str
        Name of the planner, for reports.
    optimal : bool
        True only if it is proven that no plan has a smaller sum of t_r.
    jumps : int64 array, shape (m, 2)
        For each `JUMP`, ascending: its index in `actions`, and the number of the cell it leads to. Planners make none;
        they let the audit judge files in which robots do what no robot can.

    Raises
    ------
    PlanError
        If the arrays do not fit each other or the scenario.
    """

    scenario: Scenario
    actions: NDArray[np.uint8]
    first_action: NDArray[np.int64]
    planner: str = ""
    optimal: bool = False
    jumps: NDArray[np.int64] = field(default_factory=lambda: _NO_JUMPS)

    def __post_init__(self) -> None:
        check_type("scenario", self.scenario, Scenario)
        self._set("actions", read_only(np.ascontiguousarray(self.actions, dtype=np.uint8)))
        self._set("first_action", read_only(np.ascontiguousarray(self.first_action, dtype=np.int64)))
        self._set("jumps", read_only(np.ascontiguousarray(self.jumps, dtype=np.int64).reshape(-1, 2)))
        robots, first = self.scenario.robot_count, self.first_action
        if (
            first.shape != (robots + 1,)
            or first[0] != 0
            or first[-1] != self.actions.size
            or first.min() < 0  # or the differences might overflow
            or (np.diff(first) < 0).any()
        ):
            raise PlanError(
                f"first_action must rise from 0 to {self.actions.size} in {robots + 1} entries, one more than robots"
            )
        directions = self.scenario.area.tessellation.direction_count
        odd = np.flatnonzero(self.actions - np.uint8(directions) <= JUMP - directions)  # from directions to JUMP
        bad = odd[self.actions[odd] != JUMP]
        if bad.size:
            raise PlanError(f"actions must be directions 0..{directions - 1} or WAIT, not {self.actions[bad[0]]}")
        if not np.array_equal(odd, self.jumps[:, 0]):
            raise PlanError("jumps must list every JUMP of actions in ascending order")
        if ((self.jumps[:, 1] < 0) | (self.jumps[:, 1] >= self.scenario.area.cell_count)).any():
            raise PlanError("jumps must lead to cells of the area")

    def in_words(self) -> str:
        """Return the planner, the area, how many robots arrive, steps and total time."""
        arrive = f"{np.count_nonzero(self.arrived)} of {counted(self.scenario.robot_count, 'robot')} arrive"
        times = f"{counted(self.steps, self.scenario.step_word)}, total time {self.total_time}"
        return f"{self.planner!r}, {self.scenario.area.in_words()}, {arrive}, {times}"

    @cached_property
    def jump_tables(self) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
        """Index of each jump (closed by one beyond all actions) and the site it leads to, as kernels take them."""
        at = np.append(self.jumps[:, 0], np.iinfo(np.int64).max)
        return read_only(at), self.scenario.area.layout.cell_to_site(np.append(self.jumps[:, 1], 0))

    @cached_property
    def _actions(self) -> Actions:
        from trihex.kernels.actions import Actions
        from trihex.kernels.signatures import given

        jump_at, jump_to = self.jump_tables
        own: Actions = given(
            Actions,
            action=self.actions,
            first=self.first_action,
            offset=self.scenario.area.layout.offset_of_direction,
            jump_at=jump_at,
            jump_to=jump_to,
            slowness=self.scenario.slowness.astype(np.int32),
        )
        return own

    @cached_property
    def _replayed(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Last cell, cost of the moves and number of waits of each robot."""
        from trihex.kernels.signatures import given
        from trihex.plans.kernels import replay as kernels

        area, robots = self.scenario.area, self.scenario.robot_count
        site = np.empty(robots, dtype=np.int32)
        distance, waits = np.empty(robots, dtype=np.int64), np.empty(robots, dtype=np.int64)
        kernels.replay(
            area.layout.cell_to_site(self.scenario.robots),
            self._actions,
            area.tessellation.cost_of_direction,
            given(kernels.Replayed, site=site, distance=distance, waits=waits),
        )
        return read_only(area.layout.site_to_cell(site)), read_only(distance), read_only(waits)

    @cached_property
    def duration_of_action(self) -> NDArray[np.int32]:
        """How many steps (ticks) an action lasts, by its byte: a direction, or `WAIT` and `JUMP`, 1; shape (256,).

        A move of a robot lasts `Scenario.slowness` times as long; see `durations`.
        """
        duration = np.ones(256, dtype=np.int32)
        duration[: self.scenario.area.tessellation.direction_count] = self.scenario.duration_of_direction
        return read_only(duration)

    @cached_property
    def has_steps(self) -> bool:
        """Whether every action lasts one step, so that robot r does ``actions[first_action[r] + s]`` in step s + 1."""
        return bool((self.scenario.duration_of_direction == 1).all()) and not self.scenario.has_slowness

    def durations(self, action: NDArray[np.uint8], slowness: NDArray[np.int64] | np.int64) -> NDArray[np.int64]:
        """Return how many steps (ticks) actions last that are done by robots of such a slowness."""
        return np.asarray(self.duration_of_action[action] * np.where(action < JUMP, slowness, 1), dtype=np.int64)

    @property
    def last_cell_of_robot(self) -> NDArray[np.int64]:
        """Number of the cell in which the actions of each robot end, shape (robots,)."""
        return self._replayed[0]

    @property
    def robots(self) -> NDArray[np.int64]:
        """Start of each robot, a cell number; those of the scenario."""
        return self.scenario.robots

    @cached_property
    def joined(self) -> NDArray[np.int64]:
        """The step after which each robot is in the area: 0."""
        return read_only(np.zeros(self.scenario.robot_count, dtype=np.int64))

    @property
    def ended(self) -> NDArray[np.int64]:
        """The step after which each robot is not in the area any more: that of its arrival, -1 if there is none."""
        return self.arrival_step_of_robot

    @cached_property
    def arrived(self) -> NDArray[np.bool_]:
        """Whether each robot ends on a destination, shape (robots,)."""
        return read_only(np.isin(self.last_cell_of_robot, self.scenario.destinations))

    @cached_property
    def arrival_step_of_robot(self) -> NDArray[np.int64]:
        """The step in which each robot enters its destination, -1 if it never does, shape (robots,)."""
        return read_only(np.where(self.arrived, self.last_step_of_robot, -1))

    @cached_property
    def last_step_of_robot(self) -> NDArray[np.int64]:
        """The step (tick) in which the last action of each robot ends, 0 without any, shape (robots,)."""
        if self.scenario.clock == "steps":
            actions = np.diff(self.first_action)
            if self.scenario.has_slowness:
                moves = actions - self._replayed[2] - self._jumps_of_robot
                actions = actions + (self.scenario.slowness - 1) * moves
            return read_only(actions)
        # Moves and waits last as long as they cost; a jump costs nothing and lasts one tick.
        return read_only(self.time_of_robot + self._jumps_of_robot)

    @cached_property
    def _jumps_of_robot(self) -> NDArray[np.int64]:
        owner = np.searchsorted(self.first_action, self.jumps[:, 0], side="right") - 1
        return read_only(np.bincount(owner, minlength=self.scenario.robot_count))

    @property
    def distance_of_robot(self) -> NDArray[np.int64]:
        """d_r, the cost of the moves of each robot."""
        return self._replayed[1]

    @cached_property
    def waiting_of_robot(self) -> NDArray[np.int64]:
        """w_r, the number of waits of each robot times w_t."""
        return read_only(self._replayed[2] * self.scenario.waiting_cost)

    @cached_property
    def time_of_robot(self) -> NDArray[np.int64]:
        """F_t, the list of t_r = d_r + w_r."""
        return read_only(self.distance_of_robot + self.waiting_of_robot)

    @property
    def steps(self) -> int:
        """Number of steps (ticks) until the last robot has arrived (the makespan)."""
        return int(self.last_step_of_robot.max(initial=0))

    def actions_in(self, step: int) -> NDArray[np.uint8]:
        """Return what each robot does in step 1, 2, ...: a direction, `WAIT` or `JUMP`; `WAIT` if it has no action."""
        from trihex.plans.walk import Walk

        walk = Walk(self)
        walk.skip_to(step - 1)
        return walk.action_of_robot

    def worlds(self) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.int64]]]:
        """Yield barriers and destinations in step 1, 2, ..., `steps`: those of the scenario."""
        yield from repeat((self.scenario.area.barriers, self.scenario.destinations), self.steps)

    def cells_by_step(self) -> Iterator[NDArray[np.int64]]:
        """Yield the cell of each robot after step 0, 1, ..., `steps`; -1 once it has left the area.

        A robot that is on its way, where moves last longer than a step, is in the cell whose centre it left.
        """
        from trihex.plans.walk import Walk

        walk = Walk(self)
        arrival = np.where(self.arrived, self.arrival_step_of_robot, np.iinfo(np.int64).max)
        for step in range(self.steps + 1):
            walk.go_to(step)
            cells = self.scenario.area.layout.site_to_cell(walk.site)
            np.copyto(cells, -1, where=arrival <= step)
            yield cells

    def cells_of_robot(self, robot: int) -> NDArray[np.int64]:
        """Return the path of a robot: numbers of its cells at the start and after each of its actions.

        The last is its destination, if it arrives. (x, y) of them are ``area.cell_to_xy(cells)``; `ticks_of_robot`
        tells when it is there.

        Raises
        ------
        PlanError
            If there is no such robot.

        Examples
        --------
        >>> from trihex import Area, make_plan
        >>> scenario = Scenario(Area("hexagonal", [[0, 0, 0, 0]]), destinations=(3, 0), robots=[(0, 0), (1, 0)])
        >>> make_plan(scenario).cells_of_robot(1).tolist()
        [1, 2, 3]
        """
        first, last = self._range_of_robot(robot)
        layout = self.scenario.area.layout
        offset = layout.offset_of_direction.tolist()
        jumps = dict(zip(*(table.tolist() for table in self.jump_tables), strict=True))
        sites = [int(layout.cell_to_site(self.scenario.robots[robot : robot + 1])[0])]
        for index, action in enumerate(self.actions[first:last].tolist(), first):
            site = sites[-1]
            if action == JUMP:
                site = jumps[index]
            elif action != WAIT:
                site += offset[site & 1][action]
            sites.append(site)
        return layout.site_to_cell(np.array(sites, dtype=np.int32))

    def ticks_of_robot(self, robot: int) -> NDArray[np.int64]:
        """Return the steps (ticks) at which a robot is in the cells of `cells_of_robot`: 0, then when each action ends.

        Raises
        ------
        PlanError
            If there is no such robot.

        Examples
        --------
        >>> from trihex import Area
        >>> scenario = Scenario(Area("square", [[0, 0], [0, 0]]), (1, 0), robots=(0, 1), clock="costs")
        >>> plan_from_lists(scenario, [[WAIT, 4]]).ticks_of_robot(0).tolist()
        [0, 1, 8]
        """
        first, last = self._range_of_robot(robot)
        lasts = self.durations(self.actions[first:last], self.scenario.slowness[robot])
        return np.cumsum(np.append(0, lasts), dtype=np.int64)

    def _range_of_robot(self, robot: int) -> tuple[int, int]:
        robots = self.scenario.robot_count
        if not is_whole(robot) or not 0 <= robot < robots:
            raise PlanError(f"robot must be one of 0..{robots - 1}, not {robot!r:.80}")
        return int(self.first_action[robot]), int(self.first_action[robot + 1])

    def sets_at(self, step: int) -> RobotSets:
        """Return the sets of the paper (section 2.1.1) in step 1, 2, ..., `steps` + 1; who is on its way moves.

        In the step after the last nobody moves any more: `final` holds all robots that arrive, |final| = n, as the
        paper ends.

        Raises
        ------
        PlanError
            If there is no such step.
        """
        if not is_whole(step) or not 1 <= step <= self.steps + 1:
            raise PlanError(f"step must be 1..{self.steps + 1}, the last of them after all is done, not {step!r:.80}")
        from trihex.plans.walk import Walk

        walk = Walk(self)
        walk.skip_to(step - 1)
        return walk.sets()


class RobotSets(NamedTuple):
    """Numbers of the robots in each set of the paper during one step.

    begin: not arrived before the step; filled: those of them that move in it; waiting: those that do not; final:
    arrived before the step. begin = filled + waiting, and begin and final part the robots.
    """

    begin: NDArray[np.int64]
    filled: NDArray[np.int64]
    waiting: NDArray[np.int64]
    final: NDArray[np.int64]

    def __repr__(self) -> str:
        return in_one_line(self)


def plan_from_lists(scenario: Scenario, actions: list[list[int]], **names: Any) -> Plan:
    """Return the plan in which robot r takes ``actions[r]``; for plans made by hand."""
    first = np.cumsum([0, *(len(own) for own in actions)])
    flat = np.array([action for own in actions for action in own], dtype=np.uint8) if first[-1] else _NO_ACTIONS
    return Plan(scenario, flat, first, **names)


def actions_of(plan: Plan) -> Actions:
    """Return the actions of a plan as kernels take them."""
    return plan._actions
