"""Doors: those of a document, as pages draw them and hand them on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from trihex.areas import Area, Door, Zone, seconds_per_step
from trihex.formats import Draft
from trihex.record import counted

_Text = Annotated[str, Field(max_length=200)]


class DoorHeader(BaseModel):
    """A door of a document: cells that keep it whatever is painted there, robots a step, and what is said of it."""

    model_config = ConfigDict(extra="forbid", strict=True)
    name: _Text
    cells: list[Annotated[int, Field(ge=0, le=2**30)]]
    flow: _Text
    words: _Text


def told_doors(area: Area, doors: Sequence[Door]) -> list[dict[str, Any]]:
    """Return doors of an area, by the clock that holds in it, as a document has them."""
    return [
        {
            "name": door.name,
            "cells": door.cells.tolist(),
            "flow": str(door.flow),
            "words": _words(area, door.flow),
        }
        for door in doors
    ]


def _words(area: Area, flow: Fraction) -> str:
    """Return how many robots a door lets in; seconds are those of all pages, at 1 metre a second."""
    if area.frame is not None:
        return f"lets in {float(flow) / seconds_per_step(area):.3g} robots a second at 1 m/s"
    (robots, steps), step = flow.as_integer_ratio(), "step" if area.tessellation.clock == "steps" else "tick"
    how_many = "one robot" if robots == 1 else counted(robots, "robot")
    return f"lets in {how_many} {f'a {step}' if steps == 1 else f'in {steps} {step}s'}"


def with_doors(draft: Draft, headers: Sequence[DoorHeader]) -> Draft:
    """Return a draft with doors, named by zones, where the page has left some of their cells free."""
    area, doors, zones = draft.area, [], []
    is_once = Counter(header.name for header in headers)
    for header in headers:
        cells = np.array(header.cells, dtype=np.int64)
        cells = cells[~area.is_barrier(cells)]
        if not cells.size:
            continue
        is_zone = header.name.strip() and is_once[header.name] == 1
        zones += [Zone(header.name, cells)] if is_zone else []
        doors.append((header.name if is_zone else cells.tolist(), header.flow))
    return replace(draft, area=replace(area, zones=tuple(zones)), doors=tuple(doors))
