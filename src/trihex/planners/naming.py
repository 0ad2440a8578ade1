"""Naming: a planner with its options in one word, such as ``fcost:rule=paper``."""

from __future__ import annotations

from json import loads
from typing import Any

from trihex.errors import PlanError, check_choice
from trihex.planners.registry import PLANNERS, options_of


def planner_from(text: str) -> tuple[str, dict[str, Any]]:
    """Return the name and the options of a planner that is named in one word: ``NAME:OPTION=VALUE:OPTION=VALUE``.

    Numbers, true, false and null are read as such; all else is text.

    Raises
    ------
    PlanError
        If there is no such planner, or it has no such option.

    Examples
    --------
    >>> planner_from("greedy"), planner_from("fcost:rule=paper")
    (('greedy', {}), ('fcost', {'rule': 'paper'}))
    """
    if not isinstance(text, str):
        raise PlanError(f"planner must be a name, such as 'fcost' or 'fcost:rule=paper', not {text!r:.80}")
    name, *parts = (part.strip() for part in text.split(":"))
    check_choice("planner", name, PLANNERS, PlanError)
    known, options = options_of(name), {}
    for part in parts:
        option, equals, value = part.partition("=")
        if not equals:
            raise PlanError(f"planner {text!r:.80} must be NAME:OPTION=VALUE, not {part!r:.80}")
        if not known:
            raise PlanError(f"planner {name!r} has no options, so not {option!r:.80}")
        check_choice(f"option of planner {name!r}", option, known, PlanError)
        if option in options:
            raise PlanError(f"planner {text!r:.80} must name each option once, not {option!r} twice")
        options[option] = _value_of(value)
    return name, options


def _value_of(text: str) -> Any:
    try:
        return loads(text)
    except ValueError:
        return text
