"""Flow: how many robots may enter a place in a step, whole or a fraction; where there are metres, in a second."""

from __future__ import annotations

import re
from fractions import Fraction
from math import ceil, isfinite
from numbers import Rational, Real

from trihex.areas.area import Area
from trihex.areas.seconds import seconds_per_step
from trihex.errors import ScenarioError

MOST_FLOW = 2**30
# Flows are fractions of no larger denominator: 0.7333 of a robot a step is off by less than 1 in 10 000 000 steps.
_FINEST = 10_000
_TEXT = re.compile(r"\d{1,12}(\.\d{0,12})?(/[1-9]\d{0,11})?|\.\d{1,12}", re.ASCII)
_RULE = "above 0: robots a step, such as 2, 0.5 or '1/3', or in metres a second, such as '1.6/s'"


def flow_from(parameter: str, value: object, area: Area, speed: float = 1.0) -> Fraction:
    """Return how many robots a step (tick) a flow is.

    Parameters
    ----------
    parameter : str
        What it is for, for messages.
    value : int, float, Fraction or str
        Robots a step, such as 2, 0.5 or "1/3"; as text also a second, "1.6/s".
    area : Area
        For robots a second: one with a frame.
    speed : float
        Metres in a second, which tell how long a step lasts (`seconds_per_step`).

    Raises
    ------
    ScenarioError
        If it is no number, not above 0, too small or too large; or a second where there are no metres.

    Examples
    --------
    >>> from trihex.areas.frame import Frame
    >>> area = Area("hexagonal", [[0, 0]], frame=Frame(cell_size=0.5))
    >>> flow_from("capacity", "1.6/s", area), flow_from("capacity", 0.5, area)
    (Fraction(4, 5), Fraction(1, 2))
    """
    number = _number(value)
    if number is None or not 0 < number <= MOST_FLOW:
        raise ScenarioError(f"{parameter} must be a number {_RULE}; not {value!r:.80}")
    if isinstance(value, str) and value.strip().endswith("/s"):
        if area.frame is None:
            raise ScenarioError(
                f"{parameter} must be robots a step, such as 0.5, in an area that is measured in cells, not {value!r:.80}"
            )
        number *= Fraction(seconds_per_step(area, speed))
    # Of large flows nobody sees the fraction, and kernels multiply them by steps.
    flow = number.limit_denominator(max(1, _FINEST // ceil(number)))
    if not flow or flow > MOST_FLOW:
        raise ScenarioError(f"{parameter} must be from 1/{_FINEST} to {MOST_FLOW} robots a step, not {value!r:.80}")
    return flow


def flow_in_words(flow: Fraction, area: Area, speed: float = 1.0) -> str:
    """Return a flow as text: in metres robots a second, else robots a step."""
    if area.frame is not None:
        return f"{float(flow) / seconds_per_step(area, speed):.4g}/s"
    return f"{flow} a {'step' if area.tessellation.clock == 'steps' else 'tick'}"


def _number(value: object) -> Fraction | None:
    """Return a number as a fraction, None if it is none."""
    if isinstance(value, str):
        text = value.strip().removesuffix("/s")
        return Fraction(text) if _TEXT.fullmatch(text) else None
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    if isinstance(value, Rational):
        return Fraction(int(value.numerator), int(value.denominator))
    return Fraction(float(value)) if isfinite(value) else None
