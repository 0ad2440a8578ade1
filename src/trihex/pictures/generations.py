"""Generations: the automaton on its way to the N-scheme, on one sheet (Figures 6 to 9 of the paper)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import FormatError, check_many, check_type, check_whole
from trihex.fields import DScheme
from trihex.kernels.codes import NOT_REACHED
from trihex.pictures.axes import draw_ramps, handles_of, matplotlib
from trihex.pictures.plotting import draw_area, draw_d_scheme, draw_generation, draw_plan
from trihex.pictures.scheme_picture import picture_of_generation
from trihex.plans import Plan

# A sheet of more panels shows some of the generations, evenly spread, unless the caller chooses.
_MOST_PANELS, _SPREAD = 24, 12
_SHEET_WIDTH, _MOST_STEP = 10.0, 0.6  # in inches


def draw_generations(
    scenario: Scenario,
    generations: Iterable[NDArray[np.integer]],
    *,
    numbers: Sequence[int] | None = None,
    d_scheme: DScheme | None = None,
    plan: Plan | None = None,
    configuration: bool = False,
    columns: int = 3,
    title: str | None = None,
    legend: bool = True,
) -> list[Any]:
    """Draw generations of the distance rule on one sheet, all on one colour scale; return the Axes in their order.

    Parameters
    ----------
    scenario : Scenario
    generations : iterable of arrays of integers, shape (height, width)
        As `distance_generations` yields them; the last is taken for the N-scheme.
    numbers : sequence of int, optional
        Which of them to show. Default: all, or of more than 24 a dozen, evenly spread.
    d_scheme : DScheme, optional
        Shown after the generations.
    plan : Plan, optional
        Shown at the end, the ways of the robots.
    configuration : bool
        Whether to show the scenario itself at the beginning, as Figures 6 and 8 do.
    columns : int
        How many panels lie side by side.
    title : str, optional
        Above all of them.
    legend : bool
        Whether to explain the colours, once.

    Raises
    ------
    FormatError
        If there is no generation of such a number, or `columns` is no whole number from 1.

    Examples
    --------
    >>> import trihex as th
    >>> scenario = th.Scenario(th.Area("hexagonal", [[0, 0, 1, 0], [0, 0, 0, 0]]), destinations=[(0, 0)])
    >>> axes = draw_generations(scenario, th.distance_generations(scenario))
    >>> [ax.get_title() for ax in axes][-2:]
    ['Generation 2', 'Generation 3: the N-scheme']
    """
    check_type("scenario", scenario, Scenario)
    check_many("generations", generations, dict, "arrays, as distance_generations yields them")
    check_whole("columns", columns, 1, 100, FormatError)
    states = list(generations)
    shown = _shown(len(states), numbers)
    last, far = len(states) - 1, int(states[-1].max(initial=1, where=states[-1] != NOT_REACHED))
    panels: list[Any] = [partial(draw_area, scenario, title="")] if configuration else []
    for number in shown:
        words = f"Generation {number}" + (": the N-scheme" if number == last else "")
        panels.append(partial(draw_generation, scenario, states[number], number, far=far, title=words))
    panels += [partial(draw_d_scheme, d_scheme, title="D-scheme")] if d_scheme is not None else []
    panels += [partial(draw_plan, plan, title=f"Plan, total time {plan.total_time}")] if plan is not None else []
    axes = _sheet(scenario, len(panels), min(columns, len(panels)))
    for draw, ax in zip(panels, axes, strict=True):
        draw(ax=ax, legend=False)
    if title:
        axes[0].figure.suptitle(title)
    if legend:
        _draw_legend(scenario, states[min(shown)], far, axes)  # of the first, which has most kinds of cells
    return axes


def _shown(count: int, numbers: Sequence[int] | None) -> list[int]:
    if count == 0:
        raise FormatError("generations must be at least one, as distance_generations yields them")
    if numbers is None:
        spread = np.linspace(0, count - 1, _SPREAD).round().astype(int).tolist()
        return list(range(count)) if count <= _MOST_PANELS else spread
    for number in numbers:
        check_whole("numbers of generations", number, 0, count - 1, FormatError)
    if not len(numbers):
        raise FormatError("numbers of generations must be at least one")
    return [int(number) for number in numbers]


def _sheet(scenario: Scenario, count: int, columns: int) -> list[Any]:
    """Return the Axes of a new figure for so many panels, each as large as its cells need."""
    area = scenario.area
    across, down = area.tessellation.extent(area.height, area.width)
    inches = min(_MOST_STEP, _SHEET_WIDTH / columns / across)
    rows = -(-count // columns)
    size = (max(4.0, columns * across * inches + 1.2), rows * (down * inches + 0.4) + 0.8)
    figure, axes = matplotlib("pyplot").subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    for ax in axes.flat[count:]:
        ax.remove()
    figure.get_layout_engine().set(w_pad=0.06, h_pad=0.06)
    return list(axes.flat[:count])


def _draw_legend(scenario: Scenario, states: NDArray[np.integer], far: int, axes: list[Any]) -> None:
    """Draw the one colour bar and the one legend of all generations."""
    keys = picture_of_generation(scenario, states, 0, far=far).scene.legend
    draw_ramps(keys, axes, shrink=0.6)
    axes[0].figure.legend(handles=handles_of(keys), loc="outside lower center", ncols=4, frameon=False, fontsize=8)
