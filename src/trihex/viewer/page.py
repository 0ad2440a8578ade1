"""Page: the HTML around the ES module, whether a server sends it or it lies on a disk."""

from __future__ import annotations

import gzip
import json
import os
from base64 import b64encode
from hashlib import sha256
from html import escape
from string import Template
from typing import Any

import numpy as np

from trihex.errors import check_type
from trihex.fields import make_n_scheme
from trihex.files import new_file, suffix_of
from trihex.judging import Report, make_report
from trihex.pictures import FOG, FOG_BARRIER, palette
from trihex.plans import Motion
from trihex.running import Run, RunReport, make_run_report
from trihex.viewer.bundle import Bundle, encode
from trihex.viewer.layers import layer_choices, with_layers
from trihex.viewer.script import module, source_of
from trihex.viewer.show import show_plan
from trihex.viewer.show_run import show_run

PAGE_SUFFIXES = (".html",)
_POLICY = (
    "default-src 'none'; script-src {script}; style-src {style}; img-src data: blob:; connect-src {connect}; "
    "base-uri 'none'; form-action 'none'"
)


def settings_of(**more: Any) -> dict[str, Any]:
    """Return what every page needs to know: colours, and what `more` says of its host."""
    names = ("FREE", "BARRIER", "DESTINATION", "UNREACHED", "MOVING", "WAITING", "FINAL", "STRANDED", "TIGHT", "INK")
    ramp = palette.distance_ramp(256).tolist()
    visits = palette.visits_ramp(256).tolist()
    series = [list(colour) for colour in palette.SERIES]
    colours = {name.lower(): list(getattr(palette, name)) for name in names}
    fog = {"fog": list(FOG), "fog_barrier": list(FOG_BARRIER), "late": list(palette.SERIES[1])}
    return {"colours": {**colours, **fog, "distance": ramp, "visits": visits, "series": series}, **more}


def page_with(
    settings: dict[str, Any], first: Bundle | None, title: str, *, is_alone: bool, is_site: bool = False
) -> tuple[str, str]:
    """Return the HTML of a page and the Content-Security-Policy that it obeys.

    Parameters
    ----------
    settings : dict
        See `settings_of`.
    first : Bundle, optional
        What the page shows at first.
    title : str
    is_alone : bool
        Whether the page holds the module and its policy itself, and asks nobody for anything.
    is_site : bool
        Whether it holds its policy itself, as nobody sends it as a header.
    """
    style, script = source_of("viewer.css"), module()
    policy = _POLICY.format(
        script=_hash_of(script) if is_alone else "'self'",
        style=_hash_of(style),
        connect="'none'" if is_alone else "'self'",
    )
    content = "" if first is None else b64encode(gzip.compress(encode(*first), 6, mtime=0)).decode()
    head = f'<meta http-equiv="Content-Security-Policy" content="{policy}">' if is_alone or is_site else ""
    element = (
        f'<script type="module">{script}</script>' if is_alone else '<script type="module" src="viewer.js"></script>'
    )
    html = Template(source_of("viewer.html")).substitute(
        title=escape(title),
        head=head,
        style=style,
        settings=json.dumps(settings).replace("<", "\\u003c"),
        content=content,
        module=element,
    )
    return html, policy


def write_page(plan: Motion, path: str | os.PathLike[str], *, beside: Motion | None = None) -> None:
    """Write a plan or a run as one HTML file that plays it in any browser, without a network.

    Parameters
    ----------
    plan : Plan or Run
    path : path
    beside : Plan or Run, optional
        Another one, to be played beside it on the same clock.

    Raises
    ------
    FormatError
        If the suffix is not ``.html``.
    TooLargeError
        If a page could not hold the plan.
    OSError
        If the file cannot be written.
    """
    check_type("plan", plan, Motion)
    check_type("beside", beside, Motion, type(None))
    write_report_page(_reported(plan), path, None if beside is None else _reported(beside))


def _reported(motion: Motion) -> Report | RunReport:
    if isinstance(motion, Run):
        return make_run_report(motion)
    return make_report(motion)  # type: ignore[arg-type]  # what is no run is a plan


def write_report_page(
    report: Report | RunReport, path: str | os.PathLike[str], beside: Report | RunReport | None = None
) -> None:
    """Write a plan or a run with its report as one HTML file; see `write_page`."""
    suffix_of(path, PAGE_SUFFIXES, "a page")
    first = _bundle_of(report)
    if beside is not None:
        second = encode(*_bundle_of(beside))
        first = Bundle(first.header, {**first.arrays, "beside": np.frombuffer(second, dtype=np.uint8)})
    motion = report.run if isinstance(report, RunReport) else report.plan
    name = motion.scenario.area.name
    title = f"{motion.planner or 'plan'}{f' on {name}' if name else ''} - trihex"
    html, _ = page_with(settings_of(host="alone", layers=layer_choices(is_alone=True)), first, title, is_alone=True)
    with new_file(path) as part:
        part.write_text(html, encoding="utf-8")


def _bundle_of(report: Report | RunReport) -> Bundle:
    if isinstance(report, RunReport):
        return with_layers(show_run(report), report.run)
    return with_layers(show_plan(report, make_n_scheme(report.plan.scenario)), report.plan)


def _hash_of(text: str) -> str:
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode()}'"
