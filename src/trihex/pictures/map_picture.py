"""Map picture: where robots of a plan or a run lose time, and where they crowd."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, seconds_per_step
from trihex.errors import check_type
from trihex.judging import Score
from trihex.pictures import marks as make, palette
from trihex.pictures.legend import barrier_keys, colours_of
from trihex.pictures.palette import BARRIER, DESTINATION, FREE
from trihex.pictures.picture import Picture, titled
from trihex.pictures.scene import Key, Ramp, Scene, colour_rows, scale_for
from trihex.pictures.setting import Setting, setting_of
from trihex.plans import Motion, make_density_map, make_waiting_map

_SHADES = 240


def picture_of_waiting(
    plan: Motion, *, width: int | None = None, title: str | None = None, legend: bool = True, speed: float = 1.0
) -> Picture:
    """Return the picture of `make_waiting_map`: the time that robots lost in each cell.

    Parameters
    ----------
    plan : Plan or Run
    width, title, legend
        As for `picture_of_area`.
    speed : float
        Metres in a second: a place in metres tells seconds.
    """
    check_type("plan", plan, Motion)
    area, lost = plan.scenario.area, make_waiting_map(plan)
    seconds = 1.0 if area.frame is None else seconds_per_step(area, speed)
    unit = f"{plan.scenario.step_word}s" if area.frame is None else "seconds"
    more = f", {seconds * lost.sum():.6g} {unit} in all"
    return _picture(
        setting_of(plan), lost * seconds, f"{unit} lost", _named("Waiting", plan), more, (width, title, legend)
    )


def picture_of_density(
    plan: Motion, *, width: int | None = None, title: str | None = None, legend: bool = True
) -> Picture:
    """Return the picture of `make_density_map`: robots in each cell in the mean, or on a square metre.

    The parameters are those of `picture_of_waiting`.
    """
    check_type("plan", plan, Motion)
    unit = "robots a cell" if plan.scenario.area.frame is None else "robots a square metre"
    more = f", mean over {plan.steps} {plan.scenario.step_word}s"
    return _picture(
        setting_of(plan), make_density_map(plan), unit, _named("Density", plan), more, (width, title, legend)
    )


def picture_of_lost(
    score: Score, *, width: int | None = None, title: str | None = None, legend: bool = True
) -> Picture:
    """Return the picture of the seconds that a recorded crowd lost in each cell.

    Parameters
    ----------
    score : Score
    width, title, legend
        As for `picture_of_area`.
    """
    check_type("score", score, Score)
    more = f", {score.trajectories.name}, {score.lost.sum():.6g} seconds in all"
    return _picture(score.scenario, score.lost, "seconds lost", "Time lost", more, (width, title, legend))


def _picture(
    setting: Scenario | Setting,
    values: NDArray[Any],
    words: str,
    what: str,
    more: str,
    look: tuple[int | None, str | None, bool],
) -> Picture:
    area, (width, title, legend) = setting.area, look
    scale = scale_for(area, width)
    most, shades = float(values.max(initial=0)), palette.visits_ramp(_SHADES)
    cells = make.base_cells(setting, _SHADES, _SHADES + 1, _SHADES + 2)
    is_shaded = (values > 0) & (cells == _SHADES)
    cells[is_shaded] = np.rint(values[is_shaded] * ((_SHADES - 1) / max(most, 1e-300)))
    keys: list[Key | Ramp] = [Ramp(colours_of(shades), words, "0", f"{most:.3g}")] if is_shaded.any() else []
    keys += [Key("cell", DESTINATION, "destination"), *barrier_keys(area)]
    colours = np.vstack([shades, colour_rows([FREE, BARRIER, DESTINATION])])
    marks = make.destination_marks(setting, scale)
    bold = (*range(_SHADES), _SHADES + 1, _SHADES + 2)
    scene = Scene(area, cells, colours, scale, bold, tuple(marks), tuple(keys))
    return titled(scene, title, what, more, legend)


def _named(what: str, plan: Motion) -> str:
    return f"{what} ({plan.planner})" if plan.planner else what
