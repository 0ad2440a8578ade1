"""What is described by a file and the options beside it: a scenario in the making, or a plan to be judged."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import click

from trihex.cli.options import PLACE, RULES, wrong_use
from trihex.cli.progress import bar

if TYPE_CHECKING:
    from trihex.areas import Area, Scenario
    from trihex.formats import Draft
    from trihex.plans import Motion, Plan


def read_described(path: Path, options: dict[str, Any]) -> Draft:
    """Return the draft in the file at `path`, changed by what the options say."""
    from trihex.formats import read_draft

    place = {name: options[name] for name in PLACE}
    if place["robot_radius"] and not place["cell_size"]:  # the least cells depend on the rules
        place |= {name: options.get(name) for name in ("clock", "following")}
    with bar("covering", "rows") as progress:
        draft = read_draft(
            path,
            options["tessellation"],
            neighbourhood=options["neighbourhood"],
            costs=options["costs"],
            progress=progress,
            **place,
        )
    for note in draft.notes:
        click.echo(f"trihex: {path}: {note}", err=True)
    return _changed(draft, options)


def _changed(draft: Draft, options: dict[str, Any]) -> Draft:
    """Return the draft with what the options say in place of what it says."""
    from dataclasses import replace

    from trihex.areas import cells_from
    from trihex.errors import ScenarioError

    rules = [name for name in RULES if name not in ("destination", "capacity")]
    changes: dict[str, Any] = {name: options[name] for name in rules if options.get(name) is not None}
    if options.get("capacity"):
        told = {str(place): (place, flow) for place, flow in options["capacity"]}
        changes["doors"] = (*(door for door in draft.doors if str(door[0]) not in told), *told.values())
    if options.get("destination"):
        cells = [_cell_of(draft.area, place) for place in options["destination"]]
        changes["destinations"] = cells_from(draft.area, cells, "--destination", ScenarioError)
    return replace(draft, **changes, **_robots_of(draft, options)).paced()


def _robots_of(draft: Draft, options: dict[str, Any]) -> dict[str, Any]:
    """Return what the options say of the robots of a draft, by the names of its fields."""
    from trihex.areas import check_distribution
    from trihex.files import read_bytes
    from trihex.formats import format_of, read_slowness, read_start_times, read_starts

    count, starts, seed = options.get("robots"), options.get("starts"), options.get("seed")
    times = options.get("start_times")
    if times is not None:
        check_distribution(times)
    elif isinstance(draft.start_times, str) or (count is None and starts is None):
        times = draft.start_times
    changes: dict[str, Any] = {"start_times": times}
    draws_times = isinstance(times, str)
    if count is not None and starts is None:
        return {**changes, "random_count": count, "robots": None, "seed": seed, "slowness": None}
    if seed is not None and not draws_times and count is not None:
        raise wrong_use("--seed draws robots; with --starts none are drawn")
    if seed is not None and not draws_times and (starts is not None or draft.random_count is None):
        raise wrong_use("--seed draws robots: add --robots N")
    if starts is not None:
        robots, own = read_starts(starts, draft.area), read_start_times(starts)
        if count is not None and count > robots.size:
            raise wrong_use(f"--robots takes the first of {starts}: at most {robots.size}, not {count}")
        if times is None and own is not None:
            changes["start_times"] = own[:count]
        slowness = read_slowness(starts)
        changes["slowness"] = None if slowness is None else slowness[:count]
        if format_of(read_bytes(starts), starts) == "scen":
            click.echo(f"trihex: goals of {starts} are not used: all robots go to the destinations", err=True)
        return {**changes, "robots": robots[:count], "random_count": None, "seed": seed}
    return changes if seed is None else {**changes, "seed": seed}


def _cell_of(area: Area, place: tuple[Any, Any]) -> tuple[int, int]:
    """Return the cell (x, y) of a place that may be given in metres."""
    from trihex.errors import AreaError

    if isinstance(place[0], int):
        return place
    try:
        x, y = area.cell_to_xy(area.metres_to_cell(*place))
    except AreaError as error:
        raise wrong_use(f"--destination: {error}") from None
    return int(x), int(y)


def complete(draft: Draft, *uses: str, needs_robots: bool = True) -> Scenario:
    """Return the scenario of a draft, or tell which option would complete it.

    Before robots are drawn, kernels for `uses` are compiled and loaded (`trihex.kernels.preparing`), all at once and
    so that the seconds told later are those of the work; but not before what the user said is known to be right.
    """
    from dataclasses import replace

    from trihex.fields import field_kernels
    from trihex.kernels.preparing import prepare
    from trihex.planners import check_plannable, uses_of

    if draft.destinations is None:
        raise wrong_use("there is no destination: add --destination X,Y")
    if needs_robots and draft.robots is None and draft.random_count is None:
        raise wrong_use("there are no robots: add --robots N or --starts FILE")
    known = draft if draft.random_count is None else replace(draft, random_count=None)
    scenario = known.complete()
    for use in uses:
        check_plannable(use, scenario)
    if uses and (draft.random_count or 0) <= draft.area.free_count:  # or they cannot be drawn, which is told at once
        needed = [need for use in uses for need in uses_of(use, scenario)]
        prepare(*needed, field_kernels(draft.area.tessellation, scenario.corners))
    return scenario if known is draft else draft.complete()


def read_judged(
    path: Path,
    area: Path | None,
    options: dict[str, Any],
    *,
    add_area: str = "AREA",
    for_judge: bool = False,
    pace: Mapping[str, Any] = MappingProxyType({}),
) -> Plan:
    """Return the plan at `path`; what `area` and the options say comes before what it says itself.

    ``pace`` has the speed and the turn time of robots, by which flows a second become flows a step.
    """
    from dataclasses import replace

    from trihex.areas import claimed
    from trihex.files import read_bytes
    from trihex.formats import FORMATS, draft_of, format_of, read_draft, read_plan

    form = FORMATS[format_of(read_bytes(path), path)]
    if form.holds != "plan":
        raise wrong_use(f"{path} must hold a plan (.npz, .csv or .parquet), not {form.words}")
    if not form.brings_scenario:
        if area is None:
            raise wrong_use(f"{path} does not hold its area: add {add_area}")
        described = read_described(area, options)
        described = replace(described, outputs=described.outputs | dict(pace))
        scenario = complete(described, needs_robots=False)
        with bar("reading", "rows") as progress:
            return read_plan(path, scenario, for_judge=for_judge, progress=progress)
    plan = read_plan(path, for_judge=for_judge)
    own = plan.scenario.area.tessellation
    for name, was in (("tessellation", own.name), ("neighbourhood", own.neighbourhood)):
        if options[name] not in (None, was):
            raise wrong_use(f"{path} is a plan for {name} {was}, which cannot be read as {options[name]}")
    draft = draft_of(plan.scenario)
    place = {name: options[name] for name in PLACE}
    if area is not None:
        draft = replace(draft, area=_same_size(read_draft(area, own, **place).area, draft.area, area, path))
    elif any(value is not None for value in place.values()):
        raise wrong_use(f"{path} holds its area itself, so how to read one cannot be told")
    draft = replace(draft, area=draft.area.with_tessellation(replace(own, costs=options["costs"] or own.costs)))
    draft = _changed(replace(draft, outputs=dict(pace)), options)
    if options["destination"]:  # whoever names a barrier here is wrong, not the plan
        replace(draft, robots=None).complete()
    scenario = claimed(draft.complete) if for_judge else draft.complete()
    is_same = scenario == plan.scenario
    if is_same and scenario.area.ground is None:
        return plan
    return replace(plan, scenario=scenario, optimal=plan.optimal and is_same)  # the ground is no part of it


def read_played(path: Path, area: Path | None, options: dict[str, Any], **more: Any) -> Motion:
    """Return the run at `path`, or the plan; see `read_judged`. A run says all itself."""
    from trihex.formats import is_run, read_run

    if not is_run(path):
        return read_judged(path, area, options, **more)
    told = [f"--{name.replace('_', '-')}" for name, value in options.items() if value not in (None, ())]
    if area is not None or told:
        raise wrong_use(f"{path} is a run and says all itself, so {told[0] if told else area} cannot be told")
    return read_run(path)


def _same_size(area: Area, own: Area, path: Path, of_plan: Path) -> Area:
    """Return `area` if it has the size of the plan's own."""
    sizes = [f"{one.width} x {one.height}" for one in (own, area)]
    if sizes[0] != sizes[1]:
        raise wrong_use(f"{of_plan} needs an area of {sizes[0]} cells, {path} has {sizes[1]}")
    return area
