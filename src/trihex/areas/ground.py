"""Ground: what stands in the world beneath an area, a raster of squares or a drawing, in metres.

An area in metres keeps the ground that it was made from, so that it can be covered anew and be drawn.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import cos, sin
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.errors import AreaError, MissingExtraError
from trihex.record import Record, read_only

if TYPE_CHECKING:
    from types import ModuleType

# Some 20 s of work each: 2.3 km across at hexagons of half a metre, 1 km for polygons.
MAX_COVERED = 25_000_000
MAX_COVERED_BY_POLYGONS = 5_000_000
_DRAWN_PIXELS = 500_000  # of a picture of polygons


@dataclass(frozen=True, eq=False)
class Ground(Record):
    """What stands in a box of the world; `RasterGround` and `DrawnGround` are the two kinds.

    Attributes
    ----------
    origin : (float, float)
        The north-west corner of the box, in metres.
    yaw : float
        By how much the box is turned, in radians, anticlockwise.
    size : (float, float)
        How wide it is from west to east and from north to south, in metres.
    """

    most_cells: ClassVar[int] = MAX_COVERED
    origin: tuple[float, float]
    yaw: float
    size: tuple[float, float]

    def occupied_at(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
        """Tell whether something stands at points of the world, in metres, for pictures."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class RasterGround(Ground):
    """Squares of which some are occupied.

    Parameters
    ----------
    occupied : bool array, shape (rows, columns)
        Row 0 is the north, column 0 the west.
    resolution : float
        Width of a square in metres.
    origin, yaw
        As for `Ground`.
    is_outside_occupied : bool
        Whether what lies outside the raster counts as occupied.
    shown : bool array, optional
        What pictures show as occupied. Default: all that is. (Unknown ground of a ROS map is occupied but not shown.)

    Raises
    ------
    AreaError
        If the raster or a number is none.

    Examples
    --------
    >>> RasterGround([[False, True]], 0.5, origin=(0, 0.5)).occupied_at([0.2, 0.7, 1.2], 0.1).tolist()
    [False, True, False]
    """

    occupied: NDArray[np.bool_]
    resolution: float
    is_outside_occupied: bool
    shown: NDArray[np.bool_] = field(repr=False)

    def __init__(
        self,
        occupied: ArrayLike,
        resolution: float,
        origin: tuple[float, float] = (0.0, 0.0),
        yaw: float = 0.0,
        is_outside_occupied: bool = True,
        shown: ArrayLike | None = None,
    ) -> None:
        raster = np.ascontiguousarray(occupied, dtype=bool)
        if raster.ndim != 2 or raster.size == 0:
            raise AreaError(f"occupied must have shape (rows, columns) with at least one square, not {raster.shape}")
        if not 1e-9 <= resolution <= 1e9:
            raise AreaError(f"resolution must be between 1e-9 and 1e9 metres, not {resolution:g}")
        self._set("occupied", read_only(raster))
        self._set("shown", self.occupied if shown is None else read_only(np.asarray(shown, dtype=bool)))
        self._set("resolution", float(resolution))
        self._set("origin", origin)
        self._set("yaw", yaw)
        self._set("size", (raster.shape[1] * resolution, raster.shape[0] * resolution))
        self._set("is_outside_occupied", bool(is_outside_occupied))

    def occupied_at(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
        """Tell whether points of the world are occupied, in metres; what lies outside the raster is not."""
        east, north = np.subtract(x, self.origin[0]), np.subtract(y, self.origin[1])
        across = (east * cos(self.yaw) + north * sin(self.yaw)) / self.resolution
        down = (east * sin(self.yaw) - north * cos(self.yaw)) / self.resolution
        column, row = (np.floor(part + 1e-9).astype(np.int64) for part in (across, down))
        rows, columns = self.shown.shape
        is_inside = (row >= 0) & (column >= 0) & (row < rows) & (column < columns)
        return np.asarray(is_inside & self.shown[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)])


