"""Trial: one run of a study, from what it is to do to its row of the table."""

from __future__ import annotations

import hashlib
import json
import platform
import sys
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from importlib.metadata import version
from math import sqrt
from pathlib import Path
from time import process_time
from typing import Any, TypeVar

import numpy as np

from trihex.areas import GENERATORS, Area, Scenario, Tessellation
from trihex.bounds import distance_bound, make_lower_bound
from trihex.errors import TrihexError
from trihex.fields import NScheme, make_n_scheme
from trihex.formats import Draft, read_draft, read_starts
from trihex.judging import Report, audit_plan, make_report
from trihex.kernels.codes import WAIT
from trihex.planners import make_plan
from trihex.plans import Plan
from trihex.studies.placing import place_destinations, place_robots
from trihex.studies.run_plan import make_run_plan

Trial = Mapping[str, Any]
Row = dict[str, Any]
Made = TypeVar("Made")

# The columns of a row, in this order, and what they hold. Those that begin with "seconds" are CPU times; all others
# depend on the trial and the versions alone.
COLUMNS: dict[str, type] = {
    "run": int,
    **dict.fromkeys(("area", "area_options", "tessellation", "neighbourhood", "costs"), str),
    "waiting_cost": int,
    **dict.fromkeys(("crossing", "corners"), str),
    "destination_capacity": int,
    "destinations": str,
    "robots": int,
    "placement": str,
    "seed": int,
    **dict.fromkeys(("planner", "planner_options"), str),
    "cell_size": float,
    **dict.fromkeys(("cells", "free_cells", "arrived", "unreachable", "steps", "total_time", "total_distance"), int),
    **dict.fromkeys(("total_waiting", "longest_time", "waits", "most_waiting"), int),
    **dict.fromkeys(("path_length", "straight_length"), float),
    "lower_bound": int,
    "lower_bound_name": str,
    "gap": float,
    "optimal": bool,
    "conflicts": int,
    "error": str,
    **dict.fromkeys(("scenario", "trihex", "numpy", "numba", "python"), str),
    **dict.fromkeys(("seconds_area", "seconds_field", "seconds_plan", "seconds_audit", "seconds_bound"), float),
}
# Area of a cell whose edge step is 1.
_AREA_OF_CELL = {"triangular": 0.75 * sqrt(3), "hexagonal": 0.5 * sqrt(3), "square": 1.0}


def run_trial(trial: Trial, tell: Callable[[Row], None] | None = None) -> Row:
    """Return the row of a trial; if it fails, one that says why in `error`.

    Parameters
    ----------
    trial : mapping
        See `Study`.
    tell : callable, optional
        Called with what is known of the row when the work begins, and again when the scenario is known.
    """
    row = blank_row(trial)
    try:
        warm_up(trial["planner"]["name"], "run" in trial["planner"])
        if tell is not None:
            tell(row)
        _fill(row, trial, tell)
    except Exception as error:
        row["error"] = _line_of(error)
        if isinstance(error, MemoryError):
            _kept.__dict__.clear()
    return row


def blank_row(trial: Trial) -> Row:
    """Return the row of a trial with what is known before the work."""
    return {**dict.fromkeys(COLUMNS), **_described(trial), **versions()}


def _line_of(error: Exception) -> str:
    text = " ".join(str(error).split())[:500]
    if isinstance(error, TrihexError):
        return text
    if isinstance(error, MemoryError):
        return "out of memory"
    if isinstance(error, OSError):
        return f"{error.filename}: {error.strerror}"
    return f"fault of trihex: {type(error).__name__}: {text}"


def _fill(row: Row, trial: Trial, tell: Callable[[Row], None] | None) -> None:
    """Add to the row what comes out."""
    n_scheme, seconds = _n_scheme_of(trial)
    row.update(seconds)
    scenario = n_scheme.scenario
    row.update(_described_scenario(scenario))
    if tell is not None:
        tell(row)
    plan, row["seconds_plan"] = _timed(lambda: _plan_of(trial["planner"], n_scheme))
    audit, row["seconds_audit"] = _timed(lambda: audit_plan(plan))
    make_bound = make_lower_bound if trial["bound"] else distance_bound
    bound, row["seconds_bound"] = _latest("bound", _key(trial), lambda: _timed(lambda: make_bound(n_scheme)))
    row.update(_counted(make_report(plan, n_scheme=n_scheme, audit=audit, lower_bound=bound)))


def _plan_of(planner: Mapping[str, Any], n_scheme: NScheme) -> Plan:
    if "run" in planner:
        return make_run_plan(n_scheme, planner)
    plan: Plan = make_plan(n_scheme.scenario, planner["name"], n_scheme=n_scheme, **planner["options"])
    return plan


def _counted(report: Report) -> Row:
    plan = report.plan
    summary = report.as_dict()
    known = {name: summary[name] for name in COLUMNS if name in summary and not name.startswith("seconds")}
    for name in ("area", "seed", "planner"):
        del known[name]
    return {**known, **_waits(plan), **_lengths(plan)}


