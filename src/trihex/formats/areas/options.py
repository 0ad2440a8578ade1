"""Options: what a file of a real place leaves open, such as the size of cells and what unknown ground is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from numbers import Real

from trihex.areas import (
    ALIGNS,
    CLOCKS,
    FOLLOWINGS,
    Area,
    Covering,
    Ground,
    Tessellation,
    cover,
    cover_aligned,
    least_cell_size,
    round_up_size,
    tessellation_from,
)
from trihex.areas.coverage import Progress
from trihex.errors import FormatError, check_choice, check_number
from trihex.record import Record

UNKNOWNS = ("barrier", "free")


class NoRoomError(FormatError):
    """A place that is too small for such cells, or one of whose exits leads to none of them."""


@dataclass(frozen=True, eq=False)
class AreaOptions(Record):
    """How the file of an area is to be read.

    Parameters
    ----------
    tessellation : Tessellation or str
    cell_size : float, optional
        Edge step in metres. Default: the least that robots of `robot_radius` can have, in tenths of a millimetre. ROS
        maps, GeoJSON and WKT need one of the two; images need one or have one cell for each pixel; for ``.map`` and
        ``.txt``, one cell for each letter, it only says how large a cell is.
    robot_radius : float
        In metres; how far robots are to keep from what is occupied, and half of how far from each other.
    clearance : float
        In metres; how much farther than that they keep, so that none touches at less than this beyond its way.
    unknown : {"barrier", "free"}
        What ground is that a ROS map does not know, and all that lies outside a ROS map or an image.
    threshold : float
        From which brightness on a pixel of an image is free, 0 to 1.
    invert : bool
        In images, dark pixels are free and bright ones occupied.
    resolution : float, optional
        Metres for each pixel of an image. ROS maps bring their own.
    align : {"corner", "best", "shift"}
        Where the grid begins and how it is turned: at the north-west corner along its sides; so that the largest
        connected part has most cells; or the best of a few shifts.
    walls, exits, rooms : str, optional
        Names of layers of a DXF file, parted by commas; ``*`` stands for any letters. Default: ``*wall*``, or all where
        no layer is called so, ``*exit*`` and ``*room*``.
    unit : str, optional
        What lengths in a DXF file are measured in: m, cm, mm, km, in, ft or yd. Default: as the file says.
    wall_thickness : float
        Of the lines of a DXF file that are walls, in metres.
    following : {"allow", "forbid"}
    clock : {"steps", "costs"}, optional
        The rules that the least cell size for robots of the radius depends on. Default: the clock of `tessellation`.

    Raises
    ------
    FormatError
        If a value does not exist or is out of range.
    """

    tessellation: Tessellation
    cell_size: float | None = None
    robot_radius: float = 0.0
    clearance: float = 0.0
    unknown: str = "barrier"
    threshold: float = 0.5
    invert: bool = False
    resolution: float | None = None
    align: str = "corner"
    walls: str | None = None
    exits: str | None = None
    rooms: str | None = None
    unit: str | None = None
    wall_thickness: float = 0.0
    following: str = "allow"
    clock: str | None = None

    def __post_init__(self) -> None:
        self._set("tessellation", tessellation_from(self.tessellation))
        check_choice("unknown", self.unknown, UNKNOWNS, FormatError)
        check_choice("following", self.following, FOLLOWINGS, FormatError)
        if self.clock is not None:
            check_choice("clock", self.clock, CLOCKS, FormatError)
        check_choice("align", self.align, (*ALIGNS, "shift"), FormatError)
        if not isinstance(self.threshold, Real) or not 0 <= self.threshold <= 1:
            raise FormatError(f"threshold must be between 0 and 1, not {self.threshold!r:.80}")
        check_number("clearance", self.clearance, 0, 1e9, FormatError)
        if not isinstance(self.wall_thickness, Real) or not 0 <= self.wall_thickness <= 1e3:
            raise FormatError(f"wall_thickness must be between 0 and 1000 metres, not {self.wall_thickness!r:.80}")
        if self.resolution is not None:
            if not isinstance(self.resolution, Real) or not 1e-9 <= self.resolution <= 1e9:
                raise FormatError(f"resolution must be between 1e-9 and 1e9 metres, not {self.resolution!r:.80}")

    @property
    def edge_step(self) -> float | None:
        """The cell size, or the least for robots of the radius; None where there is neither."""
        if self.cell_size is not None or not isinstance(self.robot_radius, Real) or not self.robot_radius > 0:
            return self.cell_size
        cells = replace(self.tessellation, clock=self.clock or self.tessellation.clock)
        return round_up_size(least_cell_size(cells, float(self.reach), self.following))

    def area_of(self, ground: Ground, covering: Covering, name: str, progress: Progress | None) -> Area:
        """Return the area that covers a ground as the options say."""
        if self.align == "corner":
            return cover(ground, covering, name=name, progress=progress)
        return cover_aligned(ground, covering, self.align, name=name)

    @property
    def reach(self) -> float:
        """How far from its centre nothing may come to a robot, in metres."""
        return self.robot_radius + self.clearance

    def covering_of(self, path: object, kind: str, east: float, south: float) -> Covering:
        """Return how to cover a place of so many metres; raise FormatError if there is no cell size or too large a one.

        Files in degrees or kilometres draw places smaller than a cell.
        """
        if self.edge_step is None:
            raise FormatError(
                f"{path}: {kind} is measured in metres: say how far apart the centres of neighbouring cells shall be, "
                "cell_size 0.5 for half a metre (--cell-size on the command line), or how large robots are "
                "(--robot-radius)"
            )
        covering = Covering(self.tessellation, self.edge_step, self.reach)
        if max(east, south) < covering.cell_size:
            raise NoRoomError(
                f"{path}: {kind} must be larger than a cell of {covering.cell_size:g} metres, not {east:.3g} by "
                f"{south:.3g} metres: numbers are metres, not degrees or kilometres"
            )
        return covering
