"""Scenario as arrays: the entries that it takes in an .npz file."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Door, Frame, Scenario, Tessellation, Zone
from trihex.errors import FormatError
from trihex.formats.archive import Entries

# Entries that came later, and what holds where a file does not have them: it has none that is usual.
_LATER_RULES = {"clock": "steps", "following": "allow"}
_NO_ZONES = {"zone_names": np.empty(0, dtype=np.uint8), "zone_cells": np.empty((0, 2), dtype=np.int64)}
_NO_DOORS = {
    "door_names": np.empty(0, dtype=np.uint8),
    "door_cells": np.empty((0, 2), dtype=np.int64),
    "door_flows": np.empty((0, 2), dtype=np.int64),
    "destination_flow": np.empty(0, dtype=np.int64),
}
_NO_TIMES = {"start_times": np.empty(0, dtype=np.int64), "slowness": np.empty(0, dtype=np.int64)}
LATER_ENTRIES: dict[str, Any] = {**_LATER_RULES, **_NO_ZONES, **_NO_DOORS, **_NO_TIMES}
SCENARIO_ENTRIES: Entries = {
    "tessellation": ("U", 0),
    "neighbourhood": ("U", 0),
    "costs": ("U", 0),
    "area": ("U", 0),
    "barriers": ("b", 2),
    "frame": ("f", 1),  # cell size, origin x and y, yaw, robot radius; or nothing
    "zone_names": ("u", 1),  # UTF-8, a line each
    "zone_cells": ("i", 2),  # zone, cell
    "destinations": ("i", 1),
    "robots": ("i", 1),
    "start_times": ("i", 1),  # of the robots; or nothing
    "slowness": ("i", 1),  # likewise
    "waiting_cost": ("i", 0),
    "crossing": ("U", 0),
    "corners": ("U", 0),
    "destination_capacity": ("i", 0),  # 0: any number; of a flow the next whole number
    "destination_flow": ("i", 1),  # numerator and denominator, where the capacity is no whole number
    "door_names": ("u", 1),  # UTF-8, a line each, empty for one without a name
    "door_cells": ("i", 2),  # door, cell
    "door_flows": ("i", 2),  # numerator, denominator
    "seed": ("i", 0),  # -1: none
    **dict.fromkeys(_LATER_RULES, ("U", 0)),
}


def scenario_arrays(scenario: Scenario) -> dict[str, Any]:
    """Return all of a scenario as entries of a file; `scenario_from` reads them."""
    area, tessellation = scenario.area, scenario.area.tessellation
    return {
        "tessellation": tessellation.name,
        "neighbourhood": tessellation.neighbourhood,
        "costs": tessellation.costs,
        "area": area.name,
        "barriers": area.barriers,
        "frame": np.array([] if (at := area.frame) is None else [at.cell_size, *at.origin, at.yaw, at.robot_radius]),
        **(_zone_arrays(area.zones) if area.zones else {}),
        "destinations": scenario.destinations,
        "robots": scenario.robots,
        **({"start_times": scenario.start_times} if scenario.has_start_times else {}),
        **({"slowness": scenario.slowness} if scenario.has_slowness else {}),
        "waiting_cost": scenario.waiting_cost,
        "crossing": scenario.crossing,
        "corners": scenario.corners,
        "destination_capacity": scenario.entry_limit,
        **_flow_arrays(scenario),
        "seed": -1 if scenario.seed is None else scenario.seed,
        **{name: rule for name, usual in _LATER_RULES.items() if (rule := getattr(scenario, name)) != usual},
    }


def scenario_from(arrays: dict[str, Any], path: object, kind: type[Scenario] = Scenario) -> Scenario:
    """Return the scenario in the entries of a file, or what it claims."""
    text = {name: arrays[name] for name, (kind, _) in SCENARIO_ENTRIES.items() if kind == "U"}
    seed, capacity = int(arrays["seed"]), int(arrays["destination_capacity"])
    tessellation = Tessellation(text["tessellation"], text["neighbourhood"], text["costs"])
    return kind(
        Area(tessellation, arrays["barriers"], text["area"], _frame(arrays["frame"], path), _zones(arrays, path)),
        arrays["destinations"],
        arrays["robots"],
        int(arrays["waiting_cost"]),
        text["crossing"],
        text["corners"],
        _destination_flow(arrays, path) or capacity or None,
        None if seed == -1 else seed,
        doors=_doors(arrays, path),
        **{name: text[name] for name in _LATER_RULES},
        start_times=arrays["start_times"],
        slowness=arrays["slowness"],
    )


def _flow_arrays(scenario: Scenario) -> dict[str, Any]:
    """Return the doors, and a capacity that is a fraction; nothing where there are none."""
    arrays: dict[str, Any] = {}
    if isinstance(scenario.destination_capacity, Fraction):
        arrays["destination_flow"] = np.array(scenario.destination_capacity.as_integer_ratio())
    if doors := scenario.doors:
        pairs = [(number, cell) for number, door in enumerate(doors) for cell in door.cells.tolist()]
        arrays["door_names"] = np.frombuffer("".join(f"{door.name}\n" for door in doors).encode(), dtype=np.uint8)
        arrays["door_cells"] = np.array(pairs, dtype=np.int64)
        arrays["door_flows"] = np.array([door.flow.as_integer_ratio() for door in doors])
    return arrays


def _destination_flow(arrays: dict[str, Any], path: object) -> Fraction | None:
    numbers = arrays["destination_flow"]
    if numbers.size not in (0, 2) or (numbers <= 0).any():
        raise FormatError(f"{path}: entry 'destination_flow' must hold 2 whole numbers above 0, or none")
    return Fraction(*numbers.tolist()) if numbers.size else None


def _doors(arrays: dict[str, Any], path: object) -> tuple[Door, ...]:
    names, flows = arrays["door_names"].tobytes().decode(errors="replace").split("\n")[:-1], arrays["door_flows"]
    cells = arrays["door_cells"]
    is_sound = cells.shape[1] == 2 and flows.shape == (len(names), 2) and (flows > 0).all()
    if not is_sound or (cells.size and not 0 <= cells[:, 0].min() <= cells[:, 0].max() < len(names)):
        raise FormatError(
            f"{path}: entries 'door_names', 'door_cells' and 'door_flows' must hold a name, cells and a fraction "
            "above 0 for each door"
        )
    rows = zip(names, flows.tolist(), strict=True)
    return tuple(Door(cells[cells[:, 0] == i, 1], Fraction(*flow), name) for i, (name, flow) in enumerate(rows))


def _zone_arrays(zones: tuple[Zone, ...]) -> dict[str, Any]:
    pairs = [(number, cell) for number, zone in enumerate(zones) for cell in zone.cells.tolist()]
    return {
        "zone_names": np.frombuffer("\n".join(zone.name for zone in zones).encode(), dtype=np.uint8),
        "zone_cells": np.array(pairs, dtype=np.int64).reshape(-1, 2),
    }


def _zones(arrays: dict[str, Any], path: object) -> tuple[Zone, ...]:
    names, cells = arrays["zone_names"].tobytes().decode(errors="replace").split("\n"), arrays["zone_cells"]
    if cells.shape[1] != 2 or (cells.size and not 0 <= cells[:, 0].min() <= cells[:, 0].max() < len(names)):
        raise FormatError(f"{path}: entry 'zone_cells' must hold a zone and a cell in each row")
    return tuple(Zone(name, cells[cells[:, 0] == number, 1]) for number, name in enumerate(names) if name)


def _frame(numbers: NDArray[np.float64], path: object) -> Frame | None:
    if numbers.size not in (0, 5):
        raise FormatError(f"{path}: entry 'frame' must hold 5 numbers or none, not {numbers.size}")
    if numbers.size == 0:
        return None
    cell_size, x, y, yaw, robot_radius = numbers.tolist()
    return Frame(cell_size, (x, y), yaw, robot_radius)
