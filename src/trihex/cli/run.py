"""`trihex run`: robots on their way through a world that changes, is unknown to them, or makes them late."""

from __future__ import annotations

from pathlib import Path
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
from trihex.cli.texts import door_lines, exit_lines
from trihex.cli.types import Amount, Name, Seconds, Share, Whole


class Beginning(NamedTuple):
    """What a run begins with, one of the three."""

    area: Path | None
    plan: Path | None
    resume: Path | None


class Way(NamedTuple):
    """Who decides what robots do, what they see, and what comes in their way; None where nothing is said."""

    planner: str | None
    replan: bool
    budget: float | None
    sense: float | None
    line_of_sight: bool
    events: Path | None
    delays: float | None


class Outputs(NamedTuple):
    """What is written."""

    out: Path | None
    summary: Path | None
    picture: Path | None
    animation: Path | None
    waypoints: Path | None


@click.command("run")
@click.argument("area", type=PATH, required=False)
@area_options
@rule_options
@robot_options
@click.option("--planner", type=Name("trihex.planners", "PLANNERS"), help="Who decides or plans. [default: fcost]")
@click.option("--replan", is_flag=True, help="Plan whenever the world changes, in place of deciding step by step.")
@click.option("--budget", type=Seconds(), help="With --replan: what a plan may take. [default: any]")
@click.option("--sense", type=Amount("cells", 100), help="Robots know only what one of them saw, so many cells around.")
@click.option("--line-of-sight", is_flag=True, help="With --sense: barriers hide what lies behind them.")
@click.option("--events", type=PATH, metavar="FILE", help="What happens at which step or second, as .csv or .toml.")
@click.option("--delays", type=Share(), help="The chance of each robot to be late in a step. [default: 0]")
@click.option("--plan", type=PATH, metavar="PLAN", help="Follow this plan, .npz, in its order, in place of AREA.")
@click.option("--resume", type=PATH, metavar="RUN", help="Go on where the run in this file ended, in place of AREA.")
@click.option("--max-steps", type=Whole(1), default=1_000_000, help="Stop after so many steps. [default: 1000000]")
@click.option("--out", type=PATH, metavar="RUN", help="What happened, as .npz.")
@click.option("--summary", type=PATH, metavar="FILE", help="The report as JSON; - writes it to the standard output.")
@click.option("--picture", type=PATH, metavar="FILE", help="Paths, or what robots saw, as .png, .svg or .pdf.")
@click.option("--animation", type=PATH, metavar="FILE", help="The robots on their way, as .gif, .mp4 or .html.")
@click.option("--waypoints", type=PATH, metavar="FILE", help="Where each robot was when, in metres and seconds.")
@waypoint_options
@map_options
@gathered("beginning", Beginning)
@gathered("way", Way)
@gathered("outputs", Outputs)
@gathered("maps", Maps)
def command(beginning: Beginning, way: Way, outputs: Outputs, maps: Maps, max_steps: int, **options: Any) -> int:
    """Let robots run through a world that changes, is unknown to them, or makes them late.

    AREA is what `trihex plan` takes. In each step events happen, robots look around, and each is told one safe move.

    Exit status 1: some robots are cut off, or an event was refused. The others arrive and all outputs are written.
    """
    from trihex.formats import write_run
    from trihex.running import make_run_report

    pace = of_waypoints(options)
    _check_outputs(outputs)
    check_maps(maps)
    if way.line_of_sight and way.sense is None:
        raise wrong_use("--line-of-sight is about what robots see: add --sense")
    _check_beginning(beginning, way)
    if beginning.plan is not None:
        run, plan = _followed(beginning.plan, pace, way.delays or 0.0, options["seed"] or 0, max_steps)
        told: dict[str, Any] = {"reference": plan}
        is_over = run.steps < max_steps
    else:
        trial = _trial_of(beginning, way, options, pace)
        with bar("running", "robots") as progress:
            run = trial.run(most_steps=max_steps, progress=progress)
        told = {"seconds": trial.seconds}
        is_over = trial.is_over
    if outputs.out is not None:
        with bar("writing", "bytes") as progress:
            write_run(run, outputs.out, progress=progress)
    timed: dict[str, Any] = {name: pace[name] for name in ("speed", "turn_time") if name in pace}
    report = make_run_report(run, **told, **timed)
    _write(report, outputs, pace)
    write_maps(run, maps, timed)
    status = _told(report, outputs.summary, is_over=is_over)
    if str(outputs.summary) != "-":
        tell_written(*outputs, *maps)
    return status


