"""Schema: what the tables of a TOML file may hold, and all that is wrong with one at once."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from typing import Annotated, Any, ClassVar, TypeVar, get_args, get_origin

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from trihex.areas import check_distribution, check_flow
from trihex.errors import ScenarioError, check_choice

LARGEST = 2**30


class Table(BaseModel):
    """A table of the file: nothing is converted, and a key that does not exist is a mistake."""

    model_config = ConfigDict(extra="forbid", strict=True)
    # Of these keys one at most may be given; exactly one if the last is "!".
    one_of: ClassVar[tuple[str, ...]] = ()


Model = TypeVar("Model", bound=Table)
Whole = Annotated[int, Field(ge=0, le=LARGEST)]
Count = Annotated[int, Field(ge=1, le=LARGEST)]
Number = Annotated[float, Field(allow_inf_nan=False, strict=False)]
Cells = list[Annotated[list[Annotated[int, Field(ge=-LARGEST, le=LARGEST)]], Field(min_length=2, max_length=2)]]
Points = list[Annotated[list[Number], Field(min_length=2, max_length=2)]]


def _flow(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(f"must be a number, or text such as '1.6/s', not {value!r:.60}")
    check_flow("it", value)
    return value


#: How many robots a step or a second; kept as it stands in the file.
Flow = Annotated[Any, AfterValidator(_flow)]


def choice(parameter: str, choices: tuple[str, ...]) -> AfterValidator:
    """Return what refuses words that are not among `choices`."""
    return AfterValidator(lambda value: check_choice(parameter, value, choices, ScenarioError))


def distribution(value: str) -> str:
    """Return text that names a distribution of start times."""
    try:
        check_distribution(value)
    except ScenarioError as error:
        raise ValueError(str(error).removeprefix("start times ")) from None
    return value


def check_document(model: type[Model], document: dict[str, Any]) -> tuple[Model | None, list[str]]:
    """Return the checked document, or None, and all mistakes: path of the key, rule, value and the near name."""
    mistakes = [f"{key}: {rule}" for key, rule in _exclusive(model, document, "")]
    try:
        return model.model_validate(document), mistakes
    except ValidationError as error:
        return None, [_message(model, document, detail) for detail in error.errors(include_url=False)] + mistakes


def _exclusive(model: type[Table], document: object, path: str) -> Iterator[tuple[str, str]]:
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
        inner = _table_of(field)
        if name not in document or inner is None:
            continue
        below = f"{path}.{name}".lstrip(".")
        if isinstance(document[name], list):
            for i, entry in enumerate(document[name]):
                yield from _exclusive(inner, entry, f"{below}.{i}")
        else:
            yield from _exclusive(inner, document[name], below)


def _table_of(field: FieldInfo) -> type[Table] | None:
    """Return the tables that a key holds: one, one that may be left out, or a list of them."""
    kind: Any = field.annotation
    while get_origin(kind) is not None:
        kind = get_args(kind)[0]
    return kind if isinstance(kind, type) and issubclass(kind, Table) else None


def _message(model: type[Table], document: object, detail: ErrorDetails) -> str:
    """Return one mistake as ``path: rule, not value``."""
    path = _path(document, detail["loc"])
    if detail["type"] == "extra_forbidden":
        keys = _keys_of(model, detail["loc"][:-1])
        near = get_close_matches(str(detail["loc"][-1])[:60].lower(), keys, n=1)
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


def _path(document: object, places: tuple[int | str, ...]) -> str:
    """Return the path of a mistake in the file, without the tables and lists that only stand for a bare value."""
    parts = []
    for part in places:
        if isinstance(part, str) and isinstance(document, dict):
            parts.append(f"{part:.60}")
            document = document.get(part)
        elif isinstance(part, int) and isinstance(document, list):
            parts.append(str(part))
            document = document[part]
    return ".".join(parts)


def _keys_of(model: Any, parents: tuple[int | str, ...]) -> list[str]:
    for part in parents:
        if isinstance(part, str):
            model = _table_of(model.model_fields[part])
    return list(model.model_fields)
