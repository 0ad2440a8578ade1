"""Coverage: the plane with what stands in it, covered by cells that robots of a radius can use safely.

The part of a cell is its *star*: from its centre half way to the centre of each neighbour, whether that is free or not.
A cell is a barrier if any occupied point lies within the robot's radius of its star. A move from free cell to free cell
follows one arm of each of their stars, so a robot on it touches nothing; docs/metric.md has the proof and the figures.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import floor
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.area import Area
from trihex.areas.clearance import check_cell_size
from trihex.areas.frame import Frame
from trihex.areas.tessellation import Tessellation
from trihex.errors import AreaError, MissingExtraError, TooLargeError
from trihex.record import Record, read_only

if TYPE_CHECKING:
    from types import ModuleType

# Some 20 s of work each: 2.3 km across at hexagons of half a metre, 1 km for polygons.
MAX_COVERED = 25_000_000
MAX_COVERED_BY_POLYGONS = 5_000_000
# Points at exactly the radius count as touched in spite of rounding; as a share of the cell size.
_MARGIN = 1e-9
_PIXELS_AT_ONCE = 20_000_000
_CELLS_AT_ONCE = 50_000
_STARS_AT_ONCE = 5_000

Progress = Callable[[int, int], None]


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

    Raises
    ------
    AreaError
        If two robots of that radius could not pass each other on cells of that size.
    """

    tessellation: Tessellation
    cell_size: float
    robot_radius: float = 0.0

    def __post_init__(self) -> None:
        if isinstance(self.tessellation, str):
            self._set("tessellation", Tessellation(self.tessellation))
        frame = Frame(self.cell_size, robot_radius=self.robot_radius)
        self._set("cell_size", frame.cell_size)
        self._set("robot_radius", frame.robot_radius)
        check_cell_size(self.tessellation, frame, "forbid")  # a scenario may still ask for more

    def frame_at(self, origin: tuple[float, float], yaw: float = 0.0) -> Frame:
        """Return the frame of an area whose north-west corner lies at `origin`."""
        return Frame(self.cell_size, origin, yaw, self.robot_radius)


def star_of_cell(tessellation: Tessellation) -> NDArray[np.float64]:
    """Return the ends of the arms of a cell, relative to its centre, in edge steps; shape (2, directions, 2).

    Examples
    --------
    >>> star_of_cell(Tessellation("square", "edge"))[0].tolist()
    [[0.0, -0.5], [0.5, 0.0], [0.0, 0.5], [-0.5, 0.0]]
    """
    arms = []
    # Some cell of orientation 0 and one of orientation 1 (squares have but one).
    for orientation, (x, y) in enumerate([(2, 2), (3, 2)]):
        steps = tessellation.step_of_direction[orientation]
        cx, cy = tessellation.centre_of_cell(x, y)
        px, py = tessellation.centre_of_cell(x + steps[:, 0], y + steps[:, 1])
        arms.append(np.stack([px - cx, py - cy], axis=-1) / 2)
    return read_only(np.stack(arms))


def cover_raster(
    occupied: ArrayLike,
    covering: Covering,
    *,
    resolution: float,
    origin: tuple[float, float] = (0.0, 0.0),
    yaw: float = 0.0,
    is_outside_occupied: bool = True,
    name: str = "",
    progress: Progress | None = None,
) -> Area:
    """Return the area that covers a raster of occupied squares.

    Parameters
    ----------
    occupied : array_like of bool, shape (rows, columns)
        Row 0 is the north of the raster.
    covering : Covering
    resolution : float
        Width of a square in metres.
    origin : (float, float)
        The north-west corner of the raster in the world, in metres.
    yaw : float
        By how much the raster is turned, in radians, anticlockwise.
    is_outside_occupied : bool
        Whether what lies outside the raster counts as occupied.
    name : str
    progress : callable, optional
        Called with (rows done, all rows).

    Raises
    ------
    AreaError
        If the raster or a number is none.
    TooLargeError
        If there would be too many cells.
    """
    from trihex.areas.kernels import coverage as kernels
    from trihex.kernels.signatures import given

    occupied = np.ascontiguousarray(occupied, dtype=bool)
    if occupied.ndim != 2 or occupied.size == 0:
        raise AreaError(f"occupied must have shape (rows, columns) with at least one square, not {occupied.shape}")
    if not 1e-9 <= resolution <= 1e9:
        raise AreaError(f"resolution must be between 1e-9 and 1e9 metres, not {resolution:g}")
    pixel = resolution / covering.cell_size
    frame = covering.frame_at(origin, yaw)
    tessellation = covering.tessellation
    height, width = _size_of(covering, occupied.shape[1] * resolution, occupied.shape[0] * resolution)
    star, barriers = star_of_cell(tessellation), np.empty(height * width, dtype=bool)
    radius = covering.robot_radius / covering.cell_size + _MARGIN
    reach = np.hypot(star[..., 0], star[..., 1]).max() + radius
    rows_at_once = max(1, floor(_PIXELS_AT_ONCE / ((2 * reach / pixel + 2) ** 2 * width)))
    raster = given(kernels.Raster, occupied, pixel, is_outside_occupied)
    for first, last in _bands(height, rows_at_once, progress):
        x, y, orientation = _cells_of_rows(tessellation, width, first, last)
        inside = barriers[first * width : last * width]
        kernels.fill_covered(raster, given(kernels.CellStars, x, y, orientation, star), radius, inside)
    return Area(tessellation, barriers.reshape(height, width), name, frame)


