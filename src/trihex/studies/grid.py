"""Grid: all combinations of the entries of some axes, or a random sample of them, none of them stored."""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import product
from math import prod
from typing import Any, overload

from trihex.errors import StudyError

MOST_RUNS = 10**8
_MOST_COMBINATIONS = 2**62

Axis = Sequence[Any]


def variants_of(table: dict[str, Any], fixed: tuple[str, ...] = ()) -> list[dict[str, Any]]:
    """Return the combinations of the lists in a table; those of keys in `fixed` are values themselves.

    Examples
    --------
    >>> variants_of({"count": [1, 2], "placement": ["west"]})
    [{'count': 1, 'placement': 'west'}, {'count': 2, 'placement': 'west'}]
    """
    lists = [value if isinstance(value, list) and key not in fixed else [value] for key, value in table.items()]
    return [dict(zip(table, values, strict=True)) for values in product(*lists)]


class Grid(Sequence[dict[str, Any]]):
    """The combinations of axes, the last axis changing fastest.

    Parameters
    ----------
    axes : dict of sequences
        The entries of each axis.
    sample, sample_seed : int, optional
        How many combinations to draw; they keep the order of the grid. Default: all.

    Raises
    ------
    StudyError
        If there are more combinations than a study can have.

    Examples
    --------
    >>> list(Grid({"robots": [10, 20], "seed": [0, 1]}))[1]
    {'robots': 10, 'seed': 1}
    >>> len(Grid({"robots": range(1000), "seed": range(1000)}, sample=5))
    5
    """

    def __init__(self, axes: dict[str, Axis], sample: int | None = None, sample_seed: int = 0) -> None:
        self.axes = axes
        self.size = prod(len(axis) for axis in axes.values())
        if self.size > _MOST_COMBINATIONS:
            raise StudyError(f"a study may have at most {_MOST_COMBINATIONS} combinations, not {self.size}")
        self.chosen: Sequence[int] = range(self.size)
        if sample is not None and sample < self.size:
            if sample > MOST_RUNS:
                raise StudyError(f"sample must be at most {MOST_RUNS}, not {sample}")
            self.chosen = sorted(random.Random(sample_seed).sample(range(self.size), sample))
        if len(self.chosen) > MOST_RUNS:
            raise StudyError(f"a study may have at most {MOST_RUNS} runs, not {self.size}; draw some with sample = N")

    def __len__(self) -> int:
        return len(self.chosen)

    @overload
    def __getitem__(self, index: int) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[dict[str, Any]]: ...
    def __getitem__(self, index: int | slice) -> dict[str, Any] | Sequence[dict[str, Any]]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        rest, entries = self.chosen[index], []
        for axis in reversed(self.axes.values()):
            rest, at = divmod(rest, len(axis))
            entries.append(axis[at])
        return dict(zip(self.axes, reversed(entries), strict=True))
