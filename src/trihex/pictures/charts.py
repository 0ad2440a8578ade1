"""Charts: what several plans came to, as lines and as bars (extra ``plot``)."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from math import sqrt
from numbers import Real
from statistics import fmean, stdev
from typing import Any

import numpy as np

from trihex.areas import seconds_per_step
from trihex.bounds import EarliestArrivals
from trihex.errors import FormatError, check_many, check_type
from trihex.judging import Score
from trihex.pictures.axes import fit_legend, keep_room, matplotlib, new_axes, rgb, series
from trihex.pictures.palette import INK
from trihex.plans import Motion, make_exits

# What is asked of a run beside its robots: rows that differ in one of these never become one bar.
_RULES = ("neighbourhood", "costs", "waiting_cost", "crossing", "corners", "destination_capacity", "clock", "following")
_SINCE = {"clock": "steps", "following": "allow"}  # what holds in tables that do not have them yet
# The 97.5 % point of Student's distribution, by degrees of freedom; in between, the last before.
_STUDENT = {1: 12.71, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262, 14: 2.145}
_STUDENT |= {19: 2.093, 29: 2.045, 59: 2.001, 119: 1.980}
_LABEL_POINTS = 150.0  # how long the label of an axis is in one line
_PAD = 12.0  # points round the legend

Row = Mapping[str, Any]


def draw_arrivals(
    plans: Motion | Sequence[Motion],
    ax: Any = None,
    *,
    title: str | None = None,
    legend: bool = True,
    speed: float = 1.0,
) -> Any:
    """Draw how many robots have arrived after each step, a line for each plan or run; return the Axes.

    If all areas are in metres the time is in seconds, as robots take that are as fast as `speed` metres in a second.
    """
    plans = [plans] if isinstance(plans, Motion) else plans
    check_many("plans", plans, Motion, "a plan or a list of plans")
    for number, plan in enumerate(plans):
        check_type(f"plans[{number}]", plan, Motion)
    ax, in_seconds = new_axes(ax), all(plan.scenario.area.frame is not None for plan in plans)
    for number, plan in enumerate(plans):
        unit = seconds_per_step(plan.scenario.area, speed) if in_seconds else 1
        steps = np.sort(plan.arrival_step_of_robot[plan.arrived])
        arrived = np.append(np.arange(steps.size + 1), steps.size)
        label = f"{plan.planner or 'plan'}, {plan.scenario.area.tessellation.name}"
        times = np.array([0, *steps, plan.steps]) * unit
        ax.step(times, arrived, where="post", color=series(number), label=label)
    words = " or ".join(sorted({plan.scenario.step_word for plan in plans})) or "step"
    ax.set_xlabel("seconds" if in_seconds else words)
    return _finished(ax, title, legend)


def _finished(ax: Any, title: str | None, legend: bool) -> Any:
    """Name what goes up in curves of arrivals, and return the Axes."""
    ax.set_ylabel("robots arrived")
    ax.set_ylim(bottom=0)
    if title:
        ax.set_title(title)
    if legend:
        ax.legend()
    return ax


def draw_exits(
    plan: Motion,
    earliest: EarliestArrivals | None = None,
    ax: Any = None,
    *,
    title: str | None = None,
    legend: bool = True,
    speed: float = 1.0,
) -> Any:
    """Draw N(t), how many robots have arrived, for each exit and in all, beside what no plan can beat; return the Axes.

    Parameters
    ----------
    plan : Plan or Run
    earliest : EarliestArrivals, optional
        Of `make_earliest_arrivals`: a line that no other crosses. It holds in the world as it was at the beginning.
    ax : Axes, optional
    title : str, optional
    legend : bool
    speed : float
        Metres in a second: in a place in metres the time is in seconds.
    """
    check_type("plan", plan, Motion)
    check_type("earliest", earliest, EarliestArrivals, type(None))
    ax, exits, area = new_axes(ax), make_exits(plan), plan.scenario.area
    unit = 1.0 if area.frame is None else seconds_per_step(area, speed)
    times = np.arange(plan.steps + 1) * unit
    if earliest is not None:
        words = "least possible" if earliest.name == "optimum" else f"bound ({earliest.name})"
        ax.step(times, earliest.curve(plan.steps), where="post", color=rgb(INK), linestyle="--", label=words)
    if len(exits.names) > 1:
        ax.step(times, exits.total, where="post", color=rgb(INK), label="all exits")
    for number, (name, arrived) in enumerate(zip(exits.names, exits.arrived, strict=True)):
        ax.step(times, arrived, where="post", color=series(number), label=name)
    ax.set_xlabel(plan.scenario.step_word if area.frame is None else "seconds")
    return _finished(ax, title, legend)


def draw_score(score: Score, ax: Any = None, *, title: str | None = None, legend: bool = True) -> Any:
    """Draw N(t) of a recorded crowd beside the bound that it cannot pass; return the Axes."""
    check_type("score", score, Score)
    ax, arrivals = new_axes(ax), score.arrivals
    end = max(float(times.max(initial=0)) for times in (arrivals, score.earliest))
    for times, words, style in ((score.earliest, "bound", "--"), (arrivals, score.trajectories.name, "-")):
        counts = np.append(np.arange(times.size + 1), times.size)
        colour = rgb(INK) if style == "--" else series(0)
        ax.step([0, *times, end], counts, where="post", color=colour, linestyle=style, label=words)
    ax.set_xlabel("seconds")
    ax.set_ylabel("persons arrived")
    ax.set_ylim(bottom=0)
    if title:
        ax.set_title(title)
    if legend:
        ax.legend()
    return ax


def draw_comparison(rows: Sequence[Row] | Any, ax: Any = None, *, title: str | None = None, legend: bool = True) -> Any:
    """Draw the gaps of planners as bars, grouped by tessellation; return the Axes.

    Parameters
    ----------
    rows : sequence of mappings, or Comparison
        With the keys tessellation, planner and gap, as in the summary of a report, a comparison, or a study
        (`read_results`). Rows of the same tessellation, planner, options and rules (corners, crossing, waiting cost,
        neighbourhood, costs, destination capacity, clock, following) become one bar, their mean gap. Where they
        differ in their seeds, a line shows the 95 % interval of the mean over seeds, each the mean of its rows; without
        seeds, over rows. A star marks plans that are all proven optimal. Rows whose gap is None are left out.
    ax : Axes, optional
    title : str, optional
    legend : bool

    Raises
    ------
    FormatError
        If a row lacks one of the keys, or its gap is no number.
    """
    rows = [row for row in _checked(rows.rows() if hasattr(rows, "rows") else rows) if row["gap"] is not None]
    ax = new_axes(ax)
    tessellations = list(dict.fromkeys(row["tessellation"] for row in rows))
    named = _named(rows)
    names = list(dict.fromkeys(named))
    wide = 0.8 / max(1, len(names))
    handles, seeds, has_star = [], set[int](), False
    for number, name in enumerate(names):
        handles.append(matplotlib("patches").Patch(color=series(number), label=name))
        for place, tessellation in enumerate(tessellations):
            pairs = zip(rows, named, strict=True)
            own = [row for row, other in pairs if (row["tessellation"], other) == (tessellation, name)]
            if not own:
                continue
            gap, half, count = _interval(own)
            x = place + (number - (len(names) - 1) / 2) * wide
            ax.bar(x, gap, 0.9 * wide, color=series(number))
            if count > 1:
                seeds.add(count)
                ax.errorbar(x, gap, [[min(half, gap)], [half]], color=rgb(INK), capsize=2.5, linewidth=1)
            is_optimal = all(_is_optimal(row) for row in own)
            has_star |= is_optimal
            words = f"{gap:.1f}" + "*" * is_optimal
            ax.annotate(words, (x, gap + half), (0, 2), textcoords="offset points", ha="center", fontsize=8)
    ax.set_xticks(range(len(tessellations)), tessellations)
    ax.margins(y=0.15)
    _set_label(ax, "gap to the", "lower bound, %")
    if title:
        ax.set_title(title)
    if legend and rows:
        _draw_legend(ax, [*handles, *_notes(seeds, "seed" in rows[0], has_star)], title)
    return ax


def _checked(rows: Sequence[Row]) -> Sequence[Row]:
    check_many("rows", rows, Mapping, "a comparison, or a list of rows such as read_results returns")
    for number, row in enumerate(rows):
        if not isinstance(row, Mapping):
            raise FormatError(f"rows must be mappings, or a comparison; row {number} is {row!r:.80}")
        for key in ("tessellation", "planner", "gap"):
            if key not in row:
                raise FormatError(f"rows must have the keys tessellation, planner, gap; row {number} has no {key!r}")
        if not isinstance(row["gap"], Real | None):
            hint = "; read_results reads tables with numbers as numbers" if isinstance(row["gap"], str) else ""
            raise FormatError(f"row {number}: gap must be a number or None, not {row['gap']!r:.80}{hint}")
    return rows


def _named(rows: Sequence[Row]) -> list[str]:
    """Return for each row its planner with its options, and those rules that are not the same in all rows."""
    rules = [{key: row.get(key, _SINCE.get(key)) for key in _RULES} for row in rows]
    varied = [key for key in _RULES if len({own[key] for own in rules}) > 1]
    return [
        ", ".join([_planner_of(row), *(_rule_of(key, own[key]) for key in varied)])
        for row, own in zip(rows, rules, strict=True)
    ]


def _planner_of(row: Row) -> str:
    options = row.get("planner_options") or {}
    options = json.loads(options) if isinstance(options, str) else options
    return " ".join([str(row["planner"]), *(f"{key}={_words_of(value)}" for key, value in options.items())])


def _rule_of(key: str, value: Any) -> str:
    return f"{key.replace('_', ' ')} {'any' if value is None else value}"


def _words_of(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value).replace('"', "")


def _is_optimal(row: Row) -> bool:
    """Tell whether a plan is proven optimal, as reports and studies say, or comparisons by their reference."""
    if "optimal" in row:
        return bool(row["optimal"])
    return bool(row.get("is_proven")) and row["gap"] == 0


def _interval(rows: Sequence[Row]) -> tuple[float, float, int]:
    """Return the mean gap in %, half the width of its 95 % interval, and over how many seeds (or rows) it is taken."""
    of_seed: dict[Any, list[float]] = {}
    for number, row in enumerate(rows):
        of_seed.setdefault(row.get("seed", number), []).append(100 * float(row["gap"]))
    means = [fmean(gaps) for gaps in of_seed.values()]
    degrees = len(means) - 1
    if not degrees:
        return means[0], 0.0, 1
    point = _STUDENT[max(key for key in _STUDENT if key <= degrees)]
    return fmean(means), point * stdev(means) / sqrt(len(means)), len(means)


def _set_label(ax: Any, first: str, second: str) -> None:
    """Label the y-axis in one line or, where the figure is low, in two."""
    points = 72 * ax.get_window_extent().height / ax.figure.dpi
    ax.set_ylabel(f"{first} {second}" if points > _LABEL_POINTS else f"{first}\n{second}")


def _notes(seeds: set[int], is_by_seed: bool, has_star: bool) -> list[Any]:
    """Return what lines and stars on the bars mean."""
    notes = []
    if seeds:
        count = f"{min(seeds)} to {max(seeds)}" if len(seeds) > 1 else f"{max(seeds)}"
        notes.append(("|", f"95 % over {count} {'seeds' if is_by_seed else 'rows'}"))
    if has_star:
        notes.append(("$*$", "proven optimal"))
    line = matplotlib("lines").Line2D
    return [line([], [], color=rgb(INK), marker=marker, linestyle="", label=words) for marker, words in notes]


def _draw_legend(ax: Any, handles: list[Any], title: str | None) -> None:
    """Draw the legend above the axes, below the title."""
    room = ax.get_window_extent().width
    legend = fit_legend(ax, handles, room, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
    height = 72 * legend.get_window_extent().height / ax.figure.dpi + _PAD
    if title:
        ax.set_title(title, pad=height)
    keep_room(ax, height + _PAD * bool(title), is_below=False)