def _check_outputs(outputs: Outputs) -> None:
    from trihex.formats import WAYPOINT_SUFFIXES
    from trihex.pictures import MOVIE_SUFFIXES, PICTURE_SUFFIXES
    from trihex.viewer import PAGE_SUFFIXES

    check_outputs(
        (outputs.out, (".npz",), "a run"),
        (outputs.summary, (), "a summary"),
        (outputs.picture, PICTURE_SUFFIXES, "a picture"),
        (outputs.animation, (*MOVIE_SUFFIXES, *PAGE_SUFFIXES), "a movie"),
        (outputs.waypoints, WAYPOINT_SUFFIXES, "waypoints"),
    )


def _check_beginning(beginning: Beginning, way: Way) -> None:
    """Raise if something is told that the plan or the run in a file says itself."""
    area, plan, resume = beginning
    given = {
        "AREA": area,
        "--sense": way.sense,
        "--planner": way.planner,
        "--resume": resume and plan,
        "--events": way.events and plan,
    }
    told = [name for name, value in given.items() if value is not None]
    if told and (plan or resume):
        raise wrong_use(f"--{'plan' if plan else 'resume'} says all itself, so {', '.join(told)} cannot be told")


def _trial_of(beginning: Beginning, way: Way, options: dict[str, Any], pace: dict[str, Any]) -> Any:
    """Return the trial that begins in an area, or that goes on where a run ended."""
    from dataclasses import replace

    from trihex.running import Sensor, Trial, check_followable

    if beginning.resume is not None:
        return _resumed(beginning.resume, way, pace)
    if beginning.area is None:
        raise wrong_use("there is no AREA: name one, or add --plan PLAN or --resume RUN")
    draft = read_described(beginning.area, options)
    draft = replace(draft, outputs=draft.outputs | pace)  # speed tells which second is which step
    planner = way.planner or draft.planner or "fcost"
    if draft.destinations is not None:  # what is refused is told before kernels are compiled and robots drawn
        check_followable(replace(draft, robots=None, random_count=None).complete(), planner, replan=way.replan)
    scenario = complete(draft, "trial", planner, "bound")
    sensor = None if way.sense is None else Sensor(scenario.area.tessellation, way.sense, way.line_of_sight)
    return Trial(
        scenario,
        planner,
        sensor=sensor,
        events=_events_of(way, scenario.area, pace),
        delay=way.delays or 0.0,
        seed=scenario.seed or 0,
        replan=way.replan,
        budget=way.budget,
    )


def _events_of(way: Way, area: Any, pace: dict[str, Any]) -> Any:
    """Return what happens; how fast robots are tells which second is which step."""
    from trihex.formats import read_events

    timed = {name: value for name, value in pace.items() if name != "frame_id"}
    return () if way.events is None else read_events(way.events, area, **timed)


def _check_pace(area: Any, pace: dict[str, Any]) -> None:
    """Raise unless robots can be as fast as told, before they go their ways."""
    from trihex.areas import seconds_per_step

    if area.frame is not None:
        seconds_per_step(area, **{name: value for name, value in pace.items() if name != "frame_id"})


def _resumed(path: Path, way: Way, pace: dict[str, Any]) -> Any:
    from trihex.formats import read_run
    from trihex.running import resume_trial

    if way.delays is not None:
        raise wrong_use("--resume says all itself, so --delays cannot be told")
    run = read_run(path)
    _check_pace(run.scenario.area, pace)
    events = _events_of(way, run.scenario.area, pace)
    late = [str(event) for event in events if event.step <= run.steps]
    if late:
        raise wrong_use(f"{path} is past step {run.steps}, so what happens must come later, not {late[0]}")
    return resume_trial(run, events, replan=way.replan, budget=way.budget)


