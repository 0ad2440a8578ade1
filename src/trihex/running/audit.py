"""Run audit: the judge of a run, who knows the world of each step but no planner.

All is found anew from the barriers as the events left them and from the actions: no field, no table of moves and
nothing that robots knew is looked at.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area
from trihex.errors import check_type
from trihex.judging import Conflict, is_reachable
from trihex.kernels.codes import UNDERWAY
from trihex.record import Record, counted
from trihex.running.owning import judge_arrivals, judge_doors, judge_events, judge_owners, moves_of
from trihex.running.run import ARRIVED, BROKEN, GOING, LEFT, Run

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RunAudit(Record):
    """What the judge found in a run; `conflicts` are the first, `conflict_count` is the number of all."""

    run: Run
    conflicts: tuple[Conflict, ...]
    conflict_count: int

    def in_words(self) -> str:
        """Return how many conflicts there are, and the first."""
        first = f", the first: {self.conflicts[0]}" if self.conflicts else ""
        return counted(self.conflict_count, "conflict") + first

    @property
    def is_clean(self) -> bool:
        """Whether nobody broke a rule, and all arrived who could."""
        return self.conflict_count == 0


@dataclass(frozen=True)
class _Step:
    """What is judged in one step: who acts, from where to where, past which vertex (-1: none), and the world."""

    number: int
    robots: Ints
    here: Ints
    there: Ints
    vertex: Ints
    barriers: NDArray[np.bool_]
    destinations: Ints


def audit_run(run: Run, limit: int = 100) -> RunAudit:
    """Judge a run: in each step the rules of the scenario in the world of that step, at the end who was left behind.

    Kinds of conflict are those of `trihex.judging.audit_plan`, and "late": a robot moved though an event made it late;
    "event": an event put a barrier or a robot where one stood; "end": what is said of a robot is not so; "time":
    a robot acts while it is under way, or is said to be under way when it is not.

    Examples
    --------
    >>> from trihex import Area, Scenario
    >>> from trihex.running.trial import Trial
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0)])
    >>> audit_run(Trial(scenario, sensor=1).run()).is_clean
    True
    """
    check_type("run", run, Run)
    if run.scenario.is_stepwise:
        doors = judge_doors(run, moves_of(run)[0]) if run.scenario.has_flows else ()
        found = [*_events(run), *doors, *(c for step in _steps(run) for judge in _JUDGES for c in judge(run, step))]
    else:
        moves, found = moves_of(run)
        found += [conflict for step in _steps(run) for conflict in _judge_moves(run, step)]
        found += [
            conflict
            for judge in (judge_owners, judge_doors, judge_arrivals, judge_events)
            for conflict in judge(run, moves)
        ]
    found += _ends(run)
    found.sort(key=lambda conflict: conflict.step)
    return RunAudit(run, tuple(found[:limit]), len(found))


def _steps(run: Run) -> Iterator[_Step]:
    """Follow the robots as the actions say: in each step those that are at a centre."""
    area, tessellation = run.scenario.area, run.scenario.area.tessellation
    layout, duration = area.layout, run.scenario.duration_of_direction
    cell, due = run.robots.copy(), np.zeros(run.robots.size, dtype=np.int64)
    for number, (barriers, destinations) in enumerate(run.worlds(), 1):
        robots = np.flatnonzero((run.joined < number) & ((run.ended >= number) | (run.ended < 0)) & (due < number))
        here, action = cell[robots], run.actions[number - 1, robots]
        moves = np.flatnonzero(action < UNDERWAY)
        x, y = area.cell_to_xy(here[moves])
        side, k = tessellation.orientation_of_cell(x, y), action[moves]
        step = tessellation.step_of_direction[side, k].astype(np.int64)
        to_x, to_y = x + step[:, 0], y + step[:, 1]
        is_inside = (to_x >= 0) & (to_y >= 0) & (to_x < area.width) & (to_y < area.height)
        there, vertex = here.copy(), np.full(here.size, -1, dtype=np.int64)
        there[moves] = np.where(is_inside, to_y * area.width + to_x, -1)
        passed = layout.cell_to_site(here[moves]) + layout.vertex_of_direction[side, k]
        vertex[moves] = np.where(k >= tessellation.edge_count, passed, -1)
        yield _Step(number, robots, here, there, vertex, barriers, destinations)
        cell[robots] = np.where(there < 0, here, there)
        due[robots[moves]] = number - 1 + duration[k] * (there[moves] >= 0)


def _judge_moves(run: Run, step: _Step) -> Iterator[Conflict]:
    """Barriers, the border, corners, and robots that move though they are late."""
    area = run.scenario.area
    for i in np.flatnonzero(step.there < 0).tolist():
        yield _conflict(area, "barrier", step, [i], "robot {0} leaves the area from {a}")
    inside = np.flatnonzero(step.there >= 0)
    for i in inside[step.barriers.flat[step.there[inside]]].tolist():
        yield _conflict(area, "barrier", step, [i], "robot {0} is, from {a}, on the barrier {b}")
    if run.scenario.corners != "allow":
        for i in _closed_corners(run, step).tolist():
            yield _conflict(area, "corner", step, [i], "robot {0} moves from {a} to {b} round a corner that is closed")
    moves = np.flatnonzero((step.there != step.here) & (step.robots < run.scenario.robot_count))
    for i in moves[run.scenario.start_times[step.robots[moves]] >= step.number].tolist():
        start = run.scenario.start_times[step.robots[i]]
        yield _conflict(area, "start", step, [i], f"robot {{0}} leaves {{a}} before its start time, {start}")
    late: set[int] = set()
    for one in run.occurrences:
        event = one.event
        if event.kind == "late" and one.is_accepted and event.step <= step.number < event.step + (event.steps or 0):
            late.add(-1 if event.robot is None else event.robot)
    for i in np.flatnonzero(np.isin(step.robots, list(late)) & (step.there != step.here)).tolist():
        yield _conflict(area, "late", step, [i], "robot {0} moves from {a} though it is late")


def _closed_corners(run: Run, step: _Step) -> Ints:
    """Return which moves past a vertex the barriers around it forbid."""
    layout = run.scenario.area.layout
    movers = np.flatnonzero((step.vertex >= 0) & (step.there >= 0))
    ring = step.vertex[movers, None] + layout.ring_of_vertex[None, :]
    row, x = np.divmod(ring - layout.origin, layout.pitch)
    is_inside = (row >= 0) & (row < layout.height) & (x >= 0) & (x < layout.width)
    filled = ~is_inside | step.barriers.flat[np.where(is_inside, row * layout.width + x, 0)]
    around = ring.shape[1]
    closed = np.zeros(movers.size, dtype=bool)
    for i, mover in enumerate(movers.tolist()):
        sites = ring[i].tolist()
        ends = layout.cell_to_site(np.array([step.here[mover], step.there[mover]])).tolist()
        at, to = sites.index(ends[0]), sites.index(ends[1])
        one = [filled[i, (at + j) % around] for j in range(1, (to - at) % around)]
        other = [filled[i, (to + j) % around] for j in range(1, (at - to) % around)]
        closed[i] = any(one) or any(other) if run.scenario.corners == "no-cut" else any(one) and any(other)
    return movers[closed]


def _judge_meetings(run: Run, step: _Step) -> Iterator[Conflict]:
    """Robots in one cell, robots that exchange cells, robots that pass one vertex."""
    area = run.scenario.area
    stays = np.flatnonzero((step.there >= 0) & ~np.isin(step.there, step.destinations))
    for i, j in _pairs(step.there[stays]):
        yield _conflict(area, "cell", step, [stays[i], stays[j]], "robots {0} and {1} are both in cell {b}")
    movers = np.flatnonzero((step.there >= 0) & (step.there != step.here))
    low, high = np.minimum(step.here, step.there)[movers], np.maximum(step.here, step.there)[movers]
    for i, j in _pairs(low * area.cell_count + high):
        if step.here[movers[i]] != step.here[movers[j]]:
            pair = [movers[i], movers[j]]
            yield _conflict(area, "exchange", step, pair, "robots {0} and {1} exchange cells {a} and {b}")
    if run.scenario.forbids_crossing:
        passing = np.flatnonzero(step.vertex >= 0)
        for i, j in _pairs(step.vertex[passing]):
            pair = [passing[i], passing[j]]
            yield _conflict(
                area, "crossing", step, pair, "robots {0} and {1} pass one vertex, from {a} to {b} and {c} to {d}"
            )


def _judge_arrivals(run: Run, step: _Step) -> Iterator[Conflict]:
    """Too many robots in a destination, robots that stay on one, and robots that vanish elsewhere."""
    area, capacity = run.scenario.area, run.scenario.entry_limit
    enters = np.flatnonzero(np.isin(step.there, step.destinations))
    for i in enters[run.ended[step.robots[enters]] != step.number].tolist():
        yield _conflict(area, "arrival", step, [i], "robot {0} acts on after it has entered destination {b}")
    gone = np.flatnonzero((run.ended[step.robots] == step.number) & (run.state_of_robot[step.robots] == ARRIVED))
    for i in np.setdiff1d(gone, enters).tolist():
        if not _opens(run, step.number + 1, int(step.there[i])):
            text = "robot {0} is said to arrive, but is in {b}, which is no destination"
            yield _conflict(area, "arrival", step, [i], text)
    if capacity:
        cells, counts = np.unique(step.there[enters], return_counts=True)
        for cell in cells[counts > capacity].tolist():
            many = enters[step.there[enters] == cell][capacity:].tolist()
            for i in many:
                yield _conflict(area, "capacity", step, [i], "robot {0} is one too many to enter destination {b}")


_JUDGES = (_judge_moves, _judge_meetings, _judge_arrivals)


def _opens(run: Run, step: int, cell: int) -> bool:
    return any(cell in one.opened and one.event.step == step for one in run.occurrences if one.is_accepted)


def _pairs(keys: Ints) -> Iterator[tuple[int, int]]:
    """Yield for each key that comes more than once its first place and each other."""
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    for i in same.tolist():
        first = i
        while first > 0 and keys[order[first - 1]] == keys[order[i]]:
            first -= 1
        yield int(order[first]), int(order[i + 1])


def _events(run: Run) -> Iterator[Conflict]:
    """Find events that put a barrier or a robot where a robot stood."""
    cells = list(run.cells_by_step())
    area, robots = run.scenario.area, iter(np.flatnonzero(run.joined >= 0)[run.scenario.robot_count :].tolist())
    count = run.scenario.robot_count  # of robots so far: those that join later in the same step are not there yet
    for one in run.occurrences:
        if not one.is_accepted:
            continue
        event, before = one.event, cells[min(one.event.step - 1, run.steps)]
        own = next(robots) if event.kind == "join" else event.robot
        count += event.kind == "join"
        wanted = [run.robots[own]] if event.kind == "join" and own is not None else list(one.blocked)
        for cell in wanted:
            there = [r for r in np.flatnonzero(before[:count] == cell).tolist() if r != own]
            if there:
                text = f"event {event.kind!r} at {area.name_of_cell(int(cell))}, where robot {there[0]} stands"
                yield Conflict("event", event.step, (there[0],), (_xy(area, int(cell)),), text)


def _ends(run: Run) -> Iterator[Conflict]:
    """Find robots that still go though they could arrive, and those that are said to be where they are not."""
    area, kinds = run.scenario.area, {"leave": LEFT, "break": BROKEN}
    barriers, destinations = run.last_world
    cells = deque(run.cells_by_step(), 1).pop()
    going = np.flatnonzero((run.state_of_robot == GOING) & (cells >= 0) & (cells < area.cell_count))
    going = going[~barriers.flat[cells[going]]]  # who left the area or stands on a barrier is charged with that
    if going.size and destinations.size:
        last = replace(run.scenario.with_robots(()), area=replace(area, barriers=barriers), destinations=destinations)
        for robot in going[is_reachable(last, cells[going])].tolist():
            cell = int(cells[robot])
            text = (
                f"robot {robot} ends in {area.name_of_cell(cell)}, which is no destination, though it could reach one"
            )
            yield Conflict("arrival", run.steps, (robot,), (_xy(area, cell),), text)
    said = {r: int(run.state_of_robot[r]) for r in np.flatnonzero(run.state_of_robot > ARRIVED).tolist()}
    known = {o.event.robot: kinds[o.event.kind] for o in run.occurrences if o.is_accepted and o.event.kind in kinds}
    for robot in sorted(
        robot for robot in {*said, *known} if robot is not None and said.get(robot) != known.get(robot)
    ):
        yield Conflict("end", run.steps, (robot,), (), f"robot {robot} is said to have left or broken down, or is not")


def _xy(area: Area, cell: int) -> tuple[int, int]:
    return cell % area.width, cell // area.width


def _conflict(area: Area, kind: str, step: _Step, rows: list[Any], text: str) -> Conflict:
    """Return a conflict of the robots in `rows` of a step; {a} to {d} in `text` are their cells, from and to."""
    robots = tuple(int(step.robots[i]) for i in rows)
    pairs = ((step.here[i], step.there[i] if step.there[i] >= 0 else step.here[i]) for i in rows)
    cells = tuple(_xy(area, int(cell)) for pair in pairs for cell in pair)
    return Conflict(kind, step.number, robots, cells, text.format(*robots, **dict(zip("abcd", cells, strict=False))))
