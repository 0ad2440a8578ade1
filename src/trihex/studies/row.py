"""Row: what the table of a study says of one run."""

from __future__ import annotations

import hashlib
import json
import platform
import sys
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from trihex.areas import Scenario
from trihex.errors import TrihexError
from trihex.judging import Report
from trihex.kernels.codes import WAIT
from trihex.plans import Plan, waits_by_step

# What a run is to do, plain values by the keys of `study.AXES`; or a `Scenario` in place of all but the planner.
Case = Mapping[str, Any]
Row = dict[str, Any]

# The columns of a row, in this order, and what they hold. Those that begin with "seconds" are CPU times; all others
# depend on the case and the versions alone.
COLUMNS: dict[str, type] = {
    "run": int,
    **dict.fromkeys(("area", "area_options", "tessellation", "neighbourhood", "costs"), str),
    "waiting_cost": int,
    **dict.fromkeys(("crossing", "corners"), str),
    "destination_capacity": str,  # a whole number, or a flow such as 1/2
    **dict.fromkeys(("clock", "following"), str),
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


def blank_row(case: Case) -> Row:
    """Return the row of a case with what is known before the work."""
    return {**dict.fromkeys(COLUMNS), **_described(case), **versions()}


def _described(case: Case) -> Row:
    """Return what the row says of a case before its scenario is known."""
    planner = case["planner"]
    row: Row = {"planner": planner["name"], "planner_options": canonical(_told(planner))}
    if "scenario" in case:
        return row
    area, robots = case["area"], case["robots"]
    return row | {
        "area": area.get("name") or (Path(area["path"]).stem if "path" in area else area["generator"]),
        "area_options": canonical(area),
        "destinations": canonical(case["destinations"]),
        "robots": robots.get("count"),
        "placement": robots.get("placement", "uniform") if set(robots) <= {"count", "placement"} else canonical(robots),
        "seed": case["seed"],
        "tessellation": case["tessellation"]["name"],
        "neighbourhood": case["tessellation"].get("neighbourhood", "full"),
        "costs": case["tessellation"].get("costs", "paper"),
        **case["rules"],
        "destination_capacity": _capacity(case["rules"].get("destination_capacity")),
    }


def _capacity(capacity: object) -> str | None:
    """Return a capacity as text, as 1 or 1/2; summaries have it as a number, which thirds are not."""
    return None if capacity is None else str(capacity)


def _told(planner: Mapping[str, Any]) -> dict[str, Any]:
    return {**planner["options"], **({"run": planner["run"]} if "run" in planner else {})}


def row_of_scenario(scenario: Scenario) -> Row:
    """Return what the row says of a scenario."""
    area = scenario.area
    return {
        "area": area.name,
        "seed": scenario.seed,
        "robots": scenario.robot_count,
        "cell_size": area.frame.cell_size if area.frame is not None else None,
        "scenario": hash_of_scenario(scenario),
    }


def row_of_report(report: Report) -> Row:
    """Return what the row says of a plan by its report."""
    plan = report.plan
    summary = report.as_dict()
    known = {name: summary[name] for name in COLUMNS if name in summary and not name.startswith("seconds")}
    for name in ("area", "seed", "planner"):
        del known[name]
    known["destination_capacity"] = _capacity(plan.scenario.destination_capacity)
    return {**known, **_waits(plan), **_lengths(plan)}


def _waits(plan: Plan) -> Row:
    """Return how often robots wait, and how many do in the step with the most of them."""
    waiting = waits_by_step(plan)
    return {"waits": int(waiting.sum()), "most_waiting": int(waiting.max())}


def _lengths(plan: Plan) -> Row:
    """Return how far the robots that arrive go, and how far it is as the crow flies; in metres or in edge steps."""
    area = plan.scenario.area
    tessellation = area.tessellation
    # Euclidean costs are the distances of centres, 1000 for an edge step.
    distance = np.zeros(WAIT + 1)
    distance[: tessellation.direction_count] = (
        replace(tessellation, costs="euclidean", clock="steps").cost_of_direction / 1000
    )
    moved = np.concatenate([[0.0], np.cumsum(distance[plan.actions])])[plan.first_action]
    x, y = tessellation.centre_of_cell(*area.cell_to_xy(plan.scenario.robots))
    end_x, end_y = tessellation.centre_of_cell(*area.cell_to_xy(plan.last_cell_of_robot))
    unit = area.frame.cell_size if area.frame is not None else 1.0
    straight = np.hypot(end_x - x, end_y - y)[plan.arrived].sum()
    path = np.diff(moved)[plan.arrived].sum()
    return {"path_length": round(float(path) * unit, 6), "straight_length": round(float(straight) * unit, 6)}


def line_of_error(error: Exception) -> str:
    """Return why a run failed, in a line."""
    text = " ".join(str(error).split())[:500]
    if isinstance(error, TrihexError):
        return text
    if isinstance(error, MemoryError):
        return "out of memory"
    if isinstance(error, OSError):
        return f"{error.filename}: {error.strerror}"
    return f"fault of trihex: {type(error).__name__}: {text}"


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


def hash_of_scenario(scenario: Scenario) -> str:
    """Return 16 hexadecimal digits that depend on all that a plan depends on: cells, rules, destinations, robots."""
    area, tessellation = scenario.area, scenario.area.tessellation
    frame = area.frame and (area.frame.cell_size, area.frame.origin, area.frame.yaw, area.frame.robot_radius)
    rules = tuple(map(str, (scenario.waiting_cost, scenario.crossing, scenario.corners, scenario.destination_capacity)))
    if scenario.doors:  # so did these
        rules += tuple(f"{door.flow}: {door.cells.tolist()}" for door in scenario.doors)
    if (scenario.clock, scenario.following) != ("steps", "allow"):  # these came later
        rules += (scenario.clock, scenario.following)
    if scenario.has_start_times:
        rules += tuple(map(str, scenario.start_times.tolist()))
    if scenario.has_slowness:
        rules += ("slowness", *map(str, scenario.slowness.tolist()))
    names = (tessellation.name, tessellation.neighbourhood, tessellation.costs)
    digest = hashlib.sha256(repr((names, area.height, area.width, frame, rules)).encode())
    digest.update(np.packbits(area.barriers).tobytes())
    for cells in (scenario.destinations, scenario.robots):
        digest.update(str(cells.size).encode() + np.ascontiguousarray(cells, dtype="<i8").tobytes())
    return digest.hexdigest()[:16]


def canonical(value: Any) -> str:
    """Return a value as JSON in the one way that equal values share, for columns and for keys."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"))
