"""Record: the base of all records, frozen, with read-only arrays and equality by value."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Scalar = TypeVar("Scalar", bound=np.generic)


def read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a view of `array` that cannot be written to."""
    view = array.view()
    view.flags.writeable = False
    return view


class Record:
    """Base of frozen dataclasses (declare them with ``frozen=True, eq=False``).

    Two records are equal when they are of one class and all fields are equal, arrays element by element.
    Derived values are cached properties; they take no part in the comparison.
    """

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(_is_same(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))  # type: ignore[arg-type]

    __hash__ = None  # type: ignore[assignment]

    def _set(self, name: str, value: Any) -> None:
        """Set a field of a frozen record; for `__post_init__` only."""
        object.__setattr__(self, name, value)


def _is_same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return one is other or bool(np.array_equal(one, other))
    return bool(one == other)
