"""Exports: the files that a page can save."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from trihex.errors import FormatError, check_choice
from trihex.formats import (
    AREA_SUFFIXES,
    PLAN_SUFFIXES,
    SCENARIO_SUFFIXES,
    WAYPOINT_SUFFIXES,
    write_area,
    write_plan,
    write_scenario,
    write_starts,
    write_waypoints,
)
from trihex.formats.draft import Draft, draft_of
from trihex.formats.field_npy import write_field
from trihex.formats.report_json import write_report
from trihex.movie import SUFFIXES as MOVIE_SUFFIXES
from trihex.movie import write_animation
from trihex.picture import SUFFIXES as PICTURE_SUFFIXES
from trihex.picture import picture_of_area, picture_of_plan
from trihex.report import Report
from trihex.schemes import make_n_scheme
from trihex.viewer.page import SUFFIXES as PAGE_SUFFIXES
from trihex.viewer.page import write_report_page

# What, its suffixes, and whether it takes a plan.
EXPORTS: dict[str, tuple[tuple[str, ...], bool]] = {
    "scenario": (SCENARIO_SUFFIXES, False),
    "area": (AREA_SUFFIXES, False),
    "field": ((".npy",), False),
    "starts": ((".csv",), False),
    "plan": (PLAN_SUFFIXES, True),
    "page": (PAGE_SUFFIXES, True),
    "movie": (MOVIE_SUFFIXES, True),
    "picture": (PICTURE_SUFFIXES, False),
    "waypoints": (WAYPOINT_SUFFIXES, True),
    "summary": ((".json",), True),
}


def export(
    record: Draft | Report,
    what: str,
    path: Path,
    planner: str | None,
    progress: Callable[[int, int], None],
    beside: Report | None = None,
) -> None:
    """Write `what` of a draft or of a plan and its report; a page shows the plan `beside` it as well.

    Raises
    ------
    FormatError
        If there is no such thing, or it takes a plan and there is none.
    TrihexError, OSError
        If it cannot be written.
    """
    check_choice("what", what, EXPORTS, FormatError)
    report = record if isinstance(record, Report) else None
    draft = draft_of(record.plan.scenario) if isinstance(record, Report) else record
    if report is None and EXPORTS[what][1]:
        raise FormatError(f"to save a {what} there must be a plan: plan first")
    if what == "scenario":
        write_scenario(draft.complete(), path, planner=planner or "")
    elif what == "area":
        write_area(draft.area, path)
    elif what == "field":
        write_field(make_n_scheme(draft.complete()).distance, path)
    elif what == "starts":
        write_starts(draft.area, draft.complete().robots, path)
    elif what == "picture":
        has_destination = draft.destinations is not None and draft.destinations.size > 0
        start = picture_of_area(draft.complete() if has_destination else draft.area)
        (picture_of_plan(report.plan) if report else start).save(path)
    elif report is not None:
        _export_plan(report, what, path, progress, beside)


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
