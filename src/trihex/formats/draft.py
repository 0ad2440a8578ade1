"""Draft: what a file says of a scenario, with all else left open."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import (
    Area,
    Door,
    Scenario,
    flow_from,
    is_door_of_zone,
    make_doors,
    random_robots,
    random_start_times,
    seconds_per_step,
    slowness_of,
    start_times_of,
)
from trihex.errors import ScenarioError
from trihex.record import Record


@dataclass(frozen=True, eq=False)
class Draft(Record):
    """A scenario in the making: an area, and whatever else its file holds; None stands for what it does not.

    Attributes
    ----------
    area : Area
    destinations, robots : int64 arrays of shape (n,), optional
        Cell numbers.
    start_times : int64 or float64 array of shape (n,), or str, optional
        Of the robots: steps if whole numbers, else as `start_times_of` takes them; or a distribution to draw them from
        by `seed`, as for `random_start_times`.
    slowness : int64 or float64 array of shape (n,), optional
        Of the robots: as `Scenario` takes it if whole numbers, else their speeds, in an area with a frame as parts of
        the `speed` in `outputs`; see `paced`.
    random_count : int, optional
        How many robots to draw by `seed`, instead of `robots`.
    seed : int, optional
    waiting_cost : int, optional
    destination_capacity : int, float, Fraction or str, optional
        A flow, as `Scenario` takes it.
    doors : tuple of pairs
        (name of a zone or places, flow), as `Scenario` takes them.
    crossing, corners, clock, following : str, optional
    planner : str, optional
    planner_options : dict
    outputs : dict
        What is to be written: paths of `plan`, `summary`, `picture`, `waypoints` and `certificate`; and of waypoints
        `speed`, `turn_time` and `frame_id`, as `write_waypoints` takes them.
    notes : tuple of str
        What was understood of a drawing, and what was not.
    """

    area: Area
    destinations: NDArray[np.int64] | None = None
    robots: NDArray[np.int64] | None = None
    random_count: int | None = None
    seed: int | None = None
    waiting_cost: int | None = None
    crossing: str | None = None
    corners: str | None = None
    destination_capacity: int | float | Fraction | str | None = None
    planner: str | None = None
    planner_options: dict[str, Any] = field(default_factory=dict)
    outputs: dict[str, Any] = field(default_factory=dict)
    clock: str | None = None
    following: str | None = None
    notes: tuple[str, ...] = ()
    doors: tuple[tuple[Any, Any], ...] = ()
    start_times: NDArray[Any] | str | None = None
    slowness: NDArray[Any] | None = None

    @property
    def has_start_times(self) -> bool:
        """Whether robots may not all begin to move at once."""
        times = self.start_times
        return isinstance(times, str) or (times is not None and bool(np.any(times)))

    @property
    def has_slowness(self) -> bool:
        """Whether some robots are slower than others may be."""
        return self.slowness is not None and bool(np.any(self.whole_slowness() > 1))

    def whole_slowness(self) -> NDArray[np.int64]:
        """Return the slowness of robots of which it is known, or their speeds are."""
        given = np.asarray(self.slowness)
        if given.dtype.kind != "f":
            return given
        return slowness_of(given, fastest=None if self.area.frame is None else self.outputs.get("speed"))

    def paced(self) -> Draft:
        """Return the same draft; in an area with a frame the `speed` of outputs, if there is none, is the highest."""
        given = self.slowness
        if given is None or given.dtype.kind != "f" or given.size == 0 or self.area.frame is None:
            return self
        return replace(self, outputs={"speed": float(given.max()), **self.outputs})

    def with_notes(self, notes: Iterable[str]) -> Draft:
        """Return the same draft with things that the reader of a file wants to be told."""
        return replace(self, notes=tuple(notes))

    def complete(self, kind: type[Scenario] = Scenario) -> Scenario:
        """Return the scenario, or the claim, for the judge; what is still open takes its default.

        Robots are drawn among the cells that reach a destination, or, where these are too few, among all free cells.

        Raises
        ------
        ScenarioError
            If there is no destination, or the parts do not fit.
        """
        destinations = () if self.destinations is None else self.destinations
        if len(destinations) == 0:
            raise ScenarioError("destinations must name at least one cell")
        names = ("crossing", "corners", "clock", "following")
        rules = {name: rule for name in names if (rule := getattr(self, name)) is not None}
        if self.has_slowness and self.area.frame is not None:
            rules.setdefault("following", "forbid")  # as is usual there
        capacity, doors = self.flows()
        scenario = kind(
            self.area,
            destinations,  # type: ignore[arg-type]
            () if self.robots is None else self.robots,  # type: ignore[arg-type]
            waiting_cost=self.waiting_cost,  # type: ignore[arg-type]
            destination_capacity=capacity,
            seed=self.seed,
            doors=doors,
            **rules,
        )
        if self.random_count is not None:
            seed = self.seed or 0
            scenario = scenario.with_robots(_draw(scenario, self.random_count, seed), seed)
        elif self.robots is None:
            return scenario
        if self.start_times is None and self.slowness is None:
            return scenario
        times = self.steps_of_starts(scenario.area, scenario.robot_count)
        slowness = scenario.slowness if self.slowness is None else self.whole_slowness()
        return replace(scenario, start_times=times, slowness=slowness)

    def steps_of_starts(self, area: Area, count: int) -> NDArray[np.int64]:
        """Return the start times of so many robots, in steps of the area."""
        given, pace = self.start_times, {n: v for n, v in self.outputs.items() if n in ("speed", "turn_time")}
        if given is None:
            return np.zeros(count, dtype=np.int64)
        if isinstance(given, str):
            return random_start_times(area, count, given, self.seed or 0, **pace)
        times = np.asarray(given)
        return start_times_of(area, times, **pace) if times.dtype.kind == "f" else times

    def flows(self) -> tuple[int | Fraction | None, tuple[Door, ...]]:
        """Return the capacity of destinations and the doors, by how long a step lasts as outputs say it."""
        area = self.area if self.clock is None else self.area.with_clock(self.clock)
        pace = {n: v for n, v in self.outputs.items() if n in ("speed", "turn_time")} if area.frame is not None else {}
        capacity = self.destination_capacity
        if capacity is not None:
            lasts = None if area.frame is None else seconds_per_step(area, **pace)
            capacity = flow_from("destination_capacity", capacity, area, lasts)
        return capacity, make_doors(area, self.doors, **pace)


def _draw(scenario: Scenario, count: int, seed: int) -> NDArray[np.int64]:
    """Return `count` cells for robots."""
    from trihex.fields import make_n_scheme
    from trihex.kernels.codes import NOT_REACHED

    # 1.7 % of the free cells of Berlin_1_256 are closed courtyards: 17 of 1000 robots drawn there could not arrive.
    apart = np.flatnonzero(make_n_scheme(scenario).distance.reshape(-1) == NOT_REACHED)
    avoid = np.union1d(apart, scenario.destinations)
    if count > scenario.area.cell_count - avoid.size:
        avoid = scenario.destinations
    return random_robots(scenario.area, count, seed, avoid=avoid)


def draft_of(scenario: Scenario) -> Draft:
    """Return the draft that completes to `scenario`; a waiting cost like that of an edge stays so if costs change."""
    names = ("destinations", "robots", "seed", "crossing", "corners", "destination_capacity", "clock", "following")
    waiting_cost = None if scenario.waiting_cost == scenario.area.tessellation.waiting_cost else scenario.waiting_cost
    doors = tuple(
        (door.name if is_door_of_zone(scenario.area, door) else door.cells.tolist(), door.flow)
        for door in scenario.doors
    )
    given = {name: getattr(scenario, name) for name in names}
    start_times = scenario.start_times if scenario.has_start_times else None
    slowness = scenario.slowness if scenario.has_slowness else None
    given |= {"start_times": start_times, "slowness": slowness}
    return Draft(scenario.area, waiting_cost=waiting_cost, doors=doors, **given)
