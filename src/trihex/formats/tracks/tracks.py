"""Tracks: where each robot of a plan or a run is, in metres and seconds; what all writers of waypoints write."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario, seconds_per_step
from trihex.errors import FormatError
from trihex.plans import Motion, Plan, place_of_action, rows_of_motion
from trihex.record import Record, read_only


@dataclass(frozen=True, eq=False)
class Tracks(Record):
    """The places of all robots, robot by robot; between two of them a robot moves in a straight line.

    Robot r has the rows ``first_row[r]`` to ``first_row[r + 1] - 1``, one for each step from 0, or from the step after
    which it joined a run; by the clock "costs" one where it starts, and where each move and each row of waits ends. It
    leaves the world with its last row, in which it arrives. One that never arrives, and does not leave, has rows to the
    last step. Where robots take time to turn, there are two rows a step: when it ends, and when all robots have turned
    and the next move begins.

    Attributes
    ----------
    scenario : Scenario
        What was planned.
    seconds_per_step : float
        Of a tick by the clock "costs".
    first_row : int64 array, shape (robots + 1,)
    step : int64 array, shape (rows,)
        The step that has ended.
    seconds : float64 array, shape (rows,)
    x, y : float64 arrays, shape (rows,)
        In metres, in the world.
    yaw : float64 array, shape (rows,)
        Where the robot will go next, in radians, anticlockwise from the east; while it waits, where it will go then; in
        the end, and before it turns, where it came from.
    arrived : bool array, shape (robots,)
    frame_id : str
        What ROS calls the frame of x and y.
    """

    scenario: Scenario
    seconds_per_step: float
    first_row: NDArray[np.int64]
    step: NDArray[np.int64]
    seconds: NDArray[np.float64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    yaw: NDArray[np.float64]
    arrived: NDArray[np.bool_]
    frame_id: str = "map"

    def __post_init__(self) -> None:
        for name in ("first_row", "step", "seconds", "x", "y", "yaw", "arrived"):
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
    def robot(self) -> NDArray[np.int64]:
        """Robot of each row."""
        return np.repeat(np.arange(self.robot_count), np.diff(self.first_row))

    @property
    def ends_step(self) -> NDArray[np.bool_]:
        """Whether a step ends with each row; the others tell where robots are once they have turned."""
        return np.append(True, (np.diff(self.step) != 0) | (np.diff(self.robot) != 0))[: self.step.size]

    def rows_of(self, robot: int) -> slice:
        """Return the rows of a robot."""
        return slice(int(self.first_row[robot]), int(self.first_row[robot + 1]))

    def frames(self) -> Frames:
        """Return where all robots are, step (tick) by step; one on its way is between two centres, in a straight line.

        A robot is in the frame of the step in which it arrives, its last.
        """
        own = np.flatnonzero(self.ends_step)
        step, robot = self.step[own], self.robot[own]
        is_last = np.append(np.diff(robot) > 0, True)[: own.size]
        frames = np.where(is_last, 1, np.append(step[1:], 0)[: own.size] - step)  # up to the next row of its robot
        row = np.repeat(np.arange(own.size), frames)
        later = np.arange(row.size) - np.repeat(np.cumsum(frames) - frames, frames)
        share, next_row = later / frames[row], np.where(is_last[row], row, row + 1)
        x, y = (at[own[row]] + share * (at[own[next_row]] - at[own[row]]) for at in (self.x, self.y))
        step, robot, yaw = step[row] + later, robot[row], self.yaw[own[row]]
        order = np.lexsort((robot, step))
        return Frames(step[order], robot[order], x[order], y[order], yaw[order])


class Frames(NamedTuple):
    """Where robots are in each step (tick), step by step and in each by number; x, y in metres, yaw in radians."""

    step: NDArray[np.int64]
    robot: NDArray[np.int64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    yaw: NDArray[np.float64]


def check_speed(speed: float) -> None:
    """Raise FormatError unless a speed is above 0."""
    if not isinstance(speed, Real) or not 0 < speed < float("inf"):
        raise FormatError(f"speed must be above 0 metres in a second, not {speed!r}")


def make_tracks(motion: Motion, speed: float = 1.0, *, turn_time: float = 0.0, frame_id: str = "map") -> Tracks:
    """Return the tracks of a plan or a run whose area has a frame.

    All moves take as long: a step lasts as the longest move of the tessellation does at `speed`, so that no robot is
    ever faster, and `turn_time` before it. By the clock "costs" a tick lasts as the farthest way does that a robot goes
    in a tick.

    Parameters
    ----------
    motion : Plan or Run
    speed, turn_time : float
        See `trihex.areas.seconds_per_step`.
    frame_id : str

    Raises
    ------
    AreaError
        If the area has no frame.
    FormatError
        If the speed is not above 0, a robot jumps, or all are to turn where they never stand all at once.
    """
    area = motion.scenario.area
    _check_no_jump(motion)
    duration, frame = seconds_per_step(area, speed, turn_time), area.metres
    if not (frame_id.isprintable() and frame_id.strip()):
        raise FormatError(f"frame_id must be a name in one line, not {frame_id!r:.80}")
    first_row, step, cells = _rows(motion)
    x, y = area.cell_to_metres(cells)
    yaw, seconds = yaw_of_rows(x, y, first_row, frame.yaw), np.asarray(step * duration)
    if turn_time:
        # All but the last row of a robot are there twice: before it turns, heading where it came from, and after.
        last = np.zeros(x.size, dtype=bool)
        last[first_row[1:] - 1] = True
        rows = np.repeat(np.arange(x.size), np.where(last, 1, 2))
        is_after = np.append(False, rows[1:] == rows[:-1])[: rows.size]
        begins = np.isin(rows, first_row[:-1])
        came = np.append(yaw[:1], yaw[:-1])  # the way of the move before, or that of the one to come while it stood
        yaw = np.where(is_after | begins | last[rows], yaw[rows], came[rows])
        step, x, y, seconds = step[rows], x[rows], y[rows], seconds[rows] + turn_time * is_after
        first_row = np.append(0, np.cumsum(2 * np.diff(first_row) - 1))
    return Tracks(motion.scenario, duration, first_row, step, seconds, x, y, yaw, motion.arrived, frame_id)


def _check_no_jump(motion: Motion) -> None:
    if isinstance(motion, Plan) and motion.jumps.size:
        robot, step = place_of_action(motion, int(motion.jumps[0, 0]))
        raise FormatError(f"robot {robot} jumps in {motion.scenario.step_word} {step}, as no robot can; check the plan")


def _rows(motion: Motion) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the rows of a plan or run; by the clock "costs" but one where waits end, as they last but a tick each."""
    first_row, step, cells = rows_of_motion(motion)
    if motion.scenario.clock == "steps":
        return first_row, step, cells
    is_wait = np.append(False, cells[1:] == cells[:-1])[: cells.size]
    is_wait[first_row[:-1]] = False
    kept = ~is_wait | ~np.append(is_wait[1:], False)  # a robot's last wait comes before the start of the next robot
    robot = np.repeat(np.arange(first_row.size - 1), np.diff(first_row))
    first_row = np.concatenate([[0], np.cumsum(np.bincount(robot[kept], minlength=first_row.size - 1))])
    return first_row, step[kept], cells[kept]


def yaw_of_rows(
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
