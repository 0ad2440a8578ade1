"""Run as .npz: the world, what happened in it and what each robot did, in one compressed file."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import FormatError, check_type
from trihex.files import read_bytes
from trihex.formats.archive import Entries, pack, unpack
from trihex.formats.scenarios.arrays import LATER_ENTRIES, SCENARIO_ENTRIES, scenario_arrays, scenario_from
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.running import BROKEN, KINDS, Event, Occurrence, Run, Sensor

VERSION = 1
_CHANGES = ("blocked", "freed", "opened", "closed", "left_out")
_NONE = -(2**31)
_LATER = {"zones_of_events": np.empty(0, dtype=np.uint8), "metres_of_events": np.empty((0, 4))}
_ENTRIES: Entries = {
    "version": ("i", 0),
    **SCENARIO_ENTRIES,
    "planner": ("U", 0),
    "radius": ("f", 0),  # nan: robots knew everything
    "line_of_sight": ("b", 0),
    "delay": ("f", 0),
    "run_seed": ("i", 0),
    "events": ("i", 2),  # step, kind, x, y, to_x, to_y, robot, steps
    "refusals": ("u", 1),  # UTF-8, a line for each event
    "zones_of_events": ("u", 1),  # the same
    "metres_of_events": ("f", 2),  # event, 0 or, of to_metres, 1, x, y
    "changes": ("i", 2),  # event, which of `_CHANGES`, cell
    "starts": ("i", 1),
    "joined": ("i", 1),
    "ended": ("i", 1),
    "states": ("u", 1),
    "run_actions": ("u", 2),
    "known_since": ("i", 2),
    "cut_off_since": ("i", 1),
    "touched": ("i", 2),
}


def write_run(run: Run, path: str | os.PathLike[str], *, progress: Callable[[int, int], None] | None = None) -> None:
    """Write a run with all that is needed to judge it or to go on; the same run gives the same bytes."""
    check_type("run", run, Run)
    events, refusals, changes = [], [], []
    for number, one in enumerate(run.occurrences):
        event = one.event
        numbers = [*(event.cell or (_NONE, _NONE)), *(event.to or (_NONE, _NONE))]
        numbers += [_NONE if value is None else value for value in (event.robot, event.steps)]
        events.append([event.step, list(KINDS).index(event.kind), *numbers])
        refusals.append(one.refusal.replace("\n", " "))
        changes += [[number, which, cell] for which, name in enumerate(_CHANGES) for cell in getattr(one, name)]
    sensor = run.sensor
    pack(
        {
            "version": VERSION,
            **scenario_arrays(run.scenario),
            "planner": run.planner,
            "radius": np.nan if sensor is None else float(sensor.radius),
            "line_of_sight": sensor is not None and sensor.line_of_sight,
            "delay": float(run.delay),
            "run_seed": run.seed,
            "events": np.array(events, dtype=np.int64).reshape(-1, 8),
            "refusals": np.frombuffer("\n".join(refusals).encode(), dtype=np.uint8),
            "zones_of_events": np.frombuffer(
                "\n".join(one.event.zone or "" for one in run.occurrences).encode(), dtype=np.uint8
            ),
            "metres_of_events": np.array(
                [
                    (number, which, *point)
                    for number, one in enumerate(run.occurrences)
                    for which, points in enumerate((one.event.metres, one.event.to_metres))
                    for point in points or ()
                ],
                dtype=np.float64,
            ).reshape(-1, 4),
            "changes": np.array(changes, dtype=np.int64).reshape(-1, 3),
            "starts": run.robots,
            "joined": run.joined,
            "ended": run.ended,
            "states": run.state_of_robot,
            "run_actions": run.actions,
            "known_since": run.known_since,
            "cut_off_since": run.cut_off_since,
            "touched": run.touched,
        },
        path,
        progress,
    )


def is_run(path: str | os.PathLike[str]) -> bool:
    """Tell whether a file looks like one that `write_run` made."""
    try:
        with zipfile.ZipFile(path) as archive:
            return "run_actions.npy" in archive.namelist()
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError):
        return False


def read_run(path: str | os.PathLike[str]) -> Run:
    """Return the run of a file that `write_run` made.

    Raises
    ------
    FormatError
        If the file is damaged, of another version, or its parts do not fit each other.
    ScenarioError, ...
        If there is no such scenario or event.
    OSError
        If the file cannot be read.
    """
    arrays = unpack(read_bytes(path), path, _ENTRIES, VERSION, "a run", LATER_ENTRIES | _LATER)
    scenario = scenario_from(arrays, path)
    radius, area = float(arrays["radius"]), scenario.area
    run = Run(
        scenario,
        str(arrays["planner"]),
        None if isnan(radius) else Sensor(area.tessellation, radius, bool(arrays["line_of_sight"])),
        float(arrays["delay"]),
        int(arrays["run_seed"]),
        _occurrences(arrays, area.cell_count, path),
        arrays["starts"].astype(np.int64),
        arrays["joined"].astype(np.int64),
        arrays["ended"].astype(np.int64),
        arrays["states"],
        arrays["run_actions"],
        arrays["known_since"].astype(np.int32),
        arrays["cut_off_since"].astype(np.int64),
        arrays["touched"].astype(np.int64),
    )
    _check(run, path)
    return run


def _occurrences(arrays: dict[str, Any], cells: int, path: object) -> tuple[Occurrence, ...]:
    events, changes = arrays["events"], arrays["changes"]
    refusals, zones = (_lines(arrays[name], len(events)) for name in ("refusals", "zones_of_events"))
    if events.shape[1] != 8 or not len(refusals) == len(zones) == len(events) or changes.shape[1] != 3:
        raise FormatError(f"{path}: events, refusals and changes do not fit each other")
    if changes.size and (changes.min() < 0 or (changes.max(axis=0) >= (len(events), len(_CHANGES), cells)).any()):
        raise FormatError(f"{path}: changes must name an event, what is changed and a cell of the area")
    changed: list[dict[str, Any]] = [{} for _ in range(len(events))]
    for number, which, cell in changes.tolist():
        own = changed[number]
        own[_CHANGES[which]] = (*own.get(_CHANGES[which], ()), cell)
    result = []
    places = _places(arrays["metres_of_events"], len(events), path)
    rows = zip(events.tolist(), refusals, zones, places, changed, strict=True)
    for (step, kind, *numbers), refusal, zone, metres, own in rows:
        if not 0 <= kind < len(KINDS):
            raise FormatError(f"{path}: there is no event of kind {kind}")
        x, y, to_x, to_y = numbers[:4]
        robot, steps = (None if number == _NONE else number for number in numbers[4:])
        cell, to = (None if x == _NONE else (x, y)), (None if to_x == _NONE else (to_x, to_y))
        event = Event(step, list(KINDS)[kind], cell, to, robot, steps, zone or None, *metres)
        result.append(Occurrence(event, refusal, **own))
    return tuple(result)


def _places(table: NDArray[np.float64], count: int, path: object) -> list[list[Any]]:
    """Return `metres` and `to_metres` of each event."""
    places: list[list[Any]] = [[None, None] for _ in range(count)]
    for number, which, x, y in table.tolist() if table.shape[1] == 4 else [(-1, 0, 0, 0)]:
        if not 0 <= number < count or which not in (0, 1):
            raise FormatError(f"{path}: metres_of_events must hold an event, 0 or 1, x and y in each row")
        own = places[int(number)]
        own[int(which)] = [*(own[int(which)] or []), (x, y)]
    return places


def _lines(text: NDArray[np.uint8], count: int) -> list[str]:
    """Return text as lines, of no text as many as there are to be."""
    return text.tobytes().decode(errors="replace").split("\n") if text.size else [""] * count


def _check(run: Run, path: object) -> None:
    """Raise unless all arrays have the right size and all robots stay inside the area."""
    area, layout, robots = run.scenario.area, run.scenario.area.layout, run.robots.size
    columns = (run.joined, run.ended, run.state_of_robot, run.cut_off_since)
    if any(column.size != robots for column in columns) or run.actions.shape[1] != robots:
        raise FormatError(f"{path}: every robot must have a start, an end, a state and actions")
    if run.known_since.shape != area.barriers.shape or run.touched.shape != (run.steps, 2):
        raise FormatError(f"{path}: known_since must have a number for each cell, touched two for each step")
    if not np.array_equal(run.robots[: run.scenario.robot_count], run.scenario.robots):
        raise FormatError(f"{path}: the first robots must be those of the scenario")
    if robots and (run.robots.min() < 0 or run.robots.max() >= area.cell_count or run.state_of_robot.max() > BROKEN):
        raise FormatError(f"{path}: robots must start in cells of the area, and their states be 0..{BROKEN}")
    is_action = (run.actions < area.tessellation.direction_count) | np.isin(run.actions, (WAIT, LATE, UNDERWAY))
    if not is_action.all():
        raise FormatError(f"{path}: actions must be directions, {WAIT}, {LATE} or {UNDERWAY}")
    site: NDArray[np.int32] = layout.cell_to_site(run.robots)
    for step, action in enumerate(run.actions, 1):
        moves = np.flatnonzero(action < UNDERWAY)
        site[moves] += layout.offset_of_direction[site[moves] & 1, action[moves]]
        row, column = np.divmod(site - layout.origin, layout.pitch)
        outside = np.flatnonzero((row < 0) | (row >= layout.height) | (column >= layout.width))
        if outside.size:
            raise FormatError(f"{path}: robot {outside[0]} leaves the area at step {step}")
