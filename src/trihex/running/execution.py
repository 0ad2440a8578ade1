"""Execution: one safe move for each robot, step by step, in a world that may change before the next step."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Scenario, cells_from
from trihex.errors import ExecutionError, check_choice
from trihex.fields import LivingField, NScheme, Repair, make_n_scheme
from trihex.kernels.codes import LATE, NOT_REACHED, WAIT
from trihex.planners import PLANNERS
from trihex.record import read_only
from trihex.running.replanning import Guide
from trihex.running.run import ARRIVED, BROKEN, GOING, LEFT

STEPPERS = ("greedy", "fcost")
ASIDE = ("never", "worth", "always")


class Orders(NamedTuple):
    """What the robots are to do in one step.

    Attributes
    ----------
    step : int
        The number of the step, from 1.
    action_of_robot : uint8 array
        A direction of the tessellation, or `WAIT` (255).
    cell_of_robot : int64 array
        Number of the cell after the step; -1 for robots that are not in the area any more, the destination for those
        that arrive in this step.
    """

    step: int
    action_of_robot: NDArray[np.uint8]
    cell_of_robot: NDArray[np.int64]


class Execution:
    """Robots on their way through a world that changes, driven step by step by a controller, a game or a simulation.

    It knows the world as it has been told; `observe` tells it of barriers and destinations, `step` returns one move for
    each robot and takes it as made. No orders, given together, break a rule of the scenario in the world as known.
    All is a function of what was told, in the order told: the same calls give the same moves.

    Parameters
    ----------
    scenario : Scenario
        The world as known at the beginning, with the robots and the rules.
    planner : str
        "fcost" or "greedy": by the least Fcost of the paper, or down the distance. Whoever of the robots that can act
        is nearest to a destination always comes nearer, so in a world that changes no more all arrive that can. Any
        other planner makes plans, as under `replan`.
    aside : {"always", "worth", "never"}
        For "fcost": when a robot that had better wait steps to a cell no farther than its own.
    replan : bool
        Whether to make a plan whenever the world has changed, and to keep to its order, see `PassingOrder`. While there
        is none in time, or more than 2 % of the robots are late, they go on step by step, "greedy" if that is the
        planner, else by "fcost".
    budget : float, optional
        Seconds that a plan may take; the moves then depend on the speed of the machine. Default: as long as it takes.
    n_scheme : NScheme, optional
        That of the scenario, if it is at hand.

    Raises
    ------
    ExecutionError
        If there is no such planner.

    Examples
    --------
    >>> from trihex import Area
    >>> scenario = Scenario(Area("square", [[0, 0, 0], [0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0), (1, 0)])
    >>> execution = Execution(scenario)
    >>> execution.step().cell_of_robot.tolist()
    [1, 2]
    >>> execution.observe(blocked=[(2, 1)]).touched
    1
    >>> execution.step().cell_of_robot.tolist(), execution.is_over
    ([2, -1], True)
    """

    def __init__(
        self,
        scenario: Scenario,
        planner: str = "fcost",
        *,
        aside: str = "always",
        replan: bool = False,
        budget: float | None = None,
        n_scheme: NScheme | None = None,
    ) -> None:
        check_choice("planner of an execution", planner, dict.fromkeys((*STEPPERS, *PLANNERS)), ExecutionError)
        self.guide = Guide(planner, budget) if replan or planner not in STEPPERS else None
        check_choice("aside", aside, ASIDE, ExecutionError)
        n_scheme = make_n_scheme(scenario) if n_scheme is None else n_scheme
        self.scenario, self.planner, self.aside = scenario, planner, aside
        self.field = LivingField(scenario, n_scheme.distance_of_site)
        layout, robots = scenario.area.layout, scenario.robot_count
        self._site = layout.cell_to_site(scenario.robots)
        self._came_from = np.full(robots, -1, dtype=np.int32)
        self._state = np.zeros(robots, dtype=np.uint8)
        self._occupied = np.zeros(layout.size, dtype=np.uint8)
        self._occupied[self._site] = 1
        self._seen, self._branch, self._steps, self._passed, self._entered_step, self._entered_count = (
            np.zeros(layout.size, dtype=np.int32) for _ in range(6)
        )
        self._version = 1
        #: Number of steps done.
        self.steps_done = 0
        self._arrive_on_the_spot()
        # Compiled code is loaded now, not in the first step, for which a robot may be waiting.
        self.field.change()
        self._act(self._site[:0], np.empty(0, dtype=np.uint8))

    @property
    def state_of_robot(self) -> NDArray[np.uint8]:
        """`GOING`, `ARRIVED`, `LEFT` or `BROKEN` for each robot."""
        return self._state.copy()

    @property
    def cell_of_robot(self) -> NDArray[np.int64]:
        """Number of the cell of each robot, -1 for those that are not in the area any more."""
        cells = self.scenario.area.layout.site_to_cell(self._site)
        return np.where((self._state == GOING) | (self._state == BROKEN), cells, -1)

    @property
    def site_of_robot(self) -> NDArray[np.int32]:
        """Site of each robot, where it was last."""
        return self._site.copy()

    @property
    def cut_off_robots(self) -> NDArray[np.int64]:
        """Robots that still go, but cannot arrive in the world as known; ascending."""
        return np.flatnonzero((self._state == GOING) & (self.field.distance_of_site[self._site] == NOT_REACHED))

    @property
    def is_over(self) -> bool:
        """Whether no robot can arrive any more unless the world changes."""
        return not self._can_go().any()

    def _can_go(self) -> NDArray[np.bool_]:
        return np.asarray((self._state == GOING) & (self.field.distance_of_site[self._site] != NOT_REACHED))

    def observe(
        self, *, blocked: ArrayLike = (), freed: ArrayLike = (), opened: ArrayLike = (), closed: ArrayLike = ()
    ) -> Repair:
        """Take note of a change of the world, and repair the field; parameters as for `LivingField.change`.

        A robot that stands where a destination opens has arrived.

        Raises
        ------
        ExecutionError
            If a robot stands in a cell that is to be blocked; nothing has changed then.
        ScenarioError
            As `LivingField.change`.
        """
        area = self.scenario.area
        sites = area.layout.cell_to_site(cells_from(area, blocked, "blocked", ExecutionError))
        taken = sites[self._occupied[sites] == 1]
        if taken.size:
            robot = int(np.flatnonzero((self._site == taken[0]) & (self._state == GOING))[0])
            where = area.name_of_cell(int(area.layout.site_to_cell(taken[:1])[0]))
            raise ExecutionError(f"a barrier must not appear on a robot: robot {robot} stands at {where}")
        repair = self.field.change(blocked=blocked, freed=freed, opened=opened, closed=closed)
        if repair.sites.size:
            self._version += 1
            self._forget_plan()
        self._arrive_on_the_spot()
        return repair

    def _arrive_on_the_spot(self) -> None:
        here = np.flatnonzero((self._state == GOING) & (self.field.distance_of_site[self._site] == 0))
        self._state[here] = ARRIVED
        self._occupied[self._site[here]] = 0

    def join(self, cell: tuple[int, int] | int) -> int:
        """Let a robot appear in a cell, and return its number.

        Raises
        ------
        ExecutionError
            If the cell is a barrier or holds a robot.
        """
        area = self.scenario.area
        cells = cells_from(area, np.array([cell], dtype=np.int64), "robot", ExecutionError)
        site, where = area.layout.cell_to_site(cells), area.name_of_cell(int(cells[0]))
        if self.field.blocked[site[0]]:
            raise ExecutionError(f"a robot must join on a free cell; {where} is a barrier")
        if self._occupied[site[0]]:
            robot = int(np.flatnonzero((self._site == site[0]) & (self._state == GOING))[0])
            raise ExecutionError(f"a robot must join on an empty cell; robot {robot} stands at {where}")
        self._forget_plan()
        self._site = np.append(self._site, site)
        self._came_from = np.append(self._came_from, np.int32(-1))
        self._state = np.append(self._state, np.uint8(GOING))
        self._occupied[site] = 1
        self._arrive_on_the_spot()
        return self._site.size - 1

    def leave(self, robot: int) -> None:
        """Take a robot out of the area; raises ExecutionError if it is not on its way."""
        self.check_going(robot)
        self._forget_plan()
        self._state[robot] = LEFT
        self._occupied[self._site[robot]] = 0

    def break_down(self, robot: int) -> Repair:
        """Let a robot stay for ever where it is, a barrier to all others; raises ExecutionError if it is not going."""
        self.check_going(robot)
        self._state[robot] = BROKEN
        self._occupied[self._site[robot]] = 0
        return self.observe(blocked=self.scenario.area.layout.site_to_cell(self._site[robot : robot + 1]))

    def check_going(self, robot: int) -> None:
        """Raise ExecutionError unless there is such a robot and it is on its way."""
        if not 0 <= robot < self._state.size:
            raise ExecutionError(f"robot must be one of 0..{self._state.size - 1}, not {robot}")
        if self._state[robot] != GOING:
            words = {ARRIVED: "has arrived", LEFT: "has left", BROKEN: "has broken down"}
            raise ExecutionError(f"robot {robot} is not on its way: it {words[int(self._state[robot])]}")

    def place(self, cell_of_robot: dict[int, tuple[int, int] | int]) -> None:
        """Correct where robots are that are not where they were sent; ExecutionError if a robot cannot be there."""
        area, layout = self.scenario.area, self.scenario.area.layout
        for robot in cell_of_robot:
            self.check_going(robot)
        robots = np.array(list(cell_of_robot), dtype=np.int64)
        cells = cells_from(area, np.array(list(cell_of_robot.values())), "place", ExecutionError)
        sites = layout.cell_to_site(cells)
        others = self._site[np.setdiff1d(np.flatnonzero(self._state == GOING), robots)]
        if self.field.blocked[sites].any() or np.unique(np.append(sites, others)).size < sites.size + others.size:
            raise ExecutionError("robots must be on distinct free cells")
        self._forget_plan()
        self._occupied[self._site[robots]] = 0
        self._site[robots], self._came_from[robots] = sites, -1
        self._occupied[sites] = 1
        self._arrive_on_the_spot()

    def step(self, late: Iterable[int] = ()) -> Orders:
        """Return a move for each robot, and take it as made.

        Parameters
        ----------
        late : numbers of robots, optional
            Who cannot move in this step; the others keep clear of them.

        Raises
        ------
        ExecutionError
            If there is no such robot.
        """
        is_late = np.zeros(self._state.size, dtype=bool)
        numbers = np.fromiter(late, dtype=np.int64)
        if numbers.size and (numbers.min() < 0 or numbers.max() >= is_late.size):
            wrong = int(numbers[(numbers < 0) | (numbers >= is_late.size)][0])
            raise ExecutionError(f"late must name robots 0..{is_late.size - 1}, not {wrong}")
        is_late[numbers] = True
        if self.guide is not None and not self.is_over:
            planned = self.guide.step(self.steps_done + 1, self._world, is_late)
            if planned is not None:
                return self._follow(*planned)
        acts = self._can_go() & ~is_late
        going = np.flatnonzero(acts).astype(np.int32)
        order = going[np.argsort(self.field.distance_of_site[self._site[going]], kind="stable")]
        action = np.full(self._state.size, WAIT, dtype=np.uint8)
        self.steps_done += 1
        if order.size:
            self._act(order, action)
        cells = self.cell_of_robot
        self._state[going[self.field.distance_of_site[self._site[going]] == 0]] = ARRIVED
        return Orders(self.steps_done, action, cells)

    def take(self, action_of_robot: NDArray[np.uint8]) -> None:
        """Do a step with given actions in place of its own; what is no direction counts as waiting. Nothing is checked.

        For who records what robots did and wants to go on from there.
        """
        self._forget_plan()
        self._take(action_of_robot)

    def _forget_plan(self) -> None:
        if self.guide is not None:
            self.guide.forget()

    def _follow(self, robots: NDArray[np.int64], actions: NDArray[np.uint8]) -> Orders:
        action = np.full(self._state.size, WAIT, dtype=np.uint8)
        action[robots] = actions
        there = self._state == GOING
        self._take(action)
        cells = self.scenario.area.layout.site_to_cell(self._site)
        return Orders(self.steps_done, action, np.where(there | (self._state == BROKEN), cells, -1))

    def _world(self) -> tuple[NScheme, NDArray[np.int64]]:
        """Return the N-scheme of the world as known with the robots where they are, and their numbers."""
        robots, field, area = np.flatnonzero(self._state == GOING), self.field, self.scenario.area
        scenario = replace(
            self.scenario,
            area=replace(area, barriers=field.barriers),
            destinations=np.array(sorted(field.destinations), dtype=np.int64),
            robots=area.layout.site_to_cell(self._site[robots]),
        )
        object.__setattr__(scenario, "moves", read_only(field.moves.copy()))  # the cached property, known already
        return NScheme(scenario, read_only(field.distance_of_site.copy())), robots

    def _take(self, action_of_robot: NDArray[np.uint8]) -> None:
        layout, movers = self.scenario.area.layout, np.flatnonzero(action_of_robot < LATE)
        site = self._site[movers]
        self._occupied[site] = 0
        self._came_from[movers] = site
        self._site[movers] += layout.offset_of_direction[site & 1, action_of_robot[movers]]
        arrived = movers[self.field.distance_of_site[self._site[movers]] == 0]
        self._state[arrived] = ARRIVED
        self._occupied[self._site[movers]] = 1
        self._occupied[self._site[arrived]] = 0
        self.steps_done += 1

    def _act(self, order: NDArray[np.int32], action: NDArray[np.uint8]) -> None:
        from trihex.running.kernels import stepping as kernels

        scenario, field = self.scenario, self.field
        layout, tessellation = scenario.area.layout, scenario.area.tessellation
        cost = tessellation.cost_of_direction
        table = (field.distance_of_site, field.moves, layout.offset_of_direction, cost)
        forest = (self._version, self._seen, self._branch, self._steps)
        slot_of_line, line, lines = np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64), 0
        if self.planner != "greedy":
            slots = np.empty(order.size, dtype=np.int64)
            kernels.find_slots(self._site[order], *table, *forest, slots)
            slots.sort()
            slot_of_line, line = np.empty_like(slots), np.empty_like(slots)
            lines = kernels.line_up(slots, slot_of_line, line)
        forbids = scenario.crossing == "forbid"
        rules = [
            kernels.GREEDY if self.planner == "greedy" else kernels.FCOST,
            ASIDE.index(self.aside),
            scenario.waiting_cost,
            tessellation.edge_count if forbids else tessellation.direction_count,
            scenario.destination_capacity or 0,
            self.steps_done,
        ]
        kernels.act(
            np.array(rules, dtype=np.int64),
            order,
            *table,
            layout.vertex_of_direction,
            *forest,
            lines,
            slot_of_line,
            line,
            self._site,
            self._came_from,
            self._occupied,
            self._passed,
            self._entered_step,
            self._entered_count,
            action,
        )

    def state(self) -> dict[str, NDArray[Any]]:
        """Return all that has been told and done, as arrays by name; see `restore`."""
        return {
            "robots": self.scenario.area.layout.site_to_cell(self._site),
            "came_from": self._came_from.copy(),
            "state": self._state.copy(),
            "barriers": self.field.barriers.copy(),
            "destinations": np.array(sorted(self.field.destinations), dtype=np.int64),
            "steps_done": np.array(self.steps_done),
        }

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go back, or forward, to a `state` of an execution of the same scenario; the same moves follow."""
        self._forget_plan()
        now, wanted = self.field.destinations, set(state["destinations"].tolist())
        self._state, self._site = np.empty(0, dtype=np.uint8), np.empty(0, dtype=np.int32)
        self._occupied[:] = 0
        self.observe(
            blocked=np.flatnonzero(state["barriers"] & ~self.field.barriers),
            freed=np.flatnonzero(~state["barriers"] & self.field.barriers),
            opened=np.array(sorted(wanted - now), dtype=np.int64),
            closed=np.array(sorted(now - wanted), dtype=np.int64),
        )
        self._site = self.scenario.area.layout.cell_to_site(state["robots"])
        self._came_from, self._state = state["came_from"].copy(), state["state"].copy()
        self._occupied[self._site[self._state == GOING]] = 1
        for stamps in (self._passed, self._entered_step):
            stamps[:] = 0
        self.steps_done = int(state["steps_done"])
