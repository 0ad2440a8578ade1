"""Turns: who comes to a thing after whom, and whether that one has gone by then."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]


def in_turn(
    came: Ints, went: Ints, things: NDArray[np.integer], apart: int = 1
) -> tuple[NDArray[np.bool_], Ints, Ints]:
    """Return whether who comes finds that who must go has gone, and the places of both in `came` and `went`.

    Each comes to one of `things` and goes from it, at half ticks; `apart` are how many may be there at a time.

    Examples
    --------
    >>> came, went, doors = np.array([0, 2, 5, 1]), np.array([2, 6, 7, 3]), np.array([8, 8, 8, 9])
    >>> is_free, later, earlier = in_turn(came, went, doors)
    >>> is_free.tolist(), later.tolist(), earlier.tolist()
    ([True, False], [1, 2], [0, 1])
    """
    by_came = np.lexsort((went, came, things))
    by_went = by_came if apart == 1 else np.lexsort((came, went, things))
    last, first = by_came[apart:], by_went[:-apart]
    is_same = things[last] == things[first]
    last, first = last[is_same], first[is_same]
    return went[first] <= came[last], last, first
