"""Walk: the cells through which the robots of a plan go."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.kernels.codes import JUMP, WAIT
from trihex.plans.motion import Motion
from trihex.plans.plan import Plan, RobotSets, actions_of
from trihex.plans.rows import BUDGET, blocks_of, rows_of_motion, steps_of_actions


class Walk:
    """All robots of a plan, from one step (tick) to a later one.

    Parameters
    ----------
    plan : Plan

    Attributes
    ----------
    step : int
        Where they are, from 0 on.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan, self.step = plan, 0
        # Where moves last longer than a step, 16 bytes a robot tell which action it does, and since when.
        self._cursor = None if plan.has_steps else np.stack([plan.first_action[:-1], 0 * plan.first_action[:-1]])

    @cached_property
    def _follow(self) -> Any:
        from trihex.plans.kernels.replay import follow

        return follow

    @cached_property
    def site(self) -> NDArray[np.int32]:
        """The site whose centre each robot was at last; whoever has no further actions stays, shape (robots,)."""
        return self.plan.scenario.area.layout.cell_to_site(self.plan.scenario.robots)

    def go_to(self, step: int) -> None:
        """Go on to a step that is not before this one."""
        actions, some = actions_of(self.plan), max(1, BUDGET // max(1, step - self.step))
        for first in range(0, self.site.size if step > self.step else 0, some):
            last = min(self.site.size, first + some)
            if self._cursor is None:
                self._follow(actions, first, last, self.step, step, self.site)
            else:
                from trihex.plans.kernels.ticks import follow_ticks

                follow_ticks(actions, self.plan.duration_of_action, first, last, step, *self._cursor, self.site)
        self.step = step

    def skip_to(self, step: int) -> None:
        """Go on as `go_to` does; where actions last one step, without a look at those before: `site` is left behind."""
        if self._cursor is None:
            self.step = step
        else:
            self.go_to(step)

    @property
    def action_of_robot(self) -> NDArray[np.uint8]:
        """What each robot does in the step that follows, `WAIT` for those that have arrived, shape (robots,)."""
        index, acts = self._index_of_action()
        action = np.full(index.size, WAIT, dtype=np.uint8)
        action[acts] = self.plan.actions[index[acts]]
        return action

    def sets(self) -> RobotSets:
        """Return the sets of the paper in the step that follows."""
        is_filled = self.action_of_robot != WAIT
        is_final = self.plan.arrived & (self.plan.last_step_of_robot <= self.step)
        return RobotSets(
            begin=np.flatnonzero(~is_final),
            filled=np.flatnonzero(is_filled),
            waiting=np.flatnonzero(~is_final & ~is_filled),
            final=np.flatnonzero(is_final),
        )

    def next_site(self) -> NDArray[np.int32]:
        """Return the site at which each robot is at the end of what it does in the step that follows."""
        action, site = self.action_of_robot, self.site.copy()
        moves = np.flatnonzero(action < JUMP)
        offset = self.plan.scenario.area.layout.offset_of_direction
        site[moves] += offset[site[moves] & 1, action[moves]]
        jumps = np.flatnonzero(action == JUMP)
        jump_at, jump_to = self.plan.jump_tables
        site[jumps] = jump_to[np.searchsorted(jump_at, self._index_of_action()[0][jumps])]
        return site

    def done(self, share: float) -> NDArray[np.float64] | float:
        """Return how much of what each robot does is done after a share of the step that follows, from 0 to 1."""
        if self._cursor is None:
            return share
        duration = self.plan.durations(self.action_of_robot, self.plan.scenario.slowness)
        return np.asarray((self.step - self._cursor[1] + share) / duration)

    def _index_of_action(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Return which action of the plan each robot does in the step that follows, and whether it does one at all."""
        first = self.plan.first_action
        index = first[:-1] + self.step if self._cursor is None else self._cursor[0]
        return index, index < first[1:]


def visits_of(plan: Motion) -> NDArray[np.int64]:
    """Return how many robots start in or enter each cell, shape (height, width)."""
    from trihex.plans.kernels import replay as kernels

    if not isinstance(plan, Plan):
        return _visits_of_rows(plan)
    layout = plan.scenario.area.layout
    visits = np.zeros(layout.size, dtype=np.int64)
    start, actions = layout.cell_to_site(plan.scenario.robots), actions_of(plan)
    for robot, last in blocks_of(plan):
        kernels.count_visits(start, actions, robot, last, visits)
    return layout.cells_of(visits)  # type: ignore[return-value]


def _visits_of_rows(motion: Motion) -> NDArray[np.int64]:
    first_row, _, cell = rows_of_motion(motion)
    enters = np.append(True, cell[1:] != cell[:-1])[: cell.size]
    enters[first_row[:-1]] = True
    area = motion.scenario.area
    return np.bincount(cell[enters], minlength=area.cell_count).reshape(area.height, area.width)


def count_marked_moves(plan: Plan, marked: NDArray[np.uint16]) -> int:
    """Return how many moves of a plan are marked: bit k of each site, as in `Scenario.moves`, for direction k."""
    from trihex.plans.kernels import replay as kernels

    start, actions = plan.scenario.area.layout.cell_to_site(plan.scenario.robots), actions_of(plan)
    return sum(int(kernels.count_marked(start, actions, robot, last, marked)) for robot, last in blocks_of(plan))


def waits_by_step(plan: Plan) -> NDArray[np.int64]:
    """Return how many robots wait, by an action of their own, in each step (tick) from 0, with none, to `steps`."""
    waiting = np.zeros(plan.steps + 1, dtype=np.int64)
    for robot, last in blocks_of(plan):
        own = slice(*plan.first_action[[robot, last]].tolist())
        ends = steps_of_actions(plan, robot, last)[plan.actions[own] == WAIT]
        waiting += np.bincount(ends, minlength=waiting.size)
    return waiting


def place_of_action(plan: Plan, index: int) -> tuple[int, int]:
    """Return which robot an action is of, and the step (tick) in which it ends."""
    robot = int(np.searchsorted(plan.first_action, index, side="right")) - 1
    return robot, int(plan.ticks_of_robot(robot)[index - plan.first_action[robot] + 1])
