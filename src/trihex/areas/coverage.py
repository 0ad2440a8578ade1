"""Coverage: the plane with what stands in it, covered by cells that robots of a radius can use safely.

The part of a cell is its *star*: from its centre half way to the centre of each neighbour, whether that is free or not.
A cell is a barrier if any occupied point lies within the robot's radius of its star. A move from free cell to free cell
follows one arm of each of their stars, so a robot on it touches nothing; docs/metric.md has the proof and the figures.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import floor
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.area import Area
from trihex.areas.grid import Covering, Grid, lay_grid
from trihex.areas.ground import DrawnGround, Ground, RasterGround, import_shapely
from trihex.areas.tessellation import Tessellation
from trihex.record import read_only

# Points at exactly the radius count as touched in spite of rounding; as a share of the cell size.
MARGIN = 1e-9
_PIXELS_AT_ONCE = 20_000_000
_CELLS_AT_ONCE = 50_000
_STARS_AT_ONCE = 5_000

Progress = Callable[[int, int], None]


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
    ground = RasterGround(occupied, resolution, origin, yaw, is_outside_occupied)
    return cover(ground, covering, name=name, progress=progress)


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
    import_shapely()
    return cover(DrawnGround(free, obstacles), covering, name=name, progress=progress)


def cover(ground: Ground, covering: Covering, *, name: str = "", progress: Progress | None = None) -> Area:
    """Return the area that covers a ground, and keeps it; raises TooLargeError if there would be too many cells."""
    grid = lay_grid(ground, covering)
    if isinstance(ground, DrawnGround):
        barriers = _blocked_by_polygons(ground, covering, grid, progress)
    else:
        barriers = _blocked_by_raster(cast("RasterGround", ground), covering, grid, progress)
    return Area(covering.tessellation, barriers.reshape(grid.height, grid.width), name, grid.frame, ground=ground)


def _blocked_by_raster(
    ground: RasterGround, covering: Covering, grid: Grid, progress: Progress | None
) -> NDArray[np.bool_]:
    """Return which cells a raster of occupied squares makes barriers, flat."""
    from trihex.areas.kernels import coverage as kernels
    from trihex.kernels.signatures import given

    pixel = ground.resolution / covering.cell_size
    star = grid.turned(star_of_cell(covering.tessellation))
    barriers = np.empty(grid.height * grid.width, dtype=bool)
    radius = covering.robot_radius / covering.cell_size + MARGIN
    reach = np.hypot(star[..., 0], star[..., 1]).max() + radius
    rows_at_once = max(1, floor(_PIXELS_AT_ONCE / ((2 * reach / pixel + 2) ** 2 * grid.width)))
    raster = given(kernels.Raster, ground.occupied, pixel, ground.is_outside_occupied)
    for first, last in _bands(grid.height, rows_at_once, progress):
        px, py, orientation = _cells_of_rows(covering.tessellation, grid.width, first, last)
        x, y = np.ascontiguousarray((grid.turned(np.stack([px, py], axis=-1)) + grid.corner).T)
        inside = barriers[first * grid.width : last * grid.width]
        kernels.fill_covered(raster, given(kernels.CellStars, x, y, orientation, star), radius, inside)
    return barriers


def _blocked_by_polygons(
    ground: DrawnGround, covering: Covering, grid: Grid, progress: Progress | None
) -> NDArray[np.bool_]:
    """Return which cells a drawing makes barriers, flat."""
    shapely = import_shapely()
    shapely.prepare([ground.free, *ground.walls])
    star, barriers = star_of_cell(covering.tessellation), np.empty(grid.height * grid.width, dtype=bool)
    radius = covering.robot_radius + MARGIN * covering.cell_size
    reach = float(np.hypot(star[..., 0], star[..., 1]).max()) * covering.cell_size + radius
    for first, last in _bands(grid.height, max(1, _CELLS_AT_ONCE // grid.width), progress):
        px, py, orientation = _cells_of_rows(covering.tessellation, grid.width, first, last)
        centres = shapely.points(*grid.frame.point_to_metres(px, py))
        blocked = ~shapely.contains_properly(ground.free, centres)
        for wall in ground.walls:
            near = np.flatnonzero(~blocked)
            near = near[shapely.dwithin(wall, centres[near], reach)]
            for some in np.array_split(near, near.size // _STARS_AT_ONCE + 1):
                arms = star[orientation[some]] + np.stack([px[some], py[some]], axis=-1)[:, None, :]
                ends = np.stack(grid.frame.point_to_metres(arms[..., 0], arms[..., 1]), axis=-1)
                stars = stars_from(shapely.get_coordinates(centres[some]), ends)
                blocked[some] = shapely.dwithin(wall, stars, radius)
        barriers[first * grid.width : last * grid.width] = blocked
    return barriers


def stars_from(centres: NDArray[np.float64], ends: NDArray[np.float64]) -> NDArray[Any]:
    """Return each centre, shape (n, 2), with its arms as one line that goes to each end and back to the centre.

    `ends` has shape (n, arms, 2). (A geometry of many lines for each centre takes twice as long.)
    """
    import shapely

    path = np.repeat(ends, 2, axis=1)
    path[:, 1::2] = centres[:, None, :]
    return np.asarray(shapely.linestrings(path))


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
