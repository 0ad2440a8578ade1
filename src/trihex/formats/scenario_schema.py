"""Scenario schema: the keys that a scenario file may have, and all that is wrong with one at once."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import PurePath
from typing import Annotated, Any, ClassVar, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from trihex.errors import ScenarioError, check_choice
from trihex.formats.options import UNKNOWNS
from trihex.scenario import CORNERS, CROSSINGS
from trihex.tessellation import COSTS, NEIGHBOURHOODS, TESSELLATIONS

_LARGEST = 2**30


def _choice(parameter: str, choices: tuple[str, ...]) -> AfterValidator:
    return AfterValidator(lambda value: check_choice(parameter, value, choices, ScenarioError))


_Whole = Annotated[int, Field(ge=0, le=_LARGEST)]
_Cells = list[Annotated[list[Annotated[int, Field(ge=-_LARGEST, le=_LARGEST)]], Field(min_length=2, max_length=2)]]


class _Table(BaseModel):
    """A table of the file: nothing is converted, and a key that does not exist is a mistake."""

    model_config = ConfigDict(extra="forbid", strict=True)
    # Of these keys one at most may be given; exactly one if the last is "!".
    one_of: ClassVar[tuple[str, ...]] = ()


_Number = Annotated[float, Field(allow_inf_nan=False, strict=False)]
_Metres = list[Annotated[list[_Number], Field(min_length=2, max_length=2)]]


class FrameTable(_Table):
    """[area.frame]: where the area lies in the world, in metres."""

    cell_size: Annotated[_Number, Field(gt=0)]
    origin: Annotated[list[_Number], Field(min_length=2, max_length=2)] = [0.0, 0.0]
    yaw: _Number = 0.0
    robot_radius: Annotated[_Number, Field(ge=0)] = 0.0


class AreaTable(_Table):
    """[area]: where the barriers come from, and how they are read."""

    one_of = ("path", "rows", "!")
    path: str | None = None
    rows: list[str] | None = None
    name: str | None = None
    tessellation: Annotated[str, _choice("it", TESSELLATIONS)] = "hexagonal"
    neighbourhood: Annotated[str, _choice("it", NEIGHBOURHOODS)] = "full"
    costs: Annotated[str, _choice("it", COSTS)] = "paper"
    frame: FrameTable | None = None
    # How the file at `path` is read; see `formats.options.AreaOptions`.
    cell_size: Annotated[_Number, Field(gt=0)] | None = None
    robot_radius: Annotated[_Number, Field(ge=0)] | None = None
    unknown: Annotated[str, _choice("it", UNKNOWNS)] | None = None
    threshold: Annotated[_Number, Field(ge=0, le=1)] | None = None
    invert: bool | None = None
    resolution: Annotated[_Number, Field(gt=0)] | None = None


class RulesTable(_Table):
    """[rules]: what robots may do."""

    waiting_cost: _Whole | None = None
    crossing: Annotated[str, _choice("it", CROSSINGS)] | None = None
    corners: Annotated[str, _choice("it", CORNERS)] | None = None
    destination_capacity: Annotated[int, Field(ge=1, le=_LARGEST)] | None = None


class RobotsTable(_Table):
    """[robots]: given, from a file, or drawn."""

    one_of = ("cells", "metres", "file", "random")
    cells: _Cells | None = None
    metres: _Metres | None = None
    file: str | None = None
    random: _Whole | None = None
    seed: _Whole | None = None


class PlannerTable(_Table):
    """[planner]: its name in the registry, and its options."""

    name: str | None = None
    options: dict[str, Any] = {}


def _beside(value: str) -> str:
    """Return the path of an output; a scenario from somewhere must not write to anywhere."""
    if not value or "\0" in value or PurePath(value).is_absolute() or ".." in PurePath(value).parts:
        raise ValueError(f"must be a path beside the scenario or below it, not {value!r:.60}")
    return value


_Output = Annotated[str, AfterValidator(_beside)]


class OutputsTable(_Table):
    """[outputs]: what `trihex plan` writes, unless its options say otherwise."""

    plan: _Output | None = None
    summary: _Output | None = None
    picture: _Output | None = None
    waypoints: _Output | None = None
    speed: Annotated[_Number, Field(gt=0)] | None = None


class ScenarioTable(_Table):
    """The whole file."""

    one_of = ("destinations", "destinations_in_metres")
    area: AreaTable
    destinations: _Cells | None = None
    destinations_in_metres: _Metres | None = None
    rules: RulesTable = RulesTable()
    robots: RobotsTable = RobotsTable()
    planner: PlannerTable = PlannerTable()
    outputs: OutputsTable = OutputsTable()


def check_document(document: dict[str, Any]) -> tuple[ScenarioTable | None, list[str]]:
    """Return the checked document, or None, and all mistakes: path of the key, rule, value and the near name."""
    mistakes = [f"{key}: {rule}" for key, rule in _exclusive(ScenarioTable, document, "")]
    try:
        return ScenarioTable.model_validate(document), mistakes
    except ValidationError as error:
        return None, [_message(detail) for detail in error.errors(include_url=False)] + mistakes


def _exclusive(model: type[_Table], document: object, path: str) -> Iterator[tuple[str, str]]:
    """Yield path and rule of each table that has too many or too few of its alternative keys."""
    if not isinstance(document, dict):
        return
    keys = [key for key in model.one_of if key != "!"]
    given = [key for key in keys if key in document]
    if len(given) > 1:
        yield path, f"must have only one of {', '.join(keys)}, not {' and '.join(given)}"
    if not given and "!" in model.one_of:
        yield path, f"must have one of {', '.join(keys)}"
    for name, field in model.model_fields.items():
        if name in document and _is_table(field):
            yield from _exclusive(field.annotation, document[name], f"{path}.{name}".lstrip("."))  # type: ignore[arg-type]


def _is_table(field: FieldInfo) -> bool:
    return isinstance(field.annotation, type) and issubclass(field.annotation, _Table)


def _message(detail: ErrorDetails) -> str:
    """Return one mistake as ``path: rule, not value``."""
    *parents, last = detail["loc"]
    path = ".".join(f"{part:.60}" if isinstance(part, str) else str(part) for part in detail["loc"])
    if detail["type"] == "extra_forbidden":
        keys = _keys_of(parents)
        near = get_close_matches(str(last)[:60].lower(), keys, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else f"; keys are {', '.join(keys)}"
        return f"{path}: there is no such key{hint}"
    if detail["type"] == "missing":
        return f"{path}: is missing"
    if detail["type"] == "value_error":
        return f"{path}: {str(detail['ctx']['error']).removeprefix('it ')}"
    if detail["type"] in ("model_type", "dict_type"):
        return f"{path}: must be a table, not {detail['input']!r:.60}"
    rule = detail["msg"].replace("Input should be", "must be").replace("List should have", "must have")
    for wordy, plain in {
        "a valid integer": "a whole number",
        "a valid string": "text in quotes",
        "a valid list": "a list in brackets",
        " after validation": "",
        "items": "items",
    }.items():
        rule = rule.replace(wordy, plain)
    return f"{path}: {rule.partition(', not ')[0]}, not {detail['input']!r:.60}"


def _keys_of(parents: list[int | str]) -> list[str]:
    model: Any = ScenarioTable
    for part in parents:
        kinds = get_args(model.model_fields[part].annotation) or (model.model_fields[part].annotation,)
        model = kinds[0]  # a table that may be left out is `Table | None`
    return list(model.model_fields)
