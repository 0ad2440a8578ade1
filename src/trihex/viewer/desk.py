"""Desk: answers what a page asks for, whichever host the page runs in.

A request is a bundle, and so is each frame of the answer. Frames have a ``kind``: "progress" (stage, done, total),
"part" (some of a long result), and at last "result", "error" (message) or "cancelled".
"""

from __future__ import annotations

import logging
import tempfile
from collections import OrderedDict, deque
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath
from time import monotonic, perf_counter
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from trihex.areas import GENERATORS, Area, Scenario, random_robots
from trihex.bounds import LowerBound, distance_bound, make_lower_bound, slot_bound
from trihex.errors import FormatError, TooLargeError, TrihexError, check_choice
from trihex.fields import NScheme, distance_generations, make_d_scheme, make_n_scheme
from trihex.files import read_bytes
from trihex.formats import Draft, draft_of, format_of, read_draft, read_plan, read_starts
from trihex.judging import Report, audit_plan, make_report
from trihex.planners import PLANNERS, make_plan
from trihex.plans import Plan
from trihex.running import Run
from trihex.viewer import requests as ask
from trihex.viewer.bundle import Bundle, decode, encode
from trihex.viewer.document import document_of, draft_of_document
from trihex.viewer.exports import export
from trihex.viewer.folder import Folder, references_of
from trihex.viewer.live import Live
from trihex.viewer.show import show_plan

# The automaton looks at all neighbours of all cells in every generation.
MAX_AUTOMATON_CELLS = 2**20
_MOST_PLANS = 8
_MOST_LIVES = 2
_MOST_ACTIONS = 2**29
_PLACE = ("cell_size", "robot_radius", "resolution", "threshold", "invert", "unknown")
_TICK = 0.1  # seconds between two frames of progress

Arrays = Mapping[str, NDArray[Any]]
Send = Callable[[bytes], None]
log = logging.getLogger(__name__)


class CancelledError(Exception):
    """The page does not wait for the answer any more."""


