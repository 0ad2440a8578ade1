"""Run: what robots did in a world that changed, or that they did not know, step by step."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, World, check_as_fast, count_by_zone
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.plans import Motion
from trihex.record import counted, read_only
from trihex.running.events import Occurrence
from trihex.running.sensing import Sensor

# What has become of a robot.
GOING, ARRIVED, LEFT, BROKEN = range(4)


@dataclass(frozen=True, eq=False)
class Run(Motion):
    """What happened, from which all else follows.

    Parameters
    ----------
    scenario : Scenario
        The world as it was at the beginning, and the robots that were there.
    planner : str
    sensor : Sensor or None
        None if robots knew everything.
    delay : float
        Share of the robots that were late in each step, by chance.
    seed : int
    occurrences : tuple of Occurrence
        What became of each event that came up, in order.
    robots : int64 array
        The first cell of each robot, those that joined at the end.
    joined, ended : int64 arrays
        The step after which each robot was in the area, and after which it was not any more, -1 if it still is. It acts
        in the steps from ``joined + 1`` to ``ended``.
    state_of_robot : uint8 array
        `GOING`, `ARRIVED`, `LEFT` or `BROKEN`.
    actions : uint8 array, shape (steps, robots)
        A direction in the step in which a move begins, `UNDERWAY` in those in which it goes on, `WAIT` or `LATE`;
        `WAIT` for robots that are not there.
    known_since : int32 array, shape (height, width)
        The step in which a robot first saw each cell, 0 before the first step, or when it was last told of a change;
        -1 where none did.
    cut_off_since : int64 array
        For robots that were still going at the end but could not arrive: the step in which that was known; -1 for all
        others.
    touched : int64 array, shape (steps, 2)
        Repairs of the field in each step, and the cells that they touched.
    """

    scenario: Scenario
    planner: str
    sensor: Sensor | None
    delay: float
    seed: int
    occurrences: tuple[Occurrence, ...]
    robots: NDArray[np.int64]
    joined: NDArray[np.int64]
    ended: NDArray[np.int64]
    state_of_robot: NDArray[np.uint8]
    actions: NDArray[np.uint8]
    known_since: NDArray[np.int32]
    cut_off_since: NDArray[np.int64]
    touched: NDArray[np.int64]

    def __post_init__(self) -> None:
        check_as_fast(self.scenario, "a run")
        for name in ("robots", "joined", "ended", "state_of_robot", "actions", "known_since", "cut_off_since"):
            self._set(name, read_only(getattr(self, name)))
        self._set("touched", read_only(self.touched))

    def in_words(self) -> str:
        """Return the planner, the area, how many robots arrived, steps, total time and events."""
        arrived = f"{np.count_nonzero(self.arrived)} of {counted(self.robots.size, 'robot')} arrived"
        times = (
            f"{counted(self.steps, 'step')}, total time {self.total_time}, {counted(len(self.occurrences), 'event')}"
        )
        return f"{self.planner!r}, {self.scenario.area.in_words()}, {arrived}, {times}"

    @property
    def steps(self) -> int:
        """Number of steps."""
        return len(self.actions)

    @property
    def arrived(self) -> NDArray[np.bool_]:
        """Whether each robot arrived."""
        return np.asarray(self.state_of_robot == ARRIVED)

    @cached_property
    def _acts(self) -> NDArray[np.bool_]:
        """Whether each robot was there in each step, shape (steps, robots)."""
        step = np.arange(1, self.steps + 1)[:, None]
        return (step > self.joined) & ((step <= self.ended) | (self.ended < 0))

    @cached_property
    def distance_of_robot(self) -> NDArray[np.int64]:
        """d_r, the cost of the moves of each robot."""
        cost = np.zeros(256, dtype=np.int64)
        table = self.scenario.area.tessellation.cost_of_direction
        cost[: table.size] = table
        return np.array([cost[own].sum() for own in self.actions.T], dtype=np.int64)

    @cached_property
    def waiting_of_robot(self) -> NDArray[np.int64]:
        """w_r, the number of steps in which each robot stood, late or not, times w_t."""
        stood = (self.actions == WAIT) | (self.actions == LATE)
        return np.asarray((stood & self._acts).sum(axis=0) * self.scenario.waiting_cost)

    @property
    def time_of_robot(self) -> NDArray[np.int64]:
        """F_t, the list of t_r = d_r + w_r."""
        return self.distance_of_robot + self.waiting_of_robot

    @cached_property
    def last_cell_of_robot(self) -> NDArray[np.int64]:
        """Number of the cell in which each robot was last: its destination, if it arrived."""
        *_, site = self._sites_by_step()
        return read_only(self.scenario.area.layout.site_to_cell(site))

    def actions_in(self, step: int) -> NDArray[np.uint8]:
        """Return what each robot did in step 1, 2, ...: a direction, `WAIT` or `LATE`."""
        return np.asarray(self.actions[step - 1])

    @property
    def arrivals_of_exit(self) -> dict[str, int]:
        """How many robots arrived in each zone of the area, by its name."""
        layout = self.scenario.area.layout
        *_, site = self._sites_by_step()
        return count_by_zone(self.scenario.exit_zones, layout.site_to_cell(site[self.arrived]))

    def cells_by_step(self) -> Iterator[NDArray[np.int64]]:
        """Yield the cell of each robot after step 0, 1, ..., `steps`; -1 where it is not in the area.

        A robot that is under way, where moves last longer than a step, is in the cell whose centre it left.
        """
        for step, site in enumerate(self._sites_by_step()):
            is_there = (step >= self.joined) & ((step < self.ended) | (self.ended < 0))
            yield np.where(is_there, self.scenario.area.layout.site_to_cell(site), -1)

    def _sites_by_step(self) -> Iterator[NDArray[np.int32]]:
        """Yield the site whose centre each robot was at last, be it there or not; one array, changed in place."""
        layout, duration = self.scenario.area.layout, self.scenario.duration_of_direction
        site = layout.cell_to_site(self.robots)
        target, due = site.copy(), np.zeros(site.size, dtype=np.int64)
        yield site
        for step, action in enumerate(self.actions, 1):
            moves = np.flatnonzero(action < UNDERWAY)
            target[moves] += layout.offset_of_direction[target[moves] & 1, action[moves]]
            due[moves] = step - 1 + duration[action[moves]]
            np.copyto(site, target, where=due == step)
            yield site

    def worlds(self) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.int64]]]:
        """Yield barriers (height, width) and destinations in step 1, 2, ..., `steps`; do not write to them."""
        return self._worlds(self.steps)

    @property
    def last_world(self) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
        """Barriers (height, width) and destinations after all that has happened, even if no step has followed."""
        return deque(self._worlds(self.steps + 1), 1).pop()

    def _worlds(self, steps: int) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.int64]]]:
        world, due = World(self.scenario), deque(one for one in self.occurrences if one.is_accepted)
        barriers, destinations = world.barriers.copy(), world.destination_cells
        for step in range(1, steps + 1):
            is_new = due and due[0].event.step <= step
            while due and due[0].event.step <= step:
                world.change(**due.popleft().changes)
            if is_new:
                barriers, destinations = world.barriers.copy(), world.destination_cells
            yield barriers, destinations