def _waits(plan: Plan) -> Row:
    """Return how often robots wait, and how many do in the step with the most of them."""
    length = np.diff(plan.first_action)
    step = np.arange(plan.actions.size) - np.repeat(plan.first_action[:-1], length)
    waiting = np.bincount(step[plan.actions == WAIT], minlength=1)
    return {"waits": int(waiting.sum()), "most_waiting": int(waiting.max())}


def _lengths(plan: Plan) -> Row:
    """Return how far the robots that arrive go, and how far it is as the crow flies; in metres or in edge steps."""
    area = plan.scenario.area
    tessellation = area.tessellation
    # Euclidean costs are the distances of centres, 1000 for an edge step.
    distance = np.zeros(WAIT + 1)
    distance[: tessellation.direction_count] = replace(tessellation, costs="euclidean").cost_of_direction / 1000
    moved = np.concatenate([[0.0], np.cumsum(distance[plan.actions])])[plan.first_action]
    x, y = tessellation.centre_of_cell(*area.cell_to_xy(plan.scenario.robots))
    end_x, end_y = tessellation.centre_of_cell(*area.cell_to_xy(plan.last_cell_of_robot))
    unit = area.frame.cell_size if area.frame is not None else 1.0
    straight = np.hypot(end_x - x, end_y - y)[plan.arrived].sum()
    path = np.diff(moved)[plan.arrived].sum()
    return {"path_length": round(float(path) * unit, 6), "straight_length": round(float(straight) * unit, 6)}


def _n_scheme_of(trial: Trial) -> tuple[NScheme, Row]:
    """Return the N-scheme of the trial with its robots, and what it took."""
    if (given := trial.get("scenario")) is not None:
        key = _key(trial)
        n_scheme, took = _latest("field", key, lambda: _timed(lambda: make_n_scheme(given)))
        return n_scheme, {"seconds_field": took}
    parts = {name: trial[name] for name in ("folder", "area", "tessellation")}
    if "generator" in trial["area"]:
        parts["seed"] = trial["seed"]
    draft, took = _latest("area", _text(parts), lambda: _timed(lambda: _draft_of(trial)))
    parts |= {name: trial[name] for name in ("rules", "destinations")}
    if trial["destinations"].get("place") == "random":
        parts["seed"] = trial["seed"]
    empty, took_field = _latest(
        "field", _text(parts), lambda: _timed(lambda: make_n_scheme(_scenario_of(trial, draft)))
    )
    n_scheme = _latest("robots", _key(trial), lambda: _with_robots(trial, draft, empty))
    return n_scheme, {"seconds_area": took, "seconds_field": took_field}


def _draft_of(trial: Trial) -> Draft:
    return read_area_of(trial["area"], trial["tessellation"], trial["seed"], Path(trial["folder"]))


def read_area_of(entry: Mapping[str, Any], cells: Mapping[str, Any], seed: int, folder: Path) -> Draft:
    """Return the draft of an entry of the areas on an entry of the tessellations, read or generated by `seed`.

    Raises
    ------
    TrihexError, OSError
        As readers and generators do.
    """
    tessellation = Tessellation(**cells)
    options = {name: value for name, value in entry.items() if name not in ("path", "generator", "name", "size")}
    if "generator" in entry:
        width, height = entry["size"]
        area = GENERATORS[entry["generator"]](tessellation, height, width, **{"seed": seed, **options})
        return Draft(replace(area, name=entry.get("name", area.name)))
    if (cell_area := options.pop("cell_area", None)) is not None:
        options["cell_size"] = sqrt(cell_area / _AREA_OF_CELL[tessellation.name])
    draft = read_draft(folder / entry["path"], tessellation, **options)
    return replace(draft, area=replace(draft.area, name=entry.get("name", draft.area.name)))


def _scenario_of(trial: Trial, draft: Draft) -> Scenario:
    """Return the scenario without robots."""
    wanted, area = trial["destinations"], draft.area
    destinations: Any = wanted.get("cells")
    if "metres" in wanted:
        points = np.array(wanted["metres"], dtype=np.float64).reshape(-1, 2)
        destinations = area.metres_to_cell(points[:, 0], points[:, 1])
    elif wanted.get("place") == "file":
        destinations = draft.destinations
    elif "place" in wanted:
        destinations = place_destinations(area, wanted["place"], wanted.get("count", 1), trial["seed"])
    return replace(draft, destinations=_cells(area, destinations), robots=None, **trial["rules"]).complete()


def _cells(area: Area, places: Any) -> Any:
    return area.xy_to_cell(*np.array(places).reshape(-1, 2).T) if isinstance(places, list) else places


