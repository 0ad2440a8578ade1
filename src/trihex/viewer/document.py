"""Document: a scenario in the making as the page holds it, a JSON header with three arrays."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, sqrt
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from trihex.areas import Area, Frame, RasterGround, Tessellation, usual_following
from trihex.errors import FormatError, TooLargeError
from trihex.formats import Draft
from trihex.viewer.bundle import Bundle
from trihex.viewer.doors import DoorHeader, told_doors, with_doors

# A page holds some 20 bytes a cell and 50 a robot.
MAX_CELLS = 2**24
MAX_ROBOTS = 2**21
MAX_SQUARES = 2**22  # of the ground beneath
_DRAWN_SQUARE = 0.05  # of a drawing, in edge steps

_Whole = Annotated[int, Field(ge=0, le=2**30)]
_Side = Annotated[int, Field(ge=1, le=MAX_CELLS)]
_Finite = Annotated[float, Field(allow_inf_nan=False)]
_Flow = Annotated[str, Field(max_length=40)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class FrameHeader(_Strict):
    """The frame of an area in metres."""

    cell_size: _Finite
    origin: Annotated[list[_Finite], Field(min_length=2, max_length=2)]
    yaw: _Finite
    robot_radius: _Finite


class DocumentHeader(_Strict):
    """All of a document but its arrays; None stands for the default."""

    name: Annotated[str, Field(max_length=400)] = ""
    tessellation: str
    neighbourhood: str = "full"
    costs: str = "paper"
    height: _Side
    width: _Side
    frame: FrameHeader | None = None
    waiting_cost: _Whole | None = None
    crossing: str = "forbid"
    corners: str = "allow"
    clock: str = "steps"
    following: str | None = None
    destination_capacity: Annotated[int, Field(ge=1, le=2**30)] | _Flow | None = None
    seed: Annotated[int, Field(ge=0, lt=2**53)] | None = None  # JavaScript has no larger whole numbers
    # Cell and start time of robots that may not begin at once: pages hand it on, whatever becomes of other robots.
    start_times: list[Annotated[list[_Whole], Field(min_length=2, max_length=2)]] | None = None
    doors: list[DoorHeader] | None = None
    slowness: list[Annotated[list[_Whole], Field(min_length=2, max_length=2)]] | None = None  # likewise


def document_of(draft: Draft) -> Bundle:
    """Return `draft` as a document; robots that are still to be drawn must have been drawn.

    Arrays: ``barriers``, 8 cells a byte, the first in the highest bit; ``destinations`` and ``robots``, cell numbers.

    Raises
    ------
    TooLargeError
        If a page could not hold it.
    """
    area = draft.area
    robots = np.empty(0) if draft.robots is None else draft.robots
    if area.cell_count > MAX_CELLS or robots.size > MAX_ROBOTS:
        raise TooLargeError(
            f"the viewer shows at most {MAX_CELLS} cells and {MAX_ROBOTS} robots, "
            f"not {area.cell_count} and {robots.size}"
        )
    frame = area.frame
    capacity, doors = draft.flows()
    header = {
        "name": area.name[:400],
        "tessellation": area.tessellation.name,
        "neighbourhood": area.tessellation.neighbourhood,
        "costs": area.tessellation.costs,
        "height": area.height,
        "width": area.width,
        "frame": frame
        and {
            "cell_size": frame.cell_size,
            "origin": list(frame.origin),
            "yaw": frame.yaw,
            "robot_radius": frame.robot_radius,
        },
        "waiting_cost": None if draft.waiting_cost is None else int(draft.waiting_cost),
        "crossing": draft.crossing or "forbid",
        "corners": draft.corners or "allow",
        "clock": draft.clock or area.tessellation.clock,
        "following": draft.following or usual_following(area.tessellation, frame),
        "destination_capacity": _told_capacity(capacity),
        "seed": None if draft.seed is None else int(draft.seed),
    }
    if doors:
        header["doors"] = told_doors(_clocked(draft), doors)
    if draft.has_start_times:
        header["start_times"] = _start_times(draft, robots)
    if draft.slowness is not None and draft.has_slowness:
        slowness = draft.whole_slowness()
        slow = np.flatnonzero(slowness > 1)
        header["slowness"] = np.stack([robots[slow], slowness[slow]], axis=1).astype(np.int64).tolist()
    arrays: dict[str, NDArray[Any]] = {
        "barriers": np.packbits(area.barriers),
        "destinations": _cells(draft.destinations),
        "robots": _cells(draft.robots),
    }
    return Bundle(header, arrays)


def _start_times(draft: Draft, robots: NDArray[Any]) -> list[list[int]]:
    """Return cell and start time of each robot that may not begin at once; those that join a run may."""
    times = draft.steps_of_starts(_clocked(draft), robots.size)[: robots.size]
    late = np.flatnonzero(times)
    pairs: list[list[int]] = np.stack([robots[late], times[late]], axis=1).astype(np.int64).tolist()
    return pairs


def ground_of(draft: Draft) -> Bundle | tuple[None, dict[str, NDArray[Any]]]:
    """Return what stands beneath the cells of a draft, 8 squares a byte, for the page to draw; None where nothing does.

    Squares are as large as those of the raster that the area was made from, or larger where there would be too many.
    """
    area = draft.area
    if area.ground is None:
        return None, {}
    across, down = area.tessellation.extent(area.height, area.width)
    finest = area.ground.resolution / area.metres.cell_size if isinstance(area.ground, RasterGround) else _DRAWN_SQUARE
    square = max(finest, sqrt(across * down / MAX_SQUARES))
    rows, columns = ceil(down / square), ceil(across / square)
    east, south = (np.arange(columns) + 0.5) * square, (np.arange(rows)[:, None] + 0.5) * square
    occupied = area.ground.occupied_at(*area.metres.point_to_metres(east, south))
    header = {"rows": rows, "columns": columns, "square": square, "corner": [0.0, 0.0]}
    return Bundle(header, {"ground": np.packbits(occupied)})


def draft_of_document(header: Any, arrays: dict[str, NDArray[Any]]) -> Draft:
    """Return the draft that a document describes.

    Raises
    ------
    FormatError
        If it is no document.
    TrihexError
        If its parts do not fit each other.
    """
    try:
        parsed = DocumentHeader.model_validate(header)
    except ValidationError as error:
        detail = error.errors()[0]
        where = ".".join(str(part) for part in detail["loc"])
        raise FormatError(f"document: {where}: {detail['msg']}, not {detail['input']!r:.60}") from None
    cells = parsed.height * parsed.width
    if cells > MAX_CELLS:
        raise TooLargeError(f"the viewer shows at most {MAX_CELLS} cells, not {cells}")
    for name, dtype in (("barriers", "u1"), ("destinations", "i4"), ("robots", "i4")):
        if name not in arrays or arrays[name].dtype.str[1:] != dtype:
            raise FormatError(f"document: {name} must be an array of type {dtype}")
    if arrays["barriers"].size != (cells + 7) // 8:
        raise FormatError(f"document: barriers must hold {cells} bits, not {8 * arrays['barriers'].size}")
    barriers = np.unpackbits(arrays["barriers"], count=cells).reshape(parsed.height, parsed.width).astype(bool)
    tessellation = Tessellation(parsed.tessellation, parsed.neighbourhood, parsed.costs)
    frame = None
    if parsed.frame is not None:
        x, y = parsed.frame.origin
        frame = Frame(parsed.frame.cell_size, (x, y), parsed.frame.yaw, parsed.frame.robot_radius)
    draft = Draft(
        Area(tessellation, barriers, parsed.name, frame),
        arrays["destinations"].astype(np.int64),
        arrays["robots"].astype(np.int64),
        seed=parsed.seed,
        waiting_cost=parsed.waiting_cost,
        crossing=parsed.crossing,
        corners=parsed.corners,
        clock=parsed.clock,
        following=parsed.following,
        destination_capacity=parsed.destination_capacity,
        start_times=_values_of(arrays["robots"], parsed.start_times, 0) if parsed.start_times else None,
        slowness=_values_of(arrays["robots"], parsed.slowness, 1) if parsed.slowness else None,
    )
    return with_doors(draft, parsed.doors) if parsed.doors else draft


def _values_of(robots: NDArray[np.int32], pairs: list[list[int]], usual: int) -> NDArray[np.int64]:
    value_of_cell: dict[int, int] = dict(tuple(pair) for pair in pairs)  # type: ignore[misc]
    return np.array([value_of_cell.get(cell, usual) for cell in robots.tolist()], dtype=np.int64)


def _clocked(draft: Draft) -> Area:
    return draft.area if draft.clock is None else draft.area.with_clock(draft.clock)


def _told_capacity(capacity: int | Fraction | None) -> int | str | None:
    """Return how many robots enter a destination in a step; a fraction as text."""
    if capacity is None:
        return None
    return int(capacity) if capacity.denominator == 1 else str(capacity)


def _cells(cells: NDArray[np.int64] | None) -> NDArray[np.int32]:
    return np.empty(0, dtype=np.int32) if cells is None else cells.astype(np.int32)
