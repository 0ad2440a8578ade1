"""Motion: what robots did, as a plan wants it or as it happened; the view that plans and runs share."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.record import Record, read_only

Ints = NDArray[np.int64]


class Motion(Record):
    """Base of `Plan` and `Run`: who was where after each step, and what the world was like.

    Whatever writes, draws or counts what robots did takes one of these and asks for no more than is here. Robots are
    numbered alike everywhere; those that join a run come last.
    """

    if TYPE_CHECKING:  # what the records have as fields or properties of their own

        @property
        def scenario(self) -> Scenario:
            """The world as it was at the beginning, and the robots that were there."""

        @property
        def planner(self) -> str:
            """Who planned or decided."""

        @property
        def robots(self) -> Ints:
            """The first cell of each robot."""

        @property
        def joined(self) -> Ints:
            """The step after which each robot was in the area."""

        @property
        def ended(self) -> Ints:
            """The step after which each robot was not in the area any more, -1 if it stayed to the end."""

        @property
        def arrived(self) -> NDArray[np.bool_]:
            """Whether each robot arrived."""

        @property
        def steps(self) -> int:
            """Number of steps."""

        @property
        def time_of_robot(self) -> Ints:
            """F_t, the list of t_r = d_r + w_r."""

        @property
        def last_cell_of_robot(self) -> Ints:
            """The cell in which each robot was last: its destination, if it arrived."""

        def cells_by_step(self) -> Iterator[Ints]:
            """Yield the cell of each robot after step 0, 1, ..., `steps`; -1 where it is not in the area."""

        def actions_in(self, step: int) -> NDArray[np.uint8]:
            """Return what each robot did in a step: a direction, `WAIT`, `LATE` or `JUMP`; `WAIT` if it did nothing."""

        def worlds(self) -> Iterator[tuple[NDArray[np.bool_], Ints]]:
            """Yield barriers (height, width) and destinations in step 1, 2, ..., `steps`; do not write to them."""

    @property
    def arrival_step_of_robot(self) -> Ints:
        """The step in which each robot entered its destination, -1 if it never did."""
        return read_only(np.where(self.arrived, self.ended, -1))

    @property
    def last_seen_of_robot(self) -> Ints:
        """The last step in which each robot is known to be somewhere: it arrived, left or broke down, or all was over.

        A robot that stays, because it cannot arrive, is there to the last step.
        """
        return read_only(np.where(self.ended < 0, self.steps, self.ended))

    @property
    def total_time(self) -> int:
        """Sum of t_r over the robots that arrive: what the planners minimise."""
        return int(self.time_of_robot[self.arrived].sum())


def seconds_of_arrivals(motion: Motion, step_seconds: float | None) -> dict[str, float | None]:
    """Return how long a step lasts, and when the last robot arrives and all do in the mean, in seconds."""
    steps = motion.arrival_step_of_robot[motion.arrived]
    last, mean = None, None
    if step_seconds is not None and steps.size:
        last, mean = (round(float(number) * step_seconds, 6) for number in (steps.max(), steps.mean()))
    return {"step_seconds": step_seconds, "last_arrival_seconds": last, "mean_arrival_seconds": mean}
