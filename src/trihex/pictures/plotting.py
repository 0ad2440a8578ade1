"""Drawers on the axes of matplotlib, for papers and notebooks (extra ``plot``).

A drawer takes a record and, if you like, an Axes, and returns the Axes. Lengths on the axes are in edge steps, y grows
to the south.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any

import numpy as np

from trihex.areas import Area, Scenario
from trihex.errors import MissingExtraError, check_many, check_type
from trihex.fields import DScheme, NScheme
from trihex.pictures.area_picture import picture_of_area
from trihex.pictures.palette import SERIES, Colour
from trihex.pictures.picture import Picture
from trihex.pictures.plan_picture import picture_of_plan
from trihex.pictures.png import disc_radius, paint
from trihex.pictures.scene import Discs, Key, Lines, Scene, Texts
from trihex.pictures.scheme_picture import picture_of_d_scheme, picture_of_n_scheme
from trihex.plans import Plan

# More cells are drawn as an image: as polygons they would take matplotlib over a second.
MOST_POLYGONS = 20_000
# A scene counts in pixels, matplotlib in points.
_PIXELS_PER_POINT = 2.0
_LONGER_SIDE, _MOST_STEP = 8.0, 0.9  # of a new figure and of an edge step, in inches


def draw_area(record: Area | Scenario, ax: Any = None) -> Any:
    """Draw an area, or a scenario with its destinations and robots; return the Axes."""
    check_type("record", record, Area, Scenario)
    area = record if isinstance(record, Area) else record.area
    return _draw(lambda width: picture_of_area(record, width=width), area, ax)


def draw_n_scheme(n_scheme: NScheme, ax: Any = None) -> Any:
    """Draw the distance of each cell; return the Axes."""
    check_type("n_scheme", n_scheme, NScheme)
    return _draw(lambda width: picture_of_n_scheme(n_scheme, width=width), n_scheme.scenario.area, ax)


def draw_d_scheme(d_scheme: DScheme, ax: Any = None) -> Any:
    """Draw the best moves of each cell; return the Axes."""
    check_type("d_scheme", d_scheme, DScheme)
    return _draw(lambda width: picture_of_d_scheme(d_scheme, width=width), d_scheme.n_scheme.scenario.area, ax)


def draw_plan(plan: Plan, ax: Any = None) -> Any:
    """Draw the paths of a few robots, or how often many robots visit each cell; return the Axes."""
    check_type("plan", plan, Plan)
    return _draw(lambda width: picture_of_plan(plan, width=width), plan.scenario.area, ax)


def draw_arrivals(plans: Plan | Sequence[Plan], ax: Any = None) -> Any:
    """Draw how many robots have arrived after each step, a line for each plan; return the Axes."""
    plans = [plans] if isinstance(plans, Plan) else plans
    check_many("plans", plans, Plan, "a plan or a list of plans")
    for number, plan in enumerate(plans):
        check_type(f"plans[{number}]", plan, Plan)
    ax = _axes(ax)
    for number, plan in enumerate(plans):
        steps = np.sort(plan.arrival_step_of_robot[plan.arrived])
        arrived = np.append(np.arange(steps.size + 1), steps.size)
        label = f"{plan.planner or 'plan'}, {plan.scenario.area.tessellation.name}"
        ax.step([0, *steps, plan.steps], arrived, where="post", color=_series(number), label=label)
    ax.set_xlabel("step")
    ax.set_ylabel("robots arrived")
    ax.set_ylim(bottom=0)
    ax.legend()
    return ax


def draw_comparison(rows: Sequence[Mapping[str, Any]], ax: Any = None) -> Any:
    """Draw the gaps of planners as bars, grouped by tessellation; return the Axes.

    Parameters
    ----------
    rows : sequence of mappings
        With the keys tessellation, planner, gap and optimal, as in a summary. Rows of the same planner and
        tessellation become one bar, their mean gap; a star marks plans that are all proven optimal.
    ax : Axes, optional
    """
    check_many("rows", rows, Mapping, "a list of rows, such as those of a comparison")
    ax = _axes(ax)
    tessellations = list(dict.fromkeys(row["tessellation"] for row in rows))
    planners = list(dict.fromkeys(row["planner"] for row in rows))
    wide = 0.8 / max(1, len(planners))
    for number, planner in enumerate(planners):
        label = planner
        for place, tessellation in enumerate(tessellations):
            own = [row for row in rows if (row["planner"], row["tessellation"]) == (planner, tessellation)]
            if not own:
                continue
            gap = 100 * float(np.mean([row["gap"] for row in own]))
            x = place + (number - (len(planners) - 1) / 2) * wide
            ax.bar(x, gap, 0.9 * wide, color=_series(number), label=label)
            label = "_"  # one entry in the legend is enough
            words = f"{gap:.1f}" + ("*" if all(row["optimal"] for row in own) else "")
            ax.annotate(words, (x, gap), (0, 2), textcoords="offset points", ha="center", fontsize=8)
    ax.set_xticks(range(len(tessellations)), tessellations)
    ax.set_ylabel("gap to the lower bound, % (* proven optimal)")
    ax.margins(y=0.15)
    if rows:
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, frameon=False)
    return ax


def _matplotlib(module: str) -> Any:
    try:
        return import_module(f"matplotlib.{module}")
    except ImportError as error:
        raise MissingExtraError("drawing on axes needs matplotlib: pip install 'trihex[plot]'") from error


def _axes(ax: Any, size: tuple[float, float] = (6.4, 4.8)) -> Any:
    """Return `ax`, or the Axes of a new figure of a size in inches."""
    return _matplotlib("pyplot").subplots(figsize=size, layout="constrained")[1] if ax is None else ax


def _rgb(colour: Colour) -> tuple[float, ...]:
    return tuple(band / 255 for band in colour)


def _series(number: int) -> tuple[float, ...]:
    return _rgb(SERIES[number % len(SERIES)])


def _draw(make: Callable[[int], Picture], area: Area, ax: Any) -> Any:
    """Draw on `ax` the picture that fits its size; `make` takes the width in pixels."""
    across, down = area.tessellation.extent(area.height, area.width)
    inches = min(_MOST_STEP, _LONGER_SIDE / max(across, down))
    ax = _axes(ax, (max(3.0, across * inches), max(2.0, down * inches)))
    box = ax.get_window_extent().transformed(ax.figure.dpi_scale_trans.inverted())
    points = 72 * min(box.width / across, box.height / down)
    scene = make(max(8, round(across * points * _PIXELS_PER_POINT))).scene
    if area.cell_count > MOST_POLYGONS:
        ax.imshow(paint(scene.without_words()), extent=(0, across, down, 0))
    else:
        _draw_cells(scene, ax)
        for mark in scene.marks:
            _draw_mark(mark, scene, ax)
    _draw_legend(scene, ax)
    ax.set(xlim=(0, across), ylim=(down, 0), aspect="equal", title=scene.title)
    ax.set_axis_off()
    return ax


def _draw_cells(scene: Scene, ax: Any) -> None:
    area = scene.area
    corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(np.arange(area.cell_count)))
    face = scene.colours[scene.colour_of_cell.reshape(-1)] / 255
    edge = 0.82 * face if scene.is_outlined else face
    cells = _matplotlib("collections").PolyCollection(corners, facecolors=face, edgecolors=edge, linewidths=0.4)
    ax.add_collection(cells)


def _draw_mark(mark: Discs | Lines | Texts, scene: Scene, ax: Any) -> None:
    collections = _matplotlib("collections")
    if isinstance(mark, Lines):
        width = mark.width / _PIXELS_PER_POINT
        ax.add_collection(collections.LineCollection(mark.paths, colors=[_rgb(mark.colour)], linewidths=width))
    elif isinstance(mark, Discs):
        size = np.full(mark.x.size, 2 * disc_radius(mark, scene) / scene.scale)
        places = np.stack([mark.x, mark.y], axis=-1)
        discs = collections.EllipseCollection(
            size, size, 0 * size, units="x", offsets=places, offset_transform=ax.transData, color=_rgb(mark.colour)
        )
        ax.add_collection(discs)
    else:
        size_in_points = mark.size / _PIXELS_PER_POINT
        for x, y, word in zip(mark.x, mark.y, mark.words, strict=True):
            ax.text(x, y, word, size=size_in_points, color=_rgb(mark.colour), ha="center", va="center_baseline")


def _draw_legend(scene: Scene, ax: Any) -> None:
    handles = []
    for entry in scene.legend:
        if isinstance(entry, Key):
            marker = {"cell": "s", "line": "_"}.get(entry.kind, "o")
            colour = _rgb(entry.colour)
            handles.append(
                _matplotlib("lines").Line2D([], [], color=colour, marker=marker, linestyle="", label=entry.words)
            )
            continue
        colours = _matplotlib("colors")
        scale = colours.LogNorm if "(log)" in entry.words else colours.Normalize
        shades = colours.ListedColormap([_rgb(colour) for colour in entry.colours])
        norm = scale(float(entry.low), max(float(entry.high), float(entry.low) + 1))
        shown = _matplotlib("cm").ScalarMappable(norm, shades)
        ax.figure.colorbar(shown, ax=ax, label=entry.words, shrink=0.6)
    if handles:
        ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=4, frameon=False, fontsize=8)
