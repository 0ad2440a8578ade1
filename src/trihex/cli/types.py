"""Types of options: names, whole numbers and cells, each with its own message."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import click

from trihex.errors import TrihexError, check_choice


class Name(click.ParamType):  # type: ignore[type-arg]
    """One of the names that `attribute` of `module` lists; the module is imported when they are needed."""

    name = "name"

    def __init__(self, module: str, attribute: str) -> None:
        self.module, self.attribute = module, attribute

    @property
    def choices(self) -> tuple[str, ...]:
        """The names."""
        return tuple(getattr(import_module(self.module), self.attribute))

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:
        """Show the names where an option is described."""
        return f"[{'|'.join(self.choices)}]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return `value` if it is one of the names."""
        try:
            return check_choice(_name_of(param), value, self.choices, TrihexError)
        except TrihexError as error:
            raise click.UsageError(str(error), ctx) from None


class Names(Name):
    """Several of the names, parted by commas."""

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:
        """Show the names where an option is described."""
        return ",".join(self.choices)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the names in the order given, each once."""
        one = super().convert
        return tuple(dict.fromkeys(one(part.strip(), param, ctx) for part in str(value).split(",")))


class Planners(Names):
    """Several planners, each with its options if it has any, as in ``greedy,fcost:rule=paper``."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the planners in the order given, each once."""
        from trihex.planners import planner_from

        named = [part.strip() for part in str(value).split(",")]
        for planner in named:
            Name.convert(self, planner.partition(":")[0].strip(), param, ctx)
            try:
                planner_from(planner)
            except TrihexError as error:
                raise click.UsageError(f"{_name_of(param)}: {error}", ctx) from None
        return tuple(dict.fromkeys(named))


class Whole(click.ParamType):  # type: ignore[type-arg]
    """A whole number from `least` on."""

    name = "number"

    def __init__(self, least: int) -> None:
        self.least = least

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """Return the number."""
        number = _whole(str(value))
        if number is None or not self.least <= number <= 2**30:
            rule = f"a whole number from {self.least} to {2**30}"
            raise click.UsageError(f"{_name_of(param)} must be {rule}, not {value!r}", ctx)
        return number


class Flow(click.ParamType):  # type: ignore[type-arg]
    """Robots a step, or in metres a second, as in ``0.5``, ``1/3`` or ``1.6/s``."""

    name = "flow"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the text, or a whole number."""
        from trihex.areas import check_flow

        try:
            check_flow(_name_of(param), value)
        except TrihexError as error:
            raise click.UsageError(str(error), ctx) from None
        return value if (number := _whole(str(value))) is None else number


class FlowOf(Flow):
    """A place and its flow, as in ``north=1.6/s`` or ``3,4=0.5``."""

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:
        """Show what is given."""
        return "PLACE=FLOW"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the name of a zone, or a list of one cell (x, y), and the flow."""
        place, _, flow = str(value).rpartition("=")
        if not place:
            rule = "the name of a zone or a cell X,Y, =, and a flow, as north=1.6/s or 3,4=0.5"
            raise click.UsageError(f"{_name_of(param)} must be {rule}, not {value!r}", ctx)
        numbers = [_whole(part) for part in place.split(",")]
        where = [tuple(numbers)] if len(numbers) == 2 and None not in numbers else place
        return where, super().convert(flow, param, ctx)


class Amount(click.ParamType):  # type: ignore[type-arg]
    """A number from 0 to `most`."""

    def __init__(self, name: str, most: float) -> None:
        self.name, self.most = name, most
        self.rule = f"a number from 0 to {most:g}"

    def holds(self, number: float) -> bool:
        """Tell whether the number is one of these."""
        return 0 <= number <= self.most

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number."""
        try:
            number = float(value)
        except ValueError:
            number = -1.0
        if not self.holds(number):
            raise click.UsageError(f"{_name_of(param)} must be {self.rule}, not {value!r}", ctx)
        return number


class Share(Amount):
    """A number from 0 to 1."""

    def __init__(self) -> None:
        super().__init__("share", 1)


class Positive(Amount):
    """A number above 0."""

    def __init__(self, name: str) -> None:
        super().__init__(name, 1e9)
        self.rule = "a number above 0"

    def holds(self, number: float) -> bool:
        """Tell whether the number is one of these."""
        return 0 < number < self.most


class Metres(Positive):
    """A length above 0."""

    def __init__(self) -> None:
        super().__init__("metres")


class Seconds(Positive):
    """A duration above 0."""

    def __init__(self) -> None:
        super().__init__("seconds")


class Pair(click.ParamType):  # type: ignore[type-arg]
    """Two whole numbers, as in ``118,120``."""

    name = "pair"

    def __init__(self, what: str) -> None:
        self.what = what

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:
        """Show what the numbers mean."""
        return self.what

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, int]:
        """Return the two numbers."""
        numbers = [_whole(part) for part in str(value).split(",")]
        if len(numbers) != 2 or None in numbers:
            raise click.UsageError(f"{_name_of(param)} must be {self.what}, two whole numbers, not {value!r}", ctx)
        return numbers[0], numbers[1]  # type: ignore[return-value]


class Place(Pair):
    """A cell, as in ``118,120``, or a point in metres, as in ``3.2,-1m``."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return two whole numbers, or two floats for a point in metres."""
        text = str(value)
        if not text.endswith("m"):
            return super().convert(value, param, ctx)
        try:
            x, y = (float(part.removesuffix("m")) for part in text.split(","))
        except ValueError:
            raise click.UsageError(
                f"{_name_of(param)} in metres must be X,Ym, such as 3.2,-1m, not {value!r}", ctx
            ) from None
        return x, y


def _name_of(param: click.Parameter | None) -> str:
    if param is None:
        return "it"
    return max(param.opts, key=len) if param.param_type_name == "option" else (param.name or "it").upper()


def _whole(text: str) -> int | None:
    try:
        return int(text) if len(text) <= 20 else None
    except ValueError:
        return None
