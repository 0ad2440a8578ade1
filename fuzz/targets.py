"""Targets: what is done with a damaged file, and what may come of it."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from pathlib import Path

import numpy as np

from trihex import Area, Frame, Scenario, TrihexError, audit_plan, read_plan, read_starts
from trihex.formats import read_draft

_YARD = Area("square", np.zeros((4, 8)), frame=Frame(0.5))
_SCENARIO = Scenario(_YARD, [(7, 0), (0, 3)])
# No tight worlds: what is read has to be of use.
_MOST_CELLS = 300_000


def read_place(path: Path) -> None:
    """Read a place in metres."""
    draft = read_draft(path, "hexagonal", cell_size=0.5, robot_radius=0.05, resolution=None)
    _complete(draft)


def read_image(path: Path) -> None:
    """Read an image, as cells and as squares in metres."""
    read_draft(path)
    read_draft(path, "triangular", cell_size=0.5, robot_radius=0.05, resolution=0.1)


def read_any(path: Path) -> None:
    """Read whatever it is."""
    _complete(read_draft(path))


def read_a_plan(path: Path) -> None:
    """Read a plan and judge it, since what was read has to be of use."""
    plan = read_plan(path, _SCENARIO)
    if plan.actions.size < _MOST_CELLS:
        audit_plan(plan)


def read_some_starts(path: Path) -> None:
    """Read where robots start."""
    read_starts(path, _YARD)


def _complete(draft: object) -> None:
    area = draft.area  # type: ignore[attr-defined]
    if draft.destinations is not None and area.cell_count < _MOST_CELLS:  # type: ignore[attr-defined]
        draft.complete()  # type: ignore[attr-defined]


TARGETS: dict[str, Callable[[Path], None]] = {
    "house.yaml": read_place,
    "house.geojson": read_place,
    "house.wkt": read_place,
    "place.toml": read_any,
    "world.toml": read_any,
    "yard.toml": read_any,
    "yard.map": read_any,
    "letters.txt": read_any,
    "starts.csv": read_some_starts,
    "metres.csv": read_some_starts,
    "yard.scen": read_some_starts,
    "plan.csv": read_a_plan,
    "plan.npz": read_a_plan,
    "plan.parquet": read_a_plan,
    **{f"house.{suffix}": read_image for suffix in ("pgm", "png", "bmp", "gif", "jpeg")},
    "colours.png": read_image,
}


def fault_of(target: Callable[[Path], None], path: Path) -> str | None:
    """Return what is wrong with how `target` takes the file at `path`, None if nothing is.

    A reader may return, or raise an error of trihex or of the operating system with a message that a person can read.
    """
    try:
        target(path)
    except TrihexError as error:
        message = str(error)
        if not message or len(message) > 2000 or (type(error).__name__ != "FormatError" and "\n" in message):
            return f"a message of {len(message)} letters: {message[:200]!r}"
    except OSError as error:
        if error.filename is None:
            return f"an OSError without a file name: {error!r}"
    except Exception:
        return traceback.format_exc()
    return None
