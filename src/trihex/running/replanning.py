"""Replanning: robots that follow the newest plan of a world that changes, made within a budget of time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Thread
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import ExecutionError, TooLargeError
from trihex.fields import NScheme
from trihex.kernels.codes import WAIT
from trihex.planners import make_plan
from trihex.running.follower import Follower
from trihex.running.passing import make_passing_order
from trihex.running.stepping import STEPPERS

_MOST_PAUSE = 64
# Where more robots are late, in the mean of about ten steps, the order of a plan holds up more than the plan is worth:
# 1000 robots on Berlin_1_256 take 9, 5, 2 % less time than step by step at 0, 0.5, 1 %, and 1, 14 % more at 2, 5 %.
MOST_LATE = 0.02


class _OutOfTimeError(Exception):
    """Raised from within a planner to stop it."""


class _Attempt(Thread):
    """A plan in the making, in a thread of its own: robots whose time is over go on without it.

    Planners can stop only where they report progress, up to a second apart, so nobody waits for them to stop.
    """

    def __init__(self, make: Callable[[Callable[[int, int], None]], Follower]) -> None:
        super().__init__(daemon=True)
        self._make = make
        self.is_stopped = False
        self.follower: Follower | None = None
        self.error: BaseException | None = None

    def run(self) -> None:
        """Make the plan, unless it is stopped."""
        try:
            self.follower = self._make(self._watch)
        except (_OutOfTimeError, TooLargeError):
            pass
        except BaseException as error:
            self.error = error

    def _watch(self, done: int, total: int) -> None:
        if self.is_stopped:
            raise _OutOfTimeError


@dataclass(eq=False)
class Replanner:
    """Plans for the world as it is, and tells in each step who moves, in the order of the plan, whoever is late.

    Parameters
    ----------
    planner : str
        A name of `trihex.planners.PLANNERS`.
    budget : float or None
        Seconds that a plan may take; None for any number. With a budget the moves depend on the speed of the machine.
    options : dict
        Of the planner.
    """

    planner: str
    budget: float | None = None
    options: dict[str, Any] = field(default_factory=dict)
    #: Plans made, and plans given up because they took too long or too much memory.
    plans: int = 0
    failures: int = 0
    _follower: Follower | None = None
    _attempt: _Attempt | None = None
    _robots: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    _has_begun: bool = False
    _late_share: float = 0.0
    _pause: int = 1
    _next_try: int = 0

    def forget(self) -> None:
        """Drop the plan: the world is not that of the plan any more, or robots are elsewhere."""
        self._follower = None

    def step(
        self,
        number: int,
        world: Callable[[], tuple[NScheme, NDArray[np.int64]]],
        is_late: NDArray[np.bool_],
        is_under_way: NDArray[np.bool_],
    ) -> tuple[NDArray[np.int64], NDArray[np.uint8]] | None:
        """Return robots and their actions, or None if there is no plan in time; then another must decide.

        Parameters
        ----------
        number : int
            Of the step.
        world : callable
            Returns the N-scheme of the world as it is, and which robot each of its scenario is.
        is_late, is_under_way : bool arrays
            For each robot. A plan begins at the centres of cells: if robots are under way when it is made, the others
            wait until all have come to one.
        """
        self._late_share += (float(is_late.mean()) - self._late_share) / 10
        if self._late_share > MOST_LATE:
            self._follower = None
            return None
        if self._follower is None or self._follower.is_over:
            self._follower = self._planned(world) if number >= self._next_try else None
            if self._follower is None:
                if number >= self._next_try:  # not again at once: each try keeps all robots waiting
                    self._next_try, self._pause = number + self._pause, min(2 * self._pause, _MOST_PAUSE)
                return None
            self._pause, self._has_begun = 1, False
        if not self._has_begun and is_under_way.any():
            return self._robots, np.full(self._robots.size, WAIT, dtype=np.uint8)
        self._has_begun = True
        return self._robots, self._follower.step(np.flatnonzero(is_late[self._robots]))

    def _planned(self, world: Callable[[], tuple[NScheme, NDArray[np.int64]]]) -> Follower | None:
        if self._attempt is not None and self._attempt.is_alive():
            return None  # that of an earlier step has not noticed yet that it is to stop
        n_scheme, self._robots = world()

        def make(watch: Callable[[int, int], None]) -> Follower:
            plan = make_plan(n_scheme.scenario, self.planner, n_scheme=n_scheme, progress=watch, **self.options)
            return make_passing_order(plan).follow()

        begin = perf_counter()
        self._attempt = attempt = _Attempt(make)
        if self.budget is None:
            attempt.run()
        else:
            attempt.start()
            attempt.join(max(self.budget, 0.0))
        attempt.is_stopped = True
        if attempt.error is not None:
            raise attempt.error
        is_late = self.budget is not None and perf_counter() - begin > self.budget
        if is_late or attempt.is_alive() or attempt.follower is None:
            self.failures += 1
            return None
        self.plans += 1
        return attempt.follower


def check_followable(scenario: Scenario, planner: str, *, replan: bool = False) -> None:
    """Raise ExecutionError where robots would follow a plan in its order, though doors ask for its times."""
    if scenario.has_flows and (replan or planner not in STEPPERS):
        raise ExecutionError(
            f"planner must be greedy or fcost, without replan, where doors have a flow, not {planner!r}"
            f"{' with replan' * replan}: a plan is followed in its order, not at its times"
        )
