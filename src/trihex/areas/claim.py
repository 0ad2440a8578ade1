"""Claim: a scenario as the file of a plan claims it, for the judge alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from trihex.areas.scenario import Scenario
from trihex.errors import ScenarioError


@dataclass(frozen=True, eq=False)
class Claim(Scenario):
    """A scenario in which robots and destinations may stand on barriers, and robots in one cell.

    The judge finds fault with it at step 0. Nobody plans for it.
    """

    def _check_free(self, cells: NDArray[np.int64], one: str) -> None:
        """Leave it to the judge."""

    def _check_distinct(self) -> None:
        """Leave it to the judge."""


def claimed(make: Callable[[type[Scenario]], Scenario]) -> Scenario:
    """Return the scenario that `make` makes, or the claim where its places are impossible.

    Raises
    ------
    ScenarioError
        If something else is wrong with it.
    """
    try:
        return make(Scenario)
    except ScenarioError:
        return make(Claim)


def check_possible(scenario: Scenario) -> None:
    """Raise ScenarioError if the scenario is a claim, as it would have been raised if it were none."""
    if isinstance(scenario, Claim):
        Scenario(**{field.name: getattr(scenario, field.name) for field in fields(scenario)})
