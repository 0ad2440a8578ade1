"""Tracks: where each robot of a plan is in the world, in metres and seconds; what all writers of motion write."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import FormatError
from trihex.plans import Plan, cells_of_rows
from trihex.record import Record, read_only


@dataclass(frozen=True, eq=False)
class Tracks(Record):
    """The places of all robots, robot by robot and step by step; between two of them a robot moves in a straight line.

    Robot r has the rows ``first_row[r]`` to ``first_row[r + 1] - 1``, one for each step from 0. It leaves the world
    with its last row, in which it arrives. One that never arrives has rows to the last step of the plan.

    Attributes
    ----------
    area : Area
    seconds_per_step : float
    first_row : int64 array, shape (robots + 1,)
    step : int64 array, shape (rows,)
    x, y : float64 arrays, shape (rows,)
        In metres, in the world.
    yaw : float64 array, shape (rows,)
        Where the robot will go next, in radians, anticlockwise from the east; while it waits, where it will go then; in
        the end, where it came from.
    arrived : bool array, shape (robots,)
    """

    area: Area
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


def make_tracks(plan: Plan, speed: float = 1.0) -> Tracks:
    """Return the tracks of a plan whose area has a frame.

    All moves take as long: a step lasts as the longest move of the tessellation does at `speed`, so that no robot is
    ever faster.

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
        robot = int(np.searchsorted(plan.first_action, at, side="right")) - 1
        step = at - int(plan.first_action[robot]) + 1
        raise FormatError(f"robot {robot} jumps in step {step}, as no robot can; check the plan")
    area = plan.scenario.area
    frame = area.metres
    length = np.where(plan.arrived, np.diff(plan.first_action), plan.steps)
    first_row = np.concatenate([[0], np.cumsum(length + 1)])
    cells = cells_of_rows(plan, first_row)
    x, y = area.cell_to_metres(cells)
    return Tracks(
        area,
        area.tessellation.longest_move * frame.cell_size / speed,
        first_row,
        np.arange(cells.size) - np.repeat(first_row[:-1], length + 1),
        x,
        y,
        _yaw(x, y, first_row, frame.yaw),
        plan.arrived,
    )


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
