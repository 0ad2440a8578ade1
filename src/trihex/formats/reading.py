"""Reading: from a path to the module that reads its format; what a file is, its content tells before its name."""

from __future__ import annotations

import os
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from trihex.areas import TESSELLATIONS, Area, Scenario, Tessellation, check_possible
from trihex.areas.coverage import Progress
from trihex.errors import FormatError, TrihexError, check_options, check_type
from trihex.files import read_bytes
from trihex.formats.areas.options import AreaOptions
from trihex.formats.draft import Draft, draft_of
from trihex.formats.recognise import format_of
from trihex.formats.registry import FORMATS, Format
from trihex.plans import Plan


def read_draft(
    path: str | os.PathLike[str],
    tessellation: Tessellation | str | None = None,
    *,
    neighbourhood: str | None = None,
    costs: str | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Draft:
    """Return what a file says of a scenario: an area with or without destinations, robots and rules.

    Parameters
    ----------
    path : path
        MovingAI ``.map``, letters ``.txt``, Tiled ``.tmj`` and ``.tmx``, ROS map ``.yaml``, image, ``.geojson``,
        ``.wkt``, scenario ``.toml`` or plan ``.npz``.
    tessellation : Tessellation or str, optional
        What the cells are; a name tells the shape alone. Default: what the file says, or hexagonal.
    neighbourhood, costs : str, optional
        What else the cells are. Default: as `tessellation` or the file says.
    progress : callable, optional
        Called with (rows covered, all rows).
    **options
        How areas are read, such as `cell_size` and `robot_radius` in metres; see `formats.options.AreaOptions`.

    Raises
    ------
    FormatError
        If the file is not what it claims to be.
    OSError
        If it cannot be read.
    """
    _check_names("read_draft", options)
    content = read_bytes(path)
    form = FORMATS[format_of(content, path)]
    given = {name: value for name, value in options.items() if value is not None}
    if not form.brings_scenario:
        wanted = _wanted(Tessellation("hexagonal"), tessellation, neighbourhood, costs)
        draft = _parse_area(content, form, path, AreaOptions(wanted, **given), progress)
        own = draft.area.tessellation
        if form.brings_shape and tessellation is not None and wanted.name != own.name:
            raise FormatError(f"{path}: has {own.name} cells, which cannot be read as {wanted.name}")
        return draft
    if given:
        raise FormatError(f"{path}: says itself how its area lies in the world; {', '.join(given)} cannot change it")
    if form.holds == "plan":
        draft = draft_of(form.parse(content, path).scenario)
    else:
        draft = form.parse(content, path, _read_area_draft)
    own = draft.area.tessellation
    wanted = _wanted(own, tessellation, neighbourhood, costs)
    return draft if wanted == own else replace(draft, area=draft.area.with_tessellation(wanted))


def _check_names(reader: str, options: dict[str, Any]) -> None:
    """Raise ArgumentError if an option does not exist."""
    own = (option.name for option in fields(AreaOptions))
    check_options(reader, options, dict.fromkeys([*own, "neighbourhood", "costs", "progress"]))


def _wanted(
    own: Tessellation, tessellation: Tessellation | str | None, neighbourhood: str | None, costs: str | None
) -> Tessellation:
    """Return `own`, changed by what else is given."""
    check_type("tessellation", tessellation, Tessellation, str, type(None))
    base = tessellation if isinstance(tessellation, Tessellation) else own
    name = tessellation if isinstance(tessellation, str) else base.name
    return Tessellation(name, neighbourhood or base.neighbourhood, costs or base.costs, base.clock)


def _read_area_draft(path: Path, options: AreaOptions) -> Draft:
    content = read_bytes(path)
    return _parse_area(content, FORMATS[format_of(content, path)], path, options, None)


def _parse_area(
    content: bytes, form: Format, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None
) -> Draft:
    if form.holds != "area":
        raise FormatError(f"{path}: must hold an area, not {form.words}")
    draft: Draft = form.parse(content, path, options, progress)
    return draft


def read_area(
    path: str | os.PathLike[str],
    tessellation: Tessellation | str | None = None,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Area:
    """Return the area of a file, named after it; see `read_draft`."""
    _check_names("read_area", options)
    return read_draft(path, tessellation, progress=progress, **options).area


def read_scenario(
    path: str | os.PathLike[str],
    tessellation: Tessellation | str | None = None,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Scenario:
    """Return the scenario of a file that names at least one destination; see `read_draft`.

    Raises
    ------
    ScenarioError
        If the file names no destination, or its parts do not fit.
    """
    _check_names("read_scenario", options)
    return read_draft(path, tessellation, progress=progress, **options).complete()


def read_plan(
    path: str | os.PathLike[str],
    scenario: Scenario | None = None,
    *,
    for_judge: bool = False,
    progress: Progress | None = None,
) -> Plan:
    """Return the plan of a ``.npz``, ``.csv`` or ``.parquet`` file.

    Parameters
    ----------
    path : path
    scenario : Scenario, optional
        For CSV and Parquet, which keep neither area nor rules: what the plan was made for. Its robots are not looked
        at. A plan in ``.npz`` brings its own.
    for_judge : bool
        Whether starts on barriers or in one cell, with which nothing can be done but `audit_plan`, are let through.
    progress : callable, optional
        Called with (rows read, all rows) of a CSV.

    Raises
    ------
    FormatError
        If the file is not what it claims to be, or keeps no area and there is no scenario.
    ScenarioError
        If robots start on barriers or in one cell.
    OSError
        If it cannot be read.
    """
    check_type("scenario", scenario, Scenario, type(None))
    content = read_bytes(path)
    form = FORMATS[format_of(content, path)]
    if form.holds != "plan":
        raise FormatError(f"{path}: must hold a plan (.npz, .csv or .parquet), not {form.words}")
    if scenario is None and not form.brings_scenario:
        raise FormatError(f"{path}: does not hold its area; name the area, destinations and rules as well")
    try:
        plan: Plan = form.parse(content, path, scenario, progress)
    except FormatError as error:
        raise FormatError(f"{error}{likeness_of(content, path, scenario)}") from None
    if not for_judge:
        check_possible(plan.scenario)
    return plan


def likeness_of(content: bytes, path: str | os.PathLike[str], scenario: Scenario | None) -> str:
    """Return which tessellation a plan of rows looks made for, in words: another one on which each move is a step.

    Empty if there is none, or `scenario` is None.
    """
    if scenario is None:
        return ""
    form, own = FORMATS[format_of(content, path)], scenario.area.tessellation
    for name in TESSELLATIONS:
        if name == own.name:
            continue
        other = Tessellation(name, "full", own.costs, own.clock)
        area = Area(other, scenario.area.barriers)  # without a frame, which might forbid it
        waiting_cost = scenario.waiting_cost if scenario.waiting_cost != own.waiting_cost else other.waiting_cost
        try:
            plan = form.parse(content, path, Scenario(area, scenario.destinations, waiting_cost=waiting_cost))
        except TrihexError:
            continue
        if plan.actions.size and not plan.jumps.size:
            return f"; the plan looks {name} (--tessellation {name}), not {own.name}"
    return ""
