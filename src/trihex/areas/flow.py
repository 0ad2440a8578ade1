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
_RULE = "a number of robots above 0: a step, such as 2, 0.5 or 1/3, or in metres a second, such as 1.6/s"


def flow_from(parameter: str, value: object, area: Area, step_seconds: float | None = None) -> Fraction:
    """Return how many robots a step (tick) a flow is.

    Parameters
    ----------
    parameter : str
        What it is for, for messages.
    value : int, float, Fraction or str
        Robots a step, such as 2, 0.5 or "1/3"; as text also a second, "1.6/s".
    area : Area
        For robots a second: one with a frame.
    step_seconds : float, optional
        How long a step (tick) lasts. Default: `seconds_per_step` at 1 metre in a second.

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
    number = check_flow(parameter, value)
    if isinstance(value, str) and value.strip().endswith("/s"):
        if area.frame is None:
            raise ScenarioError(
                f"{parameter} must be robots a step, such as 0.5, in an area without metres, not {value!r:.80}"
            )
        number *= Fraction(seconds_per_step(area) if step_seconds is None else step_seconds)
    # Of large flows nobody sees the fraction, and kernels multiply them by steps.
    flow = number.limit_denominator(max(1, _FINEST // ceil(number)))
    if not flow or flow > MOST_FLOW:
        raise ScenarioError(f"{parameter} must be from 1/{_FINEST} to {MOST_FLOW} robots a step, not {value!r:.80}")
    return flow


def check_flow(parameter: str, value: object) -> Fraction:
    """Return the number in a flow, a step or a second; raise ScenarioError if there is none."""
    number = _number(value)
    if number is None or not 0 < number <= MOST_FLOW:
        raise ScenarioError(f"{parameter} must be {_RULE}; not {value!r:.80}")
    return number


def plain_flow(flow: int | Fraction | None) -> int | float | None:
    """Return a flow as a plain number, for JSON."""
    return float(flow) if isinstance(flow, Fraction) else flow


def flow_in_words(flow: Fraction, area: Area, step_seconds: float | None = None) -> str:
    """Return a flow as text: robots a second where it is known how long a step lasts, else a step."""
    if step_seconds is not None:
        return f"{float(flow) / step_seconds:.4g}/s"
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
