"""Live: a run that a page drives step by step, and whose world its user changes between steps."""

from __future__ import annotations

from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import ExecutionError, TooLargeError
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.running import ARRIVED, BROKEN, GOING, LEFT, Event, Run, RunReport, Sensor, Trial, make_run_report
from trihex.viewer import requests as ask
from trihex.viewer.bundle import Bundle

# What the page knows of a cell, a bit each, and how it draws a robot.
BARRIER, DESTINATION, KNOWN = 1, 2, 4
HIDDEN, MOVING, WAITING, FINAL, STRANDED, LATE_SET = range(6)
# A run keeps one byte for each robot and step, and a page asks for steps as long as it is open.
MOST_ACTIONS = 2**29


def trial_of(scenario: Scenario, request: ask.Live) -> Trial:
    """Return the trial that a page asks for; raises what `Trial` does."""
    sense, tessellation = request.sense, scenario.area.tessellation
    return Trial(
        scenario,
        request.planner,
        replan=request.replan,
        budget=request.budget,
        sensor=None if sense is None else Sensor(tessellation, sense, request.line_of_sight),
        delay=request.delays,
        seed=scenario.seed or 0,
    )


def replay_of(run: Run) -> Live:
    """Return a run as it can be watched again, from its first step, with all that happened."""
    events = [occurrence.event for occurrence in run.occurrences]
    trial = Trial(run.scenario, run.planner, sensor=run.sensor, delay=run.delay, seed=run.seed, events=events)
    return Live(trial, run.actions)


