"""Guide: robots that follow the newest plan of a world that changes, made within a budget of time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import TooLargeError
from trihex.passing import Follower, make_passing_order
from trihex.planners import make_plan
from trihex.schemes import NScheme

_MOST_PAUSE = 64
# Where more robots are late, in the mean of about ten steps, the order of a plan holds up more than the plan is worth:
# 1000 robots on Berlin_1_256 take 9, 5, 2 % less time than step by step at 0, 0.5, 1 %, and 1, 14 % more at 2, 5 %.
MOST_LATE = 0.02


class _OutOfTimeError(Exception):
    """Raised from within a planner to stop it."""


@dataclass(eq=False)
class Guide:
    """Plans for the world as it is, and tells in each step who moves, in the order of the plan, whoever is late.

    Parameters
    ----------
    planner : str
        A name of `trihex.planners.PLANNERS`.
    budget : float or None
        Seconds that a plan may take, as far as the planner reports progress; None for any number. With a budget the
        moves depend on the speed of the machine.
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
    _robots: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    _late_share: float = 0.0
    _pause: int = 1
    _next_try: int = 0

    def forget(self) -> None:
        """Drop the plan: the world is not that of the plan any more, or robots are elsewhere."""
        self._follower = None

    def step(
        self, number: int, world: Callable[[], tuple[NScheme, NDArray[np.int64]]], is_late: NDArray[np.bool_]
    ) -> tuple[NDArray[np.int64], NDArray[np.uint8]] | None:
        """Return robots and their actions, or None if there is no plan in time; then another must decide.

        Parameters
        ----------
        number : int
            Of the step.
        world : callable
            Returns the N-scheme of the world as it is, and which robot each of its scenario is.
        is_late : bool array
            For each robot.
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
            self._pause = 1
        return self._robots, self._follower.step(np.flatnonzero(is_late[self._robots]))

    def _planned(self, world: Callable[[], tuple[NScheme, NDArray[np.int64]]]) -> Follower | None:
        n_scheme, self._robots = world()
        end = None if self.budget is None else perf_counter() + self.budget

        def watch(done: int, total: int) -> None:
            if end is not None and perf_counter() > end:
                raise _OutOfTimeError

        try:
            plan = make_plan(n_scheme.scenario, self.planner, n_scheme=n_scheme, progress=watch, **self.options)
            watch(1, 1)
        except (_OutOfTimeError, TooLargeError):
            self.failures += 1
            return None
        self.plans += 1
        return make_passing_order(plan).follow()
