"""Tile sheet: the tiles of a map for Tiled, each with a property, and their picture."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trihex.formats.areas.tiled_layout import TiledLayout
from trihex.record import Record

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

# Width, height and side of tiles in pixels, by the axis of the stagger.
_SIZES = {"": (32, 32, 0), "x": (32, 28, 16), "y": (28, 32, 16)}
COLUMNS = 64


@dataclass(frozen=True)
class Tile(Record):
    """A tile: its colour, its property, and the ways that are drawn on it, (east, south) of length 1."""

    colour: tuple[int, ...]
    name: str
    value: int | str | bool
    ways: tuple[tuple[float, float], ...] = ()


@dataclass
class TileSheet:
    """The tiles of a map, which grow as layers are made."""

    layout: TiledLayout
    tiles: list[Tile] = field(default_factory=list)

    def add(self, tiles: list[Tile]) -> int:
        """Add tiles; return the number by which layers know the first of them."""
        self.tiles += tiles
        return len(self.tiles) - len(tiles) + 1

    @property
    def size(self) -> tuple[int, int, int]:
        """Width, height and side of a tile."""
        return _SIZES[self.layout.axis]

    def middle_of(self, column: NDArray[np.int64], row: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the middle of tiles in pixels of the map, shape (n, 2)."""
        wide, high, side = self.size
        along = row if self.layout.axis == "y" else column
        shift = (along + self.layout.is_even) % 2 / 2
        x, y = column * float(wide), row * float(high)
        if self.layout.axis == "x":
            x, y = column * (wide + side) / 2, y + shift * high
        elif self.layout.axis == "y":
            x, y = x + shift * wide, row * (high + side) / 2
        return np.stack([x + wide / 2, y + high / 2], axis=-1)

    def corners(self) -> list[tuple[float, float]]:
        """Return the corners of a tile."""
        wide, high, side = self.size
        a, b = (wide - side) / 2, (high - side) / 2
        if self.layout.axis == "x":
            return [(a, 0), (a + side, 0), (wide, high / 2), (a + side, high), (a, high), (0, high / 2)]
        if self.layout.axis == "y":
            return [(wide / 2, 0), (wide, b), (wide, b + side), (wide / 2, high), (0, b + side), (0, b)]
        return [(0, 0), (wide, 0), (wide, high), (0, high)]

    def draw(self, path: Path) -> None:
        """Write the picture of all tiles, in rows."""
        from PIL import Image, ImageDraw

        wide, high, _ = self.size
        rows = -(-len(self.tiles) // COLUMNS)
        picture = Image.new("RGBA", (wide * COLUMNS, high * rows))
        pen = ImageDraw.Draw(picture)
        for number, tile in enumerate(self.tiles):
            self._draw_tile(pen, tile, number % COLUMNS * wide, number // COLUMNS * high)
        picture.save(path, "PNG")

    def _draw_tile(self, pen: ImageDraw, tile: Tile, left: int, top: int) -> None:
        pen.polygon([(left + x, top + y) for x, y in self.corners()], fill=tile.colour)
        x, y, length = left + self.size[0] / 2, top + self.size[1] / 2, 0.38 * min(self.size[:2])
        for east, south in tile.ways:
            tip = (x + length * east, y + length * south)
            pen.line([(x, y), tip], fill=(0, 0, 0), width=2)
            pen.circle(tip, 2.5, fill=(0, 0, 0))