def cover_polygons(
    free: Any, covering: Covering, *, obstacles: Any = None, name: str = "", progress: Progress | None = None
) -> Area:
    """Return the area that covers the box around `free`; what is not free is occupied.

    Parameters
    ----------
    free : shapely geometry
        Polygons, with holes or without, in metres; x to the east, y to the north.
    covering : Covering
    obstacles : shapely geometry, optional
        What is occupied besides: points, lines and polygons.
    name : str
    progress : callable, optional
        Called with (rows done, all rows).

    Raises
    ------
    AreaError
        If nothing is free.
    TooLargeError
        If there would be too many cells.
    MissingExtraError
        If shapely is not installed.
    """
    shapely = import_shapely()
    if free.area == 0:
        raise AreaError("polygons must leave some place free; their area is 0")
    west, south, east, north = free.bounds
    frame = covering.frame_at((west, north))
    tessellation = covering.tessellation
    height, width = _size_of(covering, east - west, north - south, MAX_COVERED_BY_POLYGONS)
    walls = [free.boundary] if obstacles is None else [free.boundary, obstacles]
    shapely.prepare([free, *walls])
    star, barriers = star_of_cell(tessellation), np.empty(height * width, dtype=bool)
    radius = covering.robot_radius + _MARGIN * covering.cell_size
    reach = float(np.hypot(star[..., 0], star[..., 1]).max()) * covering.cell_size + radius
    for first, last in _bands(height, max(1, _CELLS_AT_ONCE // width), progress):
        px, py, orientation = _cells_of_rows(tessellation, width, first, last)
        centres = shapely.points(*frame.point_to_metres(px, py))
        blocked = ~shapely.contains_properly(free, centres)
        for wall in walls:
            near = np.flatnonzero(~blocked)
            near = near[shapely.dwithin(wall, centres[near], reach)]
            for some in np.array_split(near, near.size // _STARS_AT_ONCE + 1):
                arms = star[orientation[some]] + np.stack([px[some], py[some]], axis=-1)[:, None, :]
                ends = np.stack(frame.point_to_metres(arms[..., 0], arms[..., 1]), axis=-1)
                stars = _stars_from(shapely.get_coordinates(centres[some]), ends)
                blocked[some] = shapely.dwithin(wall, stars, radius)
        barriers[first * width : last * width] = blocked
    return Area(tessellation, barriers.reshape(height, width), name, frame)


def import_shapely() -> ModuleType:
    """Return the module shapely, which reads polygons."""
    try:
        import shapely
    except ImportError:
        raise MissingExtraError("polygons need shapely: pip install 'trihex[io]'") from None
    return cast("ModuleType", shapely)


def _stars_from(centres: NDArray[np.float64], ends: NDArray[np.float64]) -> NDArray[Any]:
    """Return each centre, shape (n, 2), with its arms as one line that goes to each end and back to the centre.

    `ends` has shape (n, arms, 2). (A geometry of many lines for each centre takes twice as long.)
    """
    import shapely

    path = np.repeat(ends, 2, axis=1)
    path[:, 1::2] = centres[:, None, :]
    return np.asarray(shapely.linestrings(path))


def _size_of(covering: Covering, east: float, south: float, most: int = MAX_COVERED) -> tuple[int, int]:
    """Return height and width of the area whose cells have their centres in a box of that size in metres."""
    tessellation, step = covering.tessellation, covering.cell_size
    cell_area = float(np.prod(np.subtract(tessellation.extent(3, 3), tessellation.extent(2, 2))))
    # A strip counts as one cell wide at least, or else its length would know no bound.
    if not max(1.0, east / step) * max(1.0, south / step) / cell_area < most:
        least = max(np.sqrt(east * south / cell_area / most), max(east, south) / cell_area / most)
        raise TooLargeError(
            f"cell_size must be at least {1.05 * least:.2g} metres for a world of {east:g} by {south:g} metres "
            f"(at most {most} cells), not {step:g}"
        )
    # Upper bounds, then those whose centres (of either orientation) lie within.
    x, y = np.arange(int(east / step * 2) + 2), np.arange(int(south / step * 2) + 2)
    centre_x = tessellation.centre_of_cell(x, 0 * x)[0]
    centre_y = np.minimum(tessellation.centre_of_cell(0 * y, y)[1], tessellation.centre_of_cell(0 * y + 1, y)[1])
    return max(1, int((centre_y < south / step).sum())), max(1, int((centre_x < east / step).sum()))


def _bands(height: int, rows: int, progress: Progress | None) -> Iterator[tuple[int, int]]:
    """Yield (first, last + 1) of bands of `rows` rows."""
    for first in range(0, height, rows):
        last = min(height, first + rows)
        yield first, last
        if progress is not None:
            progress(last, height)


def _cells_of_rows(
    tessellation: Tessellation, width: int, first: int, last: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Return centres, in edge steps, and orientations of the cells of rows first..last-1, flat."""
    y, x = (axis.reshape(-1) for axis in np.mgrid[first:last, :width])
    px, py = tessellation.centre_of_cell(x, y)
    return px, py, np.ascontiguousarray(tessellation.orientation_of_cell(x, y), dtype=np.int64)