class Desk:
    """Answers requests; keeps the last plans, so that the page can save them, and the last fields.

    Parameters
    ----------
    folder : Folder, optional
        Where files are opened and saved; without one, files come from and go to the page only.
    """

    def __init__(self, folder: Folder | None = None) -> None:
        self.folder = folder
        self._reports: OrderedDict[str, Report] = OrderedDict()
        self._n_schemes: deque[NScheme] = deque(maxlen=4)
        self._lives: OrderedDict[str, Live] = OrderedDict()
        self._plans_made = self._runs_made = 0

    def answer(self, request: bytes, send: Send, is_cancelled: Callable[[], bool] = lambda: False) -> None:
        """Answer a request by calling `send` with frames; every kind of failure becomes a frame, too."""
        try:
            header, arrays = decode(request)
            parsed = ask.parse_request(header)
            call = _Call(arrays, send, is_cancelled)
            work = getattr(self, f"_{parsed.op}")
            result = work(parsed, call)
            send(encode({"kind": "result", **result.header}, result.arrays))
        except CancelledError:
            send(encode({"kind": "cancelled"}))
        except (TrihexError, OSError, MemoryError) as error:
            send(encode({"kind": "error", "message": _message_of(error)}))
        except Exception as error:
            log.exception("a request of the page failed")
            send(encode({"kind": "error", "message": f"this is a fault of trihex: {error!r:.200}"}))

    def show(self, record: Area | Scenario | Draft | Plan) -> Bundle:
        """Return what a page shows of a record, as the result of "open" does."""
        if isinstance(record, Plan):
            return self._shown(record, {}, _Call({}, lambda _: None, lambda: False))
        if isinstance(record, Scenario):
            return _drafted(draft_of(record))
        return _drafted(_drawn(Draft(record) if isinstance(record, Area) else record))

    @property
    def last_plan(self) -> Plan | None:
        """The last plan that was made or shown."""
        return next(reversed(self._reports.values())).plan if self._reports else None

    @property
    def last_run(self) -> Run | None:
        """What has happened so far in the last live run."""
        return next(reversed(self._lives.values())).record() if self._lives else None

    def _files(self, request: ask.ListFiles, call: _Call) -> Bundle:
        names = self.folder.names() if self.folder else []
        return Bundle({"files": names, "folder": str(self.folder.root) if self.folder else None}, {})

    def _open(self, request: ask.OpenFile, call: _Call) -> Bundle:
        if request.in_folder:
            if self.folder is None:
                raise FormatError("there is no folder to open files from; choose a file instead")
            return self._opened(self.folder.find(request.name), request, call)
        content = call.arrays.get("content")
        if content is None or content.dtype != np.uint8:
            raise FormatError(f"{request.name}: its content is missing")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, _plain_name(request.name))
            path.write_bytes(content.tobytes())
            if references_of(path):
                raise FormatError(
                    f"{path.name} names another file, which a page cannot fetch: start the viewer in their folder"
                )
            try:
                return self._opened(path, request, call)
            except FormatError as error:
                raise FormatError(str(error).replace(f"{folder}/", "")) from None

    def _opened(self, path: Path, request: ask.OpenFile, call: _Call) -> Bundle:
        form = format_of(read_bytes(path), path)
        seconds: dict[str, float] = {}
        begin = perf_counter()
        if form in ("npz", "plan", "parquet"):
            plan = read_plan(path, None if form == "npz" else call.scenario(request))
            seconds["read"] = perf_counter() - begin
            return self._shown(plan, seconds, call)
        if form in ("starts", "scen"):
            draft = call.draft(request)
            return _drafted(replace(draft, robots=read_starts(path, draft.area), seed=None))
        options = {name: getattr(request, name) for name in _PLACE}
        draft = read_draft(path, request.tessellation, progress=call.progress("reading"), **options)
        return _drafted(_drawn(draft))

    def _generate(self, request: ask.Generate, call: _Call) -> Bundle:
        check_choice("generator", request.generator, ["empty", *GENERATORS], FormatError)
        if request.generator == "empty":
            make, options = GENERATORS["random"], {"density": 0.0}
        else:
            make, options = GENERATORS[request.generator], {}
        area = make(request.tessellation, request.height, request.width, seed=request.seed, **options)
        if request.generator == "empty":
            area = replace(area, name="")
        return _drafted(Draft(area))

    def _scatter(self, request: ask.Scatter, call: _Call) -> Bundle:
        draft = _drawn(replace(call.draft(request), robots=None, random_count=request.count, seed=request.seed))
        return _drafted(draft)

    def _fields(self, request: ask.Fields, call: _Call) -> Bundle:
        n_scheme = self._n_scheme(call.scenario(request))
        directions = make_d_scheme(n_scheme).directions
        arrays: dict[str, NDArray[Any]] = {"distance": n_scheme.distance, "directions": directions}
        return Bundle({"unreachable": int(n_scheme.unreachable_robots.size)}, arrays)

    def _generations(self, request: ask.Generations, call: _Call) -> Bundle:
        """Send the changes of each generation: how many cells change, which, and to what."""
        scenario = call.scenario(request)
        if scenario.area.cell_count > MAX_AUTOMATON_CELLS:
            raise TooLargeError(
                f"generations are shown one by one in areas of at most {MAX_AUTOMATON_CELLS} cells, not "
                f"{scenario.area.cell_count}; the N-scheme itself is shown in any"
            )
        counts: list[int] = []
        cells: list[NDArray[np.int32]] = []
        values: list[NDArray[np.int32]] = []
        last_sent, before = monotonic(), None
        number = -1
        for states in distance_generations(scenario):
            number += 1
            call.check()
            if before is not None:
                changed = np.flatnonzero(states != before)
                counts.append(changed.size)
                cells.append(changed.astype(np.int32))
                values.append(states.reshape(-1)[changed].astype(np.int32))
            before = states
            if monotonic() - last_sent > _TICK and counts:
                call.part({}, _joined(counts, cells, values))
                counts, cells, values, last_sent = [], [], [], monotonic()
        return Bundle({"generations": number}, _joined(counts, cells, values))

    def _plan(self, request: ask.MakePlan, call: _Call) -> Bundle:
        draft = call.draft(request)
        own = draft.area.tessellation
        if request.tessellation is not None and request.tessellation != own.name:
            tessellation = replace(own, name=request.tessellation)
            draft = replace(draft, area=draft.area.with_tessellation(tessellation))
        scenario = draft.complete()
        seconds: dict[str, float] = {}
        begin = perf_counter()
        n_scheme = self._n_scheme(scenario)
        seconds["field"] = perf_counter() - begin
        begin = perf_counter()
        progress = call.progress("planning")
        plan = make_plan(scenario, request.planner, n_scheme=n_scheme, progress=progress, **request.options)
        seconds["plan"] = perf_counter() - begin
        return self._shown(plan, seconds, call)

    def _live(self, request: ask.Live, call: _Call) -> Bundle:
        check_choice("planner", request.planner, PLANNERS, FormatError)
        scenario = call.scenario(request)
        live = Live(scenario, request)
        self._runs_made += 1
        name = f"live-{self._runs_made}"
        self._lives[name] = live
        while len(self._lives) > _MOST_LIVES:
            self._lives.popitem(last=False)
        first = live.advance(ask.Advance(op="advance", live=name, steps=0))
        edge, wait = scenario.area.tessellation.edge_cost, int(scenario.waiting_cost)
        return Bundle({"live": name, "edge_cost": edge, "waiting_cost": wait, **first.header}, first.arrays)

    def _advance(self, request: ask.Advance, call: _Call) -> Bundle:
        return self._live_run(request.live).advance(request)

    def _judge(self, request: ask.Judge, call: _Call) -> Bundle:
        report = self._live_run(request.live).judge()
        return Bundle({"summary": report.as_dict(), "conflicts": [str(one) for one in report.audit.conflicts[:5]]}, {})

    def _live_run(self, name: str) -> Live:
        if name not in self._lives:
            raise FormatError("this live run is not kept any more: run again")
        return self._lives[name]

    def _save(self, request: ask.Save, call: _Call) -> Bundle:
        record: Draft | Report | Run
        if request.live is not None:
            record = self._live_run(request.live).record()
        else:
            record = call.draft(request) if request.plan is None else self._report(request.plan)
        beside = None if request.beside is None else self._report(request.beside)
        progress = call.progress("saving")
        if request.in_folder:
            if self.folder is None:
                raise FormatError("there is no folder to save files in; download the file instead")
            path = self.folder.resolve(request.name)
            if path.exists() and not request.overwrite:
                return Bundle({"exists": True, "name": request.name}, {})
            export(record, request.what, path, request.planner, progress, beside)
            return Bundle({"saved": request.name}, {})
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, _plain_name(request.name))
            export(record, request.what, path, request.planner, progress, beside)
            content = np.frombuffer(path.read_bytes(), dtype=np.uint8)
            return Bundle({"name": path.name}, {"content": content})

    def _bound(self, request: ask.Bound, call: _Call) -> Bundle:
        report = self._report(request.plan)
        scenario = report.plan.scenario
        if not report.optimal:
            n_scheme = self._n_scheme(scenario)
            bound = self._optimum(scenario) or make_lower_bound(n_scheme, progress=call.progress("bounding"))
            report = replace(report, bound=bound)
            self._reports[request.plan] = report
        return Bundle({"summary": report.as_dict()}, {})

    def _shown(self, plan: Plan, seconds: dict[str, float], call: _Call) -> Bundle:
        """Return the plan with the bounds that are had at once; the page asks for a better one while it plays."""
        n_scheme = self._n_scheme(plan.scenario)
        begin = perf_counter()
        audit = audit_plan(plan, progress=call.progress("checking"))
        seconds["audit"] = perf_counter() - begin
        bound = max(distance_bound(n_scheme), slot_bound(n_scheme), key=lambda bound: bound.value)
        report = make_report(plan, n_scheme=n_scheme, audit=audit, lower_bound=bound, seconds=seconds)
        return show_plan(report, n_scheme, self._keep(report))

    def _optimum(self, scenario: Scenario) -> LowerBound | None:
        """Return the least total time of a scenario, if a plan that is kept has proven it."""
        for report in self._reports.values():
            if report.optimal and report.plan.scenario == scenario:
                return LowerBound("optimum", report.total_time)
        return None

    def _n_scheme(self, scenario: Scenario) -> NScheme:
        for kept in list(self._n_schemes):
            if kept.scenario == scenario:
                return kept
        n_scheme = make_n_scheme(scenario)
        self._n_schemes.append(n_scheme)
        return n_scheme

    def _keep(self, report: Report) -> str:
        self._plans_made += 1
        name = f"plan-{self._plans_made}"
        self._reports[name] = report
        while len(self._reports) > 1 and (
            len(self._reports) > _MOST_PLANS
            or sum(kept.plan.actions.size for kept in self._reports.values()) > _MOST_ACTIONS
        ):
            self._reports.popitem(last=False)
        return name

    def _report(self, name: str) -> Report:
        if name not in self._reports:
            raise FormatError("this plan is not kept any more: plan again")
        return self._reports[name]


