"""Conflict: one breach of one rule."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario

KINDS = ("cell", "exchange", "crossing", "jump", "barrier", "corner", "capacity", "arrival", "start")

# By the codes of `kernels.findings`, in their order, and those below: the kind, how many robots and cells belong to it,
# and how it reads.
_CODES = (
    ("cell", 2, 1, "robots {0} and {1} are both in cell {a}"),
    ("exchange", 2, 2, "robots {0} and {1} exchange cells {a} and {b}"),
    ("crossing", 2, 4, "robots {0} and {1} pass one vertex, from {a} to {b} and from {c} to {d}"),
    ("jump", 1, 2, "robot {0} jumps from {a} to {b}, which is no neighbour"),
    ("barrier", 1, 1, "robot {0} leaves the area from {a}"),
    ("barrier", 1, 2, "robot {0} moves from {a} onto the barrier {b}"),
    ("corner", 1, 2, "robot {0} moves from {a} to {b} round a corner that the rule closes"),
    ("capacity", 1, 1, "robot {0} is one too many to enter destination {a}"),
    ("arrival", 1, 1, "robot {0} acts on after it has entered destination {a}"),
    ("cell", 2, 1, "robots {0} and {1} both own cell {a}"),
    ("capacity", 1, 1, "robot {0} enters the door {a} while it is shut"),
    ("arrival", 1, 1, "robot {0} ends in {a}, which is no destination, though it could have reached one"),
    ("barrier", 1, 1, "robot {0} starts on the barrier {a}"),
    ("barrier", 0, 1, "destination {a} is a barrier"),
    ("start", 1, 1, "robot {0} leaves {a} before its start time, {start}"),
)
SHARES_CELL = 0
STOPS, STARTS_ON_BARRIER, AIMS_AT_BARRIER, STARTS_EARLY = range(len(_CODES) - 4, len(_CODES))


@dataclass(frozen=True)
class Conflict:
    """One breach of one rule.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    step : int
        The step in which it happens, from 1; where moves last, the tick in which the later robot begins to own what
        another owns, or begins or ends its move. 0 for robots that do not act, or start on a destination yet act, and
        for starts and destinations that are impossible.
    robots : tuple of int
        Numbers of the robots, ascending; none where a destination is a barrier.
    cells : tuple of (x, y)
        "cell": where both are. "exchange": where each came from. "crossing": from, to, from, to. "jump", "barrier",
        "corner": from, to; only from, where a robot leaves the area; only the barrier, where it starts there or the
        destination is one. "capacity": the destination, or the door. "arrival": where the robot stopped, or arrived
        before its last action. "start": where the robot starts, which it leaves too early.
    text : str
        The same in words.
    """

    kind: str
    step: int
    robots: tuple[int, ...]
    cells: tuple[tuple[int, int], ...]
    text: str

    def __str__(self) -> str:
        return f"step {self.step}: {self.text}"


def conflict_from(scenario: Scenario, row: NDArray[np.int32]) -> Conflict:
    """Return a conflict that the kernels have found: code, step, two robots, four sites."""
    kind, robot_count, cell_count, text = _CODES[row[0]]
    area = scenario.area
    robots = tuple(int(robot) for robot in row[2 : 2 + robot_count])
    x, y = area.cell_to_xy(area.layout.site_to_cell(row[4 : 4 + cell_count]))
    cells = tuple(zip(x.tolist(), y.tolist(), strict=True))
    named = dict(zip("abcd", cells, strict=False), start=scenario.start_times[robots[0]] if robots else 0)
    return Conflict(kind, int(row[1]), robots, cells, text.format(*robots, **named))