def _followed(path: Path, pace: dict[str, Any], delay: float, seed: int, most_steps: int) -> tuple[Any, Any]:
    """Return the run of robots that keep to the order of a plan, and the plan."""
    from trihex.formats.plans.npz import read_plan_npz
    from trihex.running import make_passing_order

    plan = read_plan_npz(path)
    _check_pace(plan.scenario.area, pace)
    return make_passing_order(plan).run(delay=delay, seed=seed, most_steps=most_steps), plan


def _write(report: Any, outputs: Outputs, pace: dict[str, Any]) -> None:
    """Write and draw what happened."""
    from trihex.formats import write_waypoints
    from trihex.pictures import MOVIE_SUFFIXES, picture_of_plan, picture_of_run, write_run_animation

    run = report.run
    if outputs.waypoints is not None:
        write_waypoints(run, outputs.waypoints, **pace)
    if outputs.picture is not None:
        (picture_of_plan if run.sensor is None else picture_of_run)(run).save(outputs.picture)
    if outputs.animation is None:
        return
    if outputs.animation.suffix.lower() in MOVIE_SUFFIXES:
        with bar("drawing", "frames") as progress:
            write_run_animation(run, outputs.animation, progress=progress)
        return
    from trihex.viewer import write_report_page

    write_report_page(report, outputs.animation)


def _told(report: Any, summary: Path | None, *, is_over: bool) -> int:
    """Print the report, tell what is amiss, and return the exit status."""
    from trihex.formats import report_text, write_report

    if summary is not None and str(summary) != "-":
        write_report(report, summary)
    is_for_machines = str(summary) == "-"
    click.echo(report_text(report) if is_for_machines else "\n".join(run_lines(report)), nl=not is_for_machines)
    complaints = [str(one) for one in report.run.occurrences if not one.is_accepted]
    area = report.run.scenario.area
    complaints += [
        f"{one.event}: it stays free where a robot stands: {', '.join(map(area.place_of_cell, one.left_out))}"
        for one in report.run.occurrences
        if one.left_out
    ]
    if is_over:
        since = report.run.cut_off_since
        complaints += [
            f"robot {robot} is cut off, known after step {since[robot]}" for robot in (since >= 0).nonzero()[0]
        ]
    for line in complaints[:20]:
        click.echo(f"trihex: {line}", err=True)
    if len(complaints) > 20:
        click.echo(f"trihex: and {len(complaints) - 20} more", err=True)
    for conflict in report.audit.conflicts[:10] if is_over else ():
        click.echo(str(conflict), err=True)
    return NO if complaints or (is_over and not report.audit.is_clean) else DONE


def run_lines(report: Any) -> list[str]:
    """Return the report in a few lines."""
    from trihex.cli.texts import seconds_line

    numbers = report.as_dict()
    price = "" if numbers["price"] is None else f": {100 * numbers['price']:+.1f} %"
    robots = f"{numbers['tessellation']}, {numbers['robots']} robots, planner {numbers['planner']}"
    robots += "" if numbers["sense"] is None else f", sensing {numbers['sense']:g} cells"
    robots += f", late in {100 * numbers['delays']:g} % of the steps" if numbers["delays"] else ""
    ends = f"{numbers['cut_off']} cut off, {numbers['left']} left, {numbers['broken']} broken"
    lines = [
        f"{numbers['area'] or 'area'}: {robots}",
        f"{numbers['arrived']} arrived in {numbers['steps']} steps, {ends}; {numbers['events']} events, "
        f"{numbers['refused_events']} refused",
        *exit_lines(numbers["arrivals_of_exit"], numbers["arrived"]),
        *door_lines(numbers),
        f"total time {numbers['total_time']}; with full knowledge and no events {numbers['reference_time']} "
        f"({numbers['reference_planner']}){price}; lower bound {numbers['lower_bound']}",
        f"{100 * numbers['known']:.1f} % of the cells known, {numbers['repairs']} repairs touched "
        f"{numbers['cells_touched']} cells",
    ]
    if numbers["last_arrival_seconds"] is not None:
        lines.insert(2, seconds_line(numbers))
    if (took := numbers["milliseconds_a_step"]) is not None:
        lines.append(f"a step took {took['median']:.2f} ms in the median, {took['worst']:.2f} ms at worst")
    count = numbers["conflicts"]
    lines.append("safe: no conflicts" if not count else f"unsafe: {count} conflict{'s' * (count != 1)}")
    return lines