@dataclass(frozen=True, eq=False)
class DrawnGround(Ground):
    """Polygons that are free; all else is occupied.

    Parameters
    ----------
    free : shapely geometry
        Polygons, with holes or without, in metres; x to the east, y to the north.
    obstacles : shapely geometry, optional
        What is occupied besides: points, lines and polygons.

    Raises
    ------
    AreaError
        If nothing is free.
    """

    most_cells: ClassVar[int] = MAX_COVERED_BY_POLYGONS
    free: Any
    obstacles: Any = None

    def __init__(self, free: Any, obstacles: Any = None) -> None:
        if free.area == 0:
            raise AreaError("polygons must leave some place free; their area is 0")
        west, south, east, north = free.bounds
        self._set("free", free)
        self._set("obstacles", obstacles)
        self._set("origin", (west, north))
        self._set("yaw", 0.0)
        self._set("size", (east - west, north - south))

    @cached_property
    def walls(self) -> list[Any]:
        """What robots must keep away from: the border of what is free, and obstacles."""
        return [self.free.boundary] if self.obstacles is None else [self.free.boundary, self.obstacles]

    def occupied_at(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
        """Tell whether something is drawn at points of the world, to a pixel; all outside counts as occupied."""
        picture = self._picture
        west, north = self.origin
        is_inside = (np.asarray(x) >= west) & (np.subtract(x, west) <= self.size[0])
        is_inside = is_inside & (np.asarray(y) <= north) & (np.subtract(north, y) <= self.size[1])
        return np.asarray(~is_inside | picture.occupied_at(x, y))

    @cached_property
    def _picture(self) -> RasterGround:
        """What is occupied as a raster: made when it is first asked for, as most commands draw nothing."""
        import shapely

        square = max(*(length / 4000 for length in self.size), (self.size[0] * self.size[1] / _DRAWN_PIXELS) ** 0.5)
        columns, rows = (int(length / square) + 1 for length in self.size)
        room = self.free
        if self.obstacles is not None:  # lines and points become a pixel wide, or a little more
            things = shapely.get_parts(self.obstacles)
            flat = shapely.get_dimensions(things) < 2
            things[flat] = shapely.buffer(things[flat], 0.51 * square, quad_segs=1)
            room = shapely.difference(room, shapely.union_all(things))
        rings = shapely.get_rings(shapely.get_parts(room))
        points, ring = shapely.get_coordinates(rings, return_index=True)
        points = (points - self.origin) * (1 / square, -1 / square)
        is_edge = ring[1:] == ring[:-1]
        is_free = _inside(points[:-1][is_edge], points[1:][is_edge], rows, columns)
        return RasterGround(~is_free, square, self.origin)


def _inside(start: NDArray[np.float64], end: NDArray[np.float64], rows: int, columns: int) -> NDArray[np.bool_]:
    """Return which pixels have their centre inside rings, given the two ends of all their edges in pixels.

    A centre is inside if an odd number of edges lies to its west.
    """
    top, bottom = (
        np.ceil(extreme(start[:, 1], end[:, 1]) - 0.5).astype(np.int64) for extreme in (np.minimum, np.maximum)
    )
    top, bottom = np.clip(top, 0, rows), np.clip(bottom, 0, rows)
    edge = np.repeat(np.arange(len(start)), bottom - top)
    row = np.arange(edge.size) - np.repeat(np.cumsum(bottom - top) - (bottom - top), bottom - top) + top[edge]
    share = (row + 0.5 - start[edge, 1]) / (end[edge, 1] - start[edge, 1])
    column = np.ceil(start[edge, 0] + share * (end[edge, 0] - start[edge, 0]) - 0.5).astype(np.int64)
    crossings = np.zeros((rows, columns + 1), dtype=np.int64)
    np.add.at(crossings, (row, np.clip(column, 0, columns)), 1)
    return np.asarray(np.cumsum(crossings, axis=1)[:, :columns] % 2 == 1)


def import_shapely() -> ModuleType:
    """Return the module shapely, which reads polygons."""
    try:
        import shapely
    except ImportError:
        raise MissingExtraError("polygons need shapely: pip install 'trihex[io]'") from None
    return cast("ModuleType", shapely)