class _Call:
    """One request on its way: its arrays, and the line back to the page."""

    def __init__(self, arrays: Arrays, send: Send, is_cancelled: Callable[[], bool]) -> None:
        self.arrays = arrays
        self._send, self._is_cancelled = send, is_cancelled
        self._told = monotonic()

    def check(self) -> None:
        """Raise CancelledError if the page has gone."""
        if self._is_cancelled():
            raise CancelledError

    def part(self, header: dict[str, Any], arrays: Arrays) -> None:
        """Send some of the result."""
        self._send(encode({"kind": "part", **header}, arrays))

    def progress(self, stage: str) -> Callable[[int, int], None]:
        """Return a function that tells the page how far `stage` is, and stops the work if the page has gone."""

        def tell(done: int, total: int) -> None:
            self.check()
            if monotonic() - self._told >= _TICK:
                self._told = monotonic()
                self._send(encode({"kind": "progress", "stage": stage, "done": int(done), "total": int(total)}))

        return tell

    def draft(self, request: ask.Request) -> Draft:
        """Return the document of the request."""
        if request.document is None:
            raise FormatError(f"{request.op}: the document is missing")
        return draft_of_document(request.document, cast(dict[str, NDArray[Any]], self.arrays))

    def scenario(self, request: ask.Request) -> Scenario:
        """Return the document of the request as a scenario."""
        return self.draft(request).complete()


