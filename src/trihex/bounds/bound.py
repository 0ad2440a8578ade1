"""Bound: a number that no plan can beat."""

from __future__ import annotations

from dataclasses import dataclass

from trihex.record import Record


@dataclass(frozen=True, eq=False)
class LowerBound(Record):
    """A total time that no plan can beat.

    Parameters
    ----------
    name : str
        How it was found: "distance", "slot", ... or "optimum" where a plan proves that it can be attained.
    value : int
    """

    name: str
    value: int
