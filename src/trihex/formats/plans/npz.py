"""Plan as .npz: area, scenario and actions in one compressed file, a byte for each action."""

from __future__ import annotations

import os
from collections.abc import Callable

from trihex.areas import Scenario, check_possible, claimed
from trihex.errors import FormatError
from trihex.files import read_bytes
from trihex.formats.archive import Entries, pack, unpack
from trihex.formats.scenarios.arrays import LATER_ENTRIES, SCENARIO_ENTRIES, scenario_arrays, scenario_from
from trihex.plans import Plan, actions_of, place_of_action

VERSION = 1
_ENTRIES: Entries = {
    "version": ("i", 0),
    **SCENARIO_ENTRIES,
    "planner": ("U", 0),
    "optimal": ("b", 0),
    "actions": ("u", 1),
    "first_action": ("i", 1),
    "jumps": ("i", 2),
}


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


def read_plan_npz(path: str | os.PathLike[str]) -> Plan:
    """Return the plan of a file that `write_plan_npz` made; see `parse_plan_npz`.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    plan = parse_plan_npz(read_bytes(path), path)
    check_possible(plan.scenario)
    return plan


def parse_plan_npz(
    content: bytes,
    path: str | os.PathLike[str],
    scenario: Scenario | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Plan:
    """Return the plan of a file that `write_plan_npz` made; it brings its own scenario, and takes but a moment.

    Nothing in the file is executed, and no entry is unpacked before its size and kind are found to be in order.

    Raises
    ------
    FormatError
        If the file is damaged, of another version, too large, or its actions lead out of the area.
    ScenarioError, PlanError, ...
        If its parts do not fit each other.
    """
    arrays = unpack(content, path, _ENTRIES, VERSION, "a plan", LATER_ENTRIES)
    plan = Plan(
        claimed(lambda kind: scenario_from(arrays, path, kind)),
        arrays["actions"],
        arrays["first_action"],
        str(arrays["planner"]),
        bool(arrays["optimal"]),
        arrays["jumps"],
    )
    _check_inside(plan, path)
    return plan


def _check_inside(plan: Plan, path: object) -> None:
    """Raise if an action leads out of the area: no kernel must ever follow it."""
    from trihex.formats.kernels.escape import find_escape

    layout = plan.scenario.area.layout
    start = layout.cell_to_site(plan.scenario.robots)
    escape = find_escape(start, actions_of(plan), layout.origin, layout.pitch, layout.height, layout.width)
    if escape >= 0:
        robot, step = place_of_action(plan, escape)
        raise FormatError(f"{path}: robot {robot} leaves the area at step {step}")
