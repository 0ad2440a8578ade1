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
MOST_STEPS = 1_000_000


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

    def __post_init__(self) -> None:
        check_choice("event", self.kind, KINDS, ScenarioError)
        _check_whole("step", self.step, 1)
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
        given = {name for name in ("cell", "to", "robot", "steps", "zone") if getattr(self, name) is not None}
        if given == set(needs) or (given == {"zone"} and self.kind in OF_ZONES):
            return
        words = " and ".join(needs) + " or zone" * (self.kind in OF_ZONES)
        wrong = [f"{name}={getattr(self, name)!r:.80}" for name in sorted(given - set(needs))]
        wrong = wrong or [f"{name}=None" for name in needs if name not in given]
        raise ScenarioError(f"event {self.kind!r} at step {self.step} takes {words}, not {wrong[0]}")

    @property
    def place(self) -> str:
        """Where it happens, in words."""
        return f"{self.cell}" if self.zone is None else f"{self.zone!r}"

    def __str__(self) -> str:
        words = {
            "barrier": f"barrier at {self.place}",
            "clear": f"barrier at {self.place} goes",
            "open": f"destination opens at {self.place}",
            "close": f"destination closes at {self.place}",
            "move": f"destination moves from {self.cell} to {self.to}",
            "join": f"robot joins at {self.cell}",
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
