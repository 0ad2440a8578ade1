"""Exports: the files that a page can save."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from trihex.areas import seconds_per_step
from trihex.errors import FormatError, check_choice
from trihex.fields import make_n_scheme
from trihex.formats import (
    AREA_SUFFIXES,
    PLAN_SUFFIXES,
    SCENARIO_SUFFIXES,
    WAYPOINT_SUFFIXES,
    Draft,
    draft_of,
    write_area,
    write_field,
    write_plan,
    write_report,
    write_run,
    write_scenario,
    write_starts,
    write_waypoints,
)
from trihex.judging import Report
from trihex.pictures import (
    MOVIE_SUFFIXES,
    PICTURE_SUFFIXES,
    picture_of_area,
    picture_of_plan,
    picture_of_run,
    write_animation,
    write_run_animation,
)
from trihex.running import Run
from trihex.viewer.page import PAGE_SUFFIXES, write_page, write_report_page

# What, its suffixes, and what it is made of: a "draft", a "plan" or a live "run".
EXPORTS: dict[str, tuple[tuple[str, ...], str]] = {
    "scenario": (SCENARIO_SUFFIXES, "draft"),
    "area": (AREA_SUFFIXES, "draft"),
    "field": ((".npy",), "draft"),
    "starts": ((".csv",), "draft"),
    "plan": (PLAN_SUFFIXES, "plan"),
    "page": (PAGE_SUFFIXES, "plan"),
    "movie": (MOVIE_SUFFIXES, "plan"),
    "picture": (PICTURE_SUFFIXES, "draft"),
    "waypoints": (WAYPOINT_SUFFIXES, "plan"),
    "summary": ((".json",), "plan"),
    "run": ((".npz",), "run"),
    "run_page": (PAGE_SUFFIXES, "run"),
    "run_waypoints": (WAYPOINT_SUFFIXES, "run"),
    "run_movie": (MOVIE_SUFFIXES, "run"),
    "run_picture": (PICTURE_SUFFIXES, "run"),
}


def export(
    record: Draft | Report | Run,
    what: str,
    path: Path,
    planner: str | None,
    progress: Callable[[int, int], None],
    beside: Report | None = None,
) -> None:
    """Write `what` of a draft, of a plan and its report, or of a run; a page shows the plan `beside` it as well.

    Raises
    ------
    FormatError
        If there is no such thing, or it takes a plan or a run and there is none.
    TrihexError, OSError
        If it cannot be written.
    """
    check_choice("what", what, EXPORTS, FormatError)
    needs = EXPORTS[what][1]
    if isinstance(record, Run) or needs == "run":
        if not isinstance(record, Run) or needs != "run":
            raise FormatError(f"a {what} is not made of {'a live run' if isinstance(record, Run) else 'a plan'}")
        return _export_run(record, what, path, progress)
    report = record if isinstance(record, Report) else None
    draft = draft_of(record.plan.scenario) if isinstance(record, Report) else record
    if report is None and needs == "plan":
        raise FormatError(f"to save a {what} there must be a plan: plan first")
    if what == "scenario":
        write_scenario(draft.complete(), path, planner=planner or "")
    elif what == "area":
        write_area(draft.area, path)
    elif what == "field":
        write_field(make_n_scheme(draft.complete()).distance, path)
    elif what == "starts":
        scenario, lasts = draft.complete(), 1.0 if draft.area.frame is None else seconds_per_step(draft.area)
        times = scenario.start_times * lasts if scenario.has_start_times else None
        slowness = scenario.slowness if scenario.has_slowness else None
        write_starts(draft.area, scenario.robots, path, start_times=times, slowness=slowness)
    elif what == "picture":
        has_destination = draft.destinations is not None and draft.destinations.size > 0
        start = picture_of_area(draft.complete() if has_destination else draft.area)
        (picture_of_plan(report.plan) if report else start).save(path)
    elif report is not None:
        _export_plan(report, what, path, progress, beside)


def _export_run(run: Run, what: str, path: Path, progress: Callable[[int, int], None]) -> None:
    if what == "run":
        write_run(run, path, progress=progress)
    elif what == "run_page":
        write_page(run, path)
    elif what == "run_waypoints":
        write_waypoints(run, path)
    elif what == "run_movie":
        write_run_animation(run, path, progress=progress)
    else:
        picture_of_run(run).save(path)


def _export_plan(
    report: Report, what: str, path: Path, progress: Callable[[int, int], None], beside: Report | None
) -> None:
    if what == "plan":
        write_plan(report.plan, path)
    elif what == "page":
        write_report_page(report, path, beside)
    elif what == "movie":
        write_animation(report.plan, path, progress=progress)
    elif what == "waypoints":
        write_waypoints(report.plan, path)
    else:
        write_report(report, path)
