"""Seconds: how long a step (tick) lasts in a place in metres."""

from __future__ import annotations

from numbers import Real

from trihex.areas.area import Area
from trihex.errors import FormatError, check_number


def seconds_per_step(area: Area, speed: float = 1.0, turn_time: float = 0.0) -> float:
    """Return how long a step lasts, so that no robot is ever faster than `speed`.

    All moves take as long as the longest of the tessellation, whatever way they go; by the clock "costs" a tick lasts
    as the farthest way does that a robot goes in a tick.

    Parameters
    ----------
    area : Area
        One with a frame.
    speed : float
        Metres in a second.
    turn_time : float
        Seconds at the beginning of each step in which all robots stand, so that each can turn on the spot.

    Raises
    ------
    AreaError
        If the area has no frame.
    FormatError
        If the speed is not above 0, or the turn time below; if there is one and moves last several ticks.

    Examples
    --------
    >>> from trihex.areas.frame import Frame
    >>> seconds_per_step(Area("hexagonal", [[0, 0]], frame=Frame(cell_size=0.5)), speed=2.0, turn_time=0.1)
    0.35
    """
    if not isinstance(speed, Real) or not 0 < speed < float("inf"):
        raise FormatError(f"speed must be above 0 metres in a second, not {speed!r}")
    check_number("turn_time", turn_time, 0, 1e9, FormatError)
    if turn_time and (area.tessellation.duration_of_direction > 1).any():
        raise FormatError(
            f"turn_time must be 0 where clock is 'costs' and moves last several ticks, as robots never stand all at "
            f"once, not {turn_time!r}"
        )
    return float(area.tessellation.longest_tick * area.metres.cell_size / speed + turn_time)
