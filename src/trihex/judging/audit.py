"""Audit: the judge of a plan, which knows the rules but no planner.

Everything is found anew from the barriers, the rules and the actions: neither ``Scenario.moves`` nor any field of a
planner is looked at, so that a fault there is found here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.areas import CORNERS, Scenario
from trihex.plans import Plan
from trihex.record import Record

KINDS = ("cell", "exchange", "crossing", "jump", "barrier", "corner", "capacity", "arrival")

# By the codes of the kernel, in their order: the kind, how many robots and cells belong to it, and how it reads.
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
    ("arrival", 1, 1, "robot {0} ends in {a}, which is no destination, though it could have reached one"),
)
_STOPS = len(_CODES) - 1
# About 0.1 s of work between two looks at the keyboard.
_BUDGET = 4_000_000


@dataclass(frozen=True)
class Conflict:
    """One breach of one rule.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    step : int
        The step in which it happens, from 1; 0 for robots that do not act, or start on a destination yet act.
    robots : tuple of int
        Numbers of the robots, ascending.
    cells : tuple of (x, y)
        "cell": where both are. "exchange": where each came from. "crossing": from, to, from, to. "jump", "barrier",
        "corner": from, to (only from, where a robot leaves the area). "capacity": the destination. "arrival": where the
        robot stopped, or arrived before its last action.
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


@dataclass(frozen=True, eq=False)
class Audit(Record):
    """What the judge found in a plan.

    Parameters
    ----------
    plan : Plan
    conflicts : tuple of Conflict
        The first of them by step; as many as were asked for.
    conflict_count : int
        How many there are in all. In each step a robot gives rise to at most one conflict of a kind; where many
        robots meet, each is charged with the parked one or the one of the smallest number.
    """

    plan: Plan
    conflicts: tuple[Conflict, ...]
    conflict_count: int

    @property
    def is_clean(self) -> bool:
        """Whether the plan breaks no rule."""
        return self.conflict_count == 0


def audit_plan(plan: Plan, limit: int = 100, *, progress: Callable[[int, int], None] | None = None) -> Audit:
    """Judge `plan` by the rules of its scenario, in O(1) for each robot and step.

    Robots are followed as the actions say, whatever they break, until they enter a destination or leave the area.

    Parameters
    ----------
    plan : Plan
    limit : int
        How many conflicts to describe; all are counted.
    progress : callable, optional
        Called with (actions judged, actions in all).

    Returns
    -------
    Audit

    Examples
    --------
    >>> from trihex import Area, Scenario
    >>> from trihex.plans.plan import plan_from_lists
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0), (1, 0)])
    >>> east, west = 1, 3
    >>> print(audit_plan(plan_from_lists(scenario, [[east, east], [west, east, east]])).conflicts[0])
    step 1: robots 0 and 1 exchange cells (0, 0) and (1, 0)
    """
    found, count, site, stopped = _judged(plan, limit, progress)
    if stopped.size:
        could = stopped[is_reachable(plan.scenario, plan.scenario.robots[stopped])]
        rows = np.full((could.size, found.shape[1]), -1, dtype=np.int32)
        rows[:, 0], rows[:, 1] = _STOPS, np.diff(plan.first_action)[could]
        rows[:, 2], rows[:, 4] = could, site[could]
        found, count = np.concatenate([found, rows]), count + could.size
    order = np.lexsort((found[:, 3], found[:, 2], found[:, 0], found[:, 1]))[:limit]
    return Audit(plan, tuple(_conflict(plan, row) for row in found[order]), count)


def _judged(
    plan: Plan, limit: int, progress: Callable[[int, int], None] | None
) -> tuple[NDArray[np.int32], int, NDArray[np.int32], NDArray[np.int64]]:
    """Return the first conflicts as rows, the number of all, last sites, and who stops short of a destination."""
    from trihex.judging.kernels import audit as kernels

    scenario, layout = plan.scenario, plan.scenario.area.layout
    place, robots = _places(scenario), scenario.robot_count
    site, came_from, rank, active, ended = (np.zeros(robots, dtype=np.int32) for _ in range(5))
    passed = np.full(robots, -1, dtype=np.int32)
    forbid = scenario.crossing == "forbid" and layout.ring_of_vertex.size > 0
    vertex_holder = np.zeros(layout.size if forbid else 0, dtype=np.int32)
    found = np.full((max(limit, 0), 8), -1, dtype=np.int32)
    state = np.zeros(3, dtype=np.int64)
    kernels.begin(layout.cell_to_site(scenario.robots), plan.first_action, place, site, came_from, active, state, found)
    while state[kernels.ACTIVE]:
        kernels.judge(
            plan.actions,
            plan.first_action,
            layout.offset_of_direction,
            layout.vertex_of_direction,
            layout.ring_of_vertex,
            scenario.area.tessellation.edge_count,
            CORNERS.index(scenario.corners),
            forbid,
            scenario.destination_capacity or 0,
            *plan.jump_tables,
            site,
            came_from,
            passed,
            rank,
            place,
            vertex_holder,
            active,
            ended,
            _BUDGET,
            state,
            found,
        )
        if progress is not None:
            done = np.minimum(np.diff(plan.first_action), state[kernels.STEP]).sum()
            progress(int(done), plan.actions.size)
    count = int(state[kernels.COUNT])
    return found[:count], count, site, np.flatnonzero(came_from == kernels.PARKED)


def _places(scenario: Scenario) -> NDArray[np.int32]:
    """Return what lies at each site, and as yet robot 0, as the kernels write it."""
    from trihex.judging.kernels import audit as kernels

    area, layout = scenario.area, scenario.area.layout
    place = np.full(layout.size, kernels.OUTSIDE, dtype=np.int32)
    rows = place[layout.origin : layout.origin + area.height * layout.pitch].reshape(area.height, layout.pitch)
    rows[:, : area.width] = np.where(area.barriers, np.int32(kernels.BARRIER), np.int32(0))
    place[layout.cell_to_site(scenario.destinations)] = ~0
    return place


def is_reachable(scenario: Scenario, cells: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Tell for each cell whether a lone robot gets from there to a destination."""
    from trihex.judging.kernels import audit as kernels

    area, layout = scenario.area, scenario.area.layout
    start, place = layout.cell_to_site(cells), _places(scenario)
    mark = np.full(layout.size, kernels.UNKNOWN, dtype=np.uint8)
    queue = np.empty(area.free_count, dtype=np.int32)
    state = np.zeros(5, dtype=np.int64)
    while state[kernels.NEXT] < start.size:
        kernels.flood(
            start,
            place,
            layout.offset_of_direction,
            layout.vertex_of_direction,
            layout.ring_of_vertex,
            area.tessellation.edge_count,
            CORNERS.index(scenario.corners),
            mark,
            queue,
            state,
            _BUDGET,
        )
    return np.asarray(mark[start] == kernels.OPEN)


def _conflict(plan: Plan, row: NDArray[np.int32]) -> Conflict:
    kind, robot_count, cell_count, text = _CODES[row[0]]
    area = plan.scenario.area
    robots = tuple(int(robot) for robot in row[2 : 2 + robot_count])
    x, y = area.cell_to_xy(area.layout.site_to_cell(row[4 : 4 + cell_count]))
    cells = tuple(zip(x.tolist(), y.tolist(), strict=True))
    return Conflict(kind, int(row[1]), robots, cells, text.format(*robots, **dict(zip("abcd", cells, strict=False))))
