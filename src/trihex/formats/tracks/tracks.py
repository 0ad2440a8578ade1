"""Tracks: where each robot of a plan is in the world, in metres and seconds; what all writers of motion write."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario
from trihex.errors import FormatError
from trihex.kernels.codes import WAIT
from trihex.plans import Plan, cells_of_rows, place_of_action, steps_of_actions
from trihex.record import Record, read_only


@dataclass(frozen=True, eq=False)
class Tracks(Record):
    """The places of all robots, robot by robot; between two of them a robot moves in a straight line.

    Robot r has the rows ``first_row[r]`` to ``first_row[r + 1] - 1``: one for each step from 0; by the clock "costs"
    one where it starts, and where each move and each row of waits ends. It leaves the world with its last row, in which
    it arrives. One that never arrives has rows to the last step of the plan.

    Attributes
    ----------
    scenario : Scenario
        What was planned.
    seconds_per_step : float
        Of a tick by the clock "costs".
    first_row : int64 array, shape (robots + 1,)
    step : int64 array, shape (rows,)
    x, y : float64 arrays, shape (rows,)
        In metres, in the world.
    yaw : float64 array, shape (rows,)
        Where the robot will go next, in radians, anticlockwise from the east; while it waits, where it will go then; in
        the end, where it came from.
    arrived : bool array, shape (robots,)
    """

    scenario: Scenario
    seconds_per_step: float
    first_row: NDArray[np.int64]
    step: NDArray[np.int64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    yaw: NDArray[np.float64]
    arrived: NDArray[np.bool_]

    def __post_init__(self) -> None:
        for name in ("first_row", "step", "x", "y", "yaw", "arrived"):
            self._set(name, read_only(getattr(self, name)))

    @property
    def area(self) -> Area:
        """The area, which has a frame."""
        return self.scenario.area

    @property
    def robot_count(self) -> int:
        """Number of robots."""
        return int(self.first_row.size - 1)

    @property
    def seconds(self) -> NDArray[np.float64]:
        """Time of each row."""
        return np.asarray(self.step * self.seconds_per_step)

    @property
    def robot(self) -> NDArray[np.int64]:
        """Robot of each row."""
        return np.repeat(np.arange(self.robot_count), np.diff(self.first_row))

    def rows_of(self, robot: int) -> slice:
        """Return the rows of a robot."""
        return slice(int(self.first_row[robot]), int(self.first_row[robot + 1]))

    def frames(self) -> Frames:
        """Return where all robots are, step (tick) by step; one on its way is between two centres, in a straight line.

        A robot is in the frame of the step in which it arrives, its last.
        """
        after = np.append(self.step[1:], 0)[: self.step.size]
        is_last = np.zeros(self.step.size, dtype=bool)
        is_last[self.first_row[1:] - 1] = True
        frames = np.where(is_last, 1, after - self.step)  # from each row up to the next of its robot
        row = np.repeat(np.arange(frames.size), frames)
        later = np.arange(row.size) - np.repeat(np.cumsum(frames) - frames, frames)
        share, next_row = later / frames[row], np.where(is_last[row], row, row + 1)
        x, y = (own[row] + share * (own[next_row] - own[row]) for own in (self.x, self.y))
        step, robot = self.step[row] + later, self.robot[row]
        order = np.lexsort((robot, step))
        return Frames(step[order], robot[order], x[order], y[order], self.yaw[row][order])


class Frames(NamedTuple):
    """Where robots are in each step (tick), step by step and in each by number; x, y in metres, yaw in radians."""

    step: NDArray[np.int64]
    robot: NDArray[np.int64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    yaw: NDArray[np.float64]


def make_tracks(plan: Plan, speed: float = 1.0) -> Tracks:
    """Return the tracks of a plan whose area has a frame.

    All moves take as long: a step lasts as the longest move of the tessellation does at `speed`, so that no robot is
    ever faster. By the clock "costs" a tick lasts as the farthest way does that a robot goes in a tick.

    Parameters
    ----------
    plan : Plan
    speed : float
        Metres in a second.

    Raises
    ------
    AreaError
        If the area has no frame.
    FormatError
        If the speed is not above 0, or a robot jumps.
    """
    if not isinstance(speed, Real) or not 0 < speed < float("inf"):
        raise FormatError(f"speed must be above 0 metres in a second, not {speed!r}")
    if plan.jumps.size:
        at = int(plan.jumps[0, 0])
        robot, step = place_of_action(plan, at)
        raise FormatError(f"robot {robot} jumps in {plan.scenario.step_word} {step}, as no robot can; check the plan")
    area = plan.scenario.area
    frame = area.metres
    first_row, step, cells = _rows_by_step(plan) if plan.scenario.clock == "steps" else _rows_by_move(plan)
    x, y = area.cell_to_metres(cells)
    return Tracks(
        plan.scenario,
        area.tessellation.longest_tick * frame.cell_size / speed,
        first_row,
        step,
        x,
        y,
        _yaw(x, y, first_row, frame.yaw),
        plan.arrived,
    )


def _rows_by_step(plan: Plan) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the first row of each robot, and the step and the cell of each row, one for each step."""
    length = np.where(plan.arrived, np.diff(plan.first_action), plan.steps)
    first_row = np.concatenate([[0], np.cumsum(length + 1)])
    cells = cells_of_rows(plan, first_row)
    return first_row, np.arange(cells.size) - np.repeat(first_row[:-1], length + 1), cells


def _rows_by_move(plan: Plan) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the same with a row for each start and move, and one where waits end: they last but a tick each."""
    stays = ~plan.arrived & (plan.last_step_of_robot < plan.steps)
    length = np.diff(plan.first_action) + 1 + stays
    first_row = np.concatenate([[0], np.cumsum(length)])
    cells = cells_of_rows(plan, first_row)
    is_last = np.zeros(cells.size, dtype=bool)
    is_last[first_row[1:] - 1] = True
    is_start = np.zeros(cells.size, dtype=bool)
    is_start[first_row[:-1]] = True
    is_action = ~is_start
    is_action[first_row[1:][stays] - 1] = False
    step = np.where(is_start, 0, plan.steps)
    step[is_action] = steps_of_actions(plan)
    is_wait = ~is_start
    is_wait[is_action] = plan.actions == WAIT
    kept = ~is_wait | is_last | ~np.append(is_wait[1:], False)
    robot = np.repeat(np.arange(length.size), length)
    first_row = np.concatenate([[0], np.cumsum(np.bincount(robot[kept], minlength=length.size))])
    return first_row, step[kept], cells[kept]


def _yaw(
    x: NDArray[np.float64], y: NDArray[np.float64], first_row: NDArray[np.int64], default: float
) -> NDArray[np.float64]:
    """Return the direction of the next move at each row, or of the last one; `default` for robots that never move."""
    rows = np.arange(x.size)
    begins = np.repeat(first_row[:-1], np.diff(first_row))
    ends = np.repeat(first_row[1:], np.diff(first_row))
    moves = np.flatnonzero((np.diff(x) != 0) | (np.diff(y) != 0))
    moves = moves[ends[moves] > moves + 1]  # not from one robot to the next
    if moves.size == 0:
        return np.full(x.size, default)
    heading = np.arctan2(y[moves + 1] - y[moves], x[moves + 1] - x[moves])
    after = np.minimum(np.searchsorted(moves, rows), moves.size - 1)
    before = np.maximum(np.searchsorted(moves, rows) - 1, 0)
    has_after = (moves[after] >= rows) & (moves[after] < ends)
    has_before = (moves[before] >= begins) & (moves[before] < rows)
    return np.where(has_after, heading[after], np.where(has_before, heading[before], default))
