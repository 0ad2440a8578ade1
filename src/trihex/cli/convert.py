"""`trihex convert`: the same thing in another format."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trihex.cli.described import read_described, read_judged, read_played
from trihex.cli.options import PATH, RULES, area_options, of_waypoints, rule_options, waypoint_options, wrong_use
from trihex.cli.outputs import check_outputs, tell_written
from trihex.cli.progress import bar

if TYPE_CHECKING:
    from trihex.plans import Motion


@click.command("convert")
@click.argument("source", type=PATH, metavar="IN")
@click.argument("target", type=PATH, metavar="OUT")
@click.option("--area", type=PATH, metavar="AREA", help="The area of a plan or of starts in .csv.")
@area_options
@rule_options
@click.option("--waypoints", is_flag=True, help="Where each robot is when, in metres and seconds, instead of its plan.")
@waypoint_options
def command(source: Path, target: Path, area: Path | None, waypoints: bool, **options: Any) -> None:
    """Write what is in IN as the suffix of OUT says.

    Plans and runs: .csv, .npz and .parquet, .txt for mapf-visualizer; a plan in .csv or .parquet needs --area and the
    options that it was made with. Waypoints of both: .csv (with --waypoints), .yaml, .json, .geojson, .sqlite, .mcap.
    Of plans: who waits for whom, .dependencies.json, .vda5050.json; layers for Tiled, .tmj, which lie as those of
    --area if that is a map of Tiled. Areas: .map, .txt, images and .toml. Scenarios: .toml and .txt. Starts: .csv. What
    a format cannot carry is refused.
    """
    from trihex.files import read_bytes
    from trihex.formats import FORMATS, format_of

    way = of_waypoints(options)
    form = FORMATS[format_of(read_bytes(source), source)]
    if form.holds != "plan" and way:
        raise wrong_use(f"{_first_of(way)} is for plans; {source} holds none")
    if form.holds == "starts":
        _convert_starts(source, target, area, options)
        return
    if form.holds == "plan":
        _convert_plan(source, target, area, way, options, waypoints)
        return
    if area is not None or waypoints:
        raise wrong_use(f"--{'area' if area else 'waypoints'} is for plans; {source} holds none")
    for name in RULES:
        if options[name] not in (None, ()):
            raise wrong_use(f"--{name.replace('_', '-')} is for plans; {source} holds none")
    _convert_area(source, target, options)


def _convert_plan(
    source: Path, target: Path, area: Path | None, way: dict[str, Any], options: dict[str, Any], waypoints: bool
) -> None:
    from trihex.files import suffix_of
    from trihex.formats import (
        DEPENDENCY_SUFFIXES,
        LAYER_SUFFIXES,
        PLAN_SUFFIXES,
        WAYPOINT_SUFFIXES,
        write_dependencies,
        write_plan,
        write_tiled,
        write_waypoints,
    )

    kind = "waypoints" if waypoints else "a plan, waypoints, dependencies or layers"
    suffixes = WAYPOINT_SUFFIXES
    if not waypoints:
        every = (*DEPENDENCY_SUFFIXES, *PLAN_SUFFIXES, *WAYPOINT_SUFFIXES, *LAYER_SUFFIXES)
        suffixes = tuple(dict.fromkeys(every))
    check_outputs((target, suffixes, kind))
    suffix = suffix_of(target, suffixes, kind)
    if suffix in DEPENDENCY_SUFFIXES or suffix in LAYER_SUFFIXES:
        judged = read_judged(source, area, options, add_area="--area AREA", pace=way)
        _check_pace(judged, area, target, way, options, has_speed=suffix in DEPENDENCY_SUFFIXES)
        if suffix in LAYER_SUFFIXES:
            write_tiled(judged, target, like=area)
        else:
            write_dependencies(judged, target, speed=way.get("speed", 1.0))
    else:
        plan = read_played(source, area, options, add_area="--area AREA", pace=way)
        if waypoints or suffix not in PLAN_SUFFIXES:
            write_waypoints(plan, target, **way)
        else:
            _check_pace(plan, area, target, way, options)
            with bar("writing", "parts") as progress:
                write_plan(plan, target, progress=progress)
    tell_written(target)


def _check_pace(
    motion: Motion,
    area: Path | None,
    target: Path,
    way: dict[str, Any],
    options: dict[str, Any],
    *,
    has_speed: bool = False,
) -> None:
    """Raise if something is told of waypoints where none are written, and no flow a second was read by it either."""
    told = (options["destination_capacity"], *(flow for _, flow in options["capacity"]))
    has_flows = any(str(flow).strip().endswith("/s") for flow in told)
    if area is not None:  # its doors and rules may have been told in robots a second
        has_flows = has_flows or bool(motion.scenario.doors) or area.suffix.lower() == ".toml"
    used = {"speed", "turn_time"} if has_flows else {"speed"} if has_speed else set()
    if idle := {name: value for name, value in way.items() if name not in used}:
        hint = " without --waypoints" if target.suffix.lower() == ".csv" else ""
        raise wrong_use(f"{_first_of(idle)} is for waypoints; {target} holds none{hint}")


def _first_of(way: dict[str, Any]) -> str:
    """Return the option of waypoints that is given first."""
    return f"--{next(iter(way)).replace('_', '-')}"


def _convert_starts(source: Path, target: Path, area: Path | None, options: dict[str, Any]) -> None:
    from trihex.formats import read_slowness, read_start_times, read_starts, write_starts

    check_outputs((target, (".csv",), "starts"))
    if area is None:
        raise wrong_use(f"{source} holds starts in an area: add --area AREA")
    own = read_described(area, options).area
    times, slowness = read_start_times(source), read_slowness(source)
    write_starts(own, read_starts(source, own), target, start_times=times, slowness=slowness)
    tell_written(target)


def _convert_area(source: Path, target: Path, options: dict[str, Any]) -> None:
    from trihex.formats import AREA_SUFFIXES, SCENARIO_SUFFIXES, write_area, write_scenario
    from trihex.formats.areas.letters import lost_in_letters

    draft = read_described(source, options)
    is_area = draft.destinations is None and draft.robots is None and draft.random_count is None
    check_outputs((target, AREA_SUFFIXES if is_area else SCENARIO_SUFFIXES, "an area" if is_area else "a scenario"))
    if is_area and draft.doors:
        raise wrong_use(f"an area without destinations cannot carry doors with a flow, as {source} has")
    if is_area:
        write_area(draft.area, target)
        tell_written(target)
        return
    scenario = draft.complete()
    if target.suffix.lower() == ".txt" and (lost := lost_in_letters(scenario)):
        raise wrong_use(f"letters cannot carry {', '.join(lost)}, as {source} has")
    write_scenario(
        scenario, target, planner=draft.planner or "", planner_options=draft.planner_options, outputs=draft.outputs
    )
    tell_written(target)
