"""Recording: what the robots of a crowd do, block by block, and the plan or the arrivals that it makes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.kernels.codes import WAIT
from trihex.memory import GIB, available_memory
from trihex.planners.crowd import Crowd
from trihex.plans import Arrivals, Plan

Progress = Callable[[int, int], None]
# Below so many bytes nobody asks whether there is room; and the part of what is free that may be taken.
_SMALL = 1 << 26
_PART = 0.9


class Recording:
    """What the robots of a crowd have done so far.

    Parameters
    ----------
    crowd : Crowd
    keeps_actions : bool
        Whether to keep the actions, a byte for each robot and step, or to add up times only.
    """

    def __init__(self, crowd: Crowd, keeps_actions: bool) -> None:
        self.crowd = crowd
        self.keeps_actions = keeps_actions
        self._rows: list[Any] = []  # `Rows` of kernels
        self._kept = 0  # actions in rows
        tessellation = crowd.scenario.area.tessellation
        self._cost_of_action = np.full(WAIT + 1, crowd.scenario.waiting_cost, dtype=np.int64)
        self._cost_of_action[: tessellation.direction_count] = tessellation.cost_of_direction
        self._time = np.zeros(crowd.robot.size, dtype=np.int64)
        #: What all robots have lost: the cost of waits, and of moves beyond what they came nearer.
        self.lost = 0

    @property
    def total_time(self) -> int:
        """Sum of t_r so far and of the distances that are left, which can only grow."""
        return self.crowd.total_distance + self.lost

    @property
    def is_over(self) -> bool:
        """Whether all have arrived."""
        return self.crowd.going == 0

    def run(self, act: Callable[[Any, Any, Any, Any], int], progress: Progress | None, limit: float) -> None:
        """Simulate until all have arrived, or the total time is sure to be `limit` or more.

        ``act(regions, traffic, robots, rows)`` is a kernel that lets the robots of some regions act for a block of
        steps, fills `rows` and returns what they lose; `Traffic`, `Robots` and `Rows` are nouns of kernels.

        Raises
        ------
        TooLargeError
            If the plan takes more memory than is free: before the first step where the ways alone are that long, else
            as soon as what robots have waited makes it so.
        """
        crowd, first_step, block = self.crowd, 0, 0
        going, nouns = crowd.going, crowd.for_kernels()
        while not self.is_over:
            steps, block = self._steps_of_block(first_step), block + 1
            self._check_memory(steps)
            for regions in crowd.parts(steps):
                rows = self._make_rows(int(crowd.count_of_region[regions].sum()), block, first_step, steps)
                self.lost += act(regions, *nouns, rows)
                self._keep(rows)
                if self.total_time >= limit:
                    return
            first_step += steps
            if progress is not None:
                progress(going - crowd.going, going)

    def _steps_of_block(self, first_step: int) -> int:
        """Return how many steps to simulate at a time after so many."""
        return self.crowd.steps_of_block()

    def _make_rows(self, count: int, block: int, first_step: int, steps: int) -> Any:
        """Return empty `Rows` of kernels for so many robots and a block of steps."""
        from trihex.kernels.signatures import given
        from trihex.planners.kernels.rows import Rows

        robot, action = np.empty(count, dtype=np.int32), np.empty(count * steps, dtype=np.uint8)
        return given(Rows, robot=robot, action=action, block=block, first_step=first_step, steps=steps)

    def _check_memory(self, steps: int) -> None:
        """Refuse to go on for so many steps if what is left to record and the plan take more memory than is free.

        The plan is written from rows that are recorded, so for a while there are both. An action costs no more than
        the dearest one, so times tell how many there must be.
        """
        if not self.keeps_actions:
            return
        dearest = int(self._cost_of_action[: self.crowd.scenario.area.tessellation.direction_count].max())
        dearest *= int(self.crowd.slowness.max())
        plan = self.crowd.total_distance // dearest
        plan = max(plan, self.total_time // max(dearest, self.crowd.scenario.waiting_cost))
        need = plan + max(self.crowd.going * steps, plan - self._kept)
        if need < _SMALL:
            return
        free = int(available_memory() * _PART)
        if need > free:
            raise TooLargeError(
                f"the plan would take {need / GIB:.1f} GiB more, if it has no more than {plan} actions, and "
                f"{free / GIB:.1f} GiB are free; plan fewer robots, or keep arrivals only (record='arrivals')"
            )

    def _keep(self, rows: Any) -> None:
        from trihex.planners.kernels.rows import add_times

        if self.keeps_actions:
            self._rows.append(rows)
            self._kept += rows.action.size
        else:
            add_times(rows, self.crowd.arrival, self._cost_of_action, self._time)

    def _by_robot(self, values: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return values of the crowd's robots by their numbers in the scenario, 0 for all others."""
        by_robot = np.zeros(self.crowd.scenario.robot_count, dtype=np.int64)
        by_robot[self.crowd.robot[1:]] = values[1:]
        return by_robot

    def make_plan(self, planner: str) -> Plan:
        """Return the plan, once all have arrived."""
        from trihex.planners.kernels.rows import write_rows

        first_action = np.concatenate([[0], np.cumsum(self._by_robot(self.crowd.arrival))])
        actions = np.empty(first_action[-1], dtype=np.uint8)
        while self._rows:  # one after the other, so that what is written is freed
            write_rows(self._rows.pop(), self.crowd.robot, first_action, actions)
        return Plan(self.crowd.scenario, actions, first_action, planner=planner)

    def make_arrivals(self, planner: str) -> Arrivals:
        """Return the arrivals, once all have arrived."""
        scenario, arrival = self.crowd.scenario, self._by_robot(self.crowd.arrival)
        starts_there = np.isin(scenario.robots, scenario.destinations)
        return Arrivals(
            scenario, np.where((arrival == 0) & ~starts_there, -1, arrival), self._by_robot(self._time), planner
        )
