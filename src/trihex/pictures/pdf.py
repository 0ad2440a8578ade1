"""Painter of scenes as PDF, by matplotlib.

A writer of our own would need fonts: the fourteen that every reader of PDF has need not be embedded, but journals
refuse files without their fonts, and names of areas may hold any letter. So matplotlib draws the page that `sheet`
arranges, as vectors; the cells of areas too large for that are an image.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from trihex.pictures.axes import check_matplotlib, draw_scene, matplotlib, rgb
from trihex.pictures.palette import GROUND, PAGE
from trihex.pictures.png import ground_of_body
from trihex.pictures.scene import Scene
from trihex.pictures.sheet import RAMP_WIDTH, Sheet, arrange

# A pixel is that of SVG, 1/96 of an inch; matplotlib counts in points, 1/72.
_POINTS = 0.75
_EDGE = (0.67, 0.67, 0.67)


def write_pdf(scene: Scene, path: Path) -> None:
    """Write the picture of a scene as PDF; the same scene gives the same bytes.

    Raises
    ------
    MissingExtraError
        Without matplotlib.
    """
    check_matplotlib("a picture in PDF")
    sheet = arrange(scene)
    with matplotlib("style").context(["default", {"pdf.fonttype": 42}]), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*[Gg]lyph")  # a letter that the font lacks is drawn as a box
        figure = matplotlib("figure").Figure((sheet.width / 96, sheet.height / 96), facecolor=rgb(PAGE))
        _draw_body(scene, sheet, figure)
        _draw_strip(sheet, figure)
        # Fonts of type 42 can be searched and edited; without a date, equal pictures are equal files.
        figure.savefig(path, format="pdf", metadata={"CreationDate": None, "Title": scene.title or None})


def _draw_body(scene: Scene, sheet: Sheet, figure: Any) -> None:
    """Draw cells, what stands in the world, and marks."""
    left, top = sheet.body
    low = sheet.height - top - sheet.body_height
    wide, high = sheet.body_width / sheet.width, sheet.body_height / sheet.height
    ax = figure.add_axes((left / sheet.width, low / sheet.height, wide, high))
    draw_scene(scene, ax, pixels_per_point=1 / _POINTS)
    ax.set_title("")
    if scene.ground is not None:
        ground = ground_of_body(scene, scene.ground, sheet.body_width, sheet.body_height)
        image = np.zeros((*ground.shape, 4), dtype=np.uint8)
        image[ground] = (*GROUND, 255)
        limits = ax.get_xlim(), ax.get_ylim()
        ax.imshow(image, extent=(*limits[0], *limits[1]), zorder=1.5, interpolation="nearest")
        ax.set(xlim=limits[0], ylim=limits[1])
    ax.set_aspect("auto")  # the body is whole pixels


def _draw_strip(sheet: Sheet, figure: Any) -> None:
    """Draw title, subtitle and legend, in pixels from the north-west corner of the page."""
    ax = figure.add_axes((0, 0, 1, 1))
    ax.set_axis_off()
    patches = matplotlib("patches")
    for line in sheet.words:
        ax.text(line.x, line.y, line.words, size=_POINTS * line.size, color=rgb(line.colour), va="center_baseline")
    for x, y, key in sheet.symbols:
        colour = rgb(key.colour)
        if key.kind == "cell":
            ax.add_patch(patches.Rectangle((x - 7, y - 7), 14, 14, facecolor=colour, edgecolor=_EDGE, linewidth=0.75))
        elif key.kind == "line":
            ax.add_patch(patches.Rectangle((x - 7, y - 1), 14, 3, facecolor=colour))
        else:
            ax.add_patch(patches.Circle((x, y), 6, facecolor=colour))
    for x, y, ramp in sheet.ramps:
        colours = np.array(ramp.colours, dtype=np.uint8)[None]
        ax.imshow(colours, extent=(x, x + RAMP_WIDTH, y + 6, y - 6), aspect="auto", interpolation="nearest")
        box = patches.Rectangle((x, y - 6), RAMP_WIDTH, 12, fill=False, edgecolor=_EDGE, linewidth=0.75)
        ax.add_patch(box)
    ax.set(xlim=(0, sheet.width), ylim=(sheet.height, 0))
