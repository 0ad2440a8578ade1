"""Places: cells as users name them, by (x, y) or by number; the one rule for all of the API (docs/conventions.md)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import AreaError, TrihexError

if TYPE_CHECKING:
    from trihex.areas.area import Area

_RULE = "pairs of integers (x, y), one such pair, or cell numbers in a list or a flat array"


def cells_from(area: Area, places: Any, parameter: str, error: type[TrihexError]) -> NDArray[np.int64]:
    """Return the cell numbers of `places`, shape (n,).

    Parameters
    ----------
    area : Area
    places : one place, pairs, or numbers
        A tuple of two integers is one place (x, y). A sequence of pairs or an array of shape (n, 2) are places. An
        integer, a list, set or range of integers, or a flat array are numbers of cells.
    parameter : str
        What they are for, for messages.
    error : type
        What is raised if they are none of these, or lie outside `area`.
    """
    return _cells_from(area, places, parameter, f"{parameter}: ", error)


def _cells_from(area: Area, places: Any, parameter: str, where: str, error: type[TrihexError]) -> NDArray[np.int64]:
    """As `cells_from`; messages about cells outside begin with `where`."""
    array = _array_from(places, parameter, error)
    if array.size == 0 and array.ndim < 3:
        return np.empty(0, dtype=np.int64)
    if not np.issubdtype(array.dtype, np.integer) or array.ndim > 2 or (array.ndim == 2 and array.shape[1] != 2):
        raise error(f"{parameter} must be {_RULE}, not {_words(places)}{_hint(array)}")
    if array.ndim == 2:
        try:
            return area.xy_to_cell(array[:, 0], array[:, 1])
        except AreaError as outside:
            raise error(f"{where}{outside}") from None
    return _within(area, array.reshape(-1), where, error)


def numbers_from(area: Area, cells: Any, parameter: str = "cell", error: type[TrihexError] = AreaError) -> Any:
    """Return the cell numbers of `cells`, in the shape asked for: one place or number gives an array of no axes.

    As `cells_from`, but arrays of more axes are numbers, too, such as those of each robot at each step. One of shape
    (n, 2) might be either and is refused.
    """
    if isinstance(cells, np.ndarray) and np.issubdtype(cells.dtype, np.integer):
        if cells.ndim == 2 and cells.shape[1] == 2:
            raise error(
                f"{parameter} might be pairs (x, y) or numbers of cells, an array of shape {cells.shape}: "
                "area.xy_to_cell(x, y) makes numbers of pairs, .reshape(-1) says that they are numbers"
            )
        return _within(area, cells, "", error)
    found = _cells_from(area, cells, parameter, "", error)
    return found.reshape(()) if _is_whole(cells) or _is_place(cells) else found


def _array_from(places: Any, parameter: str, error: type[TrihexError]) -> NDArray[Any]:
    """Return `places` as an array: two axes for pairs, one for numbers; of objects if they make no array."""
    if isinstance(places, np.ndarray):
        return places
    if isinstance(places, tuple) and places:
        if _is_place(places):
            return np.array([[int(places[0]), int(places[1])]], dtype=np.int64)
        if all(_is_whole(own) for own in places):
            raise error(
                f"{parameter}: {_words(places)} is no place (x, y), which has two numbers; cell numbers are to be in a "
                "list or an array"
            )
        if len(places) == 2 and all(isinstance(own, np.ndarray) and own.ndim == 1 for own in places):
            raise error(
                f"{parameter} might be two places or all x and all y, a tuple of two arrays: "
                "area.xy_to_cell(x, y) makes numbers of x and y, a list of the two arrays says that they are places"
            )
    if isinstance(places, Iterable) and not isinstance(places, str | Mapping):
        places = list(places)
    try:
        return np.asarray(places)
    except ValueError:  # ragged
        return np.empty((0, 0, 0), dtype=object)


def _is_whole(value: Any) -> bool:
    is_array = isinstance(value, np.ndarray) and value.ndim == 0 and np.issubdtype(value.dtype, np.integer)
    return is_array or (isinstance(value, Integral) and not isinstance(value, bool))


def _is_place(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and all(_is_whole(own) for own in value)


def _within(area: Area, numbers: NDArray[Any], where: str, error: type[TrihexError]) -> NDArray[np.int64]:
    cells = np.asarray(numbers, dtype=np.int64)
    if cells.size and (cells.min() < 0 or cells.max() >= area.cell_count):
        worst = int(cells[(cells < 0) | (cells >= area.cell_count)].flat[0])
        hint = "; -1 stands for robots that are not in the area: leave them out, cells[cells >= 0]" * (worst == -1)
        raise error(f"{where}cell number {worst} lies outside the area of {area.cell_count} cells{hint}")
    return cells


def _words(places: Any) -> str:
    if isinstance(places, np.ndarray):
        return f"an array of {places.dtype} of shape {places.shape}"
    return f"{places!r:.80}".splitlines()[0]


def _hint(array: NDArray[Any]) -> str:
    if array.dtype == bool:
        return ": np.flatnonzero(mask) makes numbers of a mask"
    return ": .astype(int) makes integers" if np.issubdtype(array.dtype, np.floating) else ""
