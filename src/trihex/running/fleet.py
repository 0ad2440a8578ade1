"""Fleet: where each robot is, and what has become of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, cells_from
from trihex.errors import ExecutionError, is_whole
from trihex.kernels.codes import LATE
from trihex.running.run import ARRIVED, BROKEN, GOING, LEFT


class Fleet:
    """The robots of a scenario, and those that join them.

    Parameters
    ----------
    scenario : Scenario

    Attributes
    ----------
    site, came_from : int32 arrays
        Of each robot, where it is, or was last, and where it was before its last move, -1 if it has made none.
    state : uint8 array
        `GOING`, `ARRIVED`, `LEFT` or `BROKEN` for each robot.
    occupied : uint8 array
        1 for each site where a robot is that is going.

    Examples
    --------
    >>> from trihex import Area
    >>> fleet = Fleet(Scenario(Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0)]))
    >>> fleet.move(np.array([1], dtype=np.uint8))
    >>> fleet.cell_of_robot.tolist()
    [1]
    """

    def __init__(self, scenario: Scenario) -> None:
        self.area, self.layout = scenario.area, scenario.area.layout
        self.site = self.layout.cell_to_site(scenario.robots)
        self.came_from = np.full(self.site.size, -1, dtype=np.int32)
        self.state = np.zeros(self.site.size, dtype=np.uint8)
        self.occupied = np.zeros(self.layout.size, dtype=np.uint8)
        self.occupied[self.site] = 1

    @property
    def size(self) -> int:
        """Number of robots, whatever has become of them."""
        return int(self.site.size)

    @property
    def is_going(self) -> NDArray[np.bool_]:
        """Whether each robot is on its way."""
        return np.asarray(self.state == GOING)

    @property
    def going(self) -> NDArray[np.int64]:
        """Robots that are on their way, ascending."""
        return np.flatnonzero(self.is_going)

    @property
    def cell_of_robot(self) -> NDArray[np.int64]:
        """Number of the cell of each robot, -1 for those that are not in the area any more."""
        return np.where(self.is_going | (self.state == BROKEN), self.layout.site_to_cell(self.site), -1)

    def check_going(self, robot: int) -> None:
        """Raise ExecutionError unless there is such a robot and it is on its way."""
        if not is_whole(robot) or not 0 <= robot < self.size:
            raise ExecutionError(f"robot must be one of 0..{self.size - 1}, not {robot}")
        if self.state[robot] != GOING:
            words = {ARRIVED: "has arrived", LEFT: "has left", BROKEN: "has broken down"}
            raise ExecutionError(f"robot {robot} is not on its way: it {words[int(self.state[robot])]}")

    def check_empty(self, sites: NDArray[np.int32]) -> None:
        """Raise ExecutionError if a robot stands at one of `sites`, where barriers are to be."""
        taken = sites[self.occupied[sites] == 1]
        if taken.size:
            robot, where = self._robot_at(taken[0]), self._name_of(taken[0])
            raise ExecutionError(f"a barrier must not appear on a robot: robot {robot} stands at {where}")

    def join(self, cell: tuple[int, int] | int, blocked: NDArray[np.bool_]) -> int:
        """Add a robot and return its number; raises ExecutionError if its cell is blocked or holds a robot."""
        (site,) = self.layout.cell_to_site(self._one(cell, "robot"))
        if blocked[site]:
            raise ExecutionError(f"a robot must join on a free cell; {self._name_of(site)} is a barrier")
        if self.occupied[site]:
            robot, where = self._robot_at(site), self._name_of(site)
            raise ExecutionError(f"a robot must join on an empty cell; robot {robot} stands at {where}")
        self.site = np.append(self.site, site)
        self.came_from = np.append(self.came_from, np.int32(-1))
        self.state = np.append(self.state, np.uint8(GOING))
        self.occupied[site] = 1
        return self.size - 1

    def end(self, robot: int, state: int) -> None:
        """Let a robot be on its way no longer, but `LEFT` or `BROKEN`; raises ExecutionError if it is not going."""
        self.check_going(robot)
        self.state[robot] = state
        self.occupied[self.site[robot]] = 0

    def place(self, cell_of_robot: Mapping[int, tuple[int, int] | int], blocked: NDArray[np.bool_]) -> None:
        """Put robots elsewhere; raises ExecutionError, and changes nothing, if a robot cannot be there."""
        for robot in cell_of_robot:
            self.check_going(robot)
        robots = np.array(list(cell_of_robot), dtype=np.int64)
        cells = [self._one(cell, f"place of robot {robot}") for robot, cell in cell_of_robot.items()]
        sites = self.layout.cell_to_site(np.concatenate([np.empty(0, dtype=np.int64), *cells]))
        others = self.site[np.setdiff1d(self.going, robots)]
        if blocked[sites].any() or np.unique(np.append(sites, others)).size < sites.size + others.size:
            raise ExecutionError("robots must be on distinct free cells")
        self.occupied[self.site[robots]] = 0
        self.site[robots], self.came_from[robots] = sites, -1
        self.occupied[sites] = 1

    def move(self, action_of_robot: NDArray[np.uint8]) -> None:
        """Let robots make moves, unchecked; what is no direction counts as waiting."""
        movers = np.flatnonzero(action_of_robot < LATE)
        site = self.site[movers]
        self.occupied[site] = 0
        self.came_from[movers] = site
        self.site[movers] += self.layout.offset_of_direction[site & 1, action_of_robot[movers]]
        self.occupied[self.site[movers]] = 1

    def arrive(self, robots: NDArray[np.integer], distance_of_site: NDArray[np.int32]) -> None:
        """Let those of `robots` arrive that are at a destination."""
        here = robots[distance_of_site[self.site[robots]] == 0]
        if here.size:
            self.state[here] = ARRIVED
            self.occupied[self.site[here]] = 0

    def as_arrays(self) -> dict[str, NDArray[Any]]:
        """Return all that is known of the robots, by name; see `restore`."""
        cells = self.layout.site_to_cell(self.site)
        return {"robots": cells, "came_from": self.came_from.copy(), "state": self.state.copy()}

    def restore(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Let the robots be as `as_arrays` told."""
        self.site = self.layout.cell_to_site(arrays["robots"])
        self.came_from, self.state = arrays["came_from"].copy(), arrays["state"].copy()
        self.occupied[:] = 0
        self.occupied[self.site[self.is_going]] = 1

    def _robot_at(self, site: np.int32) -> int:
        """Return the robot that stands at a site which is occupied."""
        return int(np.flatnonzero((self.site == site) & self.is_going)[0])

    def _one(self, cell: Any, parameter: str) -> NDArray[np.int64]:
        """Return the number of the one cell that is named, shape (1,)."""
        cells = cells_from(self.area, cell, parameter, ExecutionError)
        if cells.size != 1:
            raise ExecutionError(f"{parameter} must be one cell, not {cells.size}")
        return cells

    def _name_of(self, site: np.int32) -> str:
        return self.area.name_of_cell(int(self.layout.site_to_cell(np.array([site]))[0]))
