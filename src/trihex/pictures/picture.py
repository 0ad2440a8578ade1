"""Picture: what a record looks like, as an image, as SVG or as PDF.

A maker takes a record and says what is seen (a scene); it plans nothing. Cells that are large enough show numbers,
arrows and letters, smaller ones show colours alone.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from trihex.files import new_file, suffix_of
from trihex.pictures.legend import scale_bars
from trihex.pictures.png import paint, write_png
from trihex.pictures.scene import Scene
from trihex.pictures.svg import svg_of
from trihex.record import Record

PICTURE_SUFFIXES = (".png", ".svg", ".pdf")


@dataclass(frozen=True, eq=False)
class Picture(Record):
    """A picture that can be saved, shown in a notebook, or taken as an array.

    Parameters
    ----------
    scene : Scene
        What it shows.
    """

    scene: Scene

    def to_array(self) -> NDArray[np.uint8]:
        """Return the pixels as RGB, shape (height, width, 3)."""
        return paint(self.scene)

    def to_svg(self) -> str:
        """Return the text of an SVG file; more than 60 000 cells are embedded as an image."""
        return svg_of(self.scene)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture to a file, .png, .svg or .pdf.

        Raises
        ------
        FormatError
            If the suffix is none of them.
        MissingExtraError
            If a .pdf is asked for without matplotlib (extra ``plot``).
        OSError
            If the file cannot be written.
        """
        suffix = suffix_of(path, PICTURE_SUFFIXES, "a picture")
        with new_file(path) as part:
            if suffix == ".pdf":
                from trihex.pictures.pdf import write_pdf  # imports matplotlib

                write_pdf(self.scene, part)
            elif suffix == ".svg":
                part.write_text(self.to_svg(), encoding="utf-8")
            else:
                write_png(self.to_array(), part)

    def _repr_png_(self) -> bytes:
        file = BytesIO()
        write_png(self.to_array(), file)
        return file.getvalue()


def titled(scene: Scene, title: str | None, what: str, more: str, legend: bool) -> Picture:
    """Return the picture of `scene` with `title`, or with a title that says what it is, and with its legend or not.

    Where the area lies in the world, the legend ends with the scale.
    """
    area = scene.area
    if title is None:
        title = f"{what} of {area.name}" if area.name and what != "Area" else area.name or what
    edge = ", edge neighbours" if area.tessellation.neighbourhood == "edge" else ""
    subtitle = f"{area.tessellation.name}, {area.width} x {area.height} cells{edge}{more}"
    entries = (*scene.legend, *scale_bars(area, scene.scale)) if legend else ()
    return Picture(replace(scene, title=title, subtitle=subtitle if title else "", legend=entries))
