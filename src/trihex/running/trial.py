"""Trial: robots run through a world that changes, is unknown to them, or makes them late, until no one can go on."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario
from trihex.errors import ExecutionError, ScenarioError
from trihex.kernels.codes import LATE, WAIT
from trihex.running.events import Event, Occurrence
from trihex.running.execution import Execution
from trihex.running.run import GOING, Run
from trihex.running.sensing import Sensor

_STEPS_MOST = 1_000_000
_NONE = np.empty(0, dtype=np.int32)
_JOINED, _ENDED, _LATE_UNTIL, _CUT_OFF = range(4)


class Trial:
    """A simulation: it knows the world as it is, and tells an `Execution` what robots notice of it.

    In each step, in this order: events happen; robots look around; late robots are known; the others move.

    What robots know is never darker than the world: cells that no robot has seen count as free, and what opens (a
    barrier goes, a destination opens) is announced to all. A barrier that appears is noticed when a robot sees it. So a
    robot that cannot arrive in the world as known cannot arrive.

    Parameters
    ----------
    scenario : Scenario
        The world as it is at the beginning.
    planner, aside, replan, budget
        As for `Execution`.
    sensor : Sensor or float, optional
        What each robot sees; all share what they know. Default: robots know the world, and its changes at once.
    events : iterable of Event
        What will happen; `tell` adds more while robots run.
    delay : float
        The chance of each robot to be late in a step.
    seed : int
        What chance comes from.

    Raises
    ------
    ExecutionError
        If there is no such planner, or the delay is no number from 0 to below 1.
    """

    def __init__(
        self,
        scenario: Scenario,
        planner: str = "fcost",
        *,
        aside: str = "always",
        replan: bool = False,
        budget: float | None = None,
        sensor: Sensor | float | None = None,
        events: Iterable[Event] = (),
        delay: float = 0.0,
        seed: int = 0,
    ) -> None:
        if not 0 <= delay < 1:
            raise ExecutionError(f"delay must be a number from 0 to below 1, not {delay!r}")
        if sensor is not None and not isinstance(sensor, Sensor):
            sensor = Sensor(scenario.area.tessellation, sensor)
        self.scenario, self.planner, self.sensor, self.delay, self.seed = scenario, planner, sensor, delay, seed
        self.area, self.layout = scenario.area, scenario.area.layout
        known = scenario if sensor is None else _unknown(scenario)
        self.execution = Execution(known, planner, aside=aside, replan=replan, budget=budget)
        self._destinations = set(scenario.destinations.tolist())
        self._blocked = np.ones(self.layout.size, dtype=bool)
        self._inner(self._blocked)[:] = scenario.area.barriers
        self._since = np.full(self.layout.size, -1 if sensor is not None else 0, dtype=np.int32)
        self._events = sorted(events, key=lambda event: event.step)
        self._occurrences: list[Occurrence] = []
        self._starts = scenario.robots.tolist()
        # One column for each robot: joined after step, ended after step, late up to step, cut off since step.
        self._log = np.zeros((4, len(self._starts)), dtype=np.int64)
        self._log[[_ENDED, _CUT_OFF]] = -1
        self._actions: list[NDArray[np.uint8]] = []
        self._touched: list[tuple[int, int]] = []
        #: Seconds of each step, from events to moves.
        self.seconds: list[float] = []
        self._repairs = [0, 0]
        self._moved = np.zeros(len(self._starts), dtype=bool)
        self._look(0)  # nobody does yet: the code is loaded now, not in the first step
        self._moved[:] = True
        self._note_ends(0)

    def _inner(self, sites: NDArray[Any]) -> NDArray[Any]:
        """Return the part of a padded array that belongs to cells, to write to."""
        inner = sites[self.layout.origin : self.layout.origin + self.area.height * self.layout.pitch]
        return inner.reshape(self.area.height, self.layout.pitch)[:, : self.area.width]

    @property
    def steps_done(self) -> int:
        """Number of steps done."""
        return len(self._actions)

    @property
    def is_over(self) -> bool:
        """Whether no robot can go on, now or after an event that is known already."""
        return self.execution.is_over and not self._events

    @property
    def occurrences(self) -> tuple[Occurrence, ...]:
        """What became of each event so far, in order."""
        return tuple(self._occurrences)

    @property
    def barriers(self) -> NDArray[np.bool_]:
        """Where barriers are now, whoever knows of them, shape (height, width)."""
        return self._inner(self._blocked).copy()

    @property
    def destinations(self) -> NDArray[np.int64]:
        """Numbers of the cells that are destinations now, ascending."""
        return np.array(sorted(self._destinations), dtype=np.int64)

    @property
    def known(self) -> NDArray[np.bool_]:
        """Which cells robots know, shape (height, width)."""
        return np.asarray(self._inner(self._since) >= 0)

    @property
    def repairs(self) -> tuple[int, int]:
        """Repairs of the field so far, and the cells that they touched."""
        repairs, cells = (sum(column) for column in zip(*self._touched, self._repairs, strict=True))
        return repairs, cells

    def catch_up(self) -> None:
        """Let what is due before the next step happen at once, for who shows it; robots then go on just the same."""
        happened = len(self._occurrences)
        while self._events and self._events[0].step <= self.steps_done + 1:
            self._occurrences.append(self._happen(self._events.pop(0)))
        if len(self._occurrences) > happened:
            self._note_ends(self.steps_done)

    def tell(self, event: Event) -> None:
        """Add an event; if its step is over, it happens in the next one."""
        step = max(event.step, self.steps_done + 1)
        event = Event(step, event.kind, event.cell, event.to, event.robot, event.steps)
        self._events = sorted([*self._events, event], key=lambda one: one.step)

    def run(self, *, most_steps: int = _STEPS_MOST, progress: Callable[[int, int], None] | None = None) -> Run:
        """Go on until no robot can, or for so many steps at most; return all that has happened.

        Parameters
        ----------
        most_steps : int
        progress : callable, optional
            Called with (robots arrived, robots) now and then.
        """
        while not self.is_over and self.steps_done < most_steps:
            self.step()
            if progress is not None and self.steps_done % 16 == 0:
                state = self.execution.state_of_robot
                progress(int(np.count_nonzero(state != GOING)), state.size)
        return self.record()

    def step(self, actions: NDArray[np.uint8] | None = None) -> NDArray[np.uint8]:
        """Do one step, and return the action of each robot: its own, or those given (see `resume_trial`)."""
        begin = perf_counter()
        step = self.steps_done + 1
        self.catch_up()
        self._look(step)
        late = self._late(step)
        self._note_ends(step - 1)
        is_going = self.execution.state_of_robot == GOING
        if actions is None:
            action = self.execution.step(late).action_of_robot
        else:
            action = actions[: is_going.size].copy()
            self.execution.take(action)
        self._moved = action < LATE
        action[late[is_going[late]]] = LATE
        self._actions.append(action)
        self._touched.append((self._repairs[0], self._repairs[1]))
        self._repairs = [0, 0]
        self._note_ends(step)
        self.seconds.append(perf_counter() - begin)
        return action

    def _note_ends(self, step: int) -> None:
        """Note who is not in the area any more after `step`, and who cannot arrive."""
        state, log = self.execution.state_of_robot, self._log
        log[_ENDED, (log[_ENDED] < 0) & (state != GOING)] = step
        is_cut_off = np.zeros(state.size, dtype=bool)
        is_cut_off[self.execution.cut_off_robots] = True
        log[_CUT_OFF, ~is_cut_off] = -1
        log[_CUT_OFF, is_cut_off & (log[_CUT_OFF] < 0)] = step

    def _late(self, step: int) -> NDArray[np.int64]:
        late = self._log[_LATE_UNTIL] >= step
        if self.delay:  # a generator for each step, so that a run that is resumed goes on alike
            late |= np.random.default_rng([self.seed, step]).random(late.size) < self.delay
        return np.flatnonzero(late)

    def _look(self, step: int) -> None:
        """Let robots see what is around them."""
        from trihex.running.kernels.sensing import look

        if self.sensor is None:
            return
        site = self.execution.site_of_robot[(self.execution.state_of_robot == GOING) & self._moved]
        news = np.empty(self.area.cell_count, dtype=np.int32)
        first, ray_dx, ray_dy = self.sensor.rays
        self._since[site] = np.where(self._since[site] < 0, step - 1, self._since[site])
        count = look(
            site,
            self.sensor.seen_dx,
            self.sensor.seen_dy,
            first,
            ray_dx,
            ray_dy,
            self.layout.origin,
            self.layout.pitch,
            self.area.height,
            self.area.width,
            self._blocked,
            step - 1,
            self._since,
            news,
        )
        seen = news[:count]
        self._observe(blocked=seen[self._blocked[seen] & ~self.execution.field.blocked[seen]])

    def _observe(self, **sites: NDArray[np.int32]) -> None:
        """Tell the execution of a change, if it is one."""
        if not any(own.size for own in sites.values()):
            return
        repair = self.execution.observe(**{name: self.layout.site_to_cell(own) for name, own in sites.items()})
        self._repairs[0] += 1
        self._repairs[1] += repair.touched

    def _happen(self, event: Event) -> Occurrence:
        """Let an event happen, or tell why it cannot."""
        try:
            changes = self._changes_of(event)
        except (ExecutionError, ScenarioError) as error:
            return Occurrence(event, refusal=str(error))
        site = {name: self.layout.cell_to_site(np.array(cells, dtype=np.int64)) for name, cells in changes.items()}
        blocked, freed = site.get("blocked", _NONE), site.get("freed", _NONE)
        self._blocked[blocked], self._blocked[freed] = True, False
        self._destinations.difference_update(changes.get("closed", ()))
        self._destinations.update(changes.get("opened", ()))
        if event.kind == "break":
            return Occurrence(event, **changes)
        if self.sensor is not None:
            self._since[blocked], self._since[freed] = -1, event.step - 1
            blocked, freed = _NONE, freed[self.execution.field.blocked[freed]]
            self._moved[:] = True  # all look again
        self._observe(blocked=blocked, freed=freed, opened=site.get("opened", _NONE), closed=site.get("closed", _NONE))
        return Occurrence(event, **changes)

    def _changes_of(self, event: Event) -> dict[str, Any]:
        """Return the cells that an event changes, after what it does to robots is done; raise an error if it cannot."""
        if event.kind in ("join", "leave", "break", "late"):
            return self._change_robots(event)
        cell = self._cell(event.cell)
        if event.kind == "barrier":
            if self._is_blocked(cell):
                raise ExecutionError(f"{self.area.name_of_cell(cell)} is a barrier already")
            if cell in self._destinations:
                raise ExecutionError(f"{self.area.name_of_cell(cell)} is a destination, close it first")
            robots = np.flatnonzero(self.execution.cell_of_robot == cell)
            if robots.size:
                raise ExecutionError(f"robot {robots[0]} stands at {self.area.name_of_cell(cell)}")
            return {"blocked": (cell,)}
        if event.kind == "clear":
            if not self._is_blocked(cell):
                raise ExecutionError(f"{self.area.name_of_cell(cell)} is no barrier")
            return {"freed": (cell,)}
        if event.kind == "open":
            return {"opened": (self._check_new(cell),)}
        if cell not in self._destinations:
            raise ExecutionError(f"{self.area.name_of_cell(cell)} is no destination")
        if event.kind == "close":
            return {"closed": (cell,)}
        return {"closed": (cell,), "opened": (self._check_new(self._cell(event.to)),)}

    def _change_robots(self, event: Event) -> dict[str, Any]:
        robot = -1 if event.robot is None else event.robot
        if event.kind == "join":
            cell = self._cell(event.cell)
            if self._is_blocked(cell):
                raise ExecutionError(f"a robot must join on a free cell; {self.area.name_of_cell(cell)} is a barrier")
            self.execution.join(cell)
            self._starts.append(cell)
            self._log = np.append(self._log, [[event.step - 1], [-1], [0], [-1]], axis=1)
            self._moved = np.append(self._moved, True)
            self._note_ends(event.step - 1)
        elif event.kind == "leave":
            self.execution.leave(robot)
        elif event.kind == "break":
            repair = self.execution.break_down(robot)
            self._repairs[0] += 1
            self._repairs[1] += repair.touched
            return {"blocked": (int(self.execution.cell_of_robot[robot]),)}
        else:
            self.execution.check_going(robot)
            last = event.step + (event.steps or 1) - 1
            self._log[_LATE_UNTIL, robot] = max(self._log[_LATE_UNTIL, robot], last)
        return {}

    def _cell(self, place: tuple[int, int] | None) -> int:
        assert place is not None
        x, y = place
        if not (0 <= x < self.area.width and 0 <= y < self.area.height):
            raise ExecutionError(f"({x}, {y}) lies outside the area")
        return y * self.area.width + x

    def _site(self, cell: int) -> int:
        return int(self.layout.cell_to_site(np.array([cell], dtype=np.int64))[0])

    def _is_blocked(self, cell: int) -> bool:
        return bool(self._blocked[self._site(cell)])

    def _check_new(self, cell: int) -> int:
        """Return a cell that can become a destination."""
        if self._is_blocked(cell):
            raise ExecutionError(f"{self.area.name_of_cell(cell)} is a barrier")
        if cell in self._destinations:
            raise ExecutionError(f"{self.area.name_of_cell(cell)} is a destination already")
        return cell

    def record(self) -> Run:
        """Return all that has happened so far."""
        robots, steps = len(self._starts), self.steps_done
        actions = np.full((steps, robots), WAIT, dtype=np.uint8)
        for row, action in zip(actions, self._actions, strict=True):
            row[: action.size] = action
        return Run(
            self.scenario,
            self.planner,
            self.sensor,
            self.delay,
            self.seed,
            tuple(self._occurrences),
            np.array(self._starts, dtype=np.int64),
            self._log[_JOINED].copy(),
            self._log[_ENDED].copy(),
            self.execution.state_of_robot,
            actions,
            self.layout.cells_of(self._since).copy(),  # type: ignore[arg-type]
            self._log[_CUT_OFF].copy(),
            np.array(self._touched, dtype=np.int64).reshape(-1, 2),
        )


def _unknown(scenario: Scenario) -> Scenario:
    """Return the scenario as robots know it at the beginning: free everywhere."""
    from dataclasses import replace

    area = scenario.area
    return replace(scenario, area=Area(area.tessellation, np.zeros_like(area.barriers), area.name, area.frame))


def resume_trial(run: Run, events: Iterable[Event] = (), **options: Any) -> Trial:
    """Return a trial that stands where `run` ended, to go on as if it had never stopped.

    What happened is done again, without asking the planner; `events` are those still to come, `options` those of the
    trial: aside, replan and budget. (Robots that follow plans make a new one, and may then go on in another way.)
    """
    past = [occurrence.event for occurrence in run.occurrences]
    options |= {"sensor": run.sensor, "delay": run.delay, "seed": run.seed}
    trial = Trial(run.scenario, run.planner, events=[*past, *events], **options)
    while trial.steps_done < run.steps:
        trial.step(run.actions[trial.steps_done])
    return trial
