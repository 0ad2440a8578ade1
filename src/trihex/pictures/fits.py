"""Fits: what robots find in a place on several kinds of cells, as one picture of many."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Fit, Scenario
from trihex.pictures.area_picture import picture_of_area
from trihex.pictures.palette import PAGE
from trihex.pictures.png import write_png

_WIDTH, _COLUMNS = 460, 4


def write_fits(fits: Sequence[Fit], path: Path) -> None:
    """Write one picture for each fit that has an area, beside and below each other, as PNG."""
    panels = [_panel(fit) for fit in fits if fit.area is not None]
    height = max((panel.shape[0] for panel in panels), default=1)
    width = max((panel.shape[1] for panel in panels), default=1)
    columns = min(_COLUMNS, max(1, len(panels)))
    rows = -(-len(panels) // columns) or 1
    image = np.empty((rows * height, columns * width, 3), dtype=np.uint8)
    image[:] = PAGE
    for number, panel in enumerate(panels):
        top, left = number // columns * height, number % columns * width
        image[top : top + panel.shape[0], left : left + panel.shape[1]] = panel
    write_png(image, path)


def _panel(fit: Fit) -> NDArray[np.uint8]:
    area, tessellation = fit.area, fit.tessellation
    if area is None:
        raise ValueError("a fit without an area has no picture")
    goals = fit.destinations[~area.is_barrier(fit.destinations)]
    record = Scenario(area, goals, following=fit.following) if goals.size else area
    title = f"{tessellation.name} {tessellation.direction_count}, {fit.cell_size:g} m"
    title += f", clock {fit.clocks[0]}" if len(fit.clocks) == 1 else ""
    title += ", following forbidden" if fit.following == "forbid" else ""
    return picture_of_area(record, width=_WIDTH, title=title, ground=area.ground).to_array()
