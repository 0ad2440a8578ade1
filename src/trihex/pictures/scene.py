"""Scene: what a picture shows, cells, marks and legend, before anything is painted.

Places are in edge steps from the north-west corner of the area, as `trihex.areas` gives them; sizes of letters and
widths of lines are in pixels. The painters (`png`, `svg`, `plotting`) only follow it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Ground
from trihex.errors import FormatError, TooLargeError
from trihex.pictures.palette import INK, Colour, is_light
from trihex.record import Record, read_only

# In pixels per edge step, the diameter of the circle inside a cell.
OUTLINES_FROM = 7.0
MOST_SCALE = 56.0
# The longest side of a picture unless the caller names a width: large areas get more, so that their walls show.
SIDE, MOST_SIDE = 960.0, 1600.0
MOST_PIXELS = 100_000_000


@dataclass(frozen=True, eq=False)
class Discs(Record):
    """Discs of one radius (in edge steps, but at least so many pixels) and one colour."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    radius: float
    colour: Colour
    least: float = 1.0


@dataclass(frozen=True, eq=False)
class Lines(Record):
    """Polylines, each of shape (points, 2), of one width (in pixels) and one colour."""

    paths: tuple[NDArray[np.float64], ...]
    width: float
    colour: Colour


@dataclass(frozen=True, eq=False)
class Texts(Record):
    """Words, each centred on its place, of one size (in pixels) and one colour."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    words: tuple[str, ...]
    size: float
    colour: Colour


Mark: TypeAlias = Discs | Lines | Texts


@dataclass(frozen=True)
class Key:
    """An entry of the legend: a cell, a disc, a line or a crossed disc of one colour, and what it stands for."""

    kind: str
    colour: Colour
    words: str


@dataclass(frozen=True)
class Ramp:
    """An entry of the legend: colours from `low` to `high`."""

    colours: tuple[Colour, ...]
    words: str
    low: str
    high: str


@dataclass(frozen=True)
class Bar:
    """An entry of the legend, the scale: a bar of so many edge steps, and how long that is in the world."""

    length: float
    words: str


Entry: TypeAlias = Key | Ramp | Bar


@dataclass(frozen=True, eq=False)
class Scene(Record):
    """What a picture shows.

    Parameters
    ----------
    area : Area
        Only its tessellation, its size and, for a ground, its frame are used.
    colour_of_cell : uint8 array, shape (height, width)
        Row of `colours`.
    colours : uint8 array, shape (n, 3)
    bold : tuple of int
        Rows of `colours` that must not fade where many cells share a pixel, such as barriers.
    marks : tuple of Discs, Lines and Texts
        Painted in the order lines, discs, texts.
    legend : tuple of Key, Ramp and Bar
    title, subtitle : str
    scale : float
        Pixels per edge step.
    ground : Ground, optional
        What is painted onto the cells, below all marks.
    """

    area: Area
    colour_of_cell: NDArray[np.uint8]
    colours: NDArray[np.uint8]
    scale: float
    bold: tuple[int, ...] = ()
    marks: tuple[Mark, ...] = ()
    legend: tuple[Entry, ...] = ()
    title: str = ""
    subtitle: str = ""
    ground: Ground | None = None

    @property
    def is_outlined(self) -> bool:
        """Whether cells are large enough for their outlines."""
        return self.scale >= OUTLINES_FROM

    def without_words(self) -> Scene:
        """Return the scene without title and legend."""
        return replace(self, title="", subtitle="", legend=())


def scale_for(area: Area, width: int | None, side: float = SIDE, most_side: float = MOST_SIDE) -> float:
    """Return the pixels per edge step at which `area` is `width` pixels wide.

    Without a width the longer side of the area takes `side` pixels, up to `most_side` where it has more cells.

    Raises
    ------
    FormatError
        If `width` is no whole number of at least 8 pixels.
    TooLargeError
        If the picture would have more pixels than a picture may have.
    """
    across, down = area.tessellation.extent(area.height, area.width)
    if width is None:
        side = min(max(side, across, down), most_side)
        scale = min(MOST_SCALE, side / max(across, down))
        # Squares of unequal size look wrong; other cells never fall on whole pixels in both directions.
        return float(int(scale)) if scale >= 1 and area.tessellation.name == "square" else scale
    if isinstance(width, bool) or not isinstance(width, int | np.integer) or width < 8:
        raise FormatError(f"width of a picture must be a whole number of at least 8 pixels, not {width!r}")
    scale = float(width) / across
    if scale * scale * across * down > MOST_PIXELS:
        raise TooLargeError(f"a picture may have at most {MOST_PIXELS} pixels; width {width} makes more")
    return scale


def centres_of(area: Area, cells: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the centres of cells given by number, in edge steps."""
    return area.tessellation.centre_of_cell(*area.cell_to_xy(cells))


def colour_rows(colours: list[Colour]) -> NDArray[np.uint8]:
    """Return colours as rows of an array."""
    return read_only(np.array(colours, dtype=np.uint8).reshape(-1, 3))


def ink_on(colour: Colour) -> Colour:
    """Return the colour of letters that reads best on `colour`."""
    return INK if is_light(colour) else (255, 255, 255)
