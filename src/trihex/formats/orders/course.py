"""Course: the waypoints of all robots in the world, and who waits for whom; what all writers of orders write."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Frame
from trihex.formats.tracks.tracks import check_speed, yaw_of_rows
from trihex.plans import Dependencies, Plan, make_dependencies
from trihex.record import Record, read_only

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Course(Record):
    """The waypoints of all robots, numbered as in `Dependencies`.

    Attributes
    ----------
    dependencies : Dependencies
    speed : float
        Metres in a second; edge steps, as x and y are, where the area has no frame.
    seconds_per_step : float
        Of a tick by the clock "costs".
    x, y : float64 arrays
        To the east and to the north.
    yaw : float64 array
        Where the robot will go next, in radians, anticlockwise from the east; in the end where it came from.
    earliest : float64 array
        Seconds after which the plan reaches each waypoint; at `speed` none can be reached earlier.
    """

    dependencies: Dependencies
    speed: float
    seconds_per_step: float
    x: Floats
    y: Floats
    yaw: Floats
    earliest: Floats

    def __post_init__(self) -> None:
        for name in ("x", "y", "yaw", "earliest"):
            self._set(name, read_only(getattr(self, name)))

    @property
    def has_metres(self) -> bool:
        """Whether x and y are in metres."""
        return self.dependencies.plan.scenario.area.frame is not None

    def rows_of(self, robot: int) -> range:
        """Return the numbers of the waypoints of a robot."""
        first = self.dependencies.first_waypoint
        return range(int(first[robot]), int(first[robot + 1]))


def make_course(plan: Plan, speed: float = 1.0) -> Course:
    """Return the course of a safe plan.

    Raises
    ------
    FormatError
        If the speed is not above 0.
    PlanError
        If the plan is not safe.
    """
    check_speed(speed)
    dependencies, area = make_dependencies(plan), plan.scenario.area
    frame = area.frame or Frame(cell_size=1.0)
    x, y = frame.centre_of_cell(area.tessellation, *area.cell_to_xy(dependencies.cell_of_waypoint))
    seconds_per_step = area.tessellation.longest_tick * frame.cell_size / float(speed)
    yaw = yaw_of_rows(x, y, dependencies.first_waypoint, frame.yaw)
    earliest = np.asarray(dependencies.step_of_waypoint * seconds_per_step, dtype=np.float64)
    return Course(dependencies, float(speed), seconds_per_step, x, y, yaw, earliest)
