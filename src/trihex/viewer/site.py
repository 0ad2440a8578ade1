"""Site: the viewer as a folder that any static host serves, with all the answers that its page may ask for."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from struct import pack
from typing import Any

import numpy as np

from trihex.areas import TESSELLATIONS, Area, Scenario, make_rooms_area, random_robots
from trihex.errors import FormatError, PlanError, ScenarioError, TooLargeError, check_choice, check_path, check_type
from trihex.files import new_file
from trihex.formats import Draft, draft_of
from trihex.planners import PLANNERS
from trihex.plans import Plan
from trihex.viewer.bundle import Bundle, decode, encode
from trihex.viewer.choices import choices
from trihex.viewer.desk import Desk
from trihex.viewer.document import document_of
from trihex.viewer.generations import MAX_AUTOMATON_CELLS
from trihex.viewer.layers import layer_choices
from trihex.viewer.page import page_with, settings_of
from trihex.viewer.script import module

# Up to so many robots times free cells the optimum takes seconds; `trihex compare` looks for it as far.
_MOST_FOR_OPTIMUM = 2_000_000
_OWN = "viewer.js"  # a folder that holds it is one of ours, and may be written anew

Progress = Callable[[int, int], None]


def write_site(
    record: Scenario | Plan | Draft | None,
    folder: str | os.PathLike[str],
    *,
    planners: tuple[str, ...] | None = None,
    progress: Progress | None = None,
) -> list[Path]:
    """Write the viewer with plans, fields and generations into a folder that any static host serves; return its files.

    The page grows the field, plays each plan, alone or beside another one or one on other cells, and follows robots.
    It asks its own folder only. To paint or to plan anew takes `trihex view`.

    Parameters
    ----------
    record : Scenario or Plan, optional
        What is shown. Default: the area of rooms that the viewer begins with.
    folder : path
        Made if it is not there; else it must be empty, or written by this function before.
    planners : tuple of str, optional
        Which plans there are. Default: fcost and greedy, and in the small optimal.
    progress : callable, optional
        Called with (answers, of all answers).

    Raises
    ------
    FormatError
        If the folder holds other files.
    ScenarioError
        If there is no destination, or no robot.
    PlanError
        If there is no such planner.
    OSError
        If the folder cannot be written.
    """
    check_type("record", record, Scenario, Plan, Draft, type(None))
    scenario = _scenario_of(record)
    if not scenario.robot_count:
        raise ScenarioError("a site shows plans: there must be robots, and there are none")
    names = planners or _planners_for(scenario)
    for name in names:
        check_choice("planner", name, PLANNERS, PlanError)
    root = _checked(folder)
    desk = Desk()
    if isinstance(record, Plan):
        first = desk.show(record)
    else:
        document, arrays = document_of(draft_of(scenario))
        first = Bundle({"document": document, "planner": names[0]}, arrays)
    answers = _answers(desk, scenario, names, progress or (lambda done, total: None))
    settings = settings_of(host="site", **_choices_for(scenario, names))
    html, _ = page_with(settings, first, f"{scenario.area.name or 'plans'} - trihex", is_alone=False, is_site=True)
    return _written(root, {"index.html": html.encode(), _OWN: module().encode(), **answers})


def _scenario_of(record: Scenario | Plan | Draft | None) -> Scenario:
    if record is None:
        area = make_rooms_area("hexagonal", 32, 48, seed=7)  # as in draws.js
        free = np.flatnonzero(~area.barriers)
        x, y = area.cell_to_xy(free)
        end = free[[np.argmin(abs(x - area.width / 2) + abs(y - area.height / 2))]]
        return Scenario(area, end, random_robots(area, 120, 1, avoid=end), seed=1)
    if isinstance(record, Draft):
        return record.complete()
    return record.scenario if isinstance(record, Plan) else record


def _planners_for(scenario: Scenario) -> tuple[str, ...]:
    is_small = scenario.robot_count * scenario.area.free_count <= _MOST_FOR_OPTIMUM
    return ("fcost", "greedy", "optimal") if is_small else ("fcost", "greedy")


def _checked(folder: str | os.PathLike[str]) -> Path:
    """Return the folder as a path if it may be written, which is done when all answers are there."""
    check_path(folder, "folder")
    root = Path(folder)
    if root.exists() and any(root.iterdir()) and not (root / _OWN).is_file():
        raise FormatError(f"{folder}: a site needs a folder that is new, empty or its own; this one holds other files")
    return root


def _shapes_of(area: Area) -> tuple[str, ...]:
    """Return the cells on which there are plans: places in metres have one kind."""
    return (area.tessellation.name,) if area.frame is not None else TESSELLATIONS


def _answers(desk: Desk, scenario: Scenario, planners: tuple[str, ...], progress: Progress) -> dict[str, bytes]:
    """Return all answers by the names of their files, as the page spells them."""
    shapes, layers, found = _shapes_of(scenario.area), layer_choices(is_alone=True), {}

    def ask(name: str, wish: dict[str, Any]) -> bytes:
        found[f"answers/{name}.bin"] = answer = _answer(desk, scenario, wish)
        progress(len(found), 2 + (2 + len(layers)) * len(shapes) * len(planners))
        return answer

    ask("fields", {"op": "fields"})
    if scenario.area.cell_count <= MAX_AUTOMATON_CELLS:
        ask("generations", {"op": "generations"})
    for shape in shapes:
        own = {} if shape == scenario.area.tessellation.name else {"tessellation": shape}
        plans = [ask(f"plan-{name}-{shape}", {"op": "plan", "planner": name, **own}) for name in planners]
        for plan in plans:  # when all are there: one may have proven the optimum
            name = decode(plan[4:]).header["plan"]
            ask(f"bound-{name}", {"op": "bound", "plan": name})
            for layer in layers:
                ask(f"layer-{layer}-{name}", {"op": "layer", "plan": name, "layer": layer})
    return found


def _answer(desk: Desk, scenario: Scenario, wish: dict[str, Any]) -> bytes:
    """Return the frames of an answer, as a server would send them."""
    document, arrays = document_of(draft_of(scenario))
    frames: list[bytes] = []
    desk.answer(encode({**wish, "document": document}, arrays), frames.append)
    last = decode(frames[-1]).header
    if last["kind"] == "error":
        raise TooLargeError(f"{wish['op']} {wish.get('planner', '')}: {last['message']}")
    kept = [frame for frame in frames if decode(frame).header["kind"] in ("part", "result")]
    return b"".join(pack("<I", len(frame)) + frame for frame in kept)


def _choices_for(scenario: Scenario, planners: tuple[str, ...]) -> dict[str, Any]:
    """Return what the page offers: plans that there are, and no options."""
    offered = choices()
    hints = {name: {**offered["hints"][name], "options": {}} for name in planners}
    plain = {name: offered[name] for name in ("steps", "names", "layers")}
    return {
        **plain,
        "tessellations": _shapes_of(scenario.area),
        "planners": {name: {} for name in planners},
        "hints": hints,
    }


def _written(root: Path, contents: dict[str, bytes]) -> list[Path]:
    (root / "answers").mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        with new_file(root / name) as part:
            part.write_bytes(content)
    return [root / name for name in contents]
