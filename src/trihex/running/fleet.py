"""Fleet: where each robot is, and what has become of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, cells_from
from trihex.errors import ExecutionError, is_whole
from trihex.kernels.codes import NOT_REACHED, UNDERWAY, WAIT
from trihex.running.claims import Claims
from trihex.running.run import ARRIVED, BROKEN, GOING, LEFT


class Fleet:
    """The robots of a scenario, and those that join them.

    Parameters
    ----------
    scenario : Scenario

    Attributes
    ----------
    tick : int
        Steps, or ticks where moves last longer, that are done.
    site, came_from : int32 arrays
        Of each robot, where it is or is about to be, or was last, and where it was before its last move, -1 if it has
        made none.
    due, heading, enters : int32, uint8 and bool arrays
        Where moves last several ticks, or nobody follows before a cell is left: the tick at which the last move of each
        robot ends, its direction, and whether it leads into what was a destination when it began or became one since.
    state : uint8 array
        `GOING`, `ARRIVED`, `LEFT` or `BROKEN` for each robot.
    occupied : uint8 array
        1 for each site where a robot is that is going, or that it enters; destinations that it enters are not occupied.
    claims : Claims
        What robots own beside.

    Examples
    --------
    >>> from trihex import Area, make_n_scheme
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0)])
    >>> fleet = Fleet(scenario)
    >>> fleet.move(np.array([1], dtype=np.uint8), make_n_scheme(scenario).distance_of_site)
    >>> fleet.cell_of_robot.tolist()
    [1]
    """

    def __init__(self, scenario: Scenario) -> None:
        self.area, self.layout = scenario.area, scenario.area.layout
        self.site = self.layout.cell_to_site(scenario.robots)
        self.came_from = np.full(self.site.size, -1, dtype=np.int32)
        self.state = np.zeros(self.site.size, dtype=np.uint8)
        self.tick, self.claims = 0, Claims(scenario)
        self._start_times = scenario.start_times
        self._set_at_centres()
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

    @property
    def start_times_left(self) -> NDArray[np.int64]:
        """After how many steps from now each robot may begin to move; 0 for those that joined."""
        left = np.zeros(self.size, dtype=np.int64)
        left[: self._start_times.size] = np.maximum(self._start_times - self.tick, 0)
        return left

    def check_going(self, robot: int) -> None:
        """Raise ExecutionError unless there is such a robot and it is on its way."""
        if not is_whole(robot) or not 0 <= robot < self.size:
            raise ExecutionError(f"robot must be one of 0..{self.size - 1}, not {robot}")
        if self.state[robot] != GOING:
            words = {ARRIVED: "has arrived", LEFT: "has left", BROKEN: "has broken down"}
            raise ExecutionError(f"robot {robot} is not on its way: it {words[int(self.state[robot])]}")

    def _set_at_centres(self) -> None:
        """Let no robot be under way."""
        self.due = np.zeros(self.size, dtype=np.int32)
        self.heading = np.full(self.size, WAIT, dtype=np.uint8)
        self.enters = np.zeros(self.size, dtype=bool)

    @property
    def is_under_way(self) -> NDArray[np.bool_]:
        """Whether each robot is between two centres."""
        if not self.claims.is_timed:
            return np.zeros(self.size, dtype=bool)
        return np.asarray(self.is_going & (self.due > self.tick))

    @property
    def is_leaving(self) -> NDArray[np.bool_]:
        """Whether each robot is under way and still owns the cell that it leaves."""
        return np.asarray(self.is_under_way & (self.claims.left_at(self.heading, self.due) > 2 * self.tick))

    @property
    def cells_owned(self) -> NDArray[np.int64]:
        """The cell in which each robot stands or which it enters, and that which it leaves, shape (2, robots).

        -1 where there is none: for robots that are not in the area, and in the second row for those at a centre.
        """
        left = np.where(self.is_leaving, self.layout.site_to_cell(self.came_from), -1)
        return np.stack([self.cell_of_robot, left])

    def idle_actions(self) -> NDArray[np.uint8]:
        """Return the action of each robot if none begins a move."""
        action = np.full(self.size, WAIT, dtype=np.uint8)
        action[self.is_under_way] = UNDERWAY
        return action

    def words_of_owner(self, cell: int) -> str:
        """Return who owns a cell, and how, in words; nothing if nobody does."""
        owners = np.argwhere(self.cells_owned == cell)
        if not owners.size:
            return ""
        row, robot = owners[0].tolist()
        verb = "leaves" if row else "enters" if self.is_under_way[robot] else "stands at"
        return f"robot {robot} {verb} {self.area.name_of_cell(cell)}"

    def check_empty(self, cells: NDArray[np.int64]) -> None:
        """Raise ExecutionError if a robot owns one of `cells`, where barriers are to be."""
        for cell in cells[self._is_owned(self.layout.cell_to_site(cells))].tolist():
            raise ExecutionError(f"a barrier must not appear on a robot: {self.words_of_owner(cell)}")

    def _is_owned(self, sites: NDArray[np.int32]) -> NDArray[np.bool_]:
        """Tell in which sites a robot on its way stands, which it enters or which it leaves."""
        return np.asarray((self.occupied[sites] == 1) | (self.claims.left_until[sites] > 2 * self.tick))

    def join(self, cell: tuple[int, int] | int, blocked: NDArray[np.bool_]) -> int:
        """Add a robot and return its number; raises ExecutionError if its cell is blocked or a robot's."""
        (number,) = self._one(cell, "robot")
        (site,) = self.layout.cell_to_site(np.array([number]))
        if blocked[site]:
            raise ExecutionError(
                f"a robot must join on a free cell; {self.area.name_of_cell(int(number))} is a barrier"
            )
        if self._is_owned(site):
            raise ExecutionError(f"a robot must join on an empty cell; {self.words_of_owner(int(number))}")
        self.site = np.append(self.site, site)
        self.came_from = np.append(self.came_from, np.int32(-1))
        self.state = np.append(self.state, np.uint8(GOING))
        self.due = np.append(self.due, np.int32(0))
        self.heading = np.append(self.heading, np.uint8(WAIT))
        self.enters = np.append(self.enters, np.False_)
        self.occupied[site] = 1
        return self.size - 1

    def end(self, robot: int, state: int) -> None:
        """Let a robot be on its way no longer, but `LEFT` or `BROKEN`; raises ExecutionError if it is not going.

        Who leaves owns nothing any more; who breaks down is taken to end its move.
        """
        self.check_going(robot)
        self._vacate(np.array([robot]))
        if state == LEFT:
            self._release(robot)
        elif self.is_under_way[robot]:
            self.claims.left_until[self.site[robot]] = 2 * self.due[robot]
        self.state[robot] = state

    def cells_blocked_by(self, robot: int) -> NDArray[np.int64]:
        """Return the cells that a robot blocks if it breaks down now; raises ExecutionError if it is not going.

        Where others follow at once, somebody may be on the way already into the cell that it leaves; so there it comes
        to rest at the centre of the cell that it enters, and blocks that alone.

        Raises
        ------
        ExecutionError
            If it enters a destination, where nothing can block.
        """
        self.check_going(robot)
        entered, left = self.cells_owned[:, robot].tolist()
        if self.enters[robot] and self.is_under_way[robot]:
            where = self.area.name_of_cell(entered)
            raise ExecutionError(f"robot {robot} cannot break down while it enters the destination {where}")
        return np.array([entered] if left < 0 or self.claims.follows else [entered, left], dtype=np.int64)

    def _release(self, robot: int) -> None:
        """Take back what a robot owns beside its cell, if it is under way; it then is at a centre."""
        if self.is_under_way[robot]:
            own = (int(array[robot]) for array in (self.came_from, self.heading, self.site, self.due))
            self.claims.release(*own, is_leaving=bool(self.is_leaving[robot]), enters=bool(self.enters[robot]))
        self.due[robot], self.enters[robot] = 0, False

    def place(self, cell_of_robot: Mapping[int, tuple[int, int] | int], blocked: NDArray[np.bool_]) -> None:
        """Put robots elsewhere; raises ExecutionError, and changes nothing, if a robot cannot be there."""
        for robot in cell_of_robot:
            self.check_going(robot)
        robots = np.array(list(cell_of_robot), dtype=np.int64)
        cells = [self._one(cell, f"place of robot {robot}") for robot, cell in cell_of_robot.items()]
        sites = self.layout.cell_to_site(np.concatenate([np.empty(0, dtype=np.int64), *cells]))
        others = self.cells_owned[:, np.setdiff1d(self.going, robots)].reshape(-1)
        taken = np.unique(np.append(self.layout.site_to_cell(sites), others[others >= 0]))
        if blocked[sites].any() or taken.size < sites.size + np.unique(others[others >= 0]).size:
            raise ExecutionError("robots must be on distinct free cells")
        self._vacate(robots)
        for robot in robots:
            self._release(int(robot))
        self.site[robots], self.came_from[robots] = sites, -1
        self.occupied[sites] = 1

    def move(self, action_of_robot: NDArray[np.uint8], distance_of_site: NDArray[np.int32]) -> None:
        """Let robots begin moves, unchecked; what is no direction counts as waiting."""
        movers = np.flatnonzero(action_of_robot < UNDERWAY)
        site, heading = self.site[movers], action_of_robot[movers]
        self.occupied[site] = 0
        self.came_from[movers] = site
        self.site[movers] += self.layout.offset_of_direction[site & 1, heading]
        self.occupied[self.site[movers]] = 1
        if self.claims.is_timed:
            self.due[movers] = self.tick + self.claims.duration[heading]
            self.heading[movers], self.enters[movers] = heading, False
            self.claims.take(site, heading, self.due[movers])
            self.meet(distance_of_site)

    def meet(self, distance_of_site: NDArray[np.int32]) -> None:
        """Let those enter a destination who are on the way into what is one now.

        Who enters a destination that has closed arrives all the same; until then nobody else may come into that cell.
        """
        if not self.claims.is_timed:
            return
        under_way, distance = self.is_under_way, distance_of_site[self.site]
        for robot in np.flatnonzero(under_way & ~self.enters & (distance == 0)).tolist():
            self.enters[robot] = True
            self.occupied[self.site[robot]] = 0
            self.claims.enter(int(self.site[robot]), int(self.due[robot]))
        shut = np.flatnonzero(under_way & self.enters & (distance > 0))
        np.maximum.at(self.claims.left_until, self.site[shut], 2 * self.due[shut])

    def arrive(self, robots: NDArray[np.integer], distance_of_site: NDArray[np.int32]) -> None:
        """Let those of `robots` arrive that are at a destination, or at the end of the way into one."""
        is_here = distance_of_site[self.site[robots]] == 0
        if self.claims.is_timed:
            is_here = (is_here | self.enters[robots]) & (self.due[robots] <= self.tick)
        here = robots[is_here]
        if here.size:
            self.state[here] = ARRIVED
            self._vacate(here)

    def _vacate(self, robots: NDArray[np.integer]) -> None:
        """Let robots occupy their cells no longer; in that of one that enters a destination others may be by now."""
        self.occupied[self.site[robots[~self.enters[robots]]]] = 0

    def is_able(self, distance_of_site: NDArray[np.int32]) -> NDArray[np.bool_]:
        """Return whether each robot can arrive, or is on its way into what was a destination."""
        reaches = (distance_of_site[self.site] != NOT_REACHED) | self.enters
        return np.asarray(self.is_going & reaches)

    def as_arrays(self) -> dict[str, NDArray[Any]]:
        """Return all that is known of the robots, by name; see `restore`."""
        arrays = {name: getattr(self, name).copy() for name in ("came_from", "state", "due", "heading", "enters")}
        return {"robots": self.layout.site_to_cell(self.site), "steps_done": np.array(self.tick), **arrays}

    def restore(self, arrays: Mapping[str, NDArray[Any]], distance_of_site: NDArray[np.int32]) -> None:
        """Let the robots be as `as_arrays` told, in a world with these distances."""
        self.site, self.tick = self.layout.cell_to_site(arrays["robots"]), int(arrays["steps_done"])
        for name in ("came_from", "state", "due", "heading", "enters"):
            setattr(self, name, arrays[name].copy())
        self.occupied[:] = 0
        self.occupied[self.site[self.is_going & ~self.enters]] = 1
        self.claims.clear()
        moving = np.flatnonzero((self.due > self.tick) & (self.is_going | (self.state == BROKEN)))
        moving = moving[np.argsort(self.due[moving], kind="stable")]
        self.claims.take(self.came_from[moving], self.heading[moving], self.due[moving])
        for robot in moving.tolist():
            if self.state[robot] == BROKEN:
                self.claims.left_until[self.site[robot]] = 2 * self.due[robot]
            elif self.enters[robot]:
                self.claims.enter(int(self.site[robot]), int(self.due[robot]))
        self.meet(distance_of_site)

    def _one(self, cell: Any, parameter: str) -> NDArray[np.int64]:
        """Return the number of the one cell that is named, shape (1,)."""
        cells = cells_from(self.area, cell, parameter, ExecutionError)
        if cells.size != 1:
            raise ExecutionError(f"{parameter} must be one cell, not {cells.size}")
        return cells
