"""Zone: cells of an area that have a name, such as an exit."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.errors import AreaError
from trihex.record import Record, read_only

MAX_NAME = 200
NAME_RULE = f"a line of 1 to {MAX_NAME} characters"
_WRONG = re.compile("[\\x00-\\x1f\\x7f-\\x9f\\ud800-\\udfff\\ufffe\\uffff\\u2028\\u2029]")


@dataclass(frozen=True, eq=False)
class Zone(Record):
    """Cells that have a name.

    Parameters
    ----------
    name : str
        A line of text.
    cells : int64 array
        Their numbers; kept ascending, each once.

    Raises
    ------
    AreaError
        If the name is no line of text, or too long.

    Examples
    --------
    >>> Zone("north door", [5, 4, 5]).cells.tolist()
    [4, 5]
    """

    name: str
    cells: NDArray[np.int64]

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not is_name(self.name):
            raise AreaError(f"name of a zone must be {NAME_RULE}, not {self.name!r:.80}")
        self._set("cells", read_only(np.unique(np.asarray(self.cells, dtype=np.int64))))


def is_name(text: str) -> bool:
    """Tell whether zones and doors may be called so: `NAME_RULE`."""
    return bool(text.strip()) and len(text) <= MAX_NAME and not _WRONG.search(text)


def count_by_zone(zones: Iterable[Zone], cells: NDArray[np.int64]) -> dict[str, int]:
    """Return how many of some cells, such as those in which robots arrive, lie in each zone, by its name."""
    return {zone.name: int(np.isin(cells, zone.cells).sum()) for zone in zones}


def zones_from(given: Iterable[Zone], cell_count: int) -> tuple[Zone, ...]:
    """Return zones, those of one name as one; raise AreaError if one lies outside an area of so many cells."""
    cells: dict[str, list[NDArray[np.int64]]] = {}
    for zone in given:
        if zone.cells.size and not 0 <= zone.cells[0] <= zone.cells[-1] < cell_count:
            raise AreaError(
                f"zone {zone.name!r:.80} must have cells 0..{cell_count - 1}, not {zone.cells.tolist()!s:.80}"
            )
        cells.setdefault(zone.name, []).append(zone.cells)
    return tuple(Zone(name, np.concatenate(own)) for name, own in cells.items())
