"""Draft: what a file says of a scenario, with all else left open."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.area import Area
from trihex.errors import ScenarioError
from trihex.record import Record
from trihex.scenario import Scenario, random_robots


@dataclass(frozen=True, eq=False)
class Draft(Record):
    """A scenario in the making: an area, and whatever else its file holds; None stands for what it does not.

    Attributes
    ----------
    area : Area
    destinations, robots : int64 arrays of shape (n,), optional
        Cell numbers.
    random_count : int, optional
        How many robots to draw by `seed`, instead of `robots`.
    seed : int, optional
    waiting_cost, destination_capacity : int, optional
    crossing, corners : str, optional
    planner : str, optional
    planner_options : dict
    """

    area: Area
    destinations: NDArray[np.int64] | None = None
    robots: NDArray[np.int64] | None = None
    random_count: int | None = None
    seed: int | None = None
    waiting_cost: int | None = None
    crossing: str | None = None
    corners: str | None = None
    destination_capacity: int | None = None
    planner: str | None = None
    planner_options: dict[str, Any] = field(default_factory=dict)

    def complete(self) -> Scenario:
        """Return the scenario; what is still open takes its default.

        Raises
        ------
        ScenarioError
            If there is no destination, or the parts do not fit.
        """
        destinations = () if self.destinations is None else self.destinations
        if len(destinations) == 0:
            raise ScenarioError("destinations must name at least one cell")
        robots = self.robots
        if self.random_count is not None:
            robots = random_robots(self.area, self.random_count, self.seed or 0, avoid=destinations)
        rules = {"crossing": self.crossing, "corners": self.corners}
        return Scenario(
            self.area,
            destinations,  # type: ignore[arg-type]
            () if robots is None else robots,  # type: ignore[arg-type]
            waiting_cost=self.waiting_cost,  # type: ignore[arg-type]
            destination_capacity=self.destination_capacity,
            seed=self.seed if self.seed is not None or self.random_count is None else 0,
            **{name: rule for name, rule in rules.items() if rule is not None},
        )


def draft_of(scenario: Scenario) -> Draft:
    """Return the draft that completes to `scenario`; a waiting cost like that of an edge stays so if costs change."""
    names = ("destinations", "robots", "seed", "crossing", "corners", "destination_capacity")
    waiting_cost = None if scenario.waiting_cost == scenario.area.tessellation.edge_cost else scenario.waiting_cost
    return Draft(scenario.area, waiting_cost=waiting_cost, **{name: getattr(scenario, name) for name in names})
