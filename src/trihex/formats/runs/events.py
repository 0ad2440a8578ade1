"""Events: what will happen at which step, as CSV or TOML."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable
from math import ceil, isfinite
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from trihex.areas import Area, seconds_per_step
from trihex.errors import FormatError, TrihexError, check_choice, check_many, check_type
from trihex.files import new_file, suffix_of
from trihex.formats.schema import Number, Points, Table, check_document, choice
from trihex.formats.text import Text, read_text
from trihex.formats.toml import complaint, parse_toml
from trihex.running import KINDS, MOST_STEPS, Event

SUFFIXES = (".csv", ".toml")
COLUMNS = ("step", "event", "x", "y", "to_x", "to_y", "robot", "steps", "zone", "metres", "to_metres")
MAX_BYTES = 2**26

# What a file may have beside what is written: seconds become steps when they are read.
_READ = (*COLUMNS, "second")

StepOf = Callable[[float], int]
_Step = Annotated[int, Field(ge=1, le=MOST_STEPS)]
_Point = Annotated[list[Number], Field(min_length=2, max_length=2)]
_Cell = Annotated[list[Annotated[int, Field(ge=-(2**30), le=2**30)]], Field(min_length=2, max_length=2)]


class EventTable(Table):
    """[[event]]: one event."""

    one_of = ("step", "second", "!")
    step: _Step | None = None
    second: Number | None = None
    event: Annotated[str, choice("it", tuple(KINDS))]
    cell: _Cell | None = None
    to: _Cell | None = None
    robot: Annotated[int, Field(ge=0, le=MOST_STEPS)] | None = None
    steps: _Step | None = None
    zone: str | None = None
    metres: Points | _Point | None = None
    to_metres: _Point | None = None


class EventsTable(Table):
    """The whole file."""

    event: list[EventTable] = Field(default_factory=list)


def read_events(
    path: str | os.PathLike[str], area: Area | None = None, *, speed: float = 1.0, turn_time: float = 0.0
) -> tuple[Event, ...]:
    """Return the events of a file, in its order.

    CSV has a header with `step` or `second`, `event` and those of `x`, `y`, `to_x`, `to_y`, `robot`, `steps`, `zone`,
    `metres`, `to_metres` that are needed, in any order; what an event does not need stays empty. TOML has a table
    ``[[event]]`` for each, with the keys `step` or `second`, `event` and `cell`, `to` (each ``[x, y]``), `robot`,
    `steps`, `zone` (the name of an exit), `metres`, `to_metres` (``[x, y]``; ``[[x, y], ...]`` for an obstacle). In CSV
    places in metres are written as ``3.2 -1``, several as ``3.2 -1; 4 -1; 4 0``.

    Parameters
    ----------
    path : path
    area : Area, optional
        Where they happen; needed where the file tells seconds, which count from the beginning of step 1. An event at a
        second happens at the first step that begins then or later.
    speed, turn_time : float
        How long a step lasts; see `trihex.areas.seconds_per_step`.

    Raises
    ------
    FormatError
        If the file is none of these, or says something that is no event, or seconds where the area is not in metres.
    OSError
        If it cannot be read.
    """
    check_type("area", area, Area, type(None))
    suffix = suffix_of(path, SUFFIXES, "events")
    text = read_text(path, MAX_BYTES)
    lasts = None if area is None or area.frame is None else seconds_per_step(area, speed, turn_time)

    def step_of(second: float) -> int:
        if lasts is None:
            raise FormatError(f"second needs an area in metres, where steps last; give step in place of {second:g}")
        if not isfinite(second) or not 0 <= second <= (MOST_STEPS - 1) * lasts:
            raise FormatError(f"second must be from 0 to {(MOST_STEPS - 1) * lasts:g}, not {second:g}")
        # Step k begins after k - 1 of them; 0.9 / 0.3 is a hair above 3.
        return min(ceil(second / lasts * (1 - 1e-12)) + 1, MOST_STEPS)

    return _from_toml(text, path, step_of) if suffix == ".toml" else _from_csv(text, path, step_of)


def _from_toml(text: Text, path: str | os.PathLike[str], step_of: StepOf) -> tuple[Event, ...]:
    table, mistakes = check_document(EventsTable, parse_toml(text, path))
    events = []
    for number, one in enumerate(table.event if table is not None and not mistakes else ()):
        try:
            cell, to = (None if place is None else (place[0], place[1]) for place in (one.cell, one.to))
            others = (one.robot, one.steps, one.zone, one.metres, one.to_metres)
            step = one.step if one.second is None else step_of(one.second)
            events.append(Event(step, one.event, cell, to, *others))  # type: ignore[arg-type]
        except TrihexError as error:
            mistakes.append(f"event.{number}: {error}")
    if mistakes:
        raise complaint(path, mistakes)
    return tuple(events)


def _from_csv(text: Text, path: str | os.PathLike[str], step_of: StepOf) -> tuple[Event, ...]:
    try:
        lines = [*csv.reader(text.decode().splitlines())] or [[]]
    except csv.Error as error:
        raise FormatError(f"{path}: is no CSV: {error}") from None
    header = [name.strip() for name in lines[0]]
    for name in header:
        check_choice(f"{path}: line 1: a column", name, _READ, FormatError)
    if len(set(header)) < len(header) or "event" not in header or not {"step", "second"} & set(header):
        raise FormatError(f"{path}: line 1: the header must have step or second, and event, and each column once")
    events = []
    for number, values in enumerate(lines[1:], start=2):
        if not "".join(values).strip():
            continue
        if len(values) != len(header):
            raise FormatError(f"{path}: line {number}: there must be {len(header)} columns, not {len(values)}")
        try:
            events.append(_event_of(dict(zip(header, values, strict=True)), step_of))
        except TrihexError as error:
            raise FormatError(f"{path}: line {number}: {error}") from None
    return tuple(events)


def _event_of(row: dict[str, str], step_of: StepOf) -> Event:
    """Return the event of a row of text."""
    numbers: dict[str, Any] = {}
    for name, text in row.items():
        if name not in ("event", "second", "zone", "metres", "to_metres") and text.strip():
            try:
                numbers[name] = int(text) if len(text) <= 20 else None
            except ValueError:
                numbers[name] = None
            if numbers[name] is None:
                raise FormatError(f"{name} must be a whole number, not {text.strip()[:40]!r}")
    if (second := row.get("second", "").strip()) and "step" in numbers:
        raise FormatError("there must be only one of step and second")
    if second:
        numbers["step"] = step_of(_number("second", second))
    if "step" not in numbers:
        raise FormatError(f"step{' or second' * ('second' in row)} is missing")
    for one, other in (("x", "y"), ("to_x", "to_y")):
        if (one in numbers) != (other in numbers):
            raise FormatError(f"{one} and {other} must come together")
    cell = (numbers["x"], numbers["y"]) if "x" in numbers else None
    to = (numbers["to_x"], numbers["to_y"]) if "to_x" in numbers else None
    return Event(
        numbers["step"],
        row["event"].strip(),
        cell,
        to,
        numbers.get("robot"),
        numbers.get("steps"),
        row.get("zone", "").strip() or None,
        _points_of("metres", row),
        _points_of("to_metres", row),
    )


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise FormatError(f"{name} must be a number, not {text[:40]!r}") from None


def _points_of(name: str, row: dict[str, str]) -> Any:
    """Return the points of text such as 3.2 -1; 4 -1, None if there is none."""
    text = row.get(name, "").strip()
    try:
        points = [tuple(float(number) for number in pair.split()) for pair in text.split(";") if text]
    except ValueError:
        points = [()]
    if any(len(pair) != 2 for pair in points):
        raise FormatError(f"{name} must be X Y in metres, or several as X Y; X Y, not {text[:40]!r}")
    return points or None


def write_events(events: tuple[Event, ...], path: str | os.PathLike[str]) -> None:
    """Write events as CSV."""
    check_many("events", events, Event, "a list of events")
    suffix_of(path, SUFFIXES[:1], "events")
    with new_file(path) as part, open(Path(part), "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for event in events:
            places = [*(event.cell or ("", "")), *(event.to or ("", ""))]
            others = ["" if value is None else value for value in (event.robot, event.steps, event.zone)]
            metres = ["; ".join(f"{x!r} {y!r}" for x, y in own or ()) for own in (event.metres, event.to_metres)]
            writer.writerow([event.step, event.kind, *places, *others, *metres])
