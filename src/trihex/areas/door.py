"""Door: cells that only so many robots enter in a step, an exit or a passage."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas.area import Area
from trihex.areas.flow import check_flow, flow_from
from trihex.areas.places import cells_from
from trihex.areas.seconds import seconds_per_step
from trihex.areas.zone import NAME_RULE, is_name
from trihex.errors import AreaError, ScenarioError, check_type, kind_of
from trihex.record import Record, read_only, short

MOST_CELLS = 10_000  # of a door: with the finest flow their schedule still fits into int64 for 10^9 steps


@dataclass(frozen=True, eq=False)
class Door(Record):
    """Cells that only so many robots enter in a step, all cells together.

    Up to step t, ``floor(flow * t)`` robots may have entered, the next one as soon as that is one more: a fixed
    schedule, and what nobody uses in its step is lost. The cells take turns, the first of them first. A robot enters in
    the step (tick) in which its move ends. (docs/conventions.md)

    Parameters
    ----------
    cells : sequence of cell numbers
        Destinations, or cells that robots pass on their way; kept ascending, each once.
    flow : Fraction
        Robots a step.
    name : str
        That of the zone whose cells they are; "" if they have none.

    Examples
    --------
    >>> Door([5, 4], Fraction(3, 2), "north").cells.tolist()
    [4, 5]
    """

    cells: NDArray[np.int64]
    flow: Fraction
    name: str = ""

    def __post_init__(self) -> None:
        cells = np.asarray(self.cells)
        if cells.size and (cells.dtype.kind not in "iu" or cells.ndim != 1):
            raise ScenarioError(f"cells of a door must be numbers in a list or a flat array, not {short(self.cells)}")
        self._set("cells", read_only(np.unique(cells.astype(np.int64))))
        if not isinstance(self.name, str):
            raise ScenarioError(f"name of a door must be text, not {kind_of(self.name)}")
        if self.name and not is_name(self.name):
            raise ScenarioError(f"name of a door must be {NAME_RULE}, or empty, not {self.name!r:.80}")
        flow = check_flow("flow of a door", self.flow)
        if str(self.flow).strip().endswith("/s"):
            raise ScenarioError(f"flow of a door must be robots a step, not {self.flow!r}; make_doors takes both")
        self._set("flow", flow)

    def in_words(self) -> str:
        """Return the name, or the number of cells, and the flow."""
        return f"{self.name or f'{self.cells.size} cells'}: {self.flow}"


def make_doors(area: Area, given: Any, *, speed: float = 1.0, turn_time: float = 0.0) -> tuple[Door, ...]:
    """Return the doors of an area, checked, for `Scenario`.

    Parameters
    ----------
    area : Area
    given : mapping, or iterable
        Flows (see `flow_from`) by the names of zones, or doors, or pairs (places or the name of a zone, flow).
    speed, turn_time : float
        Of robots in an area in metres, as for `write_waypoints`: they tell what a flow in robots a second is.

    Raises
    ------
    ScenarioError
        If a zone does not exist, a door has no cell or one that is a barrier, or two doors share a cell.

    Examples
    --------
    >>> from trihex.areas.frame import Frame
    >>> area = Area("hexagonal", [[0, 0]], frame=Frame(cell_size=0.5))
    >>> make_doors(area, [((0, 0), "1.6/s")], speed=2.0)[0].flow
    Fraction(2, 5)
    """
    check_type("area", area, Area)
    step_seconds = None if area.frame is None else seconds_per_step(area, speed, turn_time)
    given = list(_pairs(given))
    doors = tuple(_door_from(area, one, step_seconds) for one in given)
    seen: dict[int, str] = {}
    for number, door in enumerate(doors):
        who = f"door {door.name!r}" if door.name else f"door {number}"
        if not 0 < door.cells.size <= MOST_CELLS:
            raise ScenarioError(f"{who} must have 1 to {MOST_CELLS} free cells, not {door.cells.size}")
        barred = door.cells[area.is_barrier(door.cells)]
        if barred.size and not isinstance(given[number], Door):  # which may have been blocked meanwhile
            raise ScenarioError(f"{who} must have free cells; {area.place_of_cell(int(barred[0]))} is a barrier")
        for cell in door.cells.tolist():
            if cell in seen:
                raise ScenarioError(
                    f"doors must not share cells; {who} and {seen[cell]} have {area.name_of_cell(cell)}"
                )
            seen[cell] = who
    return doors


def is_door_of_zone(area: Area, door: Door) -> bool:
    """Tell whether a door has the free cells of the zone of its name, so that the name tells it."""
    cells = [zone.cells for zone in area.zones if zone.name == door.name]
    return bool(cells) and np.array_equal(cells[0][~area.is_barrier(cells[0])], door.cells)


def _pairs(given: Any) -> Iterable[Any]:
    """Return what doors are made of, one after the other."""
    if isinstance(given, Mapping):
        return given.items()
    if isinstance(given, Iterable) and not isinstance(given, str):
        return given
    raise ScenarioError(f"doors must be flows by the names of zones, or a list of doors, not {kind_of(given)}")


def _door_from(area: Area, given: Any, step_seconds: float | None) -> Door:
    if isinstance(given, Door):
        places, flow, name = given.cells.tolist(), given.flow, given.name
    else:
        try:
            places, flow = given
        except (TypeError, ValueError):
            raise ScenarioError(f"a door must be a pair (places or a name, flow), not {given!r:.80}") from None
        name = places if isinstance(places, str) else ""
    what = f"capacity of door {name!r:.80}" if name else "capacity of a door"
    if not isinstance(places, str):
        return Door(
            cells_from(area, places, "cells of a door", ScenarioError), flow_from(what, flow, area, step_seconds), name
        )
    try:
        cells = area.cells_of_zone(places)
    except AreaError as error:
        raise ScenarioError(f"door: {error}") from None
    return Door(cells[~area.is_barrier(cells)], flow_from(what, flow, area, step_seconds), name)
