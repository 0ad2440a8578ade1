"""For each robot: a whole number, given for each, as one for all, or not at all."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import ScenarioError, is_whole
from trihex.record import counted, short


def for_each_robot(parameter: str, given: Any, count: int, usual: int, most: int, why: str = "") -> NDArray[np.int64]:
    """Return a number of each of `count` robots, from `usual`, which is that of robots of whom nothing is said.

    Numbers that are all as usual may be those of another count of robots: a scenario whose robots are replaced still
    has them.

    Raises
    ------
    ScenarioError
        If they are no whole numbers, not one for each robot, or one is below `usual` or above `most`; `why` tells why.
    """
    if is_whole(given):
        given = [given] * count
    numbers = np.asarray(given)
    if numbers.size and (numbers.dtype.kind not in "iu" or numbers.ndim != 1):
        raise ScenarioError(f"{parameter} must be whole numbers, one for each robot, not {short(given)}")
    if numbers.size == 0 or (numbers.size != count and (numbers == usual).all()):
        return np.full(count, usual, dtype=np.int64)
    if numbers.size != count:
        raise ScenarioError(f"{parameter} must be one for each of {counted(count, 'robot')}, not {numbers.size}")
    wrong = np.flatnonzero((numbers < usual) | (numbers > most))
    if wrong.size:
        rule = f"a whole number from {usual} to {most}{why}"
        raise ScenarioError(f"{parameter}[{wrong[0]}] must be {rule}, not {numbers[wrong[0]]}")
    return numbers.astype(np.int64)
