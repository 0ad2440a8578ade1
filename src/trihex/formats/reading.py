"""Reading: from a path to the module that reads its format; what a file is, its content tells before its name."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from trihex.areas import Area, Frame, Scenario, Tessellation
from trihex.areas.coverage import Progress
from trihex.errors import FormatError
from trihex.files import check_text, read_bytes
from trihex.formats.areas.letters import parse_letters
from trihex.formats.areas.movingai import parse_movingai
from trihex.formats.areas.options import AreaOptions
from trihex.formats.draft import Draft, draft_of
from trihex.formats.plans.csv import read_plan_csv
from trihex.formats.plans.npz import read_plan_npz
from trihex.formats.recognise import NAME_OF_FORMAT, Format, format_of
from trihex.formats.starts.csv import write_starts as write_starts
from trihex.formats.starts.starts import read_starts as read_starts
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
        MovingAI ``.map``, letters ``.txt``, ROS map ``.yaml``, image, ``.geojson``, ``.wkt``, scenario ``.toml`` or
        plan ``.npz``.
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
    content = read_bytes(path)
    form = format_of(content, path)
    draft: Draft
    given = {name: value for name, value in options.items() if value is not None}
    if form in ("npz", "scenario") and given:
        raise FormatError(f"{path}: says itself how its area lies in the world; {', '.join(given)} cannot change it")
    if form == "npz":
        draft = draft_of(read_plan_npz(path, content).scenario)
    elif form == "scenario":
        from trihex.formats.scenarios.toml import read_scenario_toml

        draft = read_scenario_toml(path, _read_area_draft, content)
    else:
        wanted = _wanted(Tessellation("hexagonal"), tessellation, neighbourhood, costs)
        return _parse_area(content, form, path, AreaOptions(wanted, **given), progress)
    own = draft.area.tessellation
    wanted = _wanted(own, tessellation, neighbourhood, costs)
    return draft if wanted == own else replace(draft, area=draft.area.with_tessellation(wanted))


def _wanted(
    own: Tessellation, tessellation: Tessellation | str | None, neighbourhood: str | None, costs: str | None
) -> Tessellation:
    """Return `own`, changed by what else is given."""
    base = tessellation if isinstance(tessellation, Tessellation) else own
    name = tessellation if isinstance(tessellation, str) else base.name
    return Tessellation(name, neighbourhood or base.neighbourhood, costs or base.costs)


def _read_area_draft(path: Path, options: AreaOptions) -> Draft:
    content = read_bytes(path)
    return _parse_area(content, format_of(content, path), path, options, None)


def _parse_area(
    content: bytes, form: Format, path: str | os.PathLike[str], options: AreaOptions, progress: Progress | None
) -> Draft:
    """Return the draft of an area; parsers of real places are imported where they are used."""
    if form == "ros":
        from trihex.formats.areas.ros import parse_ros

        return parse_ros(content, path, options, progress)
    if form == "image":
        from trihex.formats.areas.image import parse_image

        return parse_image(content, path, options, progress)
    if form == "geojson":
        from trihex.formats.areas.geojson import parse_geojson

        return parse_geojson(content, path, options, progress)
    if form == "wkt":
        from trihex.formats.areas.wkt import parse_wkt

        return parse_wkt(content, path, options, progress)
    if form not in ("movingai", "letters"):
        raise FormatError(f"{path}: must hold an area, not {NAME_OF_FORMAT[form]}")
    if options.robot_radius:
        raise FormatError(f"{path}: has one cell for each letter; robot_radius needs a place with walls in metres")
    text, tessellation = check_text(content, path), options.tessellation
    if form == "movingai":
        draft = Draft(Area(tessellation, parse_movingai(text, path), Path(path).stem))
    else:
        draft = parse_letters(text, path, tessellation)
    if options.cell_size is None:
        return draft
    return replace(draft, area=replace(draft.area, frame=Frame(options.cell_size)))


def read_area(
    path: str | os.PathLike[str],
    tessellation: Tessellation | str | None = None,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Area:
    """Return the area of a file, named after it; see `read_draft`."""
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
    return read_draft(path, tessellation, progress=progress, **options).complete()


def read_plan(
    path: str | os.PathLike[str], scenario: Scenario | None = None, *, progress: Progress | None = None
) -> Plan:
    """Return the plan of a ``.npz``, ``.csv`` or ``.parquet`` file.

    Parameters
    ----------
    path : path
    scenario : Scenario, optional
        For CSV and Parquet, which keep neither area nor rules: what the plan was made for. Its robots are not looked
        at. A plan in ``.npz`` brings its own.
    progress : callable, optional
        Called with (rows read, all rows) of a CSV.

    Raises
    ------
    FormatError
        If the file is not what it claims to be, or keeps no area and there is no scenario.
    OSError
        If it cannot be read.
    """
    content = read_bytes(path)
    form = format_of(content, path)
    if form == "npz":
        return read_plan_npz(path, content)
    if form not in ("plan", "parquet"):
        raise FormatError(f"{path}: must hold a plan (.npz, .csv or .parquet), not {NAME_OF_FORMAT[form]}")
    if scenario is None:
        raise FormatError(f"{path}: does not hold its area; name the area, destinations and rules as well")
    if form == "parquet":
        from trihex.formats.plans.parquet import read_plan_parquet

        return read_plan_parquet(path, scenario, content)
    return read_plan_csv(path, scenario, content, progress=progress)
