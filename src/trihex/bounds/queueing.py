"""Queueing: what it costs to be at a mouth by when, if robots that would queue there may go to another one.

Time is cut into windows of `width` ticks; in each only so many robots pass a mouth, and a mouth has a *toll* in each.
Whoever is at a mouth in time to pass in some window pays the time at which he arrives at best in that window or a later
one, and the toll of it. Nobody can do better than by the mouth and window where time and toll are least; and all tolls
that can be paid are known. So the sum of what each pays at best, less all tolls, is a lower bound *whatever the tolls*.
`find_tolls` finds the best ones: from the slots that remain free when all robots queue as well as they can.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.approaches import Approaches
from trihex.record import Record

if TYPE_CHECKING:
    from trihex.bounds.kernels.mouths import Approach, MouthSearch, MouthSlots

_BUDGET = 10_000_000
# Mouths times windows that are looked at, four bytes each.
_MOST_SLOTS = 10_000_000


@dataclass(frozen=True, eq=False)
class Tolls(Record):
    """The tolls of all mouths.

    Parameters
    ----------
    width : int
        Ticks in a window.
    label : int64 array, shape (mouths, windows + 1)
        Window in which a robot arrives that can be at the mouth by this one, its toll included; ascending, at least the
        window itself. Later windows have no toll.
    places : int64 array, shape (mouths,)
        How many robots pass each mouth in a window.
    """

    width: int
    label: NDArray[np.int64]
    places: NDArray[np.int64]

    @property
    def of_window(self) -> NDArray[np.int64]:
        """The tolls in ticks, shape (mouths, windows + 1)."""
        return (self.label - np.arange(self.label.shape[1])) * self.width

    @property
    def total(self) -> int:
        """The sum of all tolls that can be paid."""
        return int((self.of_window.sum(axis=1) * self.places).sum())

    def pays(self, mouth: int, ticks: NDArray[np.integer]) -> NDArray[np.int64]:
        """Return the least of arrival and toll of robots that can be at a mouth after so many ticks."""
        last = self.label.shape[1] - 1
        window = np.minimum(ticks // self.width, last)
        at_once = ticks + self.of_window[mouth, window]
        later = self.label[mouth, np.minimum(window + 1, last)] * self.width
        return np.where(window < last, np.minimum(at_once, later), ticks)

    def pays_anywhere(self, ticks: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the least that robots pay which can be at no mouth before so many ticks."""
        every = np.arange(int(ticks.max(initial=0)) + 1)
        least = every + self.label.shape[1] * self.width
        for mouth in range(self.places.size):
            np.minimum(least, self.pays(mouth, every), out=least)
        return np.asarray(least[ticks])


def find_tolls(
    approaches: Approaches,
    start_times: NDArray[np.int64],
    is_free: NDArray[np.bool_],
    places: NDArray[np.int64],
    width: int,
    most_looks: int,
) -> Tolls:
    """Let robots queue, but for those free to pass, and return the tolls at which nobody wants another slot."""
    from trihex.bounds.kernels import mouths as kernels

    approach, slots, search = _make_queues(approaches, start_times, is_free, places, width)
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    while not state[kernels.DONE] and state[kernels.LOOKS] < most_looks:
        kernels.queue_at_mouths(approach, slots, search, state, _BUDGET)
    end = int(state[kernels.WINDOW])
    label = np.full((places.size, end + 1), end, dtype=np.int64)
    np.minimum(label[:, :end], slots.label.reshape(places.size, -1)[:, :end], out=label[:, :end])
    # Labels are so in any case; but the bound would be wrong if they were not.
    label = np.maximum(np.maximum.accumulate(label, axis=1), np.arange(end + 1))
    return Tolls(width, label, places)


def _make_queues(
    approaches: Approaches,
    start_times: NDArray[np.int64],
    is_free: NDArray[np.bool_],
    places: NDArray[np.int64],
    width: int,
) -> tuple[Approach, MouthSlots, MouthSearch]:
    """Return mouths where nobody has a slot yet."""
    from trihex.bounds.kernels.mouths import Approach, MouthSearch, MouthSlots
    from trihex.kernels.signatures import given

    robot, window, kept = [], [], []
    for robots, lengths in zip(approaches.robots, approaches.lengths, strict=True):
        own = ~is_free[robots]
        windows = (lengths[own] + start_times[robots[own]]) // width
        order = np.argsort(windows, kind="stable")
        robot.append(robots[own][order])
        window.append(windows[order])
        kept.append(order.size)
    first = np.cumsum([0, *kept])
    count, mouths = int(np.count_nonzero(~is_free)), places.size
    horizon = min(max(int(one.max(initial=0)) for one in window) + count + 2, _MOST_SLOTS // mouths + 1)
    approach: Approach = given(
        Approach,
        places=places,
        first=first,
        robot=(np.cumsum(~is_free) - 1)[np.concatenate(robot)].astype(np.int32),
        window=np.concatenate(window).astype(np.int32),
        horizon=horizon,
    )
    slots = MouthSlots(
        mouth=np.full(count, -1, dtype=np.int32),
        window=np.zeros(count, dtype=np.int32),
        next_unserved=first[:-1].copy(),
        label=np.full(mouths * horizon, horizon, dtype=np.int32),
    )
    search = MouthSearch(
        seen_mouth=np.zeros(mouths, dtype=np.int64),
        mouths=np.empty(mouths, dtype=np.int64),
        reach=np.empty(mouths, dtype=np.int64),
        next_robot=np.empty(mouths, dtype=np.int64),
        dead_reach=np.full(mouths, -1, dtype=np.int64),
        dead_robot=first[:-1].copy(),
        turn=np.empty(mouths, dtype=np.int64),
        is_stacked=np.zeros(mouths, dtype=bool),
        stack=np.empty(mouths, dtype=np.int64),
        seen_robot=np.zeros(count, dtype=np.int64),
        robot=np.empty(count + 1, dtype=np.int64),
        before=np.empty(count + 1, dtype=np.int64),
    )
    return approach, slots, search
