"""Requests: what a page may ask for, each with its bounds."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from trihex.errors import FormatError

_Text = Annotated[str, Field(max_length=1000)]
_Whole = Annotated[int, Field(ge=0, le=2**30)]
_Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]


class Request(BaseModel):
    """What all requests hold: what is asked for, and the document it is about."""

    model_config = ConfigDict(extra="forbid", strict=True)
    op: _Text
    document: dict[str, Any] | None = None


class First(Request):
    """What the page shows first, where it is not part of the page."""


class Prepare(Request):
    """Compile what most requests will need, beside all else."""


class ListFiles(Request):
    """The files that may be opened."""


class OpenFile(Request):
    """A file, of the folder or with its content as array ``content``."""

    name: _Text
    in_folder: bool = True
    tessellation: _Text | None = None
    cell_size: _Positive | None = None
    robot_radius: Annotated[float, Field(ge=0, allow_inf_nan=False)] | None = None
    resolution: _Positive | None = None
    threshold: Annotated[float, Field(ge=0, le=1)] | None = None
    invert: bool | None = None
    unknown: _Text | None = None


class Generate(Request):
    """An area of a generator."""

    generator: _Text
    tessellation: _Text
    height: Annotated[int, Field(ge=1, le=4096)]
    width: Annotated[int, Field(ge=1, le=4096)]
    seed: _Whole


class Scatter(Request):
    """Robots drawn at random."""

    count: _Whole
    seed: _Whole


class Fields(Request):
    """N-scheme and D-scheme."""


class Generations(Request):
    """The automaton, generation by generation."""


class MakePlan(Request):
    """A plan with its report; on other cells if `tessellation` is given."""

    planner: _Text
    options: dict[_Text, Any] = {}
    tessellation: _Text | None = None


class Bound(Request):
    """A better lower bound for a plan that was made; may take longer than the plan."""

    plan: _Text


class MakeLayer(Request):
    """A map of a plan, or of a `live` run so far, over its cells."""

    plan: _Text = ""
    live: _Text | None = None
    layer: _Text


class Live(Request):
    """A run that the page drives step by step; `sense` in cells, None for robots that know everything."""

    planner: _Text
    sense: Annotated[float, Field(ge=0, le=100)] | None = None
    line_of_sight: bool = False
    delays: Annotated[float, Field(ge=0, lt=1)] = 0.0
    replan: bool = False
    budget: _Positive | None = None


class Happening(BaseModel):
    """An event that happens before the next step, as `trihex.Event` has it."""

    model_config = ConfigDict(extra="forbid", strict=True)
    kind: _Text
    cell: Annotated[list[int], Field(min_length=2, max_length=2)] | None = None
    to: Annotated[list[int], Field(min_length=2, max_length=2)] | None = None
    robot: _Whole | None = None
    steps: Annotated[int, Field(ge=1, le=10**6)] | None = None


class Advance(Request):
    """Events, then steps, of a live run."""

    live: _Text
    events: Annotated[list[Happening], Field(max_length=10_000)] = []
    steps: Annotated[int, Field(ge=0, le=64)] = 1


class Judge(Request):
    """The report of a live run so far."""

    live: _Text


class Save(Request):
    """A file, into the folder (`in_folder`) or as an answer; a page may hold the plan `beside` as well.

    It is about the document, a `plan` that was made, or a `live` run so far.
    """

    what: _Text
    name: _Text
    in_folder: bool
    overwrite: bool = False
    plan: _Text | None = None
    beside: _Text | None = None
    live: _Text | None = None
    planner: _Text | None = None


REQUESTS: dict[str, type[Request]] = {
    "first": First,
    "prepare": Prepare,
    "files": ListFiles,
    "open": OpenFile,
    "generate": Generate,
    "scatter": Scatter,
    "fields": Fields,
    "generations": Generations,
    "plan": MakePlan,
    "bound": Bound,
    "layer": MakeLayer,
    "live": Live,
    "advance": Advance,
    "judge": Judge,
    "save": Save,
}


def parse_request(header: dict[str, Any]) -> Request:
    """Return the request that a header describes.

    Raises
    ------
    FormatError
        If there is no such request, or one of its values is out of bounds.
    """
    op = header.get("op")
    if not isinstance(op, str) or op not in REQUESTS:
        raise FormatError(f"op must be one of {', '.join(REQUESTS)}, not {op!r:.60}")
    try:
        return REQUESTS[op].model_validate(header)
    except ValidationError as error:
        detail = error.errors()[0]
        where = ".".join(str(part) for part in detail["loc"])
        raise FormatError(f"{op}: {where}: {detail['msg']}, not {detail['input']!r:.60}") from None
