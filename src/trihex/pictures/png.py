"""Painter of scenes in pixels, and writer of PNG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Ground
from trihex.pictures.palette import GROUND, INK, PAGE, Colour
from trihex.pictures.scene import OUTLINES_FROM, Discs, Lines, Scene, Texts
from trihex.pictures.sheet import RAMP_WIDTH, Sheet, Words, arrange, font_of

# Samples a call of the kernel may take, some 0.1 s, so that it can be interrupted.
_BUDGET = 8_000_000
# Pixels of the larger image on which lines are drawn to get soft edges.
_MOST_LINE_PIXELS = 60_000_000


def paint(scene: Scene, sheet: Sheet | None = None) -> NDArray[np.uint8]:
    """Return the picture of a scene as RGB, shape (height, width, 3)."""
    sheet = sheet or arrange(scene)
    page = np.full((sheet.height, sheet.width, 3), PAGE, dtype=np.uint8)
    lines = [mark for mark in scene.marks if isinstance(mark, Lines)]
    body = _body_with_lines(scene, sheet, lines) if lines else _body(scene, sheet.body_width, sheet.body_height, 1)
    left, top = sheet.body
    page[top : top + sheet.body_height, left : left + sheet.body_width] = body
    paint_disc_marks(page, scene, sheet)
    _paint_symbols(page, sheet)
    return write_words(page, (*sheet.words, *_words_in_cells(scene, sheet)))


def paint_disc_marks(page: NDArray[np.uint8], scene: Scene, sheet: Sheet) -> None:
    """Paint the discs among the marks of a scene onto its page."""
    left, top = sheet.body
    for mark in scene.marks:
        if isinstance(mark, Discs):
            x, y = left + mark.x * scene.scale, top + mark.y * scene.scale
            paint_discs(page, x, y, disc_radius(mark, scene), mark.colour)


def disc_radius(discs: Discs, scene: Scene) -> float:
    """Return the radius of discs in pixels."""
    return max(discs.radius * scene.scale, discs.least)


def paint_discs(
    image: NDArray[np.uint8], x: NDArray[np.float64], y: NDArray[np.float64], radius: float, colour: Colour
) -> None:
    """Paint discs of one colour and radius (all in pixels) onto an RGB image."""
    from trihex.pictures.kernels import raster

    x, y, rgb = np.ascontiguousarray(x), np.ascontiguousarray(y), np.array(colour, dtype=np.uint8)
    some = max(1, int(_BUDGET / (4 * (radius + 1) ** 2)))
    for first in range(0, x.size, some):
        raster.paint_discs(x[first : first + some], y[first : first + some], radius, rgb, image)


def _body(scene: Scene, width: int, height: int, larger: int) -> NDArray[np.uint8]:
    """Return the cells alone; a picture `larger` times as large needs no soft edges, for it will be reduced."""
    from trihex.kernels.signatures import given
    from trihex.pictures.kernels import raster

    tessellation, scale = scene.area.tessellation, scene.scale * larger
    edges = tessellation.edge_count
    step = tessellation.step_of_direction[:, :edges].astype(np.int64)
    # From a cell of each orientation, the way to the centres of its neighbours.
    x = np.array([[0], [1]])
    here, there = tessellation.centre_of_cell(x, 0 * x), tessellation.centre_of_cell(x + step[..., 0], step[..., 1])
    unit = np.stack([there[0] - here[0], there[1] - here[1]], axis=-1)
    weight = np.ones(len(scene.colours) + 1)
    # A wall one cell thick takes a share `scale` of its pixel; with this weight about half of its colour remains.
    weight[list(scene.bold)] = max(1.0, 1 / scene.scale)
    # Samples that are closer than cells are wide miss no wall.
    samples = 1 if larger > 1 else max(3, min(16, ceil(1.15 / scale)))
    outline = max(0.5, 0.012 * scale) / scale if scene.scale >= OUTLINES_FROM else 0.0
    page = np.array(PAGE, dtype=np.uint8)
    paint = given(
        raster.Paint,
        colour_of_cell=np.ascontiguousarray(scene.colour_of_cell),
        rgb=np.vstack([scene.colours, page]),
        weight=weight,
    )
    first_x, first_y = np.array(tessellation.centre_of_cell(0, 0)).reshape(2).tolist()
    lattice = given(
        raster.Lattice,
        step=np.ascontiguousarray(step),
        unit=np.ascontiguousarray(unit),
        pitch=scene.area.layout.pitch,
        first_x=first_x,
        first_y=first_y,
    )
    sampling = given(raster.Sampling, scale=scale, samples=samples, outline=outline)
    image = np.empty((height, width, 3), dtype=np.uint8)
    rows = max(1, _BUDGET // (width * samples**2))
    for first in range(0, height, rows):
        raster.shade(paint, lattice, sampling, first, min(height, first + rows), image)
    if scene.ground is not None:
        image[ground_of_body(scene, scene.ground, width, height)] = GROUND
    return image


def ground_of_body(scene: Scene, ground: Ground, width: int, height: int) -> NDArray[np.bool_]:
    """Return which pixels of the cells show something that stands in the world."""
    px, py = (np.arange(width) + 0.5) / scene.scale, ((np.arange(height) + 0.5) / scene.scale)[:, None]
    return ground.occupied_at(*scene.area.metres.point_to_metres(px, py))


def _body_with_lines(scene: Scene, sheet: Sheet, lines: list[Lines]) -> NDArray[np.uint8]:
    """Return the cells with lines, drawn larger and then reduced, because Pillow draws lines with hard edges."""
    from PIL import Image, ImageDraw

    larger = max(1, min(3, int((_MOST_LINE_PIXELS / (sheet.body_width * sheet.body_height)) ** 0.5)))
    image = Image.fromarray(_body(scene, sheet.body_width * larger, sheet.body_height * larger, larger))
    draw = ImageDraw.Draw(image)
    for mark in lines:
        width = max(1, round(mark.width * larger))
        for path in mark.paths:
            points = (path * scene.scale * larger).ravel().tolist()
            draw.line(points, fill=mark.colour, width=width, joint="curve" if width > 3 else None)
    return np.array(image.reduce(larger) if larger > 1 else image)


def _paint_symbols(page: NDArray[np.uint8], sheet: Sheet) -> None:
    for x, y, key in sheet.symbols:
        if key.kind == "cell":
            _paint_box(page, x - 7, y - 7, 14, 14, np.array(key.colour))
        elif key.kind == "line":
            page[round(y) - 1 : round(y) + 2, round(x) - 7 : round(x) + 7] = key.colour
        else:
            paint_discs(page, np.array([x]), np.array([y]), 6.0, key.colour)
    for x, y, ramp in sheet.ramps:
        at = np.arange(RAMP_WIDTH) * len(ramp.colours) // RAMP_WIDTH
        _paint_box(page, x, y - 6, RAMP_WIDTH, 12, np.array(ramp.colours)[at])
    for x, y, long in sheet.bars:
        left, top = round(x), round(y)
        page[top - 1 : top + 1, left : left + long] = INK
        for end in (left, left + long - 2):
            page[top - 5 : top + 5, end : end + 2] = INK


def _paint_box(page: NDArray[np.uint8], x: float, y: float, width: int, height: int, colour: NDArray[Any]) -> None:
    left, top = round(x), round(y)
    page[top : top + height, left : left + width] = (170, 170, 170)
    page[top + 1 : top + height - 1, left + 1 : left + width - 1] = colour[1:-1] if colour.ndim > 1 else colour


def write_words(page: NDArray[np.uint8], words: Iterable[Words]) -> NDArray[np.uint8]:
    """Return an RGB image with words on it."""
    from PIL import Image, ImageDraw

    image = Image.fromarray(page)
    draw = ImageDraw.Draw(image)
    for word in words:
        anchor = "mm" if word.is_centred else "lm"
        draw.text((word.x, word.y), word.words, fill=word.colour, font=font_of(word.size), anchor=anchor)
    return np.asarray(image)


def _words_in_cells(scene: Scene, sheet: Sheet) -> Iterator[Words]:
    for mark in scene.marks:
        if isinstance(mark, Texts):
            xs, ys = mark.x * scene.scale + sheet.body[0], mark.y * scene.scale + sheet.body[1]
            for x, y, word in zip(xs.tolist(), ys.tolist(), mark.words, strict=True):
                yield Words(x, y, word, mark.size, mark.colour, True)


def write_png(image: NDArray[np.uint8], file: Path | IO[bytes]) -> None:
    """Write an RGB image as PNG, with a palette if it has few colours: a third of the size."""
    from PIL import Image

    picture = Image.fromarray(image)
    colours: list[tuple[int, Any]] | None = picture.getcolors(256)
    if colours:
        rgb = np.array([colour for _, colour in colours], dtype=np.uint8)
        key = np.array([65536, 256, 1])
        index_of_key = np.zeros(1 << 24, dtype=np.uint8)
        index_of_key[rgb @ key] = np.arange(len(rgb))
        picture = Image.fromarray(index_of_key[image @ key])
        picture.putpalette(rgb.tobytes())
    picture.save(file, format="PNG", compress_level=4)  # half the time of 6 for a tenth more bytes
