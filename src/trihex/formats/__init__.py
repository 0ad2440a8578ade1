"""Formats: one module a file format; here the way from a path to the right one.

What a file is, its content tells before its name; what is written, the suffix tells.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from trihex.area import Area
from trihex.errors import FormatError
from trihex.formats.draft import Draft, draft_of
from trihex.formats.files import check_text, read_bytes, suffix_of
from trihex.formats.letters import parse_letters, write_letters
from trihex.formats.movingai import parse_movingai, write_movingai
from trihex.formats.plan_csv import read_plan_csv, write_plan_csv
from trihex.formats.plan_npz import read_plan_npz, write_plan_npz
from trihex.formats.recognise import format_of
from trihex.formats.starts_csv import read_starts as read_starts
from trihex.formats.starts_csv import write_starts as write_starts
from trihex.plan import Plan
from trihex.scenario import Scenario
from trihex.tessellation import Tessellation

AREA_SUFFIXES = (".map", ".txt")
PLAN_SUFFIXES = (".csv", ".npz")
SCENARIO_SUFFIXES = (".toml", ".txt")


def read_draft(path: str | os.PathLike[str], tessellation: Tessellation | str | None = None) -> Draft:
    """Return what a file says of a scenario: an area with or without destinations, robots and rules.

    Parameters
    ----------
    path : path
        MovingAI ``.map``, letters ``.txt``, scenario ``.toml`` or plan ``.npz``.
    tessellation : Tessellation or str, optional
        What the cells are. Default: what the file says, or hexagonal.

    Raises
    ------
    FormatError
        If the file is not what it claims to be.
    OSError
        If it cannot be read.
    """
    content = read_bytes(path)
    form = format_of(content, path)
    draft: Draft
    if form == "npz":
        draft = draft_of(read_plan_npz(path, content).scenario)
    elif form == "scenario":
        from trihex.formats.scenario_toml import read_scenario_toml

        draft = read_scenario_toml(path, _read_area_draft, content)
    else:
        return _parse_area(content, form, path, _made(tessellation or "hexagonal"))
    if tessellation is not None:
        draft = replace(draft, area=draft.area.with_tessellation(_made(tessellation)))
    return draft


def _made(tessellation: Tessellation | str) -> Tessellation:
    return Tessellation(tessellation) if isinstance(tessellation, str) else tessellation


def _read_area_draft(path: Path, tessellation: Tessellation) -> Draft:
    content = read_bytes(path)
    return _parse_area(content, format_of(content, path), path, tessellation)


def _parse_area(content: bytes, form: str, path: str | os.PathLike[str], tessellation: Tessellation) -> Draft:
    if form not in ("movingai", "letters"):
        raise FormatError(f"{path}: must hold an area (.map or .txt), not {form}")
    text = check_text(content, path)
    if form == "movingai":
        return Draft(Area(tessellation, parse_movingai(text, path), Path(path).stem))
    return parse_letters(text, path, tessellation)


def read_area(path: str | os.PathLike[str], tessellation: Tessellation | str | None = None) -> Area:
    """Return the area of a file, named after it; see `read_draft`."""
    return read_draft(path, tessellation).area


def read_scenario(path: str | os.PathLike[str], tessellation: Tessellation | str | None = None) -> Scenario:
    """Return the scenario of a file that names at least one destination; see `read_draft`.

    Raises
    ------
    ScenarioError
        If the file names no destination, or its parts do not fit.
    """
    return read_draft(path, tessellation).complete()


def write_area(area: Area, path: str | os.PathLike[str]) -> None:
    """Write the barriers of an area as MovingAI ``.map`` or letters ``.txt``; neither keeps the tessellation."""
    if suffix_of(path, AREA_SUFFIXES, "an area") == ".map":
        write_movingai(area, path)
    else:
        write_letters(area, path)


def write_scenario(scenario: Scenario, path: str | os.PathLike[str], **planner: Any) -> None:
    """Write a scenario as ``.toml``, or as letters ``.txt`` if letters can carry it.

    Raises
    ------
    FormatError
        If letters cannot carry it.
    """
    if suffix_of(path, SCENARIO_SUFFIXES, "a scenario") == ".txt":
        write_letters(scenario, path)
    else:
        from trihex.formats.scenario_toml import write_scenario_toml

        write_scenario_toml(scenario, path, **planner)


def read_plan(path: str | os.PathLike[str], scenario: Scenario | None = None) -> Plan:
    """Return the plan of a ``.npz`` or ``.csv`` file.

    Parameters
    ----------
    path : path
    scenario : Scenario, optional
        For CSV, which keeps neither area nor rules: what the plan was made for. Its robots are not looked at. A plan
        in ``.npz`` brings its own.

    Raises
    ------
    FormatError
        If the file is not what it claims to be, or is a CSV and there is no scenario.
    OSError
        If it cannot be read.
    """
    content = read_bytes(path)
    form = format_of(content, path)
    if form == "npz":
        return read_plan_npz(path, content)
    if form != "plan":
        raise FormatError(f"{path}: must hold a plan (.npz or .csv), not {form}")
    if scenario is None:
        raise FormatError(
            f"{path}: a plan in CSV does not hold its area; name the area, destinations and rules as well"
        )
    return read_plan_csv(path, scenario, content)


def write_plan(plan: Plan, path: str | os.PathLike[str]) -> None:
    """Write a plan as ``.csv`` or ``.npz``."""
    if suffix_of(path, PLAN_SUFFIXES, "a plan") == ".csv":
        write_plan_csv(plan, path)
    else:
        write_plan_npz(plan, path)
