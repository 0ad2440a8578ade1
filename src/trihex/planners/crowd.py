"""Crowd: the robots that are under way, region by region, as the kernels that simulate them want them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.fields import NScheme
from trihex.kernels.codes import NOT_REACHED

# Steps of a block: as many as there are bits for the steps in which a vertex is passed. Robot-steps between two looks
# at the keyboard: a few hundredths of a second.
MOST_STEPS = 32
BUDGET = 1_000_000
_TILE = 64


@dataclass(eq=False)
class Crowd:
    """Robots under way, numbered from 1 by region and, within a region, by distance; 0 is nobody.

    Made by `make_crowd`; kernels change its arrays.
    """

    scenario: Scenario
    #: Number in the scenario, and start, of each robot; entry 0 is unused.
    robot: NDArray[np.int32]
    site_of_robot: NDArray[np.int32]
    #: What all ways cost from the starts, and the waits until robots may begin to move: no plan takes less.
    total_distance: int
    #: Each region's part of `listed`: the robots that have not arrived.
    first_of_region: NDArray[np.int64]
    count_of_region: NDArray[np.int64]
    listed: NDArray[np.int32]

    def __post_init__(self) -> None:
        size, layout = self.robot.size, self.scenario.area.layout
        enters = layout.size if self.scenario.entry_limit else 1
        #: The step in which each robot arrives, 0 until then.
        self.arrival = np.zeros(size, dtype=np.int64)
        self.robot_at = np.zeros(layout.size, dtype=np.int32)
        self.robot_at[self.site_of_robot] = np.arange(size)
        #: For each lattice vertex in which steps of which block it was passed; and of each site when and by how many
        #: robots it was last entered.
        self.passed = np.zeros(layout.size if self.scenario.forbids_crossing else 1, dtype=np.int64)
        self.entered_step, self.entered_count = np.zeros(enters, dtype=np.int32), np.zeros(enters, dtype=np.int32)

    @property
    def start_time(self) -> NDArray[np.int64]:
        """After how many steps each robot may begin to move."""
        return np.append(0, self.scenario.start_times[self.robot[1:]])

    @cached_property
    def slowness(self) -> NDArray[np.int32]:
        """How many times as long as those of the fastest the moves of each robot last."""
        return np.append(1, self.scenario.slowness[self.robot[1:]]).astype(np.int32)

    @property
    def going(self) -> int:
        """How many robots are still under way."""
        return int(self.count_of_region.sum())

    def for_kernels(self) -> tuple[Any, Any]:
        """Return `Traffic` and `Robots` as kernels know them."""
        from trihex.kernels.signatures import given
        from trihex.planners.kernels.robots import Robots
        from trihex.planners.kernels.traffic import Traffic

        traffic = given(
            Traffic,
            robot_at=self.robot_at,
            passed=self.passed,
            entered_step=self.entered_step,
            entered_count=self.entered_count,
        )
        robots = given(
            Robots,
            first_of_region=self.first_of_region,
            count_of_region=self.count_of_region,
            listed=self.listed,
            site=self.site_of_robot,
            arrival=self.arrival,
        )
        return traffic, robots

    def parts(self, steps: int) -> list[NDArray[np.int64]]:
        """Part the regions that hold robots so that `steps` steps of each part are one call of a kernel."""
        regions = np.flatnonzero(self.count_of_region)
        if regions.size == 0:
            return []
        so_far = np.cumsum(self.count_of_region[regions]) * steps
        return np.split(regions, np.flatnonzero(np.diff(so_far // BUDGET)) + 1)

    def steps_of_block(self) -> int:
        """Return how many steps to simulate at a time."""
        largest = int(self.count_of_region.max(initial=1))
        return int(min(MOST_STEPS, max(1, 4 * BUDGET // largest)))


def regions_of(scenario: Scenario, at_once: bool = False) -> NDArray[np.int64]:
    """Return the region, from 0 without gaps, of each destination: a tile of the area, or all of it."""
    if at_once:
        return np.zeros(scenario.destinations.size, dtype=np.int64)
    y, x = scenario.destinations // scenario.area.width, scenario.destinations % scenario.area.width
    _, region = np.unique(np.stack([y // _TILE, x // _TILE]), axis=1, return_inverse=True)
    return region.reshape(-1).astype(np.int64)


def count_going(n_scheme: NScheme) -> int:
    """Return how many robots of a scenario have a way before them."""
    distance = n_scheme.distance_of_cell(n_scheme.scenario.robots)
    return int(np.count_nonzero((distance != NOT_REACHED) & (distance != 0)))


def make_crowd(n_scheme: NScheme, find_regions: Callable[[NDArray[np.int32]], NDArray[np.int64]]) -> Crowd:
    """Return the crowd of a scenario; ``find_regions(starts)`` tells the region of each start."""
    scenario = n_scheme.scenario
    site = scenario.area.layout.cell_to_site(scenario.robots)
    distance = n_scheme.distance_of_site[site]
    robot = np.flatnonzero((distance != NOT_REACHED) & (distance != 0))
    # In the order of their sites: neighbours' ways share cells, which makes finding regions three times as fast.
    robot = robot[np.argsort(site[robot])]
    region = find_regions(site[robot])
    order = _sorted_by(region, _sorted_by(distance[robot], np.arange(robot.size)))
    robot, region = robot[order], region[order]
    ways = int((distance[robot] * scenario.slowness[robot]).sum())
    count = np.bincount(region, minlength=1)
    return Crowd(
        scenario,
        np.append(0, robot).astype(np.int32),
        np.append(0, site[robot]).astype(np.int32),
        ways + scenario.waiting_cost * int(scenario.start_times[robot].sum()),
        np.cumsum(count) - count,
        count.astype(np.int64),
        np.arange(1, robot.size + 1, dtype=np.int32),
    )


def _sorted_by(values: NDArray[Any], order: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return `order` sorted by the values, all below 2^31, of what it lists; what is equal stays in order.

    A tenth of the time of numpy's stable sorts: it sorts numbers that hold the value and the place at once.
    """
    keys = values[order].astype(np.int64) << 31 | np.arange(order.size)
    keys.sort()
    return np.asarray(order[keys & 0x7FFFFFFF])


def make_ways(scenario: Scenario) -> Any:
    """Return `Ways` as kernels know them: the moves of a scenario, and its rules."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels.ways import ROW, Ways

    layout, tessellation = scenario.area.layout, scenario.area.tessellation
    offset, vertex, back = np.zeros((3, 2, 1 << ROW), dtype=np.int32)
    for wide, table in (
        (offset, layout.offset_of_direction),
        (vertex, layout.vertex_of_direction),
        (back, layout.back_of_direction),
    ):
        wide[:, : tessellation.direction_count] = table
    return given(
        Ways,
        offset=offset.reshape(-1),
        vertex=vertex.reshape(-1),
        back=back.reshape(-1),
        cost=tessellation.cost_of_direction,
        waiting_cost=scenario.waiting_cost,
        count=tessellation.direction_count,
        first_vertex_move=scenario.first_vertex_move,
        entry_limit=scenario.entry_limit,
    )
