"""Start times: after how many steps each robot begins to move, drawn or told in seconds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas.area import Area
from trihex.areas.seconds import seconds_per_step
from trihex.errors import ScenarioError, check_type, check_whole
from trihex.record import short

#: Distributions by name, with what their numbers are.
DISTRIBUTIONS = {
    "constant": ("time",),
    "uniform": ("least", "most"),
    "normal": ("mean", "sd"),
    "lognormal": ("mean", "sd"),
}
_EXAMPLE = "lognormal:30,15"
_MOST = 1e6
MOST_START_TIME = 2**24  # steps; planners count half ticks in int32
# Kept apart from what else a seed draws: robots (the seed alone) and delays (seed and step, up to a million).
_STREAM = 2**20


def random_start_times(
    area: Area, count: int, distribution: str, seed: int = 0, *, speed: float = 1.0, turn_time: float = 0.0
) -> NDArray[np.int64]:
    """Return start times of so many robots, in steps (ticks), drawn from a distribution.

    Parameters
    ----------
    area : Area
        In one with a frame the numbers of the distribution are seconds, in others steps. Whoever begins between two
        steps begins with the later one.
    count : int
    distribution : str
        "constant:TIME", "uniform:LEAST,MOST", "normal:MEAN,SD" or "lognormal:MEAN,SD"; mean and standard deviation
        are those of the times themselves. What is drawn below 0 is 0.
    seed : int
        The same seed gives the same times.
    speed, turn_time : float
        Of robots in an area with a frame, which tell how long a step lasts; see `seconds_per_step`.

    Raises
    ------
    ScenarioError
        If there is no such distribution.

    Examples
    --------
    >>> from trihex.areas.frame import Frame
    >>> hall = Area("hexagonal", [[0] * 4] * 4, frame=Frame(cell_size=0.5))
    >>> random_start_times(hall, 4, "lognormal:30,15", seed=1).tolist()
    [74, 210, 49, 38]
    """
    check_type("area", area, Area)
    check_whole("count", count, 0, None, ScenarioError)
    check_whole("seed", seed, 0, None, ScenarioError)
    draw = _draw_from(distribution)
    drawn = np.maximum(draw(np.random.default_rng([seed, _STREAM]), count), 0.0)
    return start_times_of(area, drawn, speed=speed, turn_time=turn_time)


def start_times_of(area: Area, times: ArrayLike, *, speed: float = 1.0, turn_time: float = 0.0) -> NDArray[np.int64]:
    """Return times that are seconds in an area with a frame, and else steps, as whole numbers of steps, rounded up."""
    check_type("area", area, Area)
    lasts = 1.0 if area.frame is None else seconds_per_step(area, speed, turn_time)
    try:
        values = np.asarray(times, dtype=np.float64)
    except (TypeError, ValueError):
        raise ScenarioError(f"start times must be numbers, not {short(times)}") from None
    wrong = np.flatnonzero(~((values >= 0) & (values <= _MOST)))
    if wrong.size:
        raise ScenarioError(f"start times must be from 0 to {_MOST:g}, not {values[wrong[0]]:g}")
    # Seconds that are some steps, but for the last digit, are no more than these.
    return np.ceil(values / lasts * (1 - 1e-12)).astype(np.int64)


def check_distribution(text: object) -> None:
    """Raise ScenarioError unless `text` names a distribution, as `random_start_times` takes it."""
    _draw_from(text)


def _draw_from(text: Any) -> Callable[[np.random.Generator, int], NDArray[np.float64]]:
    """Return what draws so many numbers from a distribution."""
    name, _, rest = text.partition(":") if isinstance(text, str) else ("", "", "")
    forms = ", ".join(f"{one}:{','.join(numbers)}" for one, numbers in DISTRIBUTIONS.items())
    rule = f"start times must be drawn as one of {forms}, such as {_EXAMPLE!r}"
    try:
        numbers = [float(number) for number in rest.split(",")]
    except ValueError:
        numbers = []
    if name not in DISTRIBUTIONS or len(numbers) != len(DISTRIBUTIONS[name]):
        raise ScenarioError(f"{rule}, not {text!r:.60}")
    if not all(0 <= number <= _MOST for number in numbers):
        raise ScenarioError(f"{rule}, of numbers from 0 to {_MOST:g}, not {text!r:.60}")
    first, last = numbers[0], numbers[-1]
    if name == "uniform" and first > last:
        raise ScenarioError(f"{rule}, LEAST no more than MOST, not {text!r:.60}")
    if name == "lognormal" and first == 0:
        raise ScenarioError(f"{rule}, of a mean above 0, not {text!r:.60}")
    if name == "constant":
        return lambda rng, count: np.full(count, first)
    if name == "uniform":
        return lambda rng, count: rng.uniform(first, last, count)
    if name == "normal":
        return lambda rng, count: rng.normal(first, last, count)
    variance = np.log1p((last / first) ** 2)  # of the logarithms
    return lambda rng, count: rng.lognormal(np.log(first) - variance / 2, np.sqrt(variance), count)
