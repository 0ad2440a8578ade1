"""Record: the base of all records, frozen, with read-only arrays, equality by value and one line of words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from html import escape
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

_MOST_ITEMS, _MOST_LETTERS = 8, 200  # beyond which values are cut short in text
Scalar = TypeVar("Scalar", bound=np.generic)


def read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a view of `array` that cannot be written to."""
    view = array.view()
    view.flags.writeable = False
    return view


class Record:
    """Base of frozen dataclasses (declare them with ``frozen=True, eq=False``).

    As text they are one line, whatever they hold.

    Two records are equal when they are of one class and all fields are equal, arrays element by element.
    Derived values are cached properties; they and fields declared so take no part in the comparison.
    """

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(
            _is_same(getattr(self, f.name), getattr(other, f.name))
            for f in fields(self)  # type: ignore[arg-type]
            if f.compare
        )

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        if "__repr__" not in cls.__dict__:
            cls.__repr__ = Record.__repr__  # type: ignore[method-assign]  # lest dataclasses put theirs there

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.in_words()})"

    def in_words(self) -> str:
        """Return what the record is, in a line without its class."""
        return ", ".join(f"{f.name}={short(getattr(self, f.name))}" for f in fields(self) if f.repr)  # type: ignore[arg-type]

    __hash__ = None  # type: ignore[assignment]

    def _set(self, name: str, value: Any) -> None:
        """Set a field of a frozen record; for `__post_init__` only."""
        object.__setattr__(self, name, value)


def short(value: Any) -> str:
    """Return a value as text of one line: long arrays and sequences by what they are.

    Examples
    --------
    >>> short(np.arange(3)), short(np.zeros((9, 7))), short("place"), short((1,) * 50)
    ('[0, 1, 2]', '<float64, 9 x 7>', "'place'", '<50 items>')
    """
    if isinstance(value, np.ndarray):
        if value.size <= _MOST_ITEMS:
            return str(value.tolist())
        return f"<{value.dtype}, {' x '.join(map(str, value.shape))}>"
    if isinstance(value, list | tuple | dict | set | frozenset) and len(value) > _MOST_ITEMS:
        return f"<{len(value)} items>"
    text = f"{value!r}".replace("\n", " ")
    return text if len(text) <= _MOST_LETTERS else f"{text[:_MOST_LETTERS]}..."


def in_one_line(value: Any) -> str:
    """Return a named tuple as text of one line, for its ``__repr__``."""
    return f"{type(value).__name__}({', '.join(f'{name}={short(getattr(value, name))}' for name in value._fields)})"


def counted(number: int, one: str, many: str = "") -> str:
    """Return a number and what is counted: "1 robot", "2 robots"."""
    return f"{number} {one if number == 1 else many or one + 's'}"


def html_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return rows of plain values as an HTML table, for notebooks; one row is written downwards."""
    if len(rows) == 1:
        body = "".join(f"<tr><th>{_cell(key)}</th><td>{_cell(value)}</td></tr>" for key, value in rows[0].items())
        return f"<table>{body}</table>"
    head = "".join(f"<th>{_cell(key)}</th>" for key in (rows[0] if rows else ()))
    body = "".join(f"<tr>{''.join(f'<td>{_cell(value)}</td>' for value in row.values())}</tr>" for row in rows)
    return f"<table><tr>{head}</tr>{body}</table>"


def _cell(value: Any) -> str:
    return escape("" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value))


def _is_same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return one is other or bool(np.array_equal(one, other))
    return bool(one == other)
