"""Targets: what is done with a damaged file, and what may come of it.

What was read is written again and read once more: a file out is whole, or there is none.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple
from zlib import crc32

import numpy as np

from trihex import (
    Area,
    Frame,
    Scenario,
    TrihexError,
    audit_plan,
    make_score,
    read_plan,
    read_run,
    read_starts,
    read_trajectories,
    write_area,
    write_plan,
    write_run,
)
from trihex.formats import Draft, read_draft, read_events
from trihex.plans import Plan
from trihex.studies import read_study
from trihex.viewer.bundle import decode
from trihex.viewer.desk import Desk

_YARD = Area("square", np.zeros((4, 8)), frame=Frame(0.5))
_SCENARIO = Scenario(_YARD, [(7, 0), (0, 3)])
# No tight worlds: what is read has to be of use.
_MOST_CELLS = 300_000


def read_place(path: Path) -> None:
    """Read a place in metres."""
    _use(read_draft(path, "hexagonal", cell_size=0.5, robot_radius=0.05, resolution=None), path)


def read_image(path: Path) -> None:
    """Read an image, as cells and as squares in metres."""
    _use(read_draft(path), path)
    _use(read_draft(path, "triangular", cell_size=0.5, robot_radius=0.05, resolution=0.1), path)


def read_any(path: Path) -> None:
    """Read whatever it is."""
    _use(read_draft(path), path)


def read_a_plan(path: Path) -> None:
    """Read a plan, judge it and write it."""
    plan = read_plan(path, _SCENARIO, for_judge=True)
    if plan.actions.size < _MOST_CELLS:
        audit_plan(plan)
        copy = _copy(plan, path, ("csv", "npz", "parquet"), write_plan)
        try:
            again = read_plan(copy, plan.scenario, for_judge=True)
        finally:
            copy.unlink()
        assert np.array_equal(again.actions, plan.actions), f"{copy.name} is another plan"


def read_some_starts(path: Path) -> None:
    """Read where robots start."""
    read_starts(path, _YARD)


def read_some_events(path: Path) -> None:
    """Read what will happen."""
    read_events(path, _YARD)


def read_a_run(path: Path) -> None:
    """Read what happened, and write it again."""
    run = read_run(path)
    copy = path.with_name("copy.npz")
    write_run(run, copy)
    try:
        assert read_run(copy) == run, "the copy is another run"
    finally:
        copy.unlink()


def read_a_crowd(path: Path) -> None:
    """Read where persons walked, and score them in the yard if they are there."""
    crowd = read_trajectories(path)
    if crowd.person.size < _MOST_CELLS:
        make_score(crowd, Scenario(_YARD, [(7, 0)]))


def read_a_study(path: Path) -> None:
    """Read what a study shall run."""
    read_study(path)


def answer_a_request(path: Path) -> None:
    """Answer what a page might ask for."""
    frames: list[bytes] = []
    desk().answer(path.read_bytes(), frames.append)
    *_, last = (decode(frame).header for frame in frames)
    message = last.get("message", "none")
    assert last["kind"] in ("result", "error"), last["kind"]
    assert "fault of trihex" not in message, message
    if last["kind"] == "error":
        raise TrihexError(message)


@cache
def desk() -> Desk:
    """Return a desk without a folder: it saves nothing."""
    return Desk()


def _use(draft: Draft, path: Path) -> None:
    """Make the scenario, if there is one, and write the area; what was read has to be of use."""
    area = draft.area
    if area.cell_count > _MOST_CELLS:
        return
    if draft.destinations is not None:
        draft.complete()
    copy = _copy(area, path, ("toml",) if area.frame else ("toml", "map", "txt", "png", "pgm", "bmp"), write_area)
    try:
        again = read_draft(copy, None if copy.suffix == ".toml" else area.tessellation).area
    finally:
        copy.unlink()
    assert np.array_equal(again.barriers, area.barriers), f"{copy.name} has other barriers"


def _copy(record: Area | Plan, path: Path, suffixes: tuple[str, ...], write: Callable[..., None]) -> Path:
    """Write a record in the format that the content of `path` happens to choose."""
    copy = path.with_name("copy." + suffixes[crc32(path.read_bytes()) % len(suffixes)])
    write(record, copy)
    return copy


TARGETS: dict[str, Callable[[Path], None]] = {
    "house.yaml": read_place,
    "house.geojson": read_place,
    "house.wkt": read_place,
    "style.yaml": read_place,
    "parts.geojson": read_place,
    "srid.wkt": read_place,
    "plan.dxf": read_place,
    "binary.dxf": read_place,
    "place.toml": read_any,
    "world.toml": read_any,
    "yard.toml": read_any,
    "yard.map": read_any,
    "level.tmj": read_any,
    "level.tmx": read_any,
    "letters.txt": read_any,
    "walls.txt": read_any,
    "starts.csv": read_some_starts,
    "metres.csv": read_some_starts,
    "yard.scen": read_some_starts,
    "plan.csv": read_a_plan,
    "plan.npz": read_a_plan,
    "plan.parquet": read_a_plan,
    **{f"house.{suffix}": read_image for suffix in ("pgm", "png", "bmp", "gif", "jpeg")},
    "colours.png": read_image,
    "house.pfm": read_image,
    "request.bundle": answer_a_request,
    "events.csv": read_some_events,
    "events.toml": read_some_events,
    "seconds.csv": read_some_events,
    "run.npz": read_a_run,
    "crowd.sqlite": read_a_crowd,
    "crowd.txt": read_a_crowd,
    "study.toml": read_a_study,
}


class Outcome(NamedTuple):
    """What came of a file: "read", "refused" with a message, or "fault" with what is wrong."""

    word: str
    text: str = ""


def outcome_of(target: Callable[[Path], None], path: Path) -> Outcome:
    """Return how `target` takes the file at `path`.

    A reader may return, or raise an error of trihex or of the operating system with a message that a person can read.
    """
    try:
        target(path)
    except TrihexError as error:
        message = str(error)
        if not message or len(message) > 2000 or (type(error).__name__ != "FormatError" and "\n" in message):
            return Outcome("fault", f"a message of {len(message)} letters: {message[:200]!r}")
        return Outcome("refused", message)
    except OSError as error:
        if error.filename is None:
            return Outcome("fault", f"an OSError without a file name: {error!r}")
        return Outcome("refused", str(error))
    except Exception:
        return Outcome("fault", traceback.format_exc())
    return Outcome("read")
