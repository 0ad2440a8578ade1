"""Plan as .npz: area, scenario and actions in one compressed file, a byte for each robot and step."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable
from io import BytesIO
from math import prod
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from trihex.areas import Area, Frame, Scenario, Tessellation
from trihex.errors import FormatError
from trihex.files import new_file, read_bytes
from trihex.plans import Plan, actions_of

VERSION = 1
# What a file may unpack to: an area of 10^9 cells and as many robot-steps.
MAX_UNPACKED = 2**32
_PIECE = 2**22
# Packs actions three times as fast as level 6 does, 16 % larger.
_LEVEL = 4
# Kind of number and number of axes of each entry.
Entries = dict[str, tuple[str, int]]
SCENARIO_ENTRIES: Entries = {
    "tessellation": ("U", 0),
    "neighbourhood": ("U", 0),
    "costs": ("U", 0),
    "area": ("U", 0),
    "barriers": ("b", 2),
    "frame": ("f", 1),  # cell size, origin x and y, yaw, robot radius; or nothing
    "destinations": ("i", 1),
    "robots": ("i", 1),
    "waiting_cost": ("i", 0),
    "crossing": ("U", 0),
    "corners": ("U", 0),
    "destination_capacity": ("i", 0),  # 0: any number
    "seed": ("i", 0),  # -1: none
}
_ENTRIES: Entries = {
    "version": ("i", 0),
    **SCENARIO_ENTRIES,
    "planner": ("U", 0),
    "optimal": ("b", 0),
    "actions": ("u", 1),
    "first_action": ("i", 1),
    "jumps": ("i", 2),
}
_LARGEST_ITEM = {"i": 8, "b": 1, "u": 1, "f": 8, "U": 4096}


def write_plan_npz(
    plan: Plan, path: str | os.PathLike[str], *, progress: Callable[[int, int], None] | None = None
) -> None:
    """Write a plan with all that is needed to judge it; `numpy.load` opens it without pickle.

    The same plan gives the same bytes.

    Parameters
    ----------
    plan : Plan
    path : path
    progress : callable, optional
        Called with (bytes packed, bytes to pack).
    """
    own = {"planner": plan.planner, "optimal": plan.optimal}
    own |= {"actions": plan.actions, "first_action": plan.first_action, "jumps": plan.jumps}
    pack({"version": VERSION, **scenario_arrays(plan.scenario), **own}, path, progress)


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
        "destinations": scenario.destinations,
        "robots": scenario.robots,
        "waiting_cost": scenario.waiting_cost,
        "crossing": scenario.crossing,
        "corners": scenario.corners,
        "destination_capacity": scenario.destination_capacity or 0,
        "seed": -1 if scenario.seed is None else scenario.seed,
    }


def pack(
    arrays: dict[str, Any], path: str | os.PathLike[str], progress: Callable[[int, int], None] | None = None
) -> None:
    """Write arrays, numbers and text as the entries of an .npz file; the same ones give the same bytes."""
    made = {name: np.ascontiguousarray(value).reshape(np.shape(value)) for name, value in arrays.items()}
    done, total = 0, sum(array.nbytes for array in made.values())
    # As `numpy.savez_compressed` does it, but piece by piece, so that a long one can be watched and interrupted.
    with new_file(path) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=_LEVEL) as archive:
        for name, array in made.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                npy.write_array_header_1_0(file, npy.header_data_from_array_1_0(array))
                raw = array.reshape(-1).view(np.uint8) if array.size else np.empty(0, dtype=np.uint8)
                for begin in range(0, raw.size, _PIECE):
                    done += file.write(raw[begin : begin + _PIECE].data)
                    if progress is not None:
                        progress(done, total)


def read_plan_npz(path: str | os.PathLike[str], content: bytes | None = None) -> Plan:
    """Return the plan of a file that `write_plan_npz` made.

    Nothing in the file is executed, and no entry is unpacked before its size and kind are found to be in order.

    Raises
    ------
    FormatError
        If the file is damaged, of another version, too large, or its actions lead out of the area.
    ScenarioError, PlanError, ...
        If its parts do not fit each other.
    OSError
        If the file cannot be read.
    """
    arrays = unpack(read_bytes(path) if content is None else content, path, _ENTRIES, VERSION, "a plan")
    plan = Plan(
        scenario_from(arrays, path),
        arrays["actions"],
        arrays["first_action"],
        str(arrays["planner"]),
        bool(arrays["optimal"]),
        arrays["jumps"],
    )
    _check_inside(plan, path)
    return plan


def unpack(content: bytes, path: object, entries: Entries, version: int, what: str) -> dict[str, Any]:
    """Return the entries of an .npz file by name, or raise FormatError if they are not those of `what`."""
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            arrays = _unpacked(archive, path, entries, what)
    except (FormatError, MemoryError):
        raise
    except Exception as error:  # zipfile, zlib and numpy raise whatever they stumble on: even tokenize.TokenError
        raise FormatError(f"{path}: is no whole .npz file: {error!s:.120}") from None
    if (found := int(arrays["version"])) != version:
        raise FormatError(f"{path}: version must be {version}, not {found}")
    return arrays


def scenario_from(arrays: dict[str, Any], path: object) -> Scenario:
    """Return the scenario in the entries of a file."""
    text = {name: arrays[name] for name, (kind, _) in SCENARIO_ENTRIES.items() if kind == "U"}
    seed, capacity = int(arrays["seed"]), int(arrays["destination_capacity"])
    tessellation = Tessellation(text["tessellation"], text["neighbourhood"], text["costs"])
    return Scenario(
        Area(tessellation, arrays["barriers"], text["area"], _frame(arrays["frame"], path)),
        arrays["destinations"],
        arrays["robots"],
        int(arrays["waiting_cost"]),
        text["crossing"],
        text["corners"],
        None if capacity == 0 else capacity,
        None if seed == -1 else seed,
    )


def _frame(numbers: NDArray[np.float64], path: object) -> Frame | None:
    if numbers.size not in (0, 5):
        raise FormatError(f"{path}: entry 'frame' must hold 5 numbers or none, not {numbers.size}")
    if numbers.size == 0:
        return None
    cell_size, x, y, yaw, robot_radius = numbers.tolist()
    return Frame(cell_size, (x, y), yaw, robot_radius)


def _unpacked(archive: zipfile.ZipFile, path: object, entries: Entries, what: str) -> dict[str, Any]:
    """Return the entries, each looked at before it is unpacked."""
    infos = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
    for wrong, rule in ((entries.keys() - infos, "must have"), (infos.keys() - entries, "must not have")):
        if wrong:
            raise FormatError(f"{path}: {what} {rule} the entry {min(wrong)!r}")
    unpacked = sum(info.file_size for info in infos.values())
    if unpacked > MAX_UNPACKED:
        raise FormatError(f"{path}: must unpack to at most {MAX_UNPACKED} bytes, not {unpacked}")
    arrays: dict[str, Any] = {}
    for name, (kind, axes) in entries.items():
        with archive.open(infos[name]) as file:
            if npy.read_magic(file) != (1, 0):
                raise FormatError(f"{path}: entry {name!r} has an unknown npy version")
            shape, is_fortran, dtype = npy.read_array_header_1_0(file)
            size = prod(shape) * dtype.itemsize
            if dtype.kind != kind or dtype.itemsize > _LARGEST_ITEM[kind] or len(shape) != axes or is_fortran:
                raise FormatError(
                    f"{path}: entry {name!r} must be of kind {kind} with {axes} axes, not {dtype} {shape}"
                )
            raw = file.read(size + 1)
        if len(raw) != size:
            raise FormatError(f"{path}: entry {name!r} must be {size} bytes long, not {len(raw)}")
        # A byte other than 0 and 1 makes a bool that kernels misread.
        if kind == "U":  # decoded here: numpy would take numbers for letters that are none
            arrays[name] = raw.decode("utf-32-be" if dtype.str[0] == ">" else "utf-32-le").rstrip("\0")
            continue
        items = np.frombuffer(raw, dtype=dtype)
        if kind == "b" and items.size and items.view(np.uint8).max() > 1:
            items = items.view(np.uint8) != 0
        arrays[name] = items.reshape(shape)
    return arrays


def _check_inside(plan: Plan, path: object) -> None:
    """Raise if an action leads out of the area: no kernel must ever follow it."""
    from trihex.formats.kernels.escape import find_escape

    layout = plan.scenario.area.layout
    start = layout.cell_to_site(plan.scenario.robots)
    escape = find_escape(start, actions_of(plan), layout.origin, layout.pitch, layout.height, layout.width)
    if escape >= 0:
        robot = int(np.searchsorted(plan.first_action, escape, side="right")) - 1
        step = escape - int(plan.first_action[robot]) + 1
        raise FormatError(f"{path}: robot {robot} leaves the area at step {step}")
