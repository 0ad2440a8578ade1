"""Study schema: the keys that a study file may have, each an axis of the grid, a limit or a number."""

from __future__ import annotations

import re
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BeforeValidator, Field

from trihex.areas import CLOCKS, CORNERS, COSTS, CROSSINGS, FOLLOWINGS, GENERATORS, NEIGHBOURHOODS, TESSELLATIONS
from trihex.formats.areas.options import UNKNOWNS
from trihex.formats.schema import Cells, Count, Flow, Number, Points, Table, Whole, choice, distribution
from trihex.studies.placing import DESTINATION_PLACES, ROBOT_PLACEMENTS

_MOST_SEEDS = 10_000_000
_UNITS = {"": 1, "k": 10**3, "M": 10**6, "G": 10**9, "T": 10**12, "Ki": 2**10, "Mi": 2**20, "Gi": 2**30}

Value = TypeVar("Value")


def _listed(value: Any) -> Any:
    return value if isinstance(value, list) else [value]


def _listed_sizes(value: Any) -> Any:
    return value if isinstance(value, list) and value and isinstance(value[0], list) else [value]


def _tables(key: str) -> BeforeValidator:
    """Return what makes a table of each entry of an axis that is a bare value, the table's `key`."""

    def wrap(value: Any) -> Any:
        entries = value if isinstance(value, list) else [value]
        return [entry if isinstance(entry, dict) else {key: entry} for entry in entries]

    return BeforeValidator(wrap)


def _seeds(value: Any) -> Any:
    """Return the seeds; a whole number n stands for 0 to n - 1."""
    if isinstance(value, bool) or not isinstance(value, int):
        return value
    if not 1 <= value <= _MOST_SEEDS:
        raise ValueError(f"must be a list of seeds, or how many from 1 to {_MOST_SEEDS}, not {value}")
    return list(range(value))


def _bytes(value: str) -> str:
    if bytes_of(value) < 2**20:
        raise ValueError(f"must be at least 1 MB, such as '2 GB', not {value!r:.40}")
    return value


def bytes_of(text: str) -> int:
    """Return how many bytes a text such as ``2 GB`` or ``512 MiB`` means, 0 if it means none."""
    found = re.fullmatch(r"\s*(\d{1,6}(?:\.\d{1,6})?)\s*([kMGT]i?)?B\s*", text)
    return int(float(found[1]) * _UNITS[found[2] or ""]) if found else 0


Varied = Annotated[list[Value], BeforeValidator(_listed), Field(min_length=1)]
Share = Annotated[Number, Field(ge=0, le=1)]
Positive = Annotated[Number, Field(gt=0)]
_Size = Annotated[list[Count], Field(min_length=2, max_length=2)]
_Sizes = Annotated[list[_Size], BeforeValidator(_listed_sizes), Field(min_length=1)]


class AreaAxis(Table):
    """[[areas]]: files, or areas made by a generator; the generator's seed is that of the run unless given."""

    one_of = ("path", "generator", "!")
    path: Varied[str] | None = None
    generator: Annotated[str, choice("it", tuple(GENERATORS))] | None = None
    name: str | None = None
    size: _Sizes | None = None
    seed: Varied[Whole] | None = None
    density: Varied[Share] | None = None
    rounds: Varied[Whole] | None = None
    room: Varied[Count] | None = None
    doors: Varied[Share] | None = None
    shelf_length: Varied[Count] | None = None
    shelf_depth: Varied[Count] | None = None
    aisle: Varied[Count] | None = None
    missing: Varied[Share] | None = None
    cell_size: Varied[Positive] | None = None
    cell_area: Varied[Positive] | None = None
    robot_radius: Varied[Annotated[Number, Field(ge=0)]] | None = None
    unknown: Annotated[str, choice("it", UNKNOWNS)] | None = None
    threshold: Varied[Share] | None = None
    invert: bool | None = None
    resolution: Varied[Positive] | None = None
    capacity: Varied[dict[str, Flow]] | None = None


