"""Report as JSON: the summary of a plan or a run."""

from __future__ import annotations

import json
import os

from trihex.errors import check_type
from trihex.files import new_file
from trihex.judging import Report
from trihex.running import RunReport


def report_text(report: Report | RunReport) -> str:
    """Return the summary as JSON, one key a line, with a line feed at the end."""
    return json.dumps(report.as_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def write_report(report: Report | RunReport, path: str | os.PathLike[str]) -> None:
    """Write the summary as JSON."""
    check_type("report", report, Report, RunReport)
    with new_file(path) as part:
        part.write_text(report_text(report), encoding="utf-8")
