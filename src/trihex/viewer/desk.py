"""Desk: answers what a page asks for, whichever host the page runs in.

A request is a bundle, and so is each frame of the answer. Frames have a ``kind``: "progress" (stage, done, total),
"part" (some of a long result), and at last "result", "error" (message) or "cancelled".
"""

from __future__ import annotations

import logging
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path, PurePosixPath
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import GENERATORS, Area, Scenario, random_robots
from trihex.bounds import distance_bound, make_lower_bound, slot_bound
from trihex.errors import FormatError, TrihexError, check_choice, check_type
from trihex.fields import make_d_scheme
from trihex.files import read_bytes
from trihex.formats import (
    FORMATS,
    Draft,
    draft_of,
    format_of,
    read_draft,
    read_plan,
    read_run,
    read_slowness,
    read_start_times,
    read_starts,
)
from trihex.judging import Report, audit_plan, make_report
from trihex.planners import PLANNERS, check_plannable, make_plan, uses_of
from trihex.plans import Plan
from trihex.running import Run, make_run_report
from trihex.viewer import requests as ask
from trihex.viewer.bundle import Bundle, decode, encode
from trihex.viewer.call import Call, CancelledError, Send
from trihex.viewer.compiling import are_compiled, prepare_for, prepare_usual
from trihex.viewer.document import document_of, ground_of
from trihex.viewer.exports import export
from trihex.viewer.folder import Folder, holds_run, references_of
from trihex.viewer.generations import send_generations
from trihex.viewer.layers import LAYERS, make_layer, with_layers
from trihex.viewer.live import Live, replay_of, trial_of
from trihex.viewer.needs import Record, judging_of, needs_of, needs_of_draw, needs_of_report
from trihex.viewer.shelf import Shelf
from trihex.viewer.show import show_plan
from trihex.viewer.show_run import show_run

_PLACE = ("cell_size", "robot_radius", "resolution", "threshold", "invert", "unknown")

_IN_METRES = ("ros", "geojson", "wkt")  # formats that say nothing of cells: the page asks how large they shall be

log = logging.getLogger(__name__)


