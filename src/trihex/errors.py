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
    ├── ArgumentError     (TypeError)    an argument of a wrong kind, such as an Area where a Scenario is needed
    ├── TooLargeError     (MemoryError)  work that would not fit into memory, refused before it starts
    └── MissingExtraError (ImportError)  an optional library that is not installed

"This robot cannot arrive" and "these two robots collide" are no errors but values: see `Scenario` and `audit`.
"""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Integral, Real
from os import PathLike

# How to get what is wanted from what was given; for messages. By the names of the classes, as nothing is imported here.
_WAYS = {
    ("Area", "Scenario"): "scenario.area is one",
    ("Area", "str"): "read_area(path) reads one",
    ("Scenario", "Area"): "Scenario(area, destinations, robots) makes one",
    ("Scenario", "Plan"): "plan.scenario is one",
    ("Scenario", "NScheme"): "n_scheme.scenario is one",
    ("Scenario", "str"): "read_scenario(path) reads one",
    ("NScheme", "Scenario"): "make_n_scheme(scenario) makes one",
    ("NScheme", "DScheme"): "d_scheme.n_scheme is one",
    ("NScheme", "Plan"): "make_n_scheme(plan.scenario) makes one",
    ("DScheme", "NScheme"): "make_d_scheme(n_scheme) makes one",
    ("DScheme", "Scenario"): "make_d_scheme(make_n_scheme(scenario)) makes one",
    ("Plan", "Scenario"): "make_plan(scenario) makes one",
    ("Plan", "Report"): "report.plan is one",
    ("Plan", "Arrivals"): "leave out record='arrivals' to have one made",
    ("Plan", "Run"): "audit_run judges runs, make_run_report reports on them",
    ("Plan", "str"): "read_plan(path) reads one",
    ("Report", "Plan"): "make_report(plan) makes one",
    ("Run", "Trial"): "trial.run() makes one",
    ("Run", "Plan"): "plans have functions of their own, such as picture_of_plan, audit_plan, write_plan",
    ("Run", "str"): "read_run(path) reads one",
    ("Tessellation", "Area"): "area.tessellation is one",
}
# Bases, by the names of what they are the base of: nobody makes a Motion.
_KINDS = {"Motion": ("Plan", "Run")}


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


class ArgumentError(TrihexError, TypeError):
    """An argument of a wrong kind, such as an Area where a Scenario is needed."""


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
    if not is_whole(value) or int(value) < least or (most is not None and int(value) > most):  # type: ignore[call-overload]
        end = "" if most is None else f" to {most}"
        raise error(f"{parameter} must be a whole number from {least}{end}, not {value!r}")


def is_whole(value: object) -> bool:
    """Tell whether `value` is a whole number, numpy's among them; True and False are none."""
    return isinstance(value, Integral) and not isinstance(value, bool)


def check_number(
    parameter: str, value: object, least: float, most: float, error: type[TrihexError], *, below: bool = False
) -> None:
    """Raise `error` unless `value` is a number, numpy's among them, from `least` to `most`, or to `below` it."""
    is_number = isinstance(value, Real) and not isinstance(value, bool)
    number = float(value) if is_number else float("nan")  # type: ignore[arg-type]
    if not least <= number <= most or (below and number == most):
        end = "" if most == float("inf") else f" to {'below ' if below else ''}{most:g}"
        raise error(f"{parameter} must be a number from {least:g}{end}, not {value!r:.80}")


def kind_of(value: object) -> str:
    """Return the name of the class of `value`, "None" for None; for messages."""
    return "None" if value is None else type(value).__name__


def check_type(parameter: str, value: object, *kinds: type, error: type[TrihexError] = ArgumentError) -> None:
    """Raise `error` unless `value` is one of `kinds`, saying how to get one of them from what was given.

    Examples
    --------
    >>> check_type("text", 5, str)
    Traceback (most recent call last):
    trihex.errors.ArgumentError: text must be a str, not int
    """
    if isinstance(value, kinds):
        return
    given = "str" if isinstance(value, PathLike) else kind_of(value)
    own = ["None" if kind is type(None) else kind.__name__ for kind in kinds]
    names = [name for one in own for name in _KINDS.get(one, (one,))]
    vowels = ("A", "E", "I", "O", "NS")  # as they are spoken
    named = [name if name == "None" else f"{'an' if name.startswith(vowels) else 'a'} {name}" for name in names]
    way = next((_WAYS[name, given] for name in names if (name, given) in _WAYS), "")
    # Too long for a message is what does not fit a line; of arrays and the like the class says enough.
    words = f"{value!r}" if isinstance(value, str) and len(value) < 60 else kind_of(value)
    raise error(f"{parameter} must be {' or '.join(named)}, not {words}{way and f': {way}'}")


def check_path(value: object, parameter: str = "path") -> None:
    """Raise ArgumentError unless `value` can be the path of a file: text or an ``os.PathLike``, no number."""
    if not isinstance(value, str | PathLike):
        raise ArgumentError(f"{parameter} must be the path of a file, not {kind_of(value)}")


def check_many(parameter: str, values: object, kind: type, words: str) -> None:
    """Raise ArgumentError if `values` is text or a single `kind`, or nothing that can be gone through.

    `words` says what is wanted, such as "a list of scenarios".
    """
    if isinstance(values, kind | str | bytes) or not isinstance(values, Iterable):
        given = repr(values) if isinstance(values, str) else kind_of(values)
        hint = f": put it into brackets, [{parameter.rstrip('s')}]" if isinstance(values, kind) else ""
        raise ArgumentError(f"{parameter} must be {words}, not {given:.80}{hint}")


def check_options(
    whose: str, given: Iterable[str], known: Iterable[str], error: type[TrihexError] = ArgumentError
) -> None:
    """Raise `error` if an option that is given is not among those known, with the nearest that is."""
    names = list(known)
    for name in given:
        if name in names:
            continue
        if not names:
            raise error(f"{whose} takes no options, not {name!r:.80} either")
        check_choice(f"option of {whose}", name, names, error)
