"""The errors that trihex raises.

Every error that a caller may want to catch descends from `TrihexError`, and from the builtin that names its kind::

    TrihexError
    ├── TessellationError (ValueError)   a tessellation, neighbourhood or cost table that does not exist
    ├── AreaError         (ValueError)   barriers that make no area, a generator asked for the impossible
    ├── AutomatonError    (ValueError)   a neighbourhood, states or a rule that make no cellular automaton
    ├── ScenarioError     (ValueError)   destinations, robots or rules that do not fit their area
    ├── StudyError        (ValueError)   runs that make no study, a study that cannot begin or go on
    ├── PlanError         (ValueError)   a planner or an option of it that does not exist, actions that make no plan
    ├── ExecutionError    (ValueError)   orders to robots that no robot can follow, robots that are not on their way
    ├── FormatError       (ValueError)   a file that is not what it claims to be
    ├── TooLargeError     (MemoryError)  work that would not fit into memory, refused before it starts
    └── MissingExtraError (ImportError)  an optional library that is not installed

"This robot cannot arrive" and "these two robots collide" are no errors but values: see `Scenario` and `audit`.
"""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Integral


class TrihexError(Exception):
    """Root of all errors of trihex; its message names the parameter, the rule and the value.

    It is one line; where a file is checked as a whole (scenarios), a line for each mistake.
    """


class TessellationError(TrihexError, ValueError):
    """A tessellation, neighbourhood or cost table that does not exist."""


class AreaError(TrihexError, ValueError):
    """Barriers that make no area, or a generator asked for the impossible."""


class AutomatonError(TrihexError, ValueError):
    """A neighbourhood, states or a rule that make no cellular automaton."""


class ScenarioError(TrihexError, ValueError):
    """Destinations, robots or rules that do not fit their area."""


class PlanError(TrihexError, ValueError):
    """A planner or an option of it that does not exist, or actions that make no plan."""


class StudyError(TrihexError, ValueError):
    """Runs that make no study, or a study that cannot begin or go on; what it has done so far is kept."""


class ExecutionError(TrihexError, ValueError):
    """Orders to robots that no robot can follow, or robots that are not on their way."""


class FormatError(TrihexError, ValueError):
    """A file that is not what it claims to be."""


class TooLargeError(TrihexError, MemoryError):
    """Work that would not fit into memory, refused before it starts."""


class MissingExtraError(TrihexError, ImportError):
    """An optional library that is not installed; the message names the extra that brings it."""


def check_choice(parameter: str, value: object, choices: Iterable[str], error: type[TrihexError]) -> str:
    """Return `value` if it is one of `choices`, else raise `error` with the choices and the nearest of them."""
    names = list(choices)
    if isinstance(value, str) and value in names:
        return value
    from difflib import get_close_matches  # 5 ms that only mistakes cost

    near = get_close_matches(str(value)[:80].lower(), names, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise error(f"{parameter} must be one of {', '.join(names)}, not {value!r:.80}{hint}")


def check_whole(parameter: str, value: object, least: int, most: int | None, error: type[TrihexError]) -> None:
    """Raise `error` unless `value` is a whole number, numpy's among them, from `least` to `most` (None: no end)."""
    is_whole = isinstance(value, Integral) and not isinstance(value, bool)
    if not is_whole or int(value) < least or (most is not None and int(value) > most):  # type: ignore[call-overload]
        end = "" if most is None else f" to {most}"
        raise error(f"{parameter} must be a whole number from {least}{end}, not {value!r}")
