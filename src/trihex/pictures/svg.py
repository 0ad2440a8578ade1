"""Painter of scenes as SVG, by hand and compact."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from io import BytesIO
from math import ceil

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Ground
from trihex.pictures.palette import GROUND, INK, PAGE, Colour
from trihex.pictures.png import disc_radius, ground_of_body, paint, write_png
from trihex.pictures.scene import Discs, Lines, Scene, Texts
from trihex.pictures.sheet import RAMP_WIDTH, Sheet, arrange

# Coordinates are whole numbers, so many a pixel, which is shorter than decimals.
UNITS = 20
# More cells than this are embedded as an image: as polygons they would take over 2 MB, and viewers seconds.
MOST_POLYGONS = 60_000


def svg_of(scene: Scene) -> str:
    """Return the picture of a scene as SVG."""
    sheet = arrange(scene)
    left, top = sheet.body
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{sheet.width}" height="{sheet.height}"'
        f' viewBox="0 0 {sheet.width} {sheet.height}" font-family="sans-serif">',
        f"<title>{_escape(scene.title)}</title>" if scene.title else "",
        f'<rect width="100%" height="100%" fill="{_hex(PAGE)}"/>',
        f'<g transform="translate({left} {top}) scale({1 / UNITS})">',
        *(_polygons_and_marks(scene) if scene.area.cell_count <= MOST_POLYGONS else [_image(scene, sheet)]),
        "</g>",
        _strip(sheet),
        "</svg>\n",
    ]
    return "\n".join(part for part in parts if part)


def _hex(colour: Colour) -> str:
    return "#{:02x}{:02x}{:02x}".format(*(int(band) for band in colour))


def _escape(words: str) -> str:
    return escape("".join(letter for letter in words if letter.isprintable()))


def _whole(values: NDArray[np.float64], scene: Scene) -> NDArray[np.int64]:
    """Return lengths in edge steps as whole numbers of units."""
    return np.round(values * (scene.scale * UNITS)).astype(np.int64)


def _polygons_and_marks(scene: Scene) -> list[str]:
    return [
        _cells(scene),
        *([_ground(scene, scene.ground)] if scene.ground is not None else []),
        *(_lines(mark, scene) for mark in scene.marks if isinstance(mark, Lines)),
        *(_discs(mark, scene) for mark in scene.marks if isinstance(mark, Discs)),
        *(_texts(mark, scene) for mark in scene.marks if isinstance(mark, Texts)),
    ]


def _cells(scene: Scene) -> str:
    """Return one path for each colour, with a polygon for each cell."""
    height, width = scene.colour_of_cell.shape
    y, x = np.divmod(np.arange(height * width), width)
    corners = _whole(scene.area.tessellation.polygon_of_cell(x, y), scene)
    orientation = scene.area.tessellation.orientation_of_cell(x, y)
    # What follows the first corner is the same for all cells of an orientation.
    rest = {}
    for side in np.unique(orientation).tolist():
        way = np.diff(corners[np.argmax(orientation == side)], axis=0)
        rest[side] = "l" + " ".join(f"{dx} {dy}" for dx, dy in way.tolist()).replace(" -", "-") + "z"
    stroke = max(1.0, 0.024 * scene.scale) if scene.is_outlined else 0.3
    colour_of_cell = scene.colour_of_cell.reshape(-1)
    paths = []
    for colour in np.unique(colour_of_cell).tolist():
        of_colour = np.flatnonzero(colour_of_cell == colour)
        starts, sides = corners[of_colour, 0].tolist(), orientation[of_colour].tolist()
        d = "".join(f"M{px} {py}{rest[side]}" for (px, py), side in zip(starts, sides, strict=True))
        fill = scene.colours[colour]
        edge = fill * 0.82 if scene.is_outlined else fill
        paths.append(f'<path fill="{_hex(fill)}" stroke="{_hex(edge)}" stroke-width="{stroke * UNITS:.0f}" d="{d}"/>')
    return "\n".join(paths)


def _image(scene: Scene, sheet: Sheet) -> str:
    file = BytesIO()
    write_png(paint(scene.without_words()), file)
    return (
        f'<image width="{sheet.body_width * UNITS}" height="{sheet.body_height * UNITS}"'
        f' href="data:image/png;base64,{b64encode(file.getvalue()).decode()}"/>'
    )


def _ground(scene: Scene, ground: Ground) -> str:
    """Return what stands in the world as an image, transparent elsewhere."""
    from PIL import Image

    across, down = scene.area.tessellation.extent(scene.area.height, scene.area.width)
    width, height = max(1, round(across * scene.scale)), max(1, round(down * scene.scale))
    picture = Image.fromarray(ground_of_body(scene, ground, width, height).astype(np.uint8))
    picture.putpalette([*PAGE, *GROUND])
    file = BytesIO()
    picture.save(file, format="PNG", transparency=0)
    return (
        f'<image width="{width * UNITS}" height="{height * UNITS}"'
        f' href="data:image/png;base64,{b64encode(file.getvalue()).decode()}"/>'
    )


def _lines(mark: Lines, scene: Scene) -> str:
    d = "".join(
        "M" + "L".join(f"{x} {y}" for x, y in _whole(path, scene).tolist()).replace(" -", "-") for path in mark.paths
    )
    return (
        f'<path fill="none" stroke="{_hex(mark.colour)}" stroke-width="{ceil(mark.width * UNITS)}"'
        f' stroke-linejoin="round" stroke-linecap="round" d="{d}"/>'
    )


def _discs(mark: Discs, scene: Scene) -> str:
    radius = round(disc_radius(mark, scene) * UNITS)
    places = zip(_whole(mark.x, scene).tolist(), _whole(mark.y, scene).tolist(), strict=True)
    circles = "".join(f'<circle cx="{x}" cy="{y}" r="{radius}"/>' for x, y in places)
    return f'<g fill="{_hex(mark.colour)}">{circles}</g>'


def _texts(mark: Texts, scene: Scene) -> str:
    # Capitals and digits are some 0.7 em high; not every reader of SVG knows dominant-baseline.
    y = _whole(mark.y, scene) + round(0.35 * mark.size * UNITS)
    places = zip(_whole(mark.x, scene).tolist(), y.tolist(), mark.words, strict=True)
    texts = "".join(f'<text x="{x}" y="{y}">{_escape(word)}</text>' for x, y, word in places)
    return f'<g font-size="{mark.size * UNITS:.0f}" fill="{_hex(mark.colour)}" text-anchor="middle">{texts}</g>'


def _strip(sheet: Sheet) -> str:
    """Return title, subtitle and legend."""
    parts = []
    for line in sheet.words:
        y = line.y + 0.35 * line.size
        parts.append(f'<text x="{line.x:g}" y="{y:.1f}" font-size="{line.size}">{_escape(line.words)}</text>')
    for x, y, key in sheet.symbols:
        box = f'<rect x="{x - 7:g}" y="{y - 7:g}" width="14" height="14" stroke="#aaa"'
        disc, bar = f'<circle cx="{x:g}" cy="{y:g}" r="6"', f'<rect x="{x - 7:g}" y="{y - 1:g}" width="14" height="3"'
        shape = {"cell": box, "line": bar}.get(key.kind, disc)
        parts.append(f'{shape} fill="{_hex(key.colour)}"/>')
    for number, (x, y, ramp) in enumerate(sheet.ramps):
        colours = ramp.colours[:: max(1, len(ramp.colours) // 12)]
        stops = "".join(
            f'<stop offset="{place / (len(colours) - 1):.2f}" stop-color="{_hex(colour)}"/>'
            for place, colour in enumerate(colours)
        )
        parts.append(f'<linearGradient id="ramp{number}">{stops}</linearGradient>')
        box = f'<rect x="{x:.1f}" y="{y - 6:g}" width="{RAMP_WIDTH}" height="12" stroke="#aaa"'
        parts.append(f'{box} fill="url(#ramp{number})"/>')
    for x, y, long in sheet.bars:
        d = f"M{x:g} {y - 5:g}v10m0-5h{long}m0-5v10"
        parts.append(f'<path fill="none" stroke="{_hex(INK)}" stroke-width="2" d="{d}"/>')
    return f'<g fill="{_hex(INK)}">' + "\n".join(parts) + "</g>" if parts else ""
