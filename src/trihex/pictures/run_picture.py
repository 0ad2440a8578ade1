"""Run picture: what robots came to know of their world, and when."""

from __future__ import annotations

from itertools import islice

import numpy as np
from numpy.typing import NDArray

from trihex.errors import ExecutionError, check_type, check_whole
from trihex.pictures import marks as make, palette
from trihex.pictures.legend import scale_bars
from trihex.pictures.palette import BARRIER, DESTINATION, FREE, MOVING, STRANDED
from trihex.pictures.picture import Picture
from trihex.pictures.scene import Key, Mark, Ramp, Scene, scale_for
from trihex.pictures.setting import Setting, setting_of
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


def picture_of_run(
    run: Run, *, width: int | None = None, title: str | None = None, legend: bool = True, step: int | None = None
) -> Picture:
    """Return the picture of a run: the step in which each cell was first seen, what was never seen, starts of robots.

    Parameters
    ----------
    run : Run
    width, title, legend
        As for `picture_of_area`.
    step : int, optional
        Show barriers, destinations and robots as they were after this step, 0 to ``run.steps``, and what was known by
        then. Default: the world as it was in the end, and where robots began.

    Raises
    ------
    ExecutionError
        If there is no such step.
    """
    check_type("run", run, Run)
    if step is not None:
        check_whole("step", step, 0, run.steps, ExecutionError)
    area, scale = run.scenario.area, scale_for(run.scenario.area, width)
    first, last_step = len(CLASS_COLOURS), run.steps if step is None else step
    setting = setting_of(run, step)
    barriers, destinations = run.last_world if step is None else (setting.area.barriers, setting.destinations)
    cells = classes_of(run, last_step, barriers, destinations)
    last = max(1, int(run.known_since.max(initial=0, where=run.known_since <= last_step)))
    shades = palette.distance_ramp(_SHADES)
    is_shaded = (cells == 0) & (run.known_since >= 0) & (run.known_since <= last_step)
    if run.sensor is not None:
        cells[is_shaded] = first + np.rint(run.known_since[is_shaded] * ((_SHADES - 1) / last))
    marks: list[Mark] = make.destination_marks(Setting(area, destinations, run.robots), scale)
    keys = class_keys(run)
    if run.sensor is not None:
        keys.insert(0, Ramp(tuple(map(tuple, shades.tolist())), "first seen in step", "0", str(last)))
    robot_marks, robot_keys = _start_marks(run, scale) if step is None else _marks_after(run, step, scale)
    colours = np.vstack([CLASS_COLOURS, shades])
    words = f"{area.tessellation.name}, {area.width} x {area.height} cells, "
    arrived = np.count_nonzero(run.arrived & (run.ended <= last_step))
    words += f"{arrived} of {run.robots.size} robots arrive, {run.steps} steps, total time {run.total_time}" * (
        step is None
    )
    words += f"step {step} of {run.steps}, {arrived} of {run.robots.size} robots arrived" * (step is not None)
    return Picture(
        Scene(
            area,
            cells,
            colours,
            scale,
            (1, 3, 4),
            (*marks, *robot_marks),
            (*keys, *robot_keys, *scale_bars(area, scale)) if legend else (),
            run_title(run) if title is None else title,
            "" if title == "" else words,
        )
    )


def _start_marks(run: Run, scale: float) -> tuple[list[Mark], list[Key]]:
    """Return discs where robots began, and what they are."""
    start, stranded = np.arange(run.scenario.robot_count), np.flatnonzero(run.state_of_robot == GOING)
    marks = make.robot_marks(run.scenario, start, MOVING, scale)
    marks += make.stranded_marks(run.scenario, stranded[stranded < start.size], scale)
    keys = [Key("disc", MOVING, "start")] if start.size else []
    return marks, [*keys, *([Key("disc", STRANDED, "cut off")] if stranded.size else [])]


def _marks_after(run: Run, step: int, scale: float) -> tuple[list[Mark], list[Key]]:
    """Return discs where robots were after a step, and what they are."""
    cells = next(islice(run.cells_by_step(), step, None))
    there, is_cut_off = cells >= 0, (run.cut_off_since >= 0) & (run.cut_off_since <= step)
    where = Setting(run.scenario.area, run.scenario.destinations, np.maximum(cells, 0))
    marks = make.robot_marks(where, np.flatnonzero(there & ~is_cut_off), MOVING, scale)
    marks += make.stranded_marks(where, np.flatnonzero(there & is_cut_off), scale)
    keys = [Key("disc", MOVING, "robot")] if there.any() else []
    return marks, [*keys, *([Key("disc", STRANDED, "cut off")] if (there & is_cut_off).any() else [])]