class TessellationAxis(Table):
    """[[tessellations]]: what the cells are."""

    name: Varied[Annotated[str, choice("it", TESSELLATIONS)]]
    neighbourhood: Varied[Annotated[str, choice("it", NEIGHBOURHOODS)]] | None = None
    costs: Varied[Annotated[str, choice("it", COSTS)]] | None = None


class RulesAxis(Table):
    """[[rules]]: what robots may do."""

    waiting_cost: Varied[Whole] | None = None
    crossing: Varied[Annotated[str, choice("it", CROSSINGS)]] | None = None
    corners: Varied[Annotated[str, choice("it", CORNERS)]] | None = None
    destination_capacity: Varied[Flow] | None = None
    clock: Varied[Annotated[str, choice("it", CLOCKS)]] | None = None
    following: Varied[Annotated[str, choice("it", FOLLOWINGS)]] | None = None


class DestinationsAxis(Table):
    """[[destinations]]: cells, points in metres, or a place and how many."""

    one_of = ("cells", "metres", "place", "!")
    cells: Cells | None = None
    metres: Points | None = None
    place: Varied[Annotated[str, choice("it", DESTINATION_PLACES)]] | None = None
    count: Varied[Count] | None = None


class RobotsAxis(Table):
    """[[robots]]: how many and where, or their cells, or a file with them."""

    one_of = ("count", "cells", "file", "!")
    count: Varied[Whole] | None = None
    cells: Cells | None = None
    file: Varied[str] | None = None
    placement: Varied[Annotated[str, choice("it", ROBOT_PLACEMENTS)]] | None = None
    start_times: Varied[Annotated[str, AfterValidator(distribution)]] | None = None


class RunAxis(Table):
    """run = {}: robots decide step by step, as `trihex run` has them, in place of making a plan and keeping to it."""

    sense: Varied[Annotated[Number, Field(ge=0, le=100)]] | None = None
    line_of_sight: bool | None = None
    delays: Varied[Annotated[Number, Field(ge=0, lt=1)]] | None = None
    replan: bool | None = None
    in_order: bool | None = None


class PlannerAxis(Table):
    """[[planners]]: a planner and its options; an option that is a list is varied."""

    name: Varied[str]
    options: dict[str, Any] = Field(default_factory=dict)
    run: RunAxis | None = None


class LimitsTable(Table):
    """[limits]: what one run may take; it then becomes a row with an error."""

    seconds: Positive | None = None
    memory: Annotated[str, AfterValidator(_bytes)] | None = None


class StudyTable(Table):
    """The whole file."""

    name: str = ""
    areas: Annotated[list[AreaAxis], _tables("path"), Field(min_length=1)]
    tessellations: Annotated[list[TessellationAxis], _tables("name"), Field(min_length=1)] = Field(
        default_factory=lambda: [TessellationAxis(name=["hexagonal"])]
    )
    rules: Annotated[list[RulesAxis], BeforeValidator(_listed), Field(min_length=1)] = Field(
        default_factory=lambda: [RulesAxis()]
    )
    destinations: Annotated[list[DestinationsAxis], _tables("place"), Field(min_length=1)] = Field(
        default_factory=lambda: [DestinationsAxis(place=["centre"])]
    )
    robots: Annotated[list[RobotsAxis], _tables("count"), Field(min_length=1)]
    seeds: Annotated[list[Whole], BeforeValidator(_seeds), Field(min_length=1)] = Field(default_factory=lambda: [0])
    planners: Annotated[list[PlannerAxis], _tables("name"), Field(min_length=1)] = Field(
        default_factory=lambda: [PlannerAxis(name=["fcost"])]
    )
    sample: Count | None = None
    sample_seed: Whole = 0
    bound: bool = True
    limits: LimitsTable = LimitsTable()
