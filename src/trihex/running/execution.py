"""Execution: one safe move for each robot, step by step, in a world that may change before the next step."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Area, Scenario, cells_from, check_as_fast
from trihex.errors import ExecutionError, check_choice, check_many, check_number, check_type, is_whole
from trihex.fields import LivingField, NScheme, Repair, field_kernels, make_n_scheme
from trihex.kernels.codes import UNDERWAY
from trihex.kernels.preparing import prepare
from trihex.planners import PLANNERS
from trihex.record import read_only
from trihex.running.fleet import Fleet
from trihex.running.obstacles import Obstacles
from trihex.running.orders import Orders
from trihex.running.replanning import Replanner, check_followable
from trihex.running.run import BROKEN, LEFT
from trihex.running.stepping import ASIDE, STEPPERS, Stepper


class Execution:
    """Robots on their way through a world that changes, driven step by step by a controller, a game or a simulation.

    It knows the world as it has been told; `observe` tells it of barriers and destinations, `step` returns one move for
    each robot and takes it as made. No orders, given together, break a rule of the scenario in the world as known.
    Where moves last several ticks (``clock="costs"``) a step is a tick, and robots are told what to do when they are at
    the centre of a cell. All is a function of what was told, in the order told: the same calls give the same moves.

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
        check_type("scenario", scenario, Scenario)
        check_type("n_scheme", n_scheme, NScheme, type(None))
        check_as_fast(scenario, "an execution")
        check_choice("planner of an execution", planner, dict.fromkeys((*STEPPERS, *PLANNERS)), ExecutionError)
        if budget is not None:
            check_number("budget, in seconds,", budget, 0, float("inf"), ExecutionError)
        check_choice("aside", aside, ASIDE, ExecutionError)
        #: What makes plans; None where robots go step by step.
        self.replanner = Replanner(planner, budget) if replan or planner not in STEPPERS else None
        check_followable(scenario, planner, replan=replan)
        prepare("execution", field_kernels(scenario.area.tessellation, scenario.corners))
        n_scheme = make_n_scheme(scenario) if n_scheme is None else n_scheme
        self.scenario, self.planner, self.aside = scenario, planner, aside
        self.field = LivingField(scenario, n_scheme.distance_of_site)
        self.fleet = Fleet(scenario)
        self._stepper = Stepper(scenario, self.field, self.fleet, planner, aside)
        self._obstacles = Obstacles()
        self._arrive_on_the_spot()
        # Compiled code is loaded now, not in the first step, for which a robot may be waiting.
        self.field.change()
        nobody = np.empty(0, dtype=np.int32)
        self._stepper.step(nobody, nobody, self.fleet)

    @property
    def steps_done(self) -> int:
        """Number of steps done."""
        return self.fleet.tick

    @property
    def state_of_robot(self) -> NDArray[np.uint8]:
        """`GOING`, `ARRIVED`, `LEFT` or `BROKEN` for each robot."""
        return self.fleet.state.copy()

    @property
    def cell_of_robot(self) -> NDArray[np.int64]:
        """Number of the cell in which each robot is or which it enters, -1 for those not in the area any more."""
        return self.fleet.cell_of_robot

    @property
    def cells_owned(self) -> NDArray[np.int64]:
        """Cells in which robots are or which they enter, and those that they still leave, shape (2, robots); or -1."""
        return self.fleet.cells_owned

    @property
    def is_under_way(self) -> NDArray[np.bool_]:
        """Whether each robot is between two centres; never where a move lasts a step."""
        return self.fleet.is_under_way

    @property
    def site_of_robot(self) -> NDArray[np.int32]:
        """Site of each robot, where it was last."""
        return self.fleet.site.copy()

    @property
    def cut_off_robots(self) -> NDArray[np.int64]:
        """Robots that still go, but cannot arrive in the world as known; ascending."""
        return np.flatnonzero(self.fleet.is_going & ~self._can_go())

    @property
    def is_over(self) -> bool:
        """Whether no robot can arrive any more unless the world changes, and none is under way."""
        return not (self._can_go() | self.fleet.is_under_way).any()

    def _can_go(self) -> NDArray[np.bool_]:
        return self.fleet.is_able(self.field.distance_of_site)

    def observe(
        self,
        *,
        blocked: ArrayLike = (),
        freed: ArrayLike = (),
        opened: ArrayLike = (),
        closed: ArrayLike = (),
        obstacles: Iterable[Any] = (),
        gone: Iterable[Any] = (),
    ) -> Repair:
        """Take note of a change of the world, and repair the field.

        A robot that stands where a destination opens has arrived; one that is under way into the cell arrives at the
        end of its move. So does one that has begun to enter a destination that closes.

        Parameters
        ----------
        blocked, freed, opened, closed
            As for `LivingField.change`.
        obstacles : list of shapes in metres, optional
            What has come to stand in the world, each as for `Area.cells_touched`: the cells that it touches become
            barriers and their destinations close, but where robots stand; `obstructed_robots` are these. Tell it again
            when they have moved on.
        gone : the same
            Obstacles, told before, that stand there no more. Cells are free again in which nothing else stands.

        Raises
        ------
        ExecutionError
            If a robot stands in a cell of `blocked`, enters or leaves it; nothing has changed then.
        ScenarioError
            As `LivingField.change`.
        AreaError
            If a shape is invalid, or the area has no frame.
        """
        area = self.scenario.area
        told, cleared, closing = (
            cells_from(area, cells, name, ExecutionError)
            for cells, name in ((blocked, "blocked"), (freed, "freed"), (closed, "closed"))
        )
        self.fleet.check_empty(told)
        barred = told
        come, left = (_touched(area, shapes, name) for shapes, name in ((obstacles, "obstacles"), (gone, "gone")))
        for cells in left:
            walls = np.flatnonzero(area.barriers)
            free = np.setdiff1d(list(self._obstacles.take(cells.tolist())), walls).astype(np.int64)
            cleared = np.union1d(cleared, free[self.field.barriers.reshape(-1)[free]])
        if come:
            cells = np.setdiff1d(np.concatenate(come), self.fleet.cells_owned)
            barred = np.union1d(barred, cells[~self.field.barriers.reshape(-1)[cells]])
            cleared = np.setdiff1d(cleared, np.concatenate(come))
            closing = np.union1d(closing, np.intersect1d(cells, self.field.world.destination_cells))
        repair = self._change(blocked=barred, freed=cleared, opened=opened, closed=closing)
        self._obstacles.clear(cleared.tolist())
        for cells in come:
            self._obstacles.put(cells.tolist())
        self._obstacles.fill(told.tolist())
        self._arrive_on_the_spot()
        return repair

    @property
    def obstructed_robots(self) -> NDArray[np.int64]:
        """Robots on their way that stand where an obstacle does, in cells that are therefore no barriers; ascending."""
        going = self.fleet.going
        cells = np.array(sorted(self._obstacles.cells), dtype=np.int64)
        return np.asarray(going[np.isin(self.fleet.cells_owned[:, going], cells).any(axis=0)])

    def _change(self, **changes: ArrayLike) -> Repair:
        repair = self.field.change(**changes)
        if repair.sites.size:
            self._stepper.note_change()
            self._forget_plan()
        return repair

    def _arrive_on_the_spot(self) -> None:
        self.fleet.meet(self.field.distance_of_site)
        self.fleet.arrive(self.fleet.going, self.field.distance_of_site)

    def join(self, cell: tuple[int, int] | int) -> int:
        """Let a robot appear in a cell, and return its number.

        Raises
        ------
        ExecutionError
            If the cell is a barrier, or a robot is in it, enters or leaves it.
        """
        robot = self.fleet.join(cell, self.field.blocked)
        self._forget_plan()
        self._arrive_on_the_spot()
        return robot

    def leave(self, robot: int) -> None:
        """Take a robot out of the area, wherever it is; raises ExecutionError if it is not on its way."""
        self.fleet.end(robot, LEFT)
        self._forget_plan()

    def break_down(self, robot: int) -> Repair:
        """Let a robot stay for ever where it is, a barrier to all others.

        One that is under way blocks the cell that it enters, and with ``following="forbid"`` also that which it leaves.

        Raises
        ------
        ExecutionError
            If it is not going, or enters a destination.
        """
        cells = np.setdiff1d(self.fleet.cells_blocked_by(robot), self.field.world.destination_cells)
        self.fleet.end(robot, BROKEN)
        repair = self._change(blocked=cells)
        self._obstacles.fill(cells.tolist())
        self._arrive_on_the_spot()
        return repair

    def check_going(self, robot: int) -> None:
        """Raise ExecutionError unless there is such a robot and it is on its way."""
        self.fleet.check_going(robot)

    def place(self, cell_of_robot: dict[int, tuple[int, int] | int]) -> None:
        """Correct where robots are that are not where they were sent: at the centres of these cells.

        Raises
        ------
        ExecutionError
            If a robot cannot be there.
        """
        check_type("cell_of_robot", cell_of_robot, Mapping)
        self.fleet.place(cell_of_robot, self.field.blocked)
        self._forget_plan()
        self._arrive_on_the_spot()

    def step(self, late: Iterable[int] = ()) -> Orders:
        """Return a move for each robot, and take it as made.

        Parameters
        ----------
        late : numbers of robots, optional
            Who cannot begin a move in this step; the others keep clear of them. Who is under way is not affected.

        Raises
        ------
        ExecutionError
            If there is no such robot.
        """
        is_late, can_go = self._is_late(late), self._can_go()
        planned = None
        if self.replanner is not None and can_go.any() and self.field.destinations:
            planned = self.replanner.step(self.steps_done + 1, self._world, is_late, self.fleet.is_under_way)
        if planned is not None:
            return self._follow(*planned)
        distance, fleet = self.field.distance_of_site[self.fleet.site], self.fleet
        may_move = ~is_late & ~fleet.is_under_way & (fleet.start_times_left == 0)
        going = np.flatnonzero(can_go & may_move).astype(np.int32)
        order = going[np.argsort(distance[going], kind="stable")]
        if not fleet.claims.is_timed:
            # Where a door may be shut, the first cannot always come nearer.
            captain = int(order[0]) if order.size and self.scenario.has_flows else -1
            return self._done(order, self._stepper.step(order, order, fleet, captain))
        lined = np.flatnonzero(can_go & ~fleet.enters)
        # The nearest of all comes nearer or waits: nobody can take its place but by being nearer, and what bars its way
        # is under way and will be over. So all arrive that can, whatever the others do.
        captain = int(lined[np.argmin(distance[lined])]) if lined.size else -1
        return self._done(fleet.going, self._stepper.step(order, lined, fleet, captain))

    def _is_late(self, late: Iterable[int]) -> NDArray[np.bool_]:
        check_many("late", late, int, "a list of the numbers of robots")
        late = list(late)
        if not all(map(is_whole, late)):
            raise ExecutionError(f"late must name robots by their numbers, not {late!r:.80}")
        is_late, numbers = np.zeros(self.fleet.size, dtype=bool), np.array(late, dtype=np.int64)
        if numbers.size and (numbers.min() < 0 or numbers.max() >= is_late.size):
            wrong = numbers[(numbers < 0) | (numbers >= is_late.size)][0]
            raise ExecutionError(f"late must name robots 0..{is_late.size - 1}, not {wrong}")
        is_late[numbers] = True
        return is_late

    def _follow(self, robots: NDArray[np.int64], actions: NDArray[np.uint8]) -> Orders:
        action = self.fleet.idle_actions()
        is_begun = actions < UNDERWAY
        action[robots[is_begun]] = actions[is_begun]
        return self._moved(action)

    def _moved(self, action: NDArray[np.uint8]) -> Orders:
        self.fleet.move(action, self.field.distance_of_site)
        movers = self.fleet.going if self.fleet.claims.is_timed else np.flatnonzero(action < UNDERWAY)
        return self._done(movers, action)

    def _done(self, movers: NDArray[np.integer], action: NDArray[np.uint8]) -> Orders:
        """Return the orders of a step that has been made, and let those arrive whom it brought to a destination."""
        self.fleet.tick += 1
        orders = Orders(self.steps_done, action, self.fleet.cell_of_robot)
        self.fleet.arrive(movers, self.field.distance_of_site)
        return orders

    def take(self, action_of_robot: NDArray[np.uint8]) -> None:
        """Do a step with given actions in place of its own; what is no direction counts as waiting. Nothing is checked.

        For who records what robots did and wants to go on from there.
        """
        self._forget_plan()
        self._moved(action_of_robot)

    def _forget_plan(self) -> None:
        if self.replanner is not None:
            self.replanner.forget()

    def _world(self) -> tuple[NScheme, NDArray[np.int64]]:
        """Return the N-scheme of the world as known with the robots where they are, and their numbers."""
        field, area = self.field, self.scenario.area
        robots = np.flatnonzero(self.fleet.is_going & ~self.fleet.enters)
        scenario = replace(
            self.scenario,
            area=replace(area, barriers=field.barriers),
            destinations=field.world.destination_cells,
            robots=area.layout.site_to_cell(self.fleet.site[robots]),
            start_times=self.fleet.start_times_left[robots],
            slowness=self.scenario.slowness[:1].repeat(robots.size),
        )
        object.__setattr__(scenario, "moves", read_only(field.moves.copy()))  # the cached property, known already
        return NScheme(scenario, read_only(field.distance_of_site.copy())), robots

    def state(self) -> dict[str, NDArray[Any]]:
        """Return all that has been told and done, as arrays by name; see `restore`."""
        return {
            **self.fleet.as_arrays(),
            "barriers": self.field.barriers.copy(),
            "destinations": self.field.world.destination_cells,
            "obstacles": self._obstacles.as_array(),
        }

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go back, or forward, to a `state` of an execution of the same scenario; the same moves follow."""
        self._forget_plan()
        now, wanted = self.field.destinations, set(state["destinations"].tolist())
        self._change(
            blocked=np.flatnonzero(state["barriers"] & ~self.field.barriers),
            freed=np.flatnonzero(~state["barriers"] & self.field.barriers),
            opened=np.array(sorted(wanted - now), dtype=np.int64),
            closed=np.array(sorted(now - wanted), dtype=np.int64),
        )
        self.fleet.restore(state, self.field.distance_of_site)
        self._obstacles.restore(state["obstacles"])
        self._stepper.forget_steps()


def _touched(area: Area, shapes: Iterable[Any], name: str) -> list[NDArray[np.int64]]:
    """Return the cells that each of some shapes touches."""
    check_many(name, shapes, Mapping, "a list of shapes in metres")
    return [area.cells_touched(shape) for shape in shapes]
