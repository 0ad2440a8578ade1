"""Recording: the moves of a simulation, step by step, and the plan that they make."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.plan import WAIT, Plan
from trihex.scenario import Scenario

# Robot-steps between two looks at the keyboard: a few hundredths of a second.
BUDGET = 1_000_000
_STEPS = 1 << 14


class Log(NamedTuple):
    """Arrays that a kernel fills: who moved, how, and how many had moved by the end of each step."""

    robot: NDArray[np.int32]
    action: NDArray[np.uint8]
    end: NDArray[np.int64]


@dataclass(eq=False)
class Recording:
    """Moves of robots, in blocks of steps.

    Only moves are kept, 5 bytes each: whatever is not recorded until the arrival of a robot was a wait. Crowds that
    wait cost nothing here, and the plan is laid out once its length is known.
    """

    scenario: Scenario
    robots: int
    blocks: list[tuple[Log, int]] = field(default_factory=list)

    def __post_init__(self) -> None:
        #: The step in which each robot arrives, 0 until then.
        self.arrival = np.zeros(self.scenario.robot_count, dtype=np.int64)
        self._log = self._new_log()

    def _new_log(self) -> Log:
        size = max(BUDGET, 2 * self.robots)
        return Log(np.empty(size, dtype=np.int32), np.empty(size, dtype=np.uint8), np.empty(_STEPS, dtype=np.int64))

    def new_log(self) -> Log:
        """Return arrays to fill next."""
        return self._log

    def keep(self, steps: int) -> None:
        """Keep what was put into the log during `steps` steps."""
        moves = int(self._log.end[steps - 1]) if steps else 0
        robot, action, end = self._log
        self.blocks.append((Log(robot[:moves].copy(), action[:moves].copy(), end[:steps].copy()), steps))

    def make_plan(self, planner: str) -> Plan:
        """Return the plan that was recorded."""
        from trihex.kernels.planning import write_moves

        first_action = np.concatenate([[0], np.cumsum(self.arrival)])
        actions = np.full(first_action[-1], WAIT, dtype=np.uint8)
        first_step = 0
        for log, steps in self.blocks:
            write_moves(*log, steps, first_step, first_action, actions)
            first_step += steps
        return Plan(self.scenario, actions, first_action, planner=planner)