def _drawn(draft: Draft) -> Draft:
    """Return the draft with its robots drawn if they are still to be, where they can arrive if it has a destination."""
    if draft.random_count is None:
        return draft
    if draft.destinations is not None and draft.destinations.size:
        robots = draft.complete().robots
    else:
        robots = random_robots(draft.area, draft.random_count, draft.seed or 0)
    return replace(draft, robots=robots, random_count=None, seed=draft.seed or 0)


def _drafted(draft: Draft) -> Bundle:
    header, arrays = document_of(draft)
    return Bundle({"document": header, "planner": draft.planner}, arrays)


def _joined(
    counts: list[int], cells: list[NDArray[np.int32]], values: list[NDArray[np.int32]]
) -> dict[str, NDArray[Any]]:
    nothing = np.empty(0, dtype=np.int32)
    return {
        "counts": np.array(counts, dtype=np.int32),
        "cells": np.concatenate([nothing, *cells]),
        "values": np.concatenate([nothing, *values]),
    }


def _plain_name(name: str) -> str:
    """Return the last part of a name that came from a page, or raise FormatError if it has none."""
    plain = PurePosixPath(name.replace("\\", "/")).name
    if not plain or "\0" in plain or len(plain.encode()) > 200:
        raise FormatError(f"a file must have a name, not {name!r:.120}")
    return plain


def _message_of(error: Exception) -> str:
    if isinstance(error, OSError) and not isinstance(error, TrihexError):
        name = f"{Path(str(error.filename)).name}: " if error.filename else ""
        return f"{name}{error.strerror or error}"
    return str(error) or type(error).__name__
