"""Orders: what robots are to do in one step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.record import in_one_line


class Orders(NamedTuple):
    """What the robots are to do in one step.

    Attributes
    ----------
    step : int
        The number of the step, from 1.
    action_of_robot : uint8 array
        A direction of the tessellation in the step in which a move begins, `UNDERWAY` (252) in those in which it goes
        on, else `WAIT` (255).
    cell_of_robot : int64 array
        Number of the cell in which each is after the step, or which it is entering; -1 for robots that are not in the
        area any more, the destination for those that arrive in this step.
    """

    step: int
    action_of_robot: NDArray[np.uint8]
    cell_of_robot: NDArray[np.int64]

    def __repr__(self) -> str:
        return in_one_line(self)
