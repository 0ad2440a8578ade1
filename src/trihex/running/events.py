"""Event: what happens in the world at a step, whatever the robots do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Zone
from trihex.errors import AreaError, ScenarioError, check_choice

# What each kind of event needs beside its step.
KINDS = {
    "barrier": ("cell",),
    "clear": ("cell",),
    "open": ("cell",),
    "close": ("cell",),
    "move": ("cell", "to"),
    "join": ("cell",),
    "leave": ("robot",),
    "break": ("robot",),
    "late": ("robot", "steps"),
}
# What can happen to all cells of a zone.
OF_ZONES = ("barrier", "clear", "open", "close")
# What is an obstacle where it is told in metres.
OF_SHAPES = ("barrier", "clear")
Points = tuple[tuple[float, float], ...]
MOST_STEPS = 1_000_000
MOST_POINTS = 10_000


@dataclass(frozen=True)
class Event:
    """One event.

    Parameters
    ----------
    step : int
        It happens at the beginning of this step, before the robots move; steps count from 1.
    kind : str
        "barrier": `cell` becomes a barrier; "clear": it becomes free. "open", "close": `cell` becomes a destination, or
        an ordinary cell again; "move": the destination at `cell` goes to the cell `to`. "join": a robot appears at
        `cell` and is given the next number; "leave": `robot` is taken away; "break": it breaks down, and its cell
        becomes a barrier; "late": it stands still for so many `steps`, this one being the first.
    cell, to : (x, y), optional
    robot, steps : int, optional
    zone : str, optional
        The name of a zone of the area in place of `cell`, for what happens to all of its cells that it can happen to:
        a barrier comes or goes, destinations open or close.
    metres, to_metres : (x, y) or points, optional
        Places in the world in place of `cell` and `to`: the cells in which they lie. As a barrier that comes or goes, a
        point, a line of two points or a polygon of more is an obstacle: see `Area.cells_touched`.

    Raises
    ------
    ScenarioError
        If there is no such kind, or something that it needs is missing or out of range, or something else is given.

    Examples
    --------
    >>> print(Event(5, "barrier", cell=(3, 4)))
    step 5: barrier at (3, 4)
    """

    step: int
    kind: str
    cell: tuple[int, int] | None = None
    to: tuple[int, int] | None = None
    robot: int | None = None
    steps: int | None = None
    zone: str | None = None
    metres: Points | None = None
    to_metres: Points | None = None

    def __post_init__(self) -> None:
        check_choice("event", self.kind, KINDS, ScenarioError)
        _check_whole("step", self.step, 1)
        for name in ("metres", "to_metres"):
            if (value := getattr(self, name)) is not None:
                points = _points(name, value)
                if len(points) > 1 and (name == "to_metres" or self.kind not in OF_SHAPES):
                    raise ScenarioError(f"{name} of event {self.kind!r} must be one point, not {len(points)}")
                object.__setattr__(self, name, points)
        self._check_needs()
        for name in ("cell", "to"):
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, _pair(name, value))
        if self.robot is not None:
            _check_whole("robot", self.robot, 0)
        if self.steps is not None:
            _check_whole("steps", self.steps, 1)
        if self.zone is not None:
            try:
                Zone(self.zone, ())  # type: ignore[arg-type]
            except AreaError as error:
                raise ScenarioError(f"event {self.kind!r} at step {self.step}: {error}") from None

    def _check_needs(self) -> None:
        """Raise unless all is there that the kind needs, and nothing else."""
        needs = KINDS[self.kind]
        names = ("cell", "to", "robot", "steps", "zone", "metres", "to_metres")
        given = {name for name in names if getattr(self, name) is not None}
        stands_for = {"metres": "cell", "to_metres": "to"}
        plain = {stands_for.get(name, name) for name in given}
        is_whole = len(plain) == len(given) == len(needs)
        if (is_whole and plain == set(needs)) or (given == {"zone"} and self.kind in OF_ZONES):
            return
        words = " and ".join(needs) + " or zone" * (self.kind in OF_ZONES)
        words += " (or metres)" * ("cell" in needs)
        wrong = [name for name in sorted(given) if stands_for.get(name, name) not in needs]
        wrong = wrong or [name for name in needs if name not in plain] or sorted(given)
        shown = " and ".join(f"{name}={getattr(self, name)!r:.80}" for name in wrong)
        raise ScenarioError(f"event {self.kind!r} at step {self.step} takes {words}, not {shown}")

    @property
    def place(self) -> str:
        """Where it happens, in words."""
        return _words(self.cell, self.metres) if self.zone is None else f"{self.zone!r}"

    def __str__(self) -> str:
        words = {
            "barrier": f"barrier at {self.place}",
            "clear": f"barrier at {self.place} goes",
            "open": f"destination opens at {self.place}",
            "close": f"destination closes at {self.place}",
            "move": f"destination moves from {self.place} to {_words(self.to, self.to_metres)}",
            "join": f"robot joins at {self.place}",
            "leave": f"robot {self.robot} leaves",
            "break": f"robot {self.robot} breaks down",
            "late": f"robot {self.robot} is late by {self.steps} steps",
        }
        return f"step {self.step}: {words[self.kind]}"


@dataclass(frozen=True)
class Occurrence:
    """What became of an event.

    Parameters
    ----------
    event : Event
    refusal : str
        Why it could not happen, empty if it did. The world is then as it was.
    blocked, freed, opened, closed : tuple of int
        Numbers of the cells that it changed.
    left_out : tuple of int
        Numbers of cells that should have become barriers, but robots stood there.
    """

    event: Event
    refusal: str = ""
    blocked: tuple[int, ...] = ()
    freed: tuple[int, ...] = ()
    opened: tuple[int, ...] = ()
    closed: tuple[int, ...] = ()
    left_out: tuple[int, ...] = ()

    @property
    def is_accepted(self) -> bool:
        """Whether it happened."""
        return not self.refusal

    @property
    def changes(self) -> dict[str, NDArray[np.int64]]:
        """The cells that it changed, by number, as `World.change` and `LivingField.change` take them."""
        cells = {"blocked": self.blocked, "freed": self.freed, "opened": self.opened, "closed": self.closed}
        return {name: np.array(own, dtype=np.int64) for name, own in cells.items()}

    def __str__(self) -> str:
        return f"{self.event}, refused: {self.refusal}" if self.refusal else str(self.event)


def _check_whole(parameter: str, value: object, least: int) -> None:
    is_whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not is_whole or not least <= int(value) <= MOST_STEPS:  # type: ignore[call-overload]
        raise ScenarioError(
            f"{parameter} of an event must be a whole number from {least} to {MOST_STEPS}, not {value!r}"
        )


def _pair(parameter: str, value: Any) -> tuple[int, int]:
    try:
        x, y = value
        if int(x) == x and int(y) == y and abs(int(x)) < 2**31 and abs(int(y)) < 2**31:
            return int(x), int(y)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ScenarioError(f"{parameter} of an event must be (x, y), two whole numbers, not {value!r:.80}")


def _points(parameter: str, value: Any) -> Points:
    """Return one pair (x, y) of metres, or several, as pairs of floats."""
    try:
        pairs = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        pairs = np.empty(0)
    pairs = pairs[None] if pairs.shape == (2,) else pairs
    if pairs.ndim != 2 or pairs.shape[1] != 2 or not 0 < len(pairs) <= MOST_POINTS or not (abs(pairs) <= 1e9).all():
        raise ScenarioError(
            f"{parameter} of an event must be a point (x, y) or up to {MOST_POINTS} of them, numbers of at most 1e9, "
            f"not {value!r:.80}"
        )
    return tuple((float(x), float(y)) for x, y in pairs)


def _words(cell: tuple[int, int] | None, metres: Points | None) -> str:
    """Return a cell or a place in metres as text."""
    if metres is None:
        return f"{cell}"
    more = f" and {len(metres) - 1} more points" if len(metres) > 1 else ""
    return f"({metres[0][0]:g}, {metres[0][1]:g}) metres{more}"
