"""`trihex plan`: from an area to a plan and its report."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import click

from trihex.cli.described import complete, read_described
from trihex.cli.group import DONE, NO
from trihex.cli.maps import Maps, check_maps, map_options, write_maps
from trihex.cli.options import (
    PATH,
    area_options,
    gathered,
    of_waypoints,
    robot_options,
    rule_options,
    waypoint_options,
    wrong_use,
)
from trihex.cli.outputs import check_outputs, tell_written
from trihex.cli.progress import bar
from trihex.cli.types import Name


class Outputs(NamedTuple):
    """What is written, by the names that it has in a scenario file; None where nothing is said."""

    plan: Path | None
    summary: Path | None
    picture: Path | None
    waypoints: Path | None
    certificate: Path | None
    speed: float | None
    turn_time: float | None
    frame_id: str | None


@click.command("plan")
@click.argument("area", type=PATH)
@area_options
@rule_options
@robot_options
@click.option("--planner", type=Name("trihex.planners", "PLANNERS"), help="Who plans. [default: fcost]")
@click.option("--planner-option", metavar="NAME=VALUE", multiple=True, help="One of its options; may be repeated.")
@click.option("--straight", is_flag=True, help="Then let robots turn less, with equal arrivals and at no more cost.")
@click.option(
    "--out", "plan", type=PATH, metavar="PLAN", help="The plan: .csv, .npz, .mcap, .tmj for Tiled, .dependencies.json."
)
@click.option("--summary", type=PATH, metavar="FILE", help="The report as JSON; - writes it to the standard output.")
@click.option("--picture", type=PATH, metavar="FILE", help="The plan drawn, as .png, .svg or .pdf.")
@click.option("--waypoints", type=PATH, metavar="FILE", help="Where each robot is when, in metres and seconds.")
@click.option("--certificate", type=PATH, metavar="FILE", help="Tolls that prove an optimal plan, as .csv.")
@waypoint_options
@map_options
@click.option("--write-scenario", type=PATH, metavar="FILE", help="All that was planned, as a scenario .toml.")
@gathered("named", Outputs)
@gathered("maps", Maps)
def command(
    area: Path,
    planner: str | None,
    planner_option: tuple[str, ...],
    straight: bool,
    named: Outputs,
    maps: Maps,
    write_scenario: Path | None,
    **options: Any,
) -> int:
    """Plan collision-free paths for all robots.

    AREA is a MovingAI .map, letters .txt (. free, B barrier, D destination, small letters robots), a map of Tiled
    (.tmj, .tmx), an image, a place in metres (ROS map .yaml, GeoJSON, WKT, DXF; give --robot-radius, or --cell-size,
    too), or a scenario .toml, which holds rules, destinations, robots and outputs as well; options come before what the
    file says.

    Exit status 1: some robots cannot arrive. The others are planned and all outputs are written.
    """
    from dataclasses import replace

    from trihex.planners import check_planner_options

    outputs: dict[str, Any] = {name: value for name, value in named._asdict().items() if value is not None}
    _check_outputs(outputs, write_scenario)
    check_maps(maps)
    begin = perf_counter()
    draft = read_described(area, options)
    seconds = {"read": perf_counter() - begin}
    outputs = draft.outputs | outputs
    _check_outputs(outputs, write_scenario)
    draft = replace(draft, outputs=outputs)  # speed tells how long a step lasts
    planner = planner or draft.planner or "fcost"
    planner_options = {**(draft.planner_options if planner == draft.planner else {}), **_parsed(planner_option)}
    check_planner_options(planner, planner_options)
    if "certificate" in outputs and planner != "optimal":
        raise wrong_use(f"--certificate proves what planner 'optimal' plans, not {planner!r}")
    is_order = "plan" in outputs and _is_order(outputs["plan"])
    _check_before(draft, straight=straight, certificate="certificate" in outputs, is_order=is_order)
    scenario = complete(draft, *_uses(planner, outputs))
    if scenario.area.frame is None:
        if "waypoints" in outputs:
            raise wrong_use("--waypoints are in metres: add --cell-size")
        if "plan" in outputs and _is_in_metres(outputs["plan"]):
            raise wrong_use(f"--out {outputs['plan']} is in metres: add --cell-size")
    pace: dict[str, float] = {name: outputs[name] for name in ("speed", "turn_time") if name in outputs}
    report = _reported(scenario, planner, planner_options, seconds, pace, straight=straight)
    _write(report, outputs, area)
    write_maps(report.plan, maps, pace)
    if write_scenario:
        from trihex.formats import write_scenario as write_scenario_file

        kept = {name: value for name, value in outputs.items() if str(value) != "-"}
        write_scenario_file(scenario, write_scenario, planner=planner, planner_options=planner_options, outputs=kept)
    status = _told(report, outputs.get("summary"))
    if str(outputs.get("summary")) != "-":
        files = (outputs.get(name) for name in ("plan", "summary", "picture", "waypoints", "certificate"))
        tell_written(*files, *maps, write_scenario)
    return status


def _uses(planner: str, outputs: dict[str, Any]) -> list[str]:
    """Return what kernels are for."""
    uses = [planner, "audit"] if planner == "optimal" else [planner, "audit", "bound"]
    if Path(outputs.get("plan", "")).suffix.lower() == ".csv":
        uses.append("table")
    return [*uses, *(use for use in ("picture", "certificate") if use in outputs)]


def _check_before(draft: Any, *, straight: bool, certificate: bool, is_order: bool) -> None:
    """Raise unless what is planned can be straightened, certified and ordered as asked, whatever robots there are."""
    from dataclasses import replace

    if draft.destinations is None or not (
        straight or certificate or is_order
    ):  # it is told a little later that there is none
        return
    scenario = replace(draft, robots=None, random_count=None).complete()
    if draft.has_slowness:
        option = "straight" if straight else "certificate" if certificate else "out"
        order = " for an order of who waits for whom" * (option == "out")
        raise wrong_use(f"--{option} needs robots that are all as fast{order}")
    if certificate:
        from trihex.optimum import check_certifiable

        check_certifiable(scenario)
        if draft.has_start_times:
            raise wrong_use("--certificate needs robots that may all begin at once, without start times")
    if is_order:
        from trihex.plans import check_orderable

        check_orderable(scenario)
    if straight:
        from trihex.planners import check_straightenable

        check_straightenable(scenario)


def _check_outputs(outputs: dict[str, Any], write_scenario: Path | None) -> None:
    """Raise unless all that is to be written can be."""
    from trihex.formats import (
        CERTIFICATE_SUFFIXES,
        DEPENDENCY_SUFFIXES,
        LAYER_SUFFIXES,
        PLAN_SUFFIXES,
        WAYPOINT_SUFFIXES,
    )

    plan_suffixes = dict.fromkeys((*DEPENDENCY_SUFFIXES, *PLAN_SUFFIXES, *WAYPOINT_SUFFIXES, *LAYER_SUFFIXES))
    unnamed = [value for value in outputs.values() if write_scenario and not str(value).isprintable()]
    if unnamed:
        raise wrong_use(f"--write-scenario can name no output but in printable UTF-8, not {str(unnamed[0])!a:.200}")
    if outputs.get("picture"):  # what draws is imported only for who draws
        from trihex.pictures import PICTURE_SUFFIXES

        check_outputs((outputs["picture"], PICTURE_SUFFIXES, "a picture"))
    check_outputs(
        (outputs.get("plan"), plan_suffixes, "a plan"),
        (outputs.get("summary"), (), "a summary"),
        (outputs.get("picture"), (), "a picture"),
        (outputs.get("waypoints"), WAYPOINT_SUFFIXES, "waypoints"),
        (outputs.get("certificate"), CERTIFICATE_SUFFIXES, "a certificate"),
        (write_scenario, (".toml",), "a scenario"),
    )


def _is_order(path: Path) -> bool:
    """Tell whether a file tells who waits for whom, as its suffix says."""
    from trihex.formats import DEPENDENCY_SUFFIXES

    return path.name.lower().endswith(tuple(DEPENDENCY_SUFFIXES))


def _is_in_metres(path: Path) -> bool:
    """Tell whether a file can be written of places in metres alone, as its suffix says."""
    return _is_of_waypoints(path) or path.name.lower().endswith(".vda5050.json")


def _is_of_waypoints(path: Path) -> bool:
    """Tell whether a file tells of places in metres, as its suffix says, not of a plan's actions or their order."""
    from trihex.formats import PLAN_SUFFIXES, WAYPOINT_SUFFIXES

    return not _is_order(path) and path.suffix.lower() in set(WAYPOINT_SUFFIXES) - set(PLAN_SUFFIXES)


