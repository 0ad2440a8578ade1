"""Arrivals: when each robot of a plan arrives and what that cost, without the ways."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import PlanError, check_type
from trihex.plans.motion import Motion
from trihex.record import Record, counted, read_only


@dataclass(frozen=True, eq=False)
class Arrivals(Record):
    """What remains of a plan if only the times count: 16 bytes a robot in place of a byte a step.

    Parameters
    ----------
    scenario : Scenario
    arrival_step_of_robot : int64 array
        The step in which each robot enters its destination, 0 for those that start there, -1 if it never does.
    time_of_robot : int64 array
        t_r = d_r + w_r, 0 for robots that do not arrive.
    planner : str

    Raises
    ------
    PlanError
        If the arrays have not an entry for each robot, those that joined a run among them.
    """

    scenario: Scenario
    arrival_step_of_robot: NDArray[np.int64]
    time_of_robot: NDArray[np.int64]
    planner: str = ""

    def __post_init__(self) -> None:
        check_type("scenario", self.scenario, Scenario)
        for name in ("arrival_step_of_robot", "time_of_robot"):
            values = np.ascontiguousarray(getattr(self, name), dtype=np.int64)
            robots = max(self.scenario.robot_count, np.size(self.arrival_step_of_robot))
            if values.shape != (robots,):
                raise PlanError(f"{name} must have an entry for each of {robots} robots")
            self._set(name, read_only(values))

    def in_words(self) -> str:
        """Return the planner, the area, how many robots arrive, steps and total time."""
        arrive = f"{np.count_nonzero(self.arrived)} of {counted(self.arrived.size, 'robot')} arrive"
        times = f"{counted(self.steps, self.scenario.step_word)}, total time {self.total_time}"
        return f"{self.planner!r}, {self.scenario.area.in_words()}, {arrive}, {times}"

    @property
    def arrived(self) -> NDArray[np.bool_]:
        """Whether each robot arrives."""
        return self.arrival_step_of_robot >= 0

    @property
    def steps(self) -> int:
        """Number of steps until the last robot has arrived (the makespan)."""
        return int(self.arrival_step_of_robot.max(initial=0))

    @property
    def total_time(self) -> int:
        """Sum of t_r over the robots that arrive."""
        return int(self.time_of_robot.sum())


def make_arrivals(plan: Motion) -> Arrivals:
    """Return the arrivals of a plan or a run; robots that joined a run come last."""
    check_type("plan", plan, Motion)
    return Arrivals(
        plan.scenario, plan.arrival_step_of_robot, np.where(plan.arrived, plan.time_of_robot, 0), plan.planner
    )
