"""Timely: robots that act when it is time, where moves last several ticks or nobody follows before a cell is left."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.fields import DScheme
from trihex.kernels.codes import WAIT
from trihex.planners.crowd import Crowd, make_crowd
from trihex.planners.recording import Progress, Recording
from trihex.planners.slots import Slots
from trihex.plans import Plan


class TickRecording(Recording):
    """What robots have done so far where actions last: as many in each block as each has begun in it."""

    def __init__(self, crowd: Crowd, keeps_actions: bool) -> None:
        super().__init__(crowd, keeps_actions)
        # Until they may begin to move robots wait; those waits are in no row.
        self._count = crowd.start_time
        self._time = crowd.start_time * crowd.scenario.waiting_cost

    def _steps_of_block(self, first_step: int) -> int:
        window = _window_of(self.crowd)
        return min(self.crowd.steps_of_block(), window - first_step % window)

    def _make_rows(self, count: int, block: int, first_step: int, steps: int) -> Any:
        from trihex.kernels.signatures import given
        from trihex.planners.kernels.tick_rows import TickRows

        robot, action = np.empty(count, dtype=np.int32), np.empty(count * steps, dtype=np.uint8)
        used = np.empty(count, dtype=np.uint8)
        return given(TickRows, robot=robot, action=action, used=used, block=block, first_step=first_step, steps=steps)

    def _keep(self, rows: Any) -> None:
        from trihex.planners.kernels.tick_rows import pack

        packed = np.empty(rows.action.size, dtype=np.uint8)
        size = pack(rows, self._cost_of_action, self.crowd.slowness, self._time, packed)
        if self.keeps_actions:
            self._rows.append((rows.robot, rows.used, packed[:size].copy()))
            self._kept += size
            self._count[rows.robot] += rows.used

    def make_plan(self, planner: str) -> Plan:
        """Return the plan, once all have arrived."""
        from trihex.planners.kernels.tick_rows import write_back

        first_action = np.concatenate([[0], np.cumsum(self._by_robot(self._count))])
        actions = np.full(first_action[-1], WAIT, dtype=np.uint8)
        end = np.append(first_action[1:], 0)[self.crowd.robot]
        while self._rows:  # the last first, so that what is written is freed
            write_back(*self._rows.pop(), end, actions)
        return Plan(self.crowd.scenario, actions, first_action, planner=planner)


def simulate(d_scheme: DScheme, rule: Any, keeps_actions: bool, progress: Progress | None, limit: float) -> Recording:
    """Simulate until all have arrived, or the total time is sure to be `limit` or more; `rule` as kernels know it."""
    from trihex.planners.kernels import timely as kernels

    slots = Slots(d_scheme, is_literal=False)
    crowd = make_crowd(d_scheme.n_scheme, slots.find_regions)
    recording = TickRecording(crowd, keeps_actions)
    stage, most = _make_stage(crowd, slots), int(crowd.count_of_region.max())
    agenda = _make_agenda(crowd)
    words = (most >> 6) + 1

    def act(regions: NDArray[np.int64], _traffic: Any, robots: Any, rows: Any) -> int:
        own = agenda._replace(asked=np.empty(words * rows.steps, dtype=np.int64))
        return int(kernels.act(rule, stage, own, regions, robots, rows))

    recording.run(act, progress, limit)
    return recording


def descend_timely(d_scheme: DScheme, keeps_actions: bool, progress: Progress | None, limit: float) -> Recording:
    """Simulate robots that take the first of their best directions that is open, and else wait."""
    from trihex.planners.kernels import choice

    rule = choice.Rule(counts=choice.NOTHING, aside=choice.STAY, period=1, price=0)
    return simulate(d_scheme, rule, keeps_actions, progress, limit)


def _window_of(crowd: Crowd) -> int:
    """Return how many ticks a vertex has bits for, above which there are as many as moves last."""
    from trihex.planners.kernels.claims import BITS

    return min(30, BITS - int(crowd.scenario.duration_of_direction.max() * crowd.slowness.max()))


def _make_stage(crowd: Crowd, slots: Slots) -> Any:
    """Return `Stage` as kernels know it: nobody has left any cell yet."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels import claims as kernels

    scenario, size = crowd.scenario, crowd.scenario.area.layout.size
    duration = scenario.duration_of_direction
    limit = scenario.entry_limit if scenario.entry_limit < duration.size else 0  # no more than that enter at a time
    counts = scenario.destinations.size * int(kernels.AHEAD) if scenario.has_flows else 0
    clock = given(
        kernels.Clock,
        duration=duration,
        slowness=crowd.slowness,
        window=_window_of(crowd),
        follows=scenario.following == "allow",
        shortest=duration.min(),
        headway=scenario.headway // int(duration.min()),
    )
    claims = given(
        kernels.Claims,
        owner=crowd.robot_at,
        left_until=np.zeros(size, dtype=np.int32),
        passed=crowd.passed,
        entered_until=np.zeros(max(1, scenario.destinations.size * limit), dtype=np.int32),
        let_in=np.zeros(counts, dtype=np.int32),
        let_in_at=np.zeros(counts, dtype=np.int32),
    )
    doors = scenario.schedule.for_kernels(scenario.area.layout)
    return kernels.Stage(clock, slots.ways._replace(entry_limit=limit), *slots.for_kernels(), claims, doors)


def _make_agenda(crowd: Crowd) -> Any:
    """Return `Agenda` as kernels know it: everybody is asked as soon as it may begin to move."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels.timely import Agenda

    row, came_from, waiting = np.zeros((3, crowd.robot.size), dtype=np.int32)
    due, done = (crowd.start_time.astype(np.int32) for _ in range(2))
    captain, asked = np.zeros(crowd.count_of_region.size, dtype=np.int32), np.empty(0, dtype=np.int64)
    return given(
        Agenda,
        due=due,
        done=done,
        row=row,
        came_from=came_from,
        captain_of_region=captain,
        asked=asked,
        waiting=waiting,
    )