def _write(report: Any, outputs: dict[str, Any], area: Path) -> None:
    """Write and draw the plan."""
    from trihex.formats import LAYER_SUFFIXES, write_certificate, write_plan, write_tiled, write_waypoints

    if "plan" in outputs and _is_order(outputs["plan"]):
        from trihex.formats import write_dependencies

        write_dependencies(report.plan, outputs["plan"], speed=outputs.get("speed", 1.0))
    elif "plan" in outputs and _is_of_waypoints(outputs["plan"]):
        write_waypoints(report.plan, outputs["plan"], **of_waypoints(dict(outputs)))
    elif "plan" in outputs and outputs["plan"].suffix.lower() in LAYER_SUFFIXES:
        write_tiled(report.plan, outputs["plan"], like=area)
    elif "plan" in outputs:
        with bar("writing", "parts") as progress:
            write_plan(report.plan, outputs["plan"], progress=progress)
    if "picture" in outputs:
        from trihex.pictures import picture_of_plan

        ground = report.plan.scenario.area.ground
        picture_of_plan(report.plan, ground=ground, crop=ground is not None).save(outputs["picture"])
    if "waypoints" in outputs:
        write_waypoints(report.plan, outputs["waypoints"], **of_waypoints(dict(outputs)))
    if "certificate" in outputs:
        from trihex.optimum import make_certificate

        with bar("proving", "steps") as progress:
            certificate = make_certificate(report.plan, progress=progress)
        write_certificate(certificate, outputs["certificate"])


