"""Area: a tessellation with its barriers."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.frame import Frame
from trihex.areas.ground import Ground
from trihex.areas.hexagons import axial_to_xy, whole, xy_to_axial
from trihex.areas.layout import Layout
from trihex.areas.nearest import nearest_free_cell
from trihex.areas.places import numbers_from
from trihex.areas.tessellation import Tessellation, tessellation_from
from trihex.areas.zone import Zone, zones_from
from trihex.errors import AreaError, TessellationError, check_choice, check_many, check_type, kind_of
from trihex.record import Record, read_only

# Sites are int32, and the widest kernels keep some 40 bytes a cell.
MAX_CELLS = 2_000_000_000
MAX_NAME = 1000
_FAR = 1e12  # edge steps; farther numbers are no cells
# No writer can keep these: control characters, and what stands for the bytes of a file name that is not UTF-8.
_UNWRITABLE = re.compile("[\\x00-\\x1f\\x7f-\\x9f\\ud800-\\udfff\\ufffe\\uffff]")


@dataclass(frozen=True, eq=False)
class Area(Record):
    """A piece of the plane covered by cells, some of which are barriers.

    Parameters
    ----------
    tessellation : Tessellation or str
        A name stands for the full neighbourhood at the paper's costs.
    barriers : array_like of bool, shape (height, width)
        True, or 1, where a cell is a barrier; row 0 is the north, column 0 the west.
    name : str
        For reports; a reader puts the name of the file here. Characters that no file can keep become U+FFFD.
    frame : Frame, optional
        Where the area lies in the world; None if it is measured in cells only.
    zones : tuple of Zone
        Cells that have a name, such as exits; those of one name become one.
    ground : Ground, optional
        What stands in the world, from which the barriers were made; no file keeps it, and two areas are equal without.

    Raises
    ------
    AreaError
        If `barriers` is not a rectangle of at least one cell, or holds anything but True and False, 1 and 0, or if
        `name` is too long.

    Examples
    --------
    >>> area = Area("hexagonal", [[0, 1, 0], [0, 0, 0]])
    >>> area.free_count, area.width
    (5, 3)
    """

    tessellation: Tessellation
    barriers: NDArray[np.bool_]
    name: str = ""
    frame: Frame | None = None
    zones: tuple[Zone, ...] = ()
    ground: Ground | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        self._set("tessellation", tessellation_from(self.tessellation))
        check_type("frame", self.frame, Frame, type(None))
        if not isinstance(self.name, str) or len(self.name) > MAX_NAME:
            raise AreaError(f"name must be text of at most {MAX_NAME} characters, not {self.name!r:.40}")
        self._set("name", _UNWRITABLE.sub("\ufffd", self.name))
        barriers = _barriers_from(self.barriers)
        if barriers.ndim != 2 or barriers.size == 0:
            raise AreaError(f"barriers must have shape (height, width) with at least one cell, not {barriers.shape}")
        if barriers.size > MAX_CELLS:
            raise AreaError(f"an area may have at most {MAX_CELLS} cells, not {barriers.size}")
        self._set("barriers", read_only(barriers))
        check_many("zones", self.zones, Zone, "a list of zones")
        self._set("zones", zones_from(self.zones, barriers.size))

    def in_words(self) -> str:
        """Return shape, size, free cells and name."""
        tessellation = self.tessellation
        edge = " edge" * (tessellation.neighbourhood == "edge") + " euclidean" * (tessellation.costs == "euclidean")
        metres = "" if self.frame is None else f" of {self.frame.cell_size:g} metres"
        name = f", {self.name!r:.80}" * bool(self.name)
        return f"{tessellation.name}{edge}, {self.width} x {self.height} cells{metres}, {self.free_count} free{name}"

    @property
    def height(self) -> int:
        """Number of rows."""
        return int(self.barriers.shape[0])

    @property
    def width(self) -> int:
        """Number of columns."""
        return int(self.barriers.shape[1])

    @property
    def cell_count(self) -> int:
        """Number of cells, barriers included."""
        return int(self.barriers.size)

    @cached_property
    def free_count(self) -> int:
        """Number of cells that are no barrier."""
        return int(self.barriers.size - np.count_nonzero(self.barriers))

    @cached_property
    def layout(self) -> Layout:
        """How the cells lie in the padded flat arrays of the kernels."""
        return self.tessellation.layout(self.height, self.width)

    def with_clock(self, clock: str) -> Area:
        """Return the same area whose moves last a step, or as long as they cost; in metres no robot is ever too fast.

        Examples
        --------
        >>> Area("square", [[0]]).with_clock("costs").tessellation.cost_of_direction.tolist()
        [5, 5, 5, 5, 7, 7, 7, 7]
        """
        own = self.tessellation
        costs = "euclidean" if clock == "costs" and self.frame is not None else own.costs
        if (own.clock, own.costs) == (clock, costs):
            return self
        return replace(self, tessellation=replace(own, clock=clock, costs=costs))

    def with_tessellation(self, tessellation: Tessellation | str) -> Area:
        """Return the same rectangle of barriers, read as cells of another tessellation.

        Raises
        ------
        AreaError
            If the area has a frame: cells of another shape, or with more neighbours, would not fit the world.
        """
        tessellation = tessellation_from(tessellation)
        own = self.tessellation
        if self.frame is not None and (
            own.name != tessellation.name or own.direction_count < tessellation.direction_count
        ):
            raise AreaError(
                f"tessellation must stay {own.name} {own.neighbourhood} in an area with a frame, not become "
                f"{tessellation.name} {tessellation.neighbourhood}: read its file again with the other tessellation"
            )
        return replace(self, tessellation=tessellation)

    def make_blocked(self) -> NDArray[np.bool_]:
        """Return anew where nobody can stand: barriers and the padding; a bool for each site, shape (layout.size,)."""
        from trihex.areas.kernels.moves import fill_blocked

        blocked = np.empty(self.layout.size, dtype=bool)
        fill_blocked(self.barriers, self.layout.origin, self.layout.pitch, blocked)
        return blocked

    def is_barrier(self, cells: ArrayLike) -> NDArray[np.bool_]:
        """Tell for each cell, a place (x, y) or a number, whether it is a barrier.

        Raises
        ------
        AreaError
            If a cell lies outside.
        """
        return np.asarray(self.barriers.reshape(-1)[numbers_from(self, cells)])

    def xy_to_cell(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.int64]:
        """Return the numbers of cells (x, y): y * width + x.

        Raises
        ------
        AreaError
            If a cell lies outside, or x or y is no whole number.
        """
        x, y = whole("x", x), whole("y", y)
        outside = (x < 0) | (y < 0) | (x >= self.width) | (y >= self.height)
        if np.any(outside):
            at = np.unravel_index(int(np.argmax(outside)), outside.shape)
            where = (int(np.broadcast_to(x, outside.shape)[at]), int(np.broadcast_to(y, outside.shape)[at]))
            raise AreaError(f"cell {where} lies outside the area: x is 0..{self.width - 1}, y is 0..{self.height - 1}")
        return np.asarray(y * self.width + x)

    def cell_to_xy(self, cells: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return (x, y) of cells given by number; the inverse of `xy_to_cell`.

        Raises
        ------
        AreaError
            If a cell lies outside; so does -1, which stands for robots that are not in the area.
        """
        y, x = np.divmod(numbers_from(self, cells), self.width)
        return x, y

    def cell_to_axial(self, cells: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the axial coordinates (q, r) of hexagonal cells given by number; (x, y) are "odd-q" offsets.

        Raises
        ------
        TessellationError
            If the cells are no hexagons.
        AreaError
            If a cell lies outside.

        Examples
        --------
        >>> area = Area("hexagonal", [[0, 0, 0], [0, 0, 0]])
        >>> [int(number) for number in area.cell_to_axial(5)], int(area.axial_to_cell(2, 0))
        ([2, 0], 5)
        """
        self._check_hexagons()
        return xy_to_axial(*self.cell_to_xy(cells))

    def axial_to_cell(self, q: ArrayLike, r: ArrayLike) -> NDArray[np.int64]:
        """Return the numbers of hexagonal cells in axial coordinates; the inverse of `cell_to_axial`."""
        self._check_hexagons()
        return self.xy_to_cell(*axial_to_xy(q, r))

    def cell_to_cube(self, cells: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Return the cube coordinates (q, r, s), q + r + s = 0, of hexagonal cells given by number."""
        q, r = self.cell_to_axial(cells)
        return q, r, -q - r

    def cube_to_cell(self, q: ArrayLike, r: ArrayLike, s: ArrayLike) -> NDArray[np.int64]:
        """Return the numbers of hexagonal cells in cube coordinates; the inverse of `cell_to_cube`.

        Raises
        ------
        AreaError
            If q + r + s is not 0, or a cell lies outside.
        """
        if np.any(whole("q", q) + whole("r", r) + whole("s", s) != 0):
            raise AreaError("cube coordinates must have q + r + s = 0")
        return self.axial_to_cell(q, r)

    def _check_hexagons(self) -> None:
        if self.tessellation.name != "hexagonal":
            raise TessellationError(f"axial and cube coordinates are of hexagons; the area is {self.tessellation.name}")

    def metres_to_cell(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.int64]:
        """Return the numbers of the cells in which points of the world lie.

        Raises
        ------
        AreaError
            If a point lies outside, or the area has no frame.
        """
        frame = self.metres
        x, y = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64))
        with np.errstate(over="ignore", invalid="ignore"):  # such points lie outside
            px, py = frame.metres_to_point(x, y)
        width, height = self.tessellation.extent(self.height, self.width)
        is_inside = (px >= 0) & (py >= 0) & (px <= width) & (py <= height)  # not so for nan
        cell_x, cell_y = self.tessellation.cell_at_point(np.where(is_inside, px, -9), np.where(is_inside, py, -9))
        outside = (cell_x < 0) | (cell_y < 0) | (cell_x >= self.width) | (cell_y >= self.height)
        if np.any(outside):
            at = np.unravel_index(int(np.argmax(outside)), outside.shape)
            raise AreaError(self._why_outside(float(x[at]), float(y[at]), float(px[at]), float(py[at])))
        return self.xy_to_cell(cell_x, cell_y)

    def _why_outside(self, x: float, y: float, px: float, py: float) -> str:
        """Return what is wrong with a point that lies in no cell, and where the nearest free cell is."""
        why = f"point ({x:g}, {y:g}) metres lies outside the area: in none of its cells"
        if not np.isfinite([px, py]).all():
            return why
        px, py = (float(number) for number in np.clip([px, py], -_FAR, _FAR))
        near = nearest_free_cell(self.tessellation, self.barriers, px, py)
        if near is None:
            return f"{why}, of which none is free"
        cell = int(self.xy_to_cell(*near))
        away = np.hypot(*np.subtract(self.cell_to_metres(cell), (x, y)))
        return f"{why}; the nearest free cell is {self.place_of_cell(cell)}, {away:.3g} metres away"

    def cell_to_metres(self, cells: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where the centres of cells given by number lie in the world.

        Raises
        ------
        AreaError
            If the area has no frame, or a cell lies outside.
        """
        return self.metres.centre_of_cell(self.tessellation, *self.cell_to_xy(cells))

    @property
    def metres(self) -> Frame:
        """The frame, where there must be one; raises AreaError if there is none."""
        if self.frame is None:
            raise AreaError("the area is measured in cells, not in metres; give it a frame (cell_size)")
        return self.frame

    def cells_of_zone(self, name: str) -> NDArray[np.int64]:
        """Return the numbers of the cells of a zone, ascending; raise AreaError, with a near name, if there is none."""
        cells = {zone.name: zone.cells for zone in self.zones}
        if not cells:
            raise AreaError(f"zone {name!r:.80} does not exist: the area has none")
        return cells[check_choice("zone", name, cells, AreaError)]

    def cells_touched(self, shape: Any) -> NDArray[np.int64]:
        """Return the numbers of the cells that robots of the frame's radius cannot use where something stands.

        By the rule that made the area: those whose star comes within the radius of it, free or not. So a robot that
        keeps to other cells does not touch it (docs/metric.md). Ascending.

        Parameters
        ----------
        shape : shapely geometry, or points (x, y)
            In metres. One point is a point, two are a line, more the corners of a polygon.

        Raises
        ------
        AreaError
            If the area has no frame, or the shape is invalid.
        MissingExtraError
            If shapely is not installed.

        Examples
        --------
        >>> area = Area("square", [[0, 0, 0]], frame=Frame(1.0, robot_radius=0.2))
        >>> area.cells_touched([(1.5, -0.5)]).tolist(), area.cells_touched([(1.1, -0.5)]).tolist()
        ([1], [0, 1])
        """
        from trihex.areas.touching import cells_touched

        return cells_touched(self, shape)

    def name_of_cell(self, cell: int) -> str:
        """Return ``(x, y)`` as text, for messages."""
        return f"({cell % self.width}, {cell // self.width})"

    def place_of_cell(self, cell: int) -> str:
        """Return ``(x, y)`` as text, and where that is in metres if the area has a frame."""
        if self.frame is None:
            return self.name_of_cell(cell)
        x, y = self.cell_to_metres(cell)
        return f"{self.name_of_cell(cell)} at ({x:g}, {y:g}) metres"


def _barriers_from(given: object) -> NDArray[np.bool_]:
    """Return `given` as an array of bool, else raise AreaError; that it is a rectangle is not looked at."""
    try:
        barriers = np.array(given, order="C")
    except ValueError:
        raise AreaError("barriers must be a rectangle: its rows differ in length") from None
    if barriers.dtype == bool:
        return barriers
    if barriers.dtype.kind not in "iuf" or barriers.ndim == 0:
        what = kind_of(given) if barriers.ndim == 0 else f"{barriers.dtype} values"
        hint = "; read_area reads files of letters" * (barriers.dtype.kind == "U")
        raise AreaError(f"barriers must be rows of True and False, or 1 and 0, not {what}{hint}")
    is_set: NDArray[np.bool_] = barriers != 0
    if barriers.size and not ((barriers == 1) == is_set).all():
        odd = barriers[is_set & (barriers != 1)].flat[0]
        raise AreaError(
            f"barriers must be True and False, or 1 and 0, not {odd:g}: say which values are barriers, such as grid > 0"
        )
    return is_set
