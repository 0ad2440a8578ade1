"""Image: dark pixels are barriers, one cell each, or occupied squares of a place measured in metres."""

from __future__ import annotations

import os
import re
import warnings
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, RasterGround
from trihex.areas.coverage import Progress
from trihex.errors import FormatError
from trihex.files import new_file
from trihex.formats.areas.options import AreaOptions
from trihex.formats.areas.rows import refuse_frame
from trihex.formats.draft import Draft

if TYPE_CHECKING:
    from PIL.Image import Image

# Pillow's names. No TIFF: its library writes what it thinks of a file to stderr.
KINDS = ("PNG", "PPM", "BMP", "GIF", "JPEG")
_KIND_OF_SUFFIX = {".png": "PNG", ".pgm": "PPM", ".bmp": "BMP"}  # those that are written
# What a small file may claim to unpack to: as much as 10 000 x 10 000.
MAX_PIXELS = 10**8
_ROWS_AT_ONCE = 256


class Pixels(NamedTuple):
    """The pixels of an image, 0 to 255, shape (rows, columns) each."""

    grey: NDArray[np.uint8]  # brightness; of colours the mean of red, green and blue
    alpha: NDArray[np.uint8] | None  # how opaque; None if the image has no such channel


def read_pixels(content: bytes, path: object) -> Pixels:
    """Return the brightness of each pixel, and how opaque it is.

    Raises
    ------
    FormatError
        If the image is damaged, of an unknown kind or too large.
    """
    from PIL import Image, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Pillow warns of size and of small damage: the first is judged here
            with Image.open(BytesIO(content), formats=KINDS) as image:
                width, height = image.size
                if width * height > MAX_PIXELS:
                    raise _too_large(path, f"{width} x {height}")
                image.load()
                return _pixels_of(image, path)
    except FormatError:
        raise
    except UnidentifiedImageError:
        raise FormatError(f"{path}: is no image that trihex reads ({', '.join(KINDS)})") from None
    except Image.DecompressionBombError as error:
        found = re.search(r"\((\d+) pixels\)", str(error))
        raise _too_large(path, found[1] if found else "more") from None
    except MemoryError:
        raise
    except Exception as error:  # decoders raise whatever they stumble on: struct.error, KeyError, zlib.error, ...
        raise FormatError(f"{path}: the image is damaged: {str(error) or type(error).__name__}") from None


def _too_large(path: object, size: str) -> FormatError:
    return FormatError(
        f"{path}: an image may have at most {MAX_PIXELS} pixels, not {size}: cut off what is not needed, or shrink it "
        "(a half as wide has twice the resolution in metres)"
    )


def _pixels_of(image: Image, path: object) -> Pixels:
    if image.mode == "F":  # a PFM
        values = np.asarray(image)
        if not ((values >= 0) & (values <= 1)).all():  # not so for nan
            wrong = values[~((values >= 0) & (values <= 1))][0]
            raise FormatError(f"{path}: brightness in a PFM must be a number from 0 to 1, not {wrong:g}")
        return Pixels(np.round(values * 255).astype(np.uint8), None)
    if image.mode.startswith("I"):  # 16 bits a pixel
        values = np.asarray(image).astype(np.float64)
        return Pixels(np.clip(np.round(values / 257), 0, 255).astype(np.uint8), None)
    if image.mode in ("1", "L") and not image.has_transparency_data:
        return Pixels(np.asarray(image.convert("L")), None)
    grey = np.empty((image.height, image.width), dtype=np.uint8)
    alpha = np.empty_like(grey)
    for top in range(0, image.height, _ROWS_AT_ONCE):  # four bytes a pixel, for some rows only
        rows = slice(top, min(top + _ROWS_AT_ONCE, image.height))
        colours = np.asarray(image.crop((0, rows.start, image.width, rows.stop)).convert("RGBA"))
        grey[rows] = np.round(colours[..., :3].sum(axis=2, dtype=np.uint16) / 3)
        alpha[rows] = colours[..., 3]
    return Pixels(grey, alpha if image.has_transparency_data else None)


def parse_image(content: bytes, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None) -> Draft:
    """Return the area of an image: a cell for each pixel, or cells of a size if the options have one.

    With a cell size the lower left corner of the image lies at (0, 0) metres. Transparent pixels count as bright.

    Raises
    ------
    FormatError
        If the image cannot be read, or there is a cell size but no resolution.
    """
    grey, alpha = read_pixels(content, path)
    is_free = (grey if alpha is None else np.where(alpha == 255, grey, 255)) >= options.threshold * 255
    occupied = is_free if options.invert else ~is_free
    name = Path(path).stem
    if options.edge_step is None:
        if options.clearance or options.resolution is not None:
            name = "resolution" if options.resolution is not None else "clearance"
            raise FormatError(f"{path}: {name} needs cell_size, the edge step of a cell in metres, or robot_radius")
        return Draft(Area(options.tessellation, occupied, name))
    if options.resolution is None:
        raise FormatError(
            f"{path}: an image has no measure: say how many metres a pixel is wide, resolution 0.05 for five "
            "centimetres (--resolution on the command line)"
        )
    rows, columns = occupied.shape
    covering = options.covering_of(path, "an image", columns * options.resolution, rows * options.resolution)
    origin = (0.0, rows * options.resolution)
    ground = RasterGround(occupied, options.resolution, origin, is_outside_occupied=options.unknown == "barrier")
    return Draft(options.area_of(ground, covering, name, progress))


def write_image(area: Area, path: str | os.PathLike[str]) -> None:
    """Write an area as an image of a pixel for each cell: barriers black, all else white; tessellation is not kept.

    Raises
    ------
    FormatError
        If the area has a frame, which an image cannot carry.
    """
    from PIL import Image

    refuse_frame(area.frame, path)
    with new_file(path) as part, open(part, "wb") as file:
        pixels = np.where(area.barriers, 0, 255).astype(np.uint8)
        Image.fromarray(pixels).save(file, format=_KIND_OF_SUFFIX[Path(path).suffix.lower()])
