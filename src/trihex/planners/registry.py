"""Registry: the planners by name.

Every planner is a function ``plan_<name>(n_scheme, *, option=default, progress=None) -> Plan`` in a file of its own;
its keyword-only parameters are its options, and it is imported when first asked for. It may have a sister
``arrivals_<name>`` that returns `Arrivals`. Command line, viewer, tests and API page read this registry.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from difflib import get_close_matches
from importlib import import_module
from typing import Any, Literal, overload

from trihex.areas import Scenario, check_as_fast, check_possible
from trihex.errors import PlanError, check_choice, check_type
from trihex.fields import NScheme, field_kernels, make_n_scheme
from trihex.kernels.needs import use_of
from trihex.kernels.preparing import prepare
from trihex.plans import Arrivals, Plan, make_arrivals

Progress = Callable[[int, int], None]
Planner = Callable[..., Plan]

# Parts of a scenario, by their names and by those that users try.
_PARTS = {
    **dict.fromkeys(("waiting_cost", "wt", "w_t", "waiting", "wait_cost", "waiting_time"), "waiting_cost"),
    **dict.fromkeys(("crossing", "cross"), "crossing"),
    **dict.fromkeys(("corners", "corner_rule", "diagonals"), "corners"),
    **dict.fromkeys(("destination_capacity", "capacity", "exit_capacity"), "destination_capacity"),
    **dict.fromkeys(("destinations", "goals", "targets", "exits"), "destinations"),
    **dict.fromkeys(("robots", "starts", "agents"), "robots"),
    "seed": "seed",
}
RECORDS = ("plan", "arrivals")

# Name: the module under trihex.planners that defines plan_<name>.
PLANNERS: dict[str, str] = {"greedy": "greedy", "fcost": "fcost", "astar": "astar", "optimal": "optimal"}


def planner_named(name: str) -> Planner:
    """Return the planner function registered as `name`.

    Raises
    ------
    PlanError
        If there is no such planner.
    """
    check_choice("planner", name, PLANNERS, PlanError)
    planner: Planner = getattr(import_module(f"trihex.planners.{PLANNERS[name]}"), f"plan_{name}")
    return planner


def uses_of(name: str, scenario: Scenario) -> list[str]:
    """Return what a planner needs to be compiled for a scenario, as keys of `trihex.kernels.needs.KERNELS_OF`.

    Where time is not in steps alone, robots have start times or doors a flow, others go from tick to tick; what
    `optimal` does where robots crowd depends on whether all steps cost the same.
    """
    if name == "fcost":
        from trihex.planners.fcost import has_unequal_steps

        return [use_of(name, scenario.moves_by_steps), *["fcost_mending"] * has_unequal_steps(scenario)]
    if name != "optimal":
        return [use_of(name, scenario.moves_by_steps)]
    if scenario.waiting_cost == 0:
        return [name, use_of("greedy", scenario.moves_by_steps)]
    is_equal = (scenario.area.tessellation.cost_of_direction == scenario.waiting_cost).all()
    if is_equal and not scenario.moves_by_steps:
        return [name, "optimal_earliest", use_of("fcost", is_stepwise=False)]
    return [name, "optimal_earliest" if is_equal else "optimal_crowd"]


def check_plannable(name: str, scenario: Scenario) -> None:
    """Raise PlanError if a planner cannot plan by the rules of a scenario; asked before anything is compiled for it."""
    if name == "optimal":
        from trihex.planners.optimal import check_is_flow

        check_is_flow(scenario)
    elif name == "astar":
        check_as_fast(scenario, "planner 'astar'")


def options_of(name: str) -> dict[str, Any]:
    """Return the options of the planner `name` with their defaults.

    Examples
    --------
    >>> options_of("greedy")
    {}
    """
    parameters = inspect.signature(planner_named(name)).parameters.values()
    return {p.name: p.default for p in parameters if p.kind is p.KEYWORD_ONLY and p.name != "progress"}


def check_planner_options(name: str, options: Iterable[str]) -> None:
    """Raise PlanError if the planner `name` has no such option, saying where else it belongs.

    Examples
    --------
    >>> check_planner_options("greedy", ["rule"])
    Traceback (most recent call last):
    trihex.errors.PlanError: planner 'greedy' has no options, so not 'rule'; planner 'fcost' has it
    """
    known = options_of(name)
    for option in options:
        if option in known:
            continue
        hint = _place_of(option, known)
        rule = f"option of planner {name!r} must be one of {', '.join(known)}, not {option!r:.80}"
        words = rule if known else f"planner {name!r} has no options, so not {option!r:.80}"
        raise PlanError(f"{words}{hint and f'; {hint}'}")


def _place_of(option: str, known: Iterable[str]) -> str:
    """Return where an option that a planner has not belongs, or which was meant; empty if nobody knows."""
    near = get_close_matches(option.lower(), known, n=1)
    if near:
        return f"did you mean {near[0]!r}?"
    others = [name for name in PLANNERS if option in options_of(name)]
    if others:
        names = " and ".join(map(repr, others))
        return f"planner {names} has it" if len(others) == 1 else f"planners {names} have it"
    near = get_close_matches(option.lower(), _PARTS, n=1, cutoff=0.9)  # speed is no seed
    if near:
        return f"it is a part of the scenario, Scenario({_PARTS[near[0]]}=...)"
    near = get_close_matches(option.lower(), ("n_scheme", "progress", "record", "planner"), n=1)
    return f"did you mean {near[0]!r}?" if near else ""


@overload
def make_plan(
    scenario: Scenario,
    planner: str = ...,
    *,
    n_scheme: NScheme | None = ...,
    progress: Progress | None = ...,
    record: Literal["plan"] = ...,
    **options: Any,
) -> Plan: ...
@overload
def make_plan(
    scenario: Scenario,
    planner: str = ...,
    *,
    n_scheme: NScheme | None = ...,
    progress: Progress | None = ...,
    record: Literal["arrivals"],
    **options: Any,
) -> Arrivals: ...
def make_plan(
    scenario: Scenario,
    planner: str = "fcost",
    *,
    n_scheme: NScheme | None = None,
    progress: Progress | None = None,
    record: str = "plan",
    **options: Any,
) -> Plan | Arrivals:
    """Plan collision-free paths for all robots of `scenario`.

    Parameters
    ----------
    scenario : Scenario
    planner : str
        A name of `PLANNERS`.
    n_scheme : NScheme, optional
        The N-scheme of `scenario`, if it is at hand.
    progress : callable, optional
        Called with (robots arrived, robots that can arrive) a few times a second.
    record : {"plan", "arrivals"}
        Whether to return the plan, or only when each robot arrives and what that takes: 16 bytes a robot, and with
        `greedy`, and `fcost` unless robots look ahead, no action is ever kept.
    **options
        Options of the planner, see `options_of`.

    Raises
    ------
    PlanError
        If there is no such planner, record or option of the planner, or `n_scheme` belongs to another scenario.
    ScenarioError
        If the scenario is but claimed by a plan in a file (`read_plan` with `for_judge`), and impossible.

    Examples
    --------
    >>> import trihex as th
    >>> scenario = th.Scenario(th.Area("hexagonal", [[0, 0, 0, 0]]), destinations=[(3, 0)], robots=[(0, 0), (1, 0)])
    >>> make_plan(scenario, "greedy").time_of_robot
    array([30, 20])
    """
    check_type("scenario", scenario, Scenario)
    check_type("n_scheme", n_scheme, NScheme, type(None))
    check_possible(scenario)
    plan = planner_named(planner)
    check_choice("record", record, RECORDS, PlanError)
    check_planner_options(planner, options)
    check_plannable(planner, scenario)
    prepare(*uses_of(planner, scenario), field_kernels(scenario.area.tessellation, scenario.corners))
    if n_scheme is None:
        n_scheme = make_n_scheme(scenario)
    elif n_scheme.scenario is not scenario and n_scheme.scenario != scenario:
        raise PlanError("n_scheme must be that of the scenario")
    if record == "plan":
        return plan(n_scheme, progress=progress, **options)
    arrivals = getattr(import_module(plan.__module__), f"arrivals_{planner}", None)
    if arrivals is None:
        return make_arrivals(plan(n_scheme, progress=progress, **options))
    made: Arrivals = arrivals(n_scheme, progress=progress, **options)
    return made
