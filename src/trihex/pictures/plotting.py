"""Drawers on the axes of matplotlib, for papers and notebooks (extra ``plot``).

A drawer takes a record and, if you like, an Axes, and returns the Axes. Lengths on the axes are in edge steps, y grows
to the south. All take a title (the default names the record, an empty one is left out) and `legend`, whether to explain
the colours.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario
from trihex.errors import check_type
from trihex.fields import DScheme, NScheme
from trihex.pictures.area_picture import picture_of_area
from trihex.pictures.axes import PIXELS_PER_POINT, draw_legend, draw_scene, new_axes
from trihex.pictures.picture import Picture
from trihex.pictures.plan_picture import picture_of_plan
from trihex.pictures.price_picture import picture_of_prices
from trihex.pictures.scheme_picture import picture_of_d_scheme, picture_of_generation, picture_of_n_scheme
from trihex.plans import Motion
from trihex.prices import Prices

_LONGER_SIDE, _MOST_STEP = 8.0, 0.9  # of a new figure and of an edge step, in inches


def draw_area(record: Area | Scenario, ax: Any = None, *, title: str | None = None, legend: bool = True) -> Any:
    """Draw an area, or a scenario with its destinations and robots; return the Axes."""
    check_type("record", record, Area, Scenario)
    area = record if isinstance(record, Area) else record.area
    return draw_on(lambda width: picture_of_area(record, width=width, title=title), area, ax, legend)


def draw_n_scheme(n_scheme: NScheme, ax: Any = None, *, title: str | None = None, legend: bool = True) -> Any:
    """Draw the distance of each cell; return the Axes."""
    check_type("n_scheme", n_scheme, NScheme)
    area = n_scheme.scenario.area
    return draw_on(lambda width: picture_of_n_scheme(n_scheme, width=width, title=title), area, ax, legend)


def draw_generation(
    scenario: Scenario,
    states: NDArray[np.integer],
    number: int,
    ax: Any = None,
    *,
    far: int | None = None,
    title: str | None = None,
    legend: bool = True,
) -> Any:
    """Draw a generation of the distance rule, as `picture_of_generation` does; return the Axes."""
    check_type("scenario", scenario, Scenario)

    def make(width: int) -> Picture:
        return picture_of_generation(scenario, states, number, far=far, width=width, title=title)

    return draw_on(make, scenario.area, ax, legend)


def draw_d_scheme(d_scheme: DScheme, ax: Any = None, *, title: str | None = None, legend: bool = True) -> Any:
    """Draw the best moves of each cell; return the Axes."""
    check_type("d_scheme", d_scheme, DScheme)
    area = d_scheme.n_scheme.scenario.area
    return draw_on(lambda width: picture_of_d_scheme(d_scheme, width=width, title=title), area, ax, legend)


def draw_plan(plan: Motion, ax: Any = None, *, title: str | None = None, legend: bool = True) -> Any:
    """Draw the paths of a few robots, or how often many robots visit each cell; return the Axes."""
    check_type("plan", plan, Motion)
    return draw_on(lambda width: picture_of_plan(plan, width=width, title=title), plan.scenario.area, ax, legend)


def draw_prices(prices: Prices, ax: Any = None, *, title: str | None = None, legend: bool = True) -> Any:
    """Draw what each wall and each choke costs, and the best next door; return the Axes."""
    check_type("prices", prices, Prices)
    area = prices.plan.scenario.area
    return draw_on(lambda width: picture_of_prices(prices, width=width, title=title), area, ax, legend)


def draw_on(make: Callable[[int], Picture], area: Area, ax: Any, legend: bool) -> Any:
    """Draw on `ax` the picture that fits its size; `make` takes the width in pixels."""
    across, down = area.tessellation.extent(area.height, area.width)
    inches = min(_MOST_STEP, _LONGER_SIDE / max(across, down))
    ax = new_axes(ax, (max(3.0, across * inches), max(2.0, down * inches)))
    box = ax.get_window_extent().transformed(ax.figure.dpi_scale_trans.inverted())
    points = 72 * min(box.width / across, box.height / down)
    scene = make(max(8, round(across * points * PIXELS_PER_POINT))).scene
    draw_scene(scene, ax)
    ax.set_title(scene.title)
    if legend:
        draw_legend(scene.legend, ax)
    return ax
