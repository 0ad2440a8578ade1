"""Trajectories: where persons were, frame by frame, in metres; nobody planned it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.record import Record, counted, read_only


@dataclass(frozen=True, eq=False)
class Trajectories(Record):
    """A row for each person and frame, person by person, frames ascending.

    Parameters
    ----------
    name : str
    frame_rate : float
        Frames a second.
    person, frame : int64 arrays, shape (rows,)
        Persons are numbered from 0, frames from the first of the file.
    x, y : float64 arrays, shape (rows,)
        In metres.
    """

    name: str
    frame_rate: float
    person: NDArray[np.int64]
    frame: NDArray[np.int64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]

    def __post_init__(self) -> None:
        for name in ("person", "frame", "x", "y"):
            self._set(name, read_only(np.ascontiguousarray(getattr(self, name))))

    def in_words(self) -> str:
        """Return how many persons in how many seconds."""
        seconds = (int(self.frame.max(initial=0))) / self.frame_rate
        return f"{self.name!r}, {counted(self.person_count, 'person')}, {seconds:g} seconds"

    @property
    def person_count(self) -> int:
        """Number of persons."""
        return int(self.person.max(initial=-1)) + 1

    @property
    def first_row(self) -> NDArray[np.int64]:
        """Where the rows of each person begin, shape (persons,)."""
        return np.flatnonzero(np.append(True, np.diff(self.person) != 0)[: self.person.size])

    @property
    def last_row(self) -> NDArray[np.int64]:
        """The last row of each person, shape (persons,)."""
        return np.append(self.first_row[1:], self.person.size)[: self.person_count] - 1

    @property
    def greatest_speed(self) -> float:
        """The greatest speed of anyone from one row to the next, in metres a second."""
        same = np.diff(self.person) == 0
        gone = np.hypot(np.diff(self.x), np.diff(self.y))[same]
        took = np.diff(self.frame)[same] / self.frame_rate
        return float((gone / took).max(initial=0.0))
