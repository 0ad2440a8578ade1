"""Run picture: what robots came to know of their world, and when."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.pictures import marks as make, palette
from trihex.pictures.legend import scale_bars
from trihex.pictures.palette import BARRIER, DESTINATION, FREE, MOVING, STRANDED
from trihex.pictures.picture import Picture
from trihex.pictures.scene import Key, Mark, Ramp, Scene, scale_for
from trihex.running import GOING, Run

# What no robot has seen is drawn under fog, free cells and barriers each in a shade of it.
FOG: palette.Colour = (190, 198, 214)
FOG_BARRIER: palette.Colour = (134, 144, 164)
_SHADES = 200


def classes_of(run: Run, step: int, barriers: NDArray[np.bool_], destinations: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Return row of `CLASS_COLOURS` for each cell as it was after `step`, shape (height, width)."""
    is_known = (run.known_since >= 0) & (run.known_since <= step)
    classes = np.where(is_known, barriers, barriers + np.uint8(2)).astype(np.uint8)
    classes.reshape(-1)[destinations] = 4
    return classes


CLASS_COLOURS = np.array([FREE, BARRIER, FOG, FOG_BARRIER, DESTINATION], dtype=np.uint8)


def class_keys(run: Run) -> list[Key | Ramp]:
    """Return what the colours of cells mean."""
    keys: list[Key | Ramp] = [Key("cell", DESTINATION, "destination"), Key("cell", BARRIER, "barrier")]
    if run.sensor is not None:
        keys += [Key("cell", FOG, "not seen"), Key("cell", FOG_BARRIER, "barrier not seen")]
    return keys


def run_title(run: Run) -> str:
    """Return planner and area, and what robots saw."""
    name = f" of {run.scenario.area.name}" if run.scenario.area.name else ""
    sight = "" if run.sensor is None else f", sensing {run.sensor.radius:g} cells"
    sight += " in line of sight" if run.sensor is not None and run.sensor.line_of_sight else ""
    return f"Run ({run.planner}){name}{sight}"


def picture_of_run(run: Run, *, width: int | None = None, title: str | None = None, legend: bool = True) -> Picture:
    """Return the picture of a run: the step in which each cell was first seen, what was never seen, starts of robots.

    The parameters are those of `trihex.picture_of_area`.
    """
    area, scale = run.scenario.area, scale_for(run.scenario.area, width)
    first = len(CLASS_COLOURS)
    cells = classes_of(run, run.steps, *run.last_world)
    last = max(1, int(run.known_since.max(initial=0)))
    shades = palette.distance_ramp(_SHADES)
    is_shaded = (cells == 0) & (run.known_since >= 0)
    if run.sensor is not None:
        cells[is_shaded] = first + np.rint(run.known_since[is_shaded] * ((_SHADES - 1) / last))
    marks: list[Mark] = make.destination_marks(run.scenario, scale)
    start, stranded = np.arange(run.scenario.robot_count), np.flatnonzero(run.state_of_robot == GOING)
    marks += make.robot_marks(run.scenario, start, MOVING, scale)
    marks += make.stranded_marks(run.scenario, stranded[stranded < start.size], scale)
    keys = class_keys(run)
    if run.sensor is not None:
        keys.insert(0, Ramp(tuple(map(tuple, shades.tolist())), "first seen in step", "0", str(last)))
    keys += [Key("disc", MOVING, "start")] if start.size else []
    keys += [Key("disc", STRANDED, "cut off")] if stranded.size else []
    colours = np.vstack([CLASS_COLOURS, shades])
    words = f"{area.tessellation.name}, {area.width} x {area.height} cells, {np.count_nonzero(run.arrived)} of "
    words += f"{run.robots.size} robots arrive, {run.steps} steps, total time {run.total_time}"
    return Picture(
        Scene(
            area,
            cells,
            colours,
            scale,
            (1, 3, 4),
            tuple(marks),
            (*keys, *scale_bars(area, scale)) if legend else (),
            run_title(run) if title is None else title,
            "" if title == "" else words,
        )
    )
