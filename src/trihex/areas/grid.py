"""Grid: where the cells of a covering lie over a ground: how large they are, where they begin, how they are turned."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.clearance import check_cell_size
from trihex.areas.frame import Frame
from trihex.areas.ground import Ground
from trihex.areas.tessellation import Tessellation
from trihex.errors import TooLargeError
from trihex.record import Record


@dataclass(frozen=True, eq=False)
class Covering(Record):
    """How the plane is to be covered.

    Parameters
    ----------
    tessellation : Tessellation or str
    cell_size : float
        Edge step in metres.
    robot_radius : float
        In metres.
    offset : (float, float)
        By how much the grid begins west and north of the corner of what it covers, in edge steps.
    turn : float
        By how much it is turned against what it covers, in radians, anticlockwise.

    Raises
    ------
    AreaError
        If two robots of that radius could not pass each other on cells of that size.
    """

    tessellation: Tessellation
    cell_size: float
    robot_radius: float = 0.0
    offset: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0

    def __post_init__(self) -> None:
        if isinstance(self.tessellation, str):
            self._set("tessellation", Tessellation(self.tessellation))
        frame = Frame(self.cell_size, robot_radius=self.robot_radius)
        self._set("cell_size", frame.cell_size)
        self._set("robot_radius", frame.robot_radius)
        check_cell_size(self.tessellation, frame, "forbid")  # a scenario may still ask for more


@dataclass(frozen=True, eq=False)
class Grid(Record):
    """Rows of cells that cover the box of a ground.

    Attributes
    ----------
    frame : Frame
        Where it lies in the world.
    height, width : int
        Rows and columns.
    corner : (float, float)
        Its north-west corner, in edge steps east and south of that of the ground, along the ground's own axes.
    turn : float
        By how much it is turned against the ground, in radians, anticlockwise.
    """

    frame: Frame
    height: int
    width: int
    corner: tuple[float, float]
    turn: float

    def turned(self, vectors: ArrayLike) -> NDArray[np.float64]:
        """Return vectors (to the east, to the south) of the grid along the axes of the ground, shape (..., 2)."""
        east, south = np.moveaxis(np.asarray(vectors), -1, 0)
        c, s = cos(self.turn), sin(self.turn)
        return np.ascontiguousarray(np.stack([east * c + south * s, south * c - east * s], axis=-1))


def lay_grid(ground: Ground, covering: Covering) -> Grid:
    """Return the cells that have their centre in the box around a ground along the axes of the grid.

    Raises
    ------
    TooLargeError
        If there would be too many.
    """
    step, c, s = covering.cell_size, cos(covering.turn), sin(covering.turn)
    east, south = (length / step for length in ground.size)
    # The corners of the ground along the axes of the grid; then that of the grid along those of the ground.
    across = [u * c - v * s for u in (0.0, east) for v in (0.0, south)]
    down = [u * s + v * c for u in (0.0, east) for v in (0.0, south)]
    west, north = min(across) - covering.offset[0], min(down) - covering.offset[1]
    height, width = _size_of(covering, max(across) - west, max(down) - north, ground.most_cells)
    corner = (west * c + north * s, north * c - west * s)
    own = Frame(step, ground.origin, ground.yaw, covering.robot_radius)
    x, y = (float(metres) for metres in own.point_to_metres(*corner))
    frame = Frame(step, (x, y), ground.yaw + covering.turn, covering.robot_radius)
    return Grid(frame, height, width, corner, covering.turn)


def _size_of(covering: Covering, east: float, south: float, most: int) -> tuple[int, int]:
    """Return height and width of the area whose cells have their centres in a box of that size in edge steps."""
    tessellation, step = covering.tessellation, covering.cell_size
    cell_area = float(np.prod(np.subtract(tessellation.extent(3, 3), tessellation.extent(2, 2))))
    # A strip counts as one cell wide at least, or else its length would know no bound.
    if not max(1.0, east) * max(1.0, south) / cell_area < most:
        least = step * max(np.sqrt(east * south / cell_area / most), max(east, south) / cell_area / most)
        raise TooLargeError(
            f"cell_size must be at least {1.05 * least:.2g} metres for a world of {east * step:g} by "
            f"{south * step:g} metres (at most {most} cells), not {step:g}"
        )
    # Upper bounds, then those whose centres (of either orientation) lie within.
    x, y = np.arange(int(east * 2) + 2), np.arange(int(south * 2) + 2)
    centre_x = tessellation.centre_of_cell(x, 0 * x)[0]
    centre_y = np.minimum(tessellation.centre_of_cell(0 * y, y)[1], tessellation.centre_of_cell(0 * y + 1, y)[1])
    return max(1, int((centre_y < south).sum())), max(1, int((centre_x < east).sum()))
