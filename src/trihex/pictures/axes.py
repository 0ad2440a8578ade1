"""Axes: scenes on the axes of matplotlib, cells as polygons, marks as collections, legends that fit."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np

from trihex.errors import MissingExtraError
from trihex.pictures.palette import SERIES, Colour
from trihex.pictures.png import disc_radius, paint
from trihex.pictures.scene import Bar, Discs, Key, Lines, Ramp, Scene, Texts

# More cells are drawn as an image: as polygons they would take matplotlib over a second.
MOST_POLYGONS = 20_000
# A scene counts in pixels, matplotlib in points.
PIXELS_PER_POINT = 2.0
_PAD = 6.0  # between legend and axes, in points


def matplotlib(module: str, what: str = "drawing on axes") -> Any:
    """Return a module of matplotlib, or raise MissingExtraError that says what needs it."""
    try:
        return import_module(f"matplotlib.{module}")
    except ImportError as error:
        raise MissingExtraError(f"{what} needs matplotlib: pip install 'trihex[plot]'") from error


def check_matplotlib(what: str) -> None:
    """Raise MissingExtraError, which says what needs it, unless matplotlib is there."""
    matplotlib("figure", what)


def new_axes(ax: Any, size: tuple[float, float] = (6.4, 4.8)) -> Any:
    """Return `ax`, or the Axes of a new figure of a size in inches."""
    return matplotlib("pyplot").subplots(figsize=size, layout="constrained")[1] if ax is None else ax


def rgb(colour: Colour) -> tuple[float, ...]:
    """Return a colour as matplotlib takes it."""
    return tuple(band / 255 for band in colour)


def series(number: int) -> tuple[float, ...]:
    """Return the colour of the line or bar of a number."""
    return rgb(SERIES[number % len(SERIES)])


def draw_scene(scene: Scene, ax: Any, pixels_per_point: float = PIXELS_PER_POINT) -> None:
    """Draw cells and marks of a scene, and set the limits of the axes."""
    across, down = scene.area.tessellation.extent(scene.area.height, scene.area.width)
    if scene.area.cell_count > MOST_POLYGONS:
        ax.imshow(paint(scene.without_words()), extent=(0, across, down, 0))
    else:
        _draw_cells(scene, ax)
        for mark in scene.marks:
            _draw_mark(mark, scene, ax, pixels_per_point)
    ax.set(xlim=(0, across), ylim=(down, 0), aspect="equal")
    ax.set_axis_off()


def _draw_cells(scene: Scene, ax: Any) -> None:
    area = scene.area
    corners = area.tessellation.polygon_of_cell(*area.cell_to_xy(np.arange(area.cell_count)))
    face = scene.colours[scene.colour_of_cell.reshape(-1)] / 255
    edge = 0.82 * face if scene.is_outlined else face
    cells = matplotlib("collections").PolyCollection(corners, facecolors=face, edgecolors=edge, linewidths=0.4)
    ax.add_collection(cells)


def _draw_mark(mark: Discs | Lines | Texts, scene: Scene, ax: Any, pixels_per_point: float) -> None:
    collections = matplotlib("collections")
    if isinstance(mark, Lines):
        width = mark.width / pixels_per_point
        ax.add_collection(collections.LineCollection(mark.paths, colors=[rgb(mark.colour)], linewidths=width, zorder=2))
    elif isinstance(mark, Discs):
        size = np.full(mark.x.size, 2 * disc_radius(mark, scene) / scene.scale)
        places = np.stack([mark.x, mark.y], axis=-1)
        place = {"offsets": places, "offset_transform": ax.transData, "units": "x", "zorder": 2.5}
        discs = collections.EllipseCollection(size, size, 0 * size, color=rgb(mark.colour), **place)
        ax.add_collection(discs)
    else:
        size_in_points = mark.size / pixels_per_point
        for x, y, word in zip(mark.x, mark.y, mark.words, strict=True):
            ax.text(x, y, word, size=size_in_points, color=rgb(mark.colour), ha="center", va="center_baseline")


def handles_of(keys: Sequence[Key | Ramp | Bar]) -> list[Any]:
    """Return what stands for the keys of a legend."""
    line, marker = matplotlib("lines").Line2D, {"cell": "s", "line": "_"}
    return [
        line([], [], color=rgb(key.colour), marker=marker.get(key.kind, "o"), linestyle="", label=key.words)
        for key in keys
        if isinstance(key, Key)
    ]


def draw_ramps(keys: Sequence[Key | Ramp | Bar], axes: Any, **options: Any) -> bool:
    """Draw a colour bar beside the axes (one or several) for each ramp of a legend; tell whether there is one."""
    colours, figure = matplotlib("colors"), np.ravel(axes)[0].figure
    ramps = [key for key in keys if isinstance(key, Ramp)]
    for ramp in ramps:
        scale = colours.LogNorm if "(log)" in ramp.words else colours.Normalize
        shades = colours.ListedColormap([rgb(colour) for colour in ramp.colours])
        norm = scale(float(ramp.low), max(float(ramp.high), float(ramp.low) + 1))
        figure.colorbar(matplotlib("cm").ScalarMappable(norm, shades), ax=axes, label=ramp.words, **options)
    return bool(ramps)


def draw_legend(keys: Sequence[Key | Ramp | Bar], ax: Any) -> None:
    """Draw the legend of a scene beside and below its axes, no wider than there is room."""
    is_alone = len(ax.figure.axes) == 1
    has_ramps = draw_ramps(keys, ax, shrink=0.6)
    bars = [key for key in keys if isinstance(key, Bar)]
    for bar in bars:
        _draw_bar(bar, ax)
    if not (handles := handles_of(keys)):
        return
    room = ax.figure.bbox.width if is_alone else ax.get_window_extent().width
    if has_ramps and not is_alone:
        room *= 0.85  # the colour bar takes its share when the figure is laid out
    place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "frameon": False}
    legend = fit_legend(ax, handles, room, borderaxespad=2.5 if bars else 0.5, **place)
    keep_room(ax, 72 * legend.get_window_extent().height / ax.figure.dpi + _PAD, is_below=True)


def _draw_bar(bar: Bar, ax: Any) -> None:
    """Draw the scale below the axes, on the left."""
    place = matplotlib("transforms").blended_transform_factory(ax.transData, ax.transAxes)
    style = {"arrowstyle": "|-|, widthA=0.3, widthB=0.3", "shrinkA": 0, "shrinkB": 0}
    end, height = (bar.length, -0.03), {"xycoords": place, "annotation_clip": False}
    ax.annotate("", end, (0.0, -0.03), textcoords=place, arrowprops=style, **height)
    ax.annotate(bar.words, end, (4, 0), textcoords="offset points", fontsize=8, va="center", **height)


def keep_room(ax: Any, points: float, *, is_below: bool) -> None:
    """Make the axes lower, for a legend below or above, unless the figure lays out its axes by itself."""
    if ax.figure.get_layout_engine() is not None:
        return
    place = ax.get_position(original=True)
    taken = min(points * ax.figure.dpi / 72 / ax.figure.bbox.height, 0.6 * place.height)
    ax.set_position([place.x0, place.y0 + taken * is_below, place.width, place.height - taken])
    ax.set_in_layout(True)
    left = max(0.0, 1 - ax.get_tightbbox().x0) / ax.figure.bbox.width  # of words left of the figure
    if left:
        low, high = ax.get_position(original=True).intervaly
        ax.set_position([place.x0 + left, low, place.width - left, high - low])
        ax.set_in_layout(True)


def fit_legend(ax: Any, handles: Sequence[Any], room: float, **options: Any) -> Any:
    """Return a legend of as many columns, and of the largest of three sizes, as fit into so many pixels."""
    legend = None
    for size in (8, 6.5, 5):
        for columns in range(min(4, len(handles)), 0, -1):
            legend = ax.legend(handles=handles, ncols=columns, fontsize=size, **options)
            if legend.get_window_extent().width <= room:
                return legend
    return legend