def _with_robots(trial: Trial, draft: Draft, empty: NScheme) -> NScheme:
    wanted, scenario, seed = trial["robots"], empty.scenario, trial["seed"]
    if "cells" in wanted:
        robots = _cells(scenario.area, wanted["cells"])
    elif "file" in wanted:
        robots = read_starts(Path(trial["folder"]) / wanted["file"], scenario.area)
    else:
        robots = place_robots(empty, wanted["count"], wanted.get("placement", "uniform"), seed)
    return replace(empty, scenario=scenario.with_robots(robots, seed))


def _described(trial: Trial) -> Row:
    """Return what the row says of a trial before its scenario is known."""
    planner = trial["planner"]
    row: Row = {"planner": planner["name"], "planner_options": _text(_told(planner))}
    if "scenario" in trial:
        return row
    area, robots = trial["area"], trial["robots"]
    return row | {
        "area": area.get("name") or (Path(area["path"]).stem if "path" in area else area["generator"]),
        "area_options": _text(area),
        "destinations": _text(trial["destinations"]),
        "robots": robots.get("count"),
        "placement": robots.get("placement", "uniform") if "count" in robots else _text(robots),
        "seed": trial["seed"],
        "tessellation": trial["tessellation"]["name"],
        "neighbourhood": trial["tessellation"].get("neighbourhood", "full"),
        "costs": trial["tessellation"].get("costs", "paper"),
        **trial["rules"],
    }


def _told(planner: Mapping[str, Any]) -> dict[str, Any]:
    return {**planner["options"], **({"run": planner["run"]} if "run" in planner else {})}


def _described_scenario(scenario: Scenario) -> Row:
    area = scenario.area
    return {
        "area": area.name,
        "seed": scenario.seed,
        "robots": scenario.robot_count,
        "cell_size": area.frame.cell_size if area.frame is not None else None,
        "scenario": hash_of_scenario(scenario),
    }


def hash_of_scenario(scenario: Scenario) -> str:
    """Return 16 hexadecimal digits that depend on all that a plan depends on: cells, rules, destinations, robots."""
    area, tessellation = scenario.area, scenario.area.tessellation
    frame = area.frame and (area.frame.cell_size, area.frame.origin, area.frame.yaw, area.frame.robot_radius)
    rules = (scenario.waiting_cost, scenario.crossing, scenario.corners, scenario.destination_capacity)
    names = (tessellation.name, tessellation.neighbourhood, tessellation.costs)
    digest = hashlib.sha256(repr((names, area.height, area.width, frame, tuple(map(str, rules)))).encode())
    digest.update(np.packbits(area.barriers).tobytes())
    for cells in (scenario.destinations, scenario.robots):
        digest.update(str(cells.size).encode() + np.ascontiguousarray(cells, dtype="<i8").tobytes())
    return digest.hexdigest()[:16]


@cache
def versions() -> dict[str, str]:
    """Return the versions on which results may depend."""
    return {
        # Not imported by name: the package as a whole lies above all its layers.
        "trihex": sys.modules["trihex"].__version__,
        "numpy": version("numpy"),
        "numba": version("numba"),
        "python": platform.python_version(),
    }


def try_planner(planner: Mapping[str, Any]) -> Report:
    """Plan for two robots in a corridor: whether a planner and its options exist shows at once."""
    area = Area(Tessellation("hexagonal"), np.zeros((1, 3), dtype=bool))
    scenario = Scenario(area, np.array([0]), np.array([1, 2]))
    n_scheme = make_n_scheme(scenario)
    plan = _plan_of(planner, n_scheme)
    return make_report(plan, n_scheme=n_scheme, lower_bound=make_lower_bound(n_scheme))


@cache
def warm_up(planner: str, is_run: bool = False) -> None:
    """Load what a run needs, so that no run is charged for it."""
    try_planner({"name": planner, "options": {}, **({"run": {"sense": 1}} if is_run else {})})


def _timed(work: Callable[[], Made]) -> tuple[Made, float]:
    begin = process_time()
    made = work()
    return made, round(process_time() - begin, 6)


# What was made last in this thread: the planners of one scenario follow each other, and so share it.
_kept = threading.local()
_LEVELS = ("area", "field", "robots", "bound")


def _latest(level: str, key: str, make: Callable[[], Made]) -> Made:
    """Return what was made last for `key`, or make it after all that hung on the one before is dropped."""
    kept = getattr(_kept, level, None)
    if kept is not None and kept[0] == key:
        return kept[1]  # type: ignore[no-any-return]
    for name in _LEVELS[_LEVELS.index(level) :]:
        setattr(_kept, name, None)
    made = make()
    setattr(_kept, level, (key, made))
    return made


def _key(trial: Trial) -> str:
    """Return what the scenario and its bound depend on."""
    if "scenario" in trial:
        return f"{hash_of_scenario(trial['scenario'])} {trial['bound']}"
    return _text({name: value for name, value in trial.items() if name != "planner"})


def _text(value: Any) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"))
