"""Follower: tells robots step by step who may move, so that they keep to a passing order."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trihex.kernels.codes import UNDERWAY, WAIT

if TYPE_CHECKING:
    from trihex.running.passing import PassingOrder

Ints = NDArray[np.int64]


@dataclass(eq=False)
class Follower:
    """Who may move in each step, given who is late; robots keep to the order and else move as early as they can."""

    order: PassingOrder
    _at: Ints = field(init=False)
    _due: Ints = field(init=False)
    _tick: int = field(init=False, default=0)
    _stack: Ints = field(init=False)
    _precedence: Any = field(init=False)

    def __post_init__(self) -> None:
        from trihex.kernels.signatures import given
        from trihex.running.kernels.passing import Precedence

        order = self.order
        self._at = order.first_move[:-1].copy()
        self._due, self._stack = np.zeros_like(self._at), np.empty_like(self._at)
        self._precedence = given(
            Precedence,
            end=order.first_move[1:],
            owner=order.robot_of_move,
            leaves_before=order.leaves_before,
            enters_after=order.enters_after,
            vertex_before=order.vertex_before,
            entry_before=order.entry_before,
            lasts=order.duration_of_move,
            follows=int(order.plan.scenario.following == "allow"),
        )

    @property
    def is_going(self) -> NDArray[np.bool_]:
        """Whether each robot has moves left, or is under way."""
        return np.asarray((self._at < self.order.first_move[1:]) | (self._due > self._tick))

    @property
    def is_over(self) -> bool:
        """Whether all moves are done."""
        return not self.is_going.any()

    def step(self, late: Iterable[int] = ()) -> NDArray[np.uint8]:
        """Return the action of each robot in this step, and take it as done; `late` robots cannot begin a move."""
        from trihex.kernels.signatures import given
        from trihex.running.kernels.passing import Progress, choose

        is_late, moves = np.zeros(self._at.size, dtype=bool), np.zeros(self._at.size, dtype=bool)
        is_late[np.fromiter(late, dtype=np.int64)] = True
        is_late |= self.order.plan.scenario.start_times > self._tick
        now = given(Progress, tick=self._tick, at=self._at, due=self._due, is_late=is_late)
        choose(self._precedence, now, self._stack, moves)
        action = np.where(self._due > self._tick, np.uint8(UNDERWAY), np.uint8(WAIT))
        action[moves] = self.order.action_of_move[self._at[moves]]
        self._due[moves] = self._tick + self._precedence.lasts[self._at[moves]]
        self._at += moves
        self._tick += 1
        return action
