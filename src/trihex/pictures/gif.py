"""Writer of animated GIF, frame by frame, each stored as what differs from the frame before."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.pictures.palette import INK, PAGE, Colour

TRANSPARENT = 255
# Of the 255 other colours so many are left to the background.
_BACKGROUND_COLOURS = 130


class GifWriter:
    """Writes RGB frames of one size to a new file with one palette.

    Pillow's own writer keeps all frames until the last one has come; here memory is that of two frames. The pixels that
    do not change are stored as transparent, which makes files of moving robots 3 to 10 times smaller.

    Parameters
    ----------
    path : Path
    background : uint8 array, shape (height, width, 3)
        What all frames have in common; gives most of the palette.
    colours : list of Colour
        What moves over the background.
    """

    def __init__(self, path: Path, background: NDArray[np.uint8], colours: list[Colour]) -> None:
        palette = _palette(background, colours)
        self._index_of_colour = _nearest(palette)
        height, width = background.shape[:2]
        self._shown: NDArray[np.uint8] = np.full((height, width), TRANSPARENT, dtype=np.uint8)
        size = np.array([width, height], dtype="<u2").tobytes()
        table = np.zeros((256, 3), dtype=np.uint8)
        table[: len(palette)] = palette
        self._file = path.open("wb")
        self._file.write(b"GIF89a" + size + b"\xf7\x00\x00" + table.tobytes())
        self._file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")  # repeat for ever

    def add(self, frame: NDArray[np.uint8], milliseconds: int) -> None:
        """Append a frame, shown for a multiple of 10 ms."""
        from PIL import Image
        from PIL.GifImagePlugin import getdata

        from trihex.pictures.kernels.raster import look_up

        indexes = np.empty(frame.shape[:2], dtype=np.uint8)
        look_up(np.ascontiguousarray(frame), self._index_of_colour, indexes)
        is_new = indexes != self._shown
        rows, columns = np.flatnonzero(is_new.any(axis=1)), np.flatnonzero(is_new.any(axis=0))
        top, bottom = (rows[0], rows[-1] + 1) if rows.size else (0, 1)
        left, right = (columns[0], columns[-1] + 1) if columns.size else (0, 1)
        indexes_of_new = np.where(is_new, indexes, np.uint8(TRANSPARENT))
        part = np.ascontiguousarray(indexes_of_new[top:bottom, left:right])
        self._shown = indexes
        for block in getdata(
            Image.fromarray(part),
            (int(left), int(top)),
            duration=milliseconds,
            transparency=TRANSPARENT,
            disposal=1,
        ):
            self._file.write(block)

    def close(self) -> None:
        """Write what ends a GIF and close the file."""
        self._file.write(b";")
        self._file.close()


def _palette(background: NDArray[np.uint8], colours: list[Colour]) -> NDArray[np.uint8]:
    """Return at most 255 colours: those of letters, of soft edges, of the background, and the main ones last."""
    from PIL import Image

    image = Image.fromarray(background)
    if image.getcolors(_BACKGROUND_COLOURS) is None:  # too many: Pillow finds the nearest
        image = image.quantize(_BACKGROUND_COLOURS).convert("RGB")
    counted: list[tuple[int, Any]] = sorted(image.getcolors(_BACKGROUND_COLOURS) or [])
    own = [colour for _, colour in counted]
    parts = [np.linspace(INK, PAGE, 10)]
    parts += [np.linspace(colour, other, 7)[1:-1] for colour in colours for other in (PAGE, *own[-4:])]
    return np.round(np.concatenate([*parts, np.array(own), np.array(colours)])).astype(np.uint8)


def _nearest(palette: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the number of the nearest colour of `palette` for each colour given by the upper 5 bits of its bands.

    A colour of the palette stands for all that share its upper bits, the later ones before the earlier.
    """
    band = np.arange(32, dtype=np.float32) * 8 + 4
    red, green, blue = np.meshgrid(band, band, band, indexing="ij")
    wanted = np.stack([red, green, blue], axis=-1).reshape(-1, 1, 3)
    nearest = np.empty(len(wanted), dtype=np.uint8)
    for first in range(0, len(wanted), 4096):
        away = ((wanted[first : first + 4096] - palette[None].astype(np.float32)) ** 2).sum(axis=-1)
        nearest[first : first + 4096] = away.argmin(axis=-1)
    own = palette.astype(np.int64) >> 3
    nearest[own[:, 0] << 10 | own[:, 1] << 5 | own[:, 2]] = np.arange(len(palette))
    return nearest