class Live:
    """A trial and what the page has been told of it; each answer tells what is new.

    Parameters
    ----------
    trial : Trial
        Before its first step.
    recorded : uint8 array, shape (steps, robots), optional
        What robots did in a run that is watched again. When that is over, or the page has let something happen, they
        go on by themselves.
    """

    def __init__(self, trial: Trial, recorded: NDArray[np.uint8] | None = None) -> None:
        self.trial = trial
        scenario, tessellation = trial.scenario, trial.area.tessellation
        self._recorded = np.empty((0, 0), dtype=np.uint8) if recorded is None else recorded
        self._lock = Lock()
        cost = np.full(256, scenario.waiting_cost, dtype=np.int64)
        cost[: tessellation.direction_count] = tessellation.cost_of_direction
        cost[UNDERWAY] = 0  # paid when the move began
        self._cost = cost
        self._spent = 0
        self._sets = np.empty(0, dtype=np.uint8)
        self._world = np.zeros(scenario.area.cell_count, dtype=np.uint8)
        self._distance = np.full(scenario.area.cell_count, -1, dtype=np.int32)

    def advance(self, request: ask.Advance) -> Bundle:
        """Let events happen, do so many steps as long as robots can go on, and return what is new.

        Raises
        ------
        ScenarioError
            If an event lacks something; none has happened then.
        TooLargeError
            If the run has become longer than what is kept.
        """
        with self._lock:
            trial, told = self.trial, len(self.trial.occurrences)
            if request.events:
                self._recorded = self._recorded[: trial.steps_done]
            for event in [Event(trial.steps_done + 1, **one.model_dump()) for one in request.events]:
                trial.tell(event)
            trial.catch_up()
            self._note_events()
            for _ in range(request.steps):
                if trial.is_over:
                    break
                if (trial.steps_done + 1) * self._sets.size > MOST_ACTIONS:
                    raise TooLargeError(f"a live run keeps at most {MOST_ACTIONS} robot steps: save it and begin anew")
                self._step()
            return self._news(told)

    def _step(self) -> None:
        self.trial.catch_up()  # in a run that is watched, others may join
        self._note_events()
        was_going = self.trial.execution.state_of_robot == GOING
        done = self.trial.steps_done
        action = self.trial.step(self._recorded[done] if done < len(self._recorded) else None)
        state = self.trial.execution.state_of_robot
        self._spent += int(self._cost[action[was_going]].sum())
        self._sets = np.select(
            [was_going & (state == ARRIVED), state == BROKEN, state != GOING, action == LATE, action == WAIT],
            [FINAL, STRANDED, HIDDEN, LATE_SET, WAITING],
            MOVING,
        ).astype(np.uint8)
        self._sets[self.trial.execution.cut_off_robots] = STRANDED

    def _note_events(self) -> None:
        """Change how robots are drawn that have joined, left, broken down, or have a way again, or none."""
        state = self.trial.execution.state_of_robot
        sets = np.append(self._sets, np.full(state.size - self._sets.size, WAITING, dtype=np.uint8))
        sets[(sets == STRANDED) & (state == GOING)] = WAITING
        sets[self.trial.execution.cut_off_robots] = STRANDED
        sets[state == BROKEN], sets[state == LEFT] = STRANDED, HIDDEN
        sets[(state == ARRIVED) & (sets != HIDDEN)] = FINAL
        self._sets = sets

    def _news(self, told: int) -> Bundle:
        """Return the frame for the page: all numbers, all robots, and the cells that are not as they were told."""
        trial, execution = self.trial, self.trial.execution
        state, layout = execution.state_of_robot, trial.layout
        world = trial.barriers.reshape(-1) * np.uint8(BARRIER) + trial.known.reshape(-1) * np.uint8(KNOWN)
        world[trial.destinations] += DESTINATION
        distance = execution.field.distance.reshape(-1)
        changed, moved = np.flatnonzero(world != self._world), np.flatnonzero(distance != self._distance)
        self._world, self._distance = world, distance.copy()
        milliseconds = 1000 * np.array(trial.seconds or (0.0,))
        refused = [one for one in trial.occurrences[told:] if not one.is_accepted]
        header: dict[str, Any] = {
            "step": trial.steps_done,
            "pace": int(trial.scenario.duration_of_direction.min()),
            "robots": int(state.size),
            "arrived": int(np.count_nonzero(state == ARRIVED)),
            "going": int(np.count_nonzero(state == GOING)),
            "cut_off": int(execution.cut_off_robots.size),
            "spent": self._spent,
            "repairs": trial.repairs[0],
            "touched": trial.repairs[1],
            "milliseconds": [float(milliseconds[-1]), float(np.median(milliseconds)), float(milliseconds.max())],
            "known": float(trial.known.mean()),
            "broken": int(np.count_nonzero(state == BROKEN)),
            "is_over": trial.is_over,
            "refused": [{"kind": one.event.kind, "cell": one.event.cell, "why": one.refusal} for one in refused[:100]],
            "refused_count": len(refused),
        }
        arrays: dict[str, NDArray[Any]] = {
            "cells": layout.site_to_cell(execution.site_of_robot).astype(np.int32),
            "sets": self._sets,
            "world_cells": changed.astype(np.int32),
            "world": world[changed],
            "distance_cells": moved.astype(np.int32),
            "distance": distance[moved],
        }
        return Bundle(header, {**arrays, **self._ways()})

    def _ways(self) -> dict[str, NDArray[Any]]:
        """Return from where robots come that moved in the last tick, -1 for others, and how much of that way is done.

        Where all moves last a step and robots follow at once that goes without saying.
        """
        fleet = self.trial.execution.fleet
        if not fleet.claims.is_timed:
            return {}
        duration = fleet.claims.duration[np.minimum(fleet.heading, fleet.claims.duration.size - 1)]
        moves = (fleet.came_from >= 0) & (fleet.due >= fleet.tick) & (fleet.heading < UNDERWAY)
        done = 1 - (fleet.due - fleet.tick) / duration
        came_from = np.where(moves, self.trial.layout.site_to_cell(fleet.came_from), -1)
        return {"came_from": came_from.astype(np.int32), "share": np.rint(255 * np.clip(done, 0, 1)).astype(np.uint8)}

    def record(self) -> Run:
        """Return the run so far."""
        with self._lock:
            return self.trial.record()

    def judge(self) -> RunReport:
        """Return the report of the run so far; raises ExecutionError if there has been no step."""
        run, seconds = self.record(), list(self.trial.seconds)
        if not run.steps:
            raise ExecutionError("there is nothing to judge before the first step")
        return make_run_report(run, seconds=seconds[: run.steps])
