"""Tables: rows of results, their means with intervals, and Markdown."""

import csv
from collections.abc import Callable, Iterable, Sequence
from math import sqrt
from pathlib import Path
from statistics import fmean, stdev
from typing import Any

FOLDER = Path(__file__).parent
WORDS = ("area", "tessellation", "neighbourhood", "costs", "planner", "planner_options", "destinations", "error")
# The 97.5 % point of Student's distribution, by degrees of freedom; above, the last.
_STUDENT = {1: 12.71, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 7: 2.365, 9: 2.262, 14: 2.145, 19: 2.093, 29: 2.045}

Row = dict[str, Any]


def read_rows(name: str) -> list[Row]:
    """Return the results of a study, its numbers as numbers."""
    with open(FOLDER / f"{name}.csv", newline="", encoding="utf-8") as file:
        return [{key: _value(key, text) for key, text in row.items()} for row in csv.DictReader(file)]


def _value(key: str, text: str) -> Any:
    if key in WORDS:
        return text
    try:
        return float(text) if "." in text or "e" in text else int(text)
    except ValueError:
        return text or None


def chosen(rows: Iterable[Row], **wanted: Any) -> list[Row]:
    """Return the rows that have the values wanted."""
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def mean_by_seed(rows: Sequence[Row], value: Callable[[Row], float]) -> tuple[float, float]:
    """Return the mean over seeds of the mean of each seed, and half the width of its 95 % interval."""
    means = [fmean(value(row) for row in rows if row["seed"] == seed) for seed in sorted({row["seed"] for row in rows})]
    degrees = len(means) - 1
    point = _STUDENT[max(key for key in _STUDENT if key <= max(degrees, 1))]
    return fmean(means), point * stdev(means) / sqrt(len(means)) if degrees else 0.0


def shown(rows: Sequence[Row], value: Callable[[Row], float], digits: int = 2) -> str:
    """Return the mean and its interval as text."""
    mean, half = mean_by_seed(rows, value)
    return f"{mean:.{digits}f} ± {half:.{digits}f}"


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table as Markdown."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def made_with(rows: Sequence[Row], study: str) -> str:
    """Return a line that tells how to make the results again."""
    versions = ", ".join(f"{name} {rows[0][name]}" for name in ("trihex", "numpy", "numba"))
    failed = sum(bool(row["error"]) for row in rows)
    seeds = len({row["seed"] for row in rows})
    return (
        f"{len(rows)} runs, {seeds} seeds, {failed} failed; {versions}.\n"
        f"`trihex study examples/studies/{study}.toml` makes `examples/studies/{study}.csv` again,\n"
        "`make studies` this page from it. ± is half a 95 % interval of the mean over seeds."
    )
