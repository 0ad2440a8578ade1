"""Trial: robots run through a world that changes, is unknown to them, or makes them late, until no one can go on."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario, World
from trihex.errors import ExecutionError, ScenarioError, check_many, check_number, check_type, check_whole
from trihex.fields import Repair
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.running.changes import cell_at, changes_of
from trihex.running.events import Event, Occurrence
from trihex.running.execution import Execution
from trihex.running.knowledge import Knowledge
from trihex.running.log import Log
from trihex.running.obstacles import Obstacles
from trihex.running.run import GOING, Run
from trihex.running.sensing import Sensor

_STEPS_MOST = 1_000_000
_NONE = np.empty(0, dtype=np.int32)


class Trial:
    """A simulation: it knows the world as it is, and tells an `Execution` what robots notice of it.

    In each step, in this order: events happen; robots look around; late robots are known; the others move. Where moves
    last several ticks a step is a tick; robots look around when they come to the centre of a cell.

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
        check_type("scenario", scenario, Scenario)
        check_number("delay", delay, 0, 1, ExecutionError, below=True)
        check_whole("seed", seed, 0, None, ExecutionError)
        check_many("events", events, Event, "a list of events, such as those of read_events")
        events = list(events)
        for number, event in enumerate(events):
            check_type(f"events[{number}]", event, Event)
        if sensor is not None and not isinstance(sensor, Sensor):
            sensor = Sensor(scenario.area.tessellation, sensor)
        self.scenario, self.planner, self.sensor, self.delay, self.seed = scenario, planner, sensor, delay, seed
        self.area, self.layout = scenario.area, scenario.area.layout
        known = scenario if sensor is None else _unknown(scenario)
        self.execution = Execution(known, planner, aside=aside, replan=replan, budget=budget)
        self._world, self._obstacles = World(scenario), Obstacles()
        self._knowledge = Knowledge(self._world, sensor)
        self._events = sorted(events, key=lambda event: event.step)
        self._occurrences: list[Occurrence] = []
        self._log = Log(scenario.robots)
        self._actions: list[NDArray[np.uint8]] = []
        self._touched: list[tuple[int, int]] = []
        #: Seconds of each step, from events to moves.
        self.seconds: list[float] = []
        self._repairs = [0, 0]
        self._moved = np.zeros(scenario.robot_count, dtype=bool)
        self._look(0)  # nobody does yet: the code is loaded now, not in the first step
        self._moved[:] = True
        self._note_ends(0)

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
        return self._world.barriers.copy()

    @property
    def destinations(self) -> NDArray[np.int64]:
        """Numbers of the cells that are destinations now, ascending."""
        return self._world.destination_cells

    @property
    def known(self) -> NDArray[np.bool_]:
        """Which cells robots know, shape (height, width)."""
        return self._knowledge.is_known

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
        self._events = sorted([*self._events, replace(event, step=step)], key=lambda one: one.step)

    def run(self, *, most_steps: int = _STEPS_MOST, progress: Callable[[int, int], None] | None = None) -> Run:
        """Go on until no robot can, or for so many steps at most; return all that has happened.

        Parameters
        ----------
        most_steps : int
        progress : callable, optional
            Called with (robots arrived, robots) now and then.
        """
        check_whole("most_steps", most_steps, 0, None, ExecutionError)
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
        self._moved = (action <= UNDERWAY) & ~self.execution.is_under_way
        action[late[is_going[late] & (action[late] == WAIT)]] = LATE
        self._actions.append(action)
        self._touched.append((self._repairs[0], self._repairs[1]))
        self._repairs = [0, 0]
        self._note_ends(step)
        self.seconds.append(perf_counter() - begin)
        return action

    def _note_ends(self, step: int) -> None:
        """Note who is not in the area any more after `step`, and who cannot arrive."""
        self._log.note(step, self.execution.state_of_robot, self.execution.cut_off_robots)

    def _late(self, step: int) -> NDArray[np.int64]:
        late = self._log.late_until >= step
        if self.delay:  # a generator for each step, so that a run that is resumed goes on alike
            late |= np.random.default_rng([self.seed, step]).random(late.size) < self.delay
        return np.flatnonzero(late)

    def _look(self, step: int) -> None:
        """Let robots see what is around them."""
        looking = (self.execution.state_of_robot == GOING) & self._moved & ~self.execution.is_under_way
        seen = self._knowledge.look(self.execution.site_of_robot[looking], step - 1)
        self._observe(blocked=seen[self._world.blocked[seen] & ~self.execution.field.blocked[seen]])

    def _observe(self, **sites: NDArray[np.int32]) -> None:
        """Tell the execution of a change, if it is one."""
        if not any(own.size for own in sites.values()):
            return
        self._note_repair(self.execution.observe(**{n: self.layout.site_to_cell(own) for n, own in sites.items()}))

    def _note_repair(self, repair: Repair) -> None:
        self._repairs[0] += 1
        self._repairs[1] += repair.touched

    def _happen(self, event: Event) -> Occurrence:
        """Let an event happen, or tell why it cannot."""
        try:
            changes = self._changes_of(event)
        except (ExecutionError, ScenarioError) as error:
            return Occurrence(event, refusal=str(error))
        occurrence = Occurrence(event, "", **changes)
        sites = self._world.change(**occurrence.changes)
        if event.kind == "break":  # all know it
            return occurrence
        if self.sensor is not None:
            self._knowledge.change(sites["blocked"], sites["freed"], event.step - 1)
            sites["blocked"], sites["freed"] = _NONE, sites["freed"][self.execution.field.blocked[sites["freed"]]]
            self._moved[:] = True  # all look again
        self._observe(**sites)
        return occurrence

    def _changes_of(self, event: Event) -> dict[str, tuple[int, ...]]:
        """Return the cells that an event changes, after what it does to robots is done; raise an error if it cannot."""
        robot = -1 if event.robot is None else event.robot
        if event.kind == "join":
            self._join(cell_at(self.area, event.cell, event.metres), event.step - 1)
        elif event.kind == "leave":
            self.execution.leave(robot)
        elif event.kind == "break":
            was_barrier = self.execution.field.barriers.copy()
            self._note_repair(self.execution.break_down(robot))
            own = np.flatnonzero(self.execution.field.barriers & ~was_barrier).tolist()
            self._obstacles.fill(own)
            return {"blocked": tuple(own)}
        elif event.kind == "late":
            self.execution.check_going(robot)
            self._log.delay(robot, event.step + (event.steps or 1) - 1)
        else:
            return changes_of(event, self._world, self.execution.fleet, self._obstacles)
        return {}

    def _join(self, cell: int, step: int) -> None:
        if self._world.is_barrier(cell):  # which robots may not know yet
            raise ExecutionError(f"a robot must join on a free cell; {self.area.name_of_cell(cell)} is a barrier")
        self.execution.join(cell)
        self._log.join(cell, step)
        self._moved = np.append(self._moved, True)
        self._note_ends(step)

    def record(self) -> Run:
        """Return all that has happened so far."""
        log, state = self._log, self.execution.state_of_robot
        actions = np.full((self.steps_done, state.size), WAIT, dtype=np.uint8)
        for row, action in zip(actions, self._actions, strict=True):
            row[: action.size] = action
        return Run(
            self.scenario,
            self.planner,
            self.sensor,
            self.delay,
            self.seed,
            tuple(self._occurrences),
            log.start.copy(),
            log.joined.copy(),
            log.ended.copy(),
            state,
            actions,
            self._knowledge.known_since,
            log.cut_off_since.copy(),
            np.array(self._touched, dtype=np.int64).reshape(-1, 2),
        )


def _unknown(scenario: Scenario) -> Scenario:
    """Return the scenario as robots know it at the beginning: free everywhere, but doors are as they are."""
    area, turns = scenario.area, scenario.schedule.cells
    doors = tuple(replace(door, cells=np.intersect1d(door.cells, turns)) for door in scenario.doors)
    free = Area(area.tessellation, np.zeros_like(area.barriers), area.name, area.frame)
    return replace(scenario, area=free, doors=doors)


def resume_trial(run: Run, events: Iterable[Event] = (), **options: Any) -> Trial:
    """Return a trial that stands where `run` ended, to go on as if it had never stopped.

    What happened is done again, without asking the planner; `events` are those still to come, `options` those of the
    trial: aside, replan and budget. (Robots that follow plans make a new one, and may then go on in another way.)
    """
    check_type("run", run, Run)
    past = [occurrence.event for occurrence in run.occurrences]
    options |= {"sensor": run.sensor, "delay": run.delay, "seed": run.seed}
    trial = Trial(run.scenario, run.planner, events=[*past, *events], **options)
    while trial.steps_done < run.steps:
        trial.step(run.actions[trial.steps_done])
    return trial
