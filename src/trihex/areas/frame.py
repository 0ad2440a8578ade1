"""Frame: where an area lies in the world, in metres, and for robots of which radius it was made."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError
from trihex.record import Record

# The Earth is 4e7 metres around; beyond, sums lose their micrometres.
_LARGEST = 1e9

Metres = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Frame(Record):
    """Where an area lies in the world: cells count x to the east and y to the south, the world y to the north.

    Parameters
    ----------
    cell_size : float
        Edge step: the distance in metres between the centres of two cells that share an edge.
    origin : (float, float)
        The north-west corner of the area in the world, in metres.
    yaw : float
        By how much the area is turned in the world, in radians, anticlockwise; 0: its rows run to the east.
    robot_radius : float
        In metres. A robot of this radius that moves from free cell to free cell touches nothing that stands in the
        world (see `trihex.areas.coverage`). 0 makes robots points, and then nothing is promised.

    Raises
    ------
    AreaError
        If a number is beyond 1e9, `cell_size` not positive or `robot_radius` negative.

    Examples
    --------
    >>> frame = Frame(cell_size=0.5, origin=(-10.0, 10.0))
    >>> [float(metres) for metres in frame.centre_of_cell(Tessellation("square"), 0, 1)]
    [-9.75, 9.25]
    >>> [int(number) for number in frame.cell_at(Tessellation("square"), -9.75, 9.25)]
    [0, 1]
    """

    cell_size: float
    origin: tuple[float, float] = (0.0, 0.0)
    yaw: float = 0.0
    robot_radius: float = 0.0

    def __post_init__(self) -> None:
        for name in ("cell_size", "yaw", "robot_radius"):
            self._set(name, _number(name, getattr(self, name)))
        try:
            x, y = self.origin
        except (TypeError, ValueError):
            raise AreaError(f"origin must be two numbers, not {self.origin!r:.80}") from None
        self._set("origin", (_number("origin", x), _number("origin", y)))
        if self.cell_size <= 0:
            raise AreaError(f"cell_size must be above 0 metres, not {self.cell_size:g}")
        if self.robot_radius < 0:
            raise AreaError(f"robot_radius must be at least 0 metres, not {self.robot_radius:g}")

    def point_to_metres(self, px: ArrayLike, py: ArrayLike) -> tuple[Metres, Metres]:
        """Return where points of the area lie in the world; px, py in edge steps from its north-west corner."""
        east, north = np.multiply(px, self.cell_size), np.multiply(py, -self.cell_size)
        return (
            np.asarray(self.origin[0] + east * cos(self.yaw) - north * sin(self.yaw)),
            np.asarray(self.origin[1] + east * sin(self.yaw) + north * cos(self.yaw)),
        )

    def metres_to_point(self, x: ArrayLike, y: ArrayLike) -> tuple[Metres, Metres]:
        """Return where points of the world lie in the area, in edge steps; the inverse of `point_to_metres`."""
        east, north = np.subtract(x, self.origin[0]), np.subtract(y, self.origin[1])
        return (
            np.asarray((east * cos(self.yaw) + north * sin(self.yaw)) / self.cell_size),
            np.asarray((east * sin(self.yaw) - north * cos(self.yaw)) / self.cell_size),
        )

    def centre_of_cell(self, tessellation: Tessellation, x: ArrayLike, y: ArrayLike) -> tuple[Metres, Metres]:
        """Return the centre of cells (x, y) in the world."""
        return self.point_to_metres(*tessellation.centre_of_cell(x, y))

    def cell_at(
        self, tessellation: Tessellation, x: ArrayLike, y: ArrayLike
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return (x, y) of the cells in which points of the world lie; any integers, unbounded."""
        return tessellation.cell_at_point(*self.metres_to_point(x, y))


def _number(name: str, value: object) -> float:
    """Return `value` as a float, else raise AreaError."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        number = float("nan")
    if not abs(number) <= _LARGEST:
        raise AreaError(f"{name} must be a number of at most {_LARGEST:g}, not {value!r:.80}")
    return number