def _reported(
    scenario: Any,
    planner: str,
    planner_options: dict[str, Any],
    seconds: dict[str, float],
    pace: dict[str, float],
    *,
    straight: bool,
) -> Any:
    """Plan, judge and report; add to `seconds` how long each part took."""
    from trihex.bounds import make_lower_bound
    from trihex.fields import make_n_scheme
    from trihex.judging import audit_plan, make_report
    from trihex.planners import make_plan, straighten

    begin = perf_counter()
    n_scheme = make_n_scheme(scenario)
    seconds["field"] = perf_counter() - begin
    begin = perf_counter()
    with bar("planning", "robots") as progress:
        plan = make_plan(scenario, planner, n_scheme=n_scheme, progress=progress, **planner_options)
    if straight:
        with bar("straightening", "robots") as progress:
            plan = straighten(plan, progress=progress)
    seconds["plan"] = perf_counter() - begin
    begin = perf_counter()
    with bar("judging", "actions") as progress:
        audit = audit_plan(plan, progress=progress)
    seconds["audit"] = perf_counter() - begin
    bound = None
    if not plan.optimal:
        with bar("bounding", "rounds") as progress:
            bound = make_lower_bound(n_scheme, progress=progress)
    return make_report(plan, n_scheme=n_scheme, audit=audit, lower_bound=bound, seconds=seconds, **pace)


def _parsed(planner_option: tuple[str, ...]) -> dict[str, Any]:
    """Return planner options by name; numbers, true and false are read as such."""
    from json import loads

    values: dict[str, Any] = {}
    for text in planner_option:
        name, equals, value = text.partition("=")
        if not equals:
            raise wrong_use(f"--planner-option must be NAME=VALUE, not {text!r}")
        try:
            values[name.strip()] = loads(value)
        except ValueError:
            values[name.strip()] = value
    return values


def _told(report: Any, summary: Path | None) -> int:
    """Print the report, tell what is amiss, and return the exit status."""
    from trihex.cli.texts import conflict_lines, report_lines, stranded_line
    from trihex.formats import report_text, write_report

    if summary and str(summary) != "-":
        write_report(report, summary)
    if str(summary) == "-":
        click.echo(report_text(report), nl=False)
    else:
        click.echo("\n".join(report_lines(report)))
    if not report.audit.is_clean:
        click.echo("\n".join(conflict_lines(report.audit, 10)), err=True)
    if report.unreachable_robots.size:
        line = stranded_line(report.plan.scenario, report.unreachable_robots.tolist())
        click.echo(f"trihex: {line}", err=True)
    return NO if report.unreachable_robots.size or not report.audit.is_clean else DONE