class Desk:
    """Answers requests; keeps the last plans on a shelf, so that the page can save them, and the last fields.

    Parameters
    ----------
    folder : Folder, optional
        Where files are opened and saved; without one, files come from and go to the page only.
    first : Area, Scenario, Plan or Run, optional
        What the page asks for first, where compiling what it needs would keep the page from coming.
    """

    def __init__(self, folder: Folder | None = None, first: Record | None = None) -> None:
        self.folder, self.first = folder, first
        self.shelf = Shelf()

    def answer(self, request: bytes, send: Send, is_cancelled: Callable[[], bool] = lambda: False) -> None:
        """Answer a request by calling `send` with frames; every kind of failure becomes a frame, too."""
        try:
            header, arrays = decode(request)
            parsed = ask.parse_request(header)
            call = Call(arrays, send, is_cancelled)
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

    def show(self, record: Record) -> Bundle:
        """Return what a page shows of a record, as the result of "open" does."""
        return self._record_shown(record, Call({}, lambda _: None, lambda: False))

    def can_show_at_once(self, record: Record) -> bool:
        """Tell whether nothing must be compiled for it."""
        check_type("record", record, Area, Scenario, Plan, Run, Draft)
        return are_compiled(needs_of(record))

    def _record_shown(self, record: Record, call: Call) -> Bundle:
        check_type("record", record, Area, Scenario, Plan, Run, Draft)
        if isinstance(record, Run):
            prepare_for(call, *needs_of(record))
            return with_layers(show_run(make_run_report(record)), record)
        if isinstance(record, Plan):
            return self._shown(record, {}, call)
        if isinstance(record, Scenario):
            return _drafted(draft_of(record))
        return _drafted(_drawn(Draft(record) if isinstance(record, Area) else record, call))

    @property
    def last_plan(self) -> Plan | None:
        """The last plan that was made or shown."""
        report = self.shelf.last_report
        return None if report is None else report.plan

    @property
    def last_run(self) -> Run | None:
        """What has happened so far in the last live run."""
        live = self.shelf.last_live
        return None if live is None else live.record()

    def _first(self, request: ask.First, call: Call) -> Bundle:
        if self.first is None:
            raise FormatError("there is nothing to be shown first")
        return self._record_shown(self.first, call)

    def _prepare(self, request: ask.Prepare, call: Call) -> Bundle:
        prepare_usual(call)
        return Bundle({}, {})

    def _files(self, request: ask.ListFiles, call: Call) -> Bundle:
        names = self.folder.names() if self.folder else []
        return Bundle({"files": names, "folder": str(self.folder.root) if self.folder else None}, {})

    def _open(self, request: ask.OpenFile, call: Call) -> Bundle:
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

    def _opened(self, path: Path, request: ask.OpenFile, call: Call) -> Bundle:
        form = FORMATS[format_of(read_bytes(path), path)]
        if form.name == "npz" and holds_run(path):
            return self._watched(read_run(path), call)
        seconds: dict[str, float] = {}
        begin = perf_counter()
        if form.holds == "plan":
            plan = read_plan(path, None if form.brings_scenario else call.scenario(request))
            seconds["read"] = perf_counter() - begin
            return self._shown(plan, seconds, call)
        if form.holds == "starts":
            draft = call.draft(request)
            robots, times, slowness = read_starts(path, draft.area), read_start_times(path), read_slowness(path)
            return _drafted(replace(draft, robots=robots, start_times=times, slowness=slowness, seed=None).paced())
        options = {name: getattr(request, name) for name in _PLACE}
        try:
            draft = read_draft(path, request.tessellation, progress=call.progress("reading"), **options)
        except FormatError as error:
            if request.cell_size is None and form.name in _IN_METRES and "cell_size" in str(error):
                return Bundle({"needs": "cell_size", "name": path.name}, {})
            raise
        return _drafted(_drawn(draft, call))

    def _generate(self, request: ask.Generate, call: Call) -> Bundle:
        check_choice("generator", request.generator, ["empty", *GENERATORS], FormatError)
        prepare_for(call, *(("area",) if request.generator in ("caves", "maze") else ()))
        if request.generator == "empty":
            make, options = GENERATORS["random"], {"density": 0.0}
        else:
            make, options = GENERATORS[request.generator], {}
        area = make(request.tessellation, request.height, request.width, seed=request.seed, **options)
        if request.generator == "empty":
            area = replace(area, name="")
        return _drafted(Draft(area))

    def _scatter(self, request: ask.Scatter, call: Call) -> Bundle:
        draft = replace(call.draft(request), robots=None, start_times=None, slowness=None, random_count=request.count)
        draft = replace(draft, seed=request.seed)
        return _drafted(_drawn(draft, call))

    def _fields(self, request: ask.Fields, call: Call) -> Bundle:
        scenario = call.scenario(request)
        prepare_for(call, "d_scheme", scenario=scenario)
        n_scheme = self.shelf.n_scheme(scenario)
        directions = make_d_scheme(n_scheme).directions
        arrays: dict[str, NDArray[Any]] = {"distance": n_scheme.distance, "directions": directions}
        return Bundle({"unreachable": int(n_scheme.unreachable_robots.size)}, arrays)

    def _generations(self, request: ask.Generations, call: Call) -> Bundle:
        return send_generations(call.scenario(request), call)

    def _plan(self, request: ask.MakePlan, call: Call) -> Bundle:
        draft = call.draft(request)
        own = draft.area.tessellation
        if request.tessellation is not None and request.tessellation != own.name:
            tessellation = replace(own, name=request.tessellation)
            draft = replace(draft, area=draft.area.with_tessellation(tessellation))
        scenario = draft.complete()
        check_choice("planner", request.planner, PLANNERS, FormatError)
        check_plannable(request.planner, scenario)
        prepare_for(call, *uses_of(request.planner, scenario), *judging_of(scenario), scenario=scenario)
        seconds: dict[str, float] = {}
        begin = perf_counter()
        n_scheme = self.shelf.n_scheme(scenario)
        seconds["field"] = perf_counter() - begin
        begin = perf_counter()
        progress = call.progress("planning")
        plan = make_plan(scenario, request.planner, n_scheme=n_scheme, progress=progress, **request.options)
        seconds["plan"] = perf_counter() - begin
        return self._shown(plan, seconds, call)

    def _live(self, request: ask.Live, call: Call) -> Bundle:
        check_choice("planner", request.planner, PLANNERS, FormatError)
        scenario = call.scenario(request)
        planner = uses_of(request.planner, scenario) if request.replan else ()
        prepare_for(call, "trial", *planner, scenario=scenario)
        return self._begun(Live(trial_of(scenario, request)))

    def _begun(self, live: Live) -> Bundle:
        name = self.shelf.put_live(live)
        first = live.advance(ask.Advance(op="advance", live=name, steps=0))
        return Bundle({"live": name, **first.header}, first.arrays)

    def _watched(self, run: Run, call: Call) -> Bundle:
        """Return a run as a live one that does again what it did, with its document."""
        prepare_for(call, "trial", scenario=run.scenario)
        document, arrays = document_of(draft_of(run.scenario))
        begun = self._begun(replay_of(run))
        told = {"sense": None if run.sensor is None else run.sensor.radius, "delays": run.delay, "steps": run.steps}
        return Bundle({"document": document, "watched": told, **begun.header}, {**arrays, **begun.arrays})

    def _advance(self, request: ask.Advance, call: Call) -> Bundle:
        return self.shelf.live(request.live).advance(request)

    def _judge(self, request: ask.Judge, call: Call) -> Bundle:
        live = self.shelf.live(request.live)
        prepare_for(call, *needs_of_report(live.trial.scenario))
        report = live.judge()
        return Bundle({"summary": report.as_dict(), "conflicts": [str(one) for one in report.audit.conflicts[:5]]}, {})

    def _save(self, request: ask.Save, call: Call) -> Bundle:
        record: Draft | Report | Run
        if request.live is not None:
            record = self.shelf.live(request.live).record()
        else:
            record = call.draft(request) if request.plan is None else self.shelf.report(request.plan)
        beside = None if request.beside is None else self.shelf.report(request.beside)
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

    def _bound(self, request: ask.Bound, call: Call) -> Bundle:
        report = self.shelf.report(request.plan)
        scenario = report.plan.scenario
        if not report.optimal:
            prepare_for(call, "bound", scenario=scenario)
            n_scheme = self.shelf.n_scheme(scenario)
            bound = self.shelf.optimum(scenario) or make_lower_bound(n_scheme, progress=call.progress("bounding"))
            report = replace(report, bound=bound)
            self.shelf.replace_report(request.plan, report)
        return Bundle({"summary": report.as_dict()}, {})

    def _layer(self, request: ask.MakeLayer, call: Call) -> Bundle:
        check_choice("layer", request.layer, LAYERS, FormatError)
        motion: Plan | Run
        if request.live is None:
            motion = self.shelf.report(request.plan).plan
        else:
            motion = self.shelf.live(request.live).record()
        prepare_for(call, *LAYERS[request.layer].uses, scenario=motion.scenario)
        return make_layer(request.layer, motion, call.progress("pricing"))

    def _shown(self, plan: Plan, seconds: dict[str, float], call: Call) -> Bundle:
        """Return the plan with the bounds that are had at once; the page asks for a better one while it plays."""
        prepare_for(call, *judging_of(plan.scenario), scenario=plan.scenario)
        n_scheme = self.shelf.n_scheme(plan.scenario)
        begin = perf_counter()
        audit = audit_plan(plan, progress=call.progress("checking"))
        seconds["audit"] = perf_counter() - begin
        bounds = [distance_bound] if plan.scenario.has_slowness else [distance_bound, slot_bound]
        bound = max((make(n_scheme) for make in bounds), key=lambda bound: bound.value)
        report = make_report(plan, n_scheme=n_scheme, audit=audit, lower_bound=bound, seconds=seconds)
        return show_plan(report, n_scheme, self.shelf.put_report(report))


def _drawn(draft: Draft, call: Call) -> Draft:
    """Return the draft with its robots drawn if they are still to be, where they can arrive if it has a destination."""
    if draft.random_count is None:
        return draft
    if needed := needs_of_draw(draft):
        prepare_for(call, *needed)
        robots = draft.complete().robots
    else:
        robots = random_robots(draft.area, draft.random_count, draft.seed or 0)
    return replace(draft, robots=robots, random_count=None, seed=draft.seed or 0)


def _drafted(draft: Draft) -> Bundle:
    header, arrays = document_of(draft)
    ground, more = ground_of(draft)
    return Bundle({"document": header, "planner": draft.planner, "ground": ground}, {**arrays, **more})


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
