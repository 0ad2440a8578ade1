"""Slowness: how many times as long as those of the fastest the moves of each robot last."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.for_each_robot import for_each_robot
from trihex.errors import PlanError, ScenarioError
from trihex.record import short

if TYPE_CHECKING:
    from trihex.areas.scenario import Scenario

#: Ticks that a move may last: those who plan from tick to tick look so far ahead.
LONGEST_MOVE = 30


def slowness_of(speeds: ArrayLike, *, fastest: float | None = None) -> NDArray[np.int64]:
    """Return the slowness of robots of some speeds: `fastest` / speed, rounded up, so that none is faster than it can.

    Parameters
    ----------
    speeds : sequence of float
        In any unit.
    fastest : float, optional
        The speed of slowness 1, which is the ``speed`` to tell all that makes seconds of steps. Default: the highest of
        `speeds`. At some times that, speeds that are no whole parts of one another are met more closely, by more steps.

    Raises
    ------
    ScenarioError
        If a speed is no number above 0.

    Examples
    --------
    >>> slowness_of([1.4, 1.4, 0.7, 0.5]).tolist()
    [1, 1, 2, 3]
    >>> slowness_of([1.5, 1.0], fastest=3).tolist()
    [2, 3]
    """
    try:
        own = np.asarray(speeds, dtype=np.float64)
        top = float(own.max(initial=0.0) if fastest is None else fastest)
    except (TypeError, ValueError):
        raise ScenarioError(f"speeds must be numbers above 0, not {short(speeds)}") from None
    if own.ndim != 1:
        raise ScenarioError(f"speeds must be numbers in a list, one for each robot, not {short(speeds)}")
    wrong = np.flatnonzero(~((own > 0) & (own < np.inf)))
    if wrong.size:
        raise ScenarioError(f"speeds[{wrong[0]}] must be a number above 0, not {own[wrong[0]]:g}")
    if own.size and not 0 < top < np.inf:
        raise ScenarioError(f"fastest must be a number above 0, not {top:g}")
    # What is a whole part but for the last digit is one.
    return np.maximum(1, np.ceil(np.minimum(top / own, 2.0**31) * (1 - 1e-12))).astype(np.int64)


def make_slowness(given: Any, count: int, longest: int) -> NDArray[np.int64]:
    """Return the slowness of each of `count` robots; `longest` is how many ticks moves of the fastest last at most."""
    why = f": no move may last longer than {LONGEST_MOVE} ticks"
    return for_each_robot("slowness", given, count, 1, LONGEST_MOVE // longest, why)


def check_as_fast(scenario: Scenario, what: str) -> None:
    """Raise PlanError where robots have slowness, of which `what` knows nothing."""
    if scenario.has_slowness:
        most = scenario.slowness.max()
        raise PlanError(f"{what} needs robots that are all as fast, without slowness, not slowness up to {most}")


def is_slower(slowness: Any) -> bool:
    """Tell whether some robot is said to be slower; whether it may be said so is asked later."""
    given = np.asarray(slowness)
    return given.dtype.kind in "iu" and bool((given > 1).any())


def check_following(following: str) -> None:
    """Raise ScenarioError unless a rule keeps robots that differ in slowness apart in an area in metres."""
    if following != "forbid":
        raise ScenarioError(
            f"following must be 'forbid' where robots have slowness in an area in metres, not {following!r}: "
            "who follows a slower one comes too near"
        )
