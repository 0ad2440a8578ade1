"""Log: when each robot came and went, until when it is late, and since when it has had no way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.running.run import GOING

Ints = NDArray[np.int64]


class Log:
    """Steps of note in the life of each robot; numbers of steps as in `Run`.

    Parameters
    ----------
    start : int64 array
        The cells in which robots are at the beginning.

    Attributes
    ----------
    start : int64 array
        The first cell of each robot.
    joined, ended : int64 arrays
        The step after which each was in the area, and after which it was not any more, -1 if it still is.
    late_until : int64 array
        The last step in which an event makes it late.
    cut_off_since : int64 array
        The step in which it was known that it cannot arrive; -1 if it can.
    """

    def __init__(self, start: Ints) -> None:
        self.start = self.joined = self.ended = self.late_until = self.cut_off_since = np.empty(0, dtype=np.int64)
        self._add(start, 0)

    def _add(self, start: Ints, step: int) -> None:
        for name, value in (("joined", step), ("ended", -1), ("late_until", 0), ("cut_off_since", -1)):
            setattr(self, name, np.append(getattr(self, name), np.full(start.size, value, dtype=np.int64)))
        self.start = np.append(self.start, start)

    def join(self, cell: int, step: int) -> None:
        """Note that a robot joined in a cell after `step`."""
        self._add(np.array([cell], dtype=np.int64), step)

    def delay(self, robot: int, last: int) -> None:
        """Note that a robot is late up to the step `last`."""
        self.late_until[robot] = max(self.late_until[robot], last)

    def note(self, step: int, state_of_robot: NDArray[np.uint8], cut_off_robots: Ints) -> None:
        """Note who is not in the area any more after `step`, and who cannot arrive."""
        self.ended[(self.ended < 0) & (state_of_robot != GOING)] = step
        is_cut_off = np.zeros(state_of_robot.size, dtype=bool)
        is_cut_off[cut_off_robots] = True
        self.cut_off_since[~is_cut_off] = -1
        self.cut_off_since[is_cut_off & (self.cut_off_since < 0)] = step
