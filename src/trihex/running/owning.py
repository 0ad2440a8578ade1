"""Owning: a run judged by who owns what, where moves last or following is forbidden.

Tick t is half tick 2t. All is found from the actions and from the destinations of each step, as the model says it: a
move from a to b that begins at tick t and lasts d owns, where following is allowed, a before half tick 2t + d and b
from then on; where it is forbidden both from 2t on, a before 2t + 2d; the lattice vertex that it passes from 2t on,
before 2t + 2d.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from trihex.judging import Conflict
from trihex.kernels.codes import UNDERWAY
from trihex.running.run import ARRIVED, BROKEN, LEFT, Run

_EVER = 2**62


class Move(NamedTuple):
    """A robot on its way from one cell to another, from one tick to another; `vertex` is -1 if it passes none."""

    begin: int
    end: int
    robot: int
    here: int
    there: int
    vertex: int
    # The half tick from which it enters a destination, if it does: one that is open when it begins, or opens later.
    entry: int | None


class Stay(NamedTuple):
    """A robot owns a place in the half ticks from `begin` to before `end`; several may enter a destination."""

    begin: int
    end: int
    robot: int
    is_entry: bool
    #: The half tick in which it begins to leave.
    leaves: int = _EVER


def judge_owners(run: Run, moves: list[Move]) -> Iterator[Conflict]:
    """Find robots that own one cell or vertex, exchange cells, or are too many to enter a destination."""
    stays = stays_of(run, moves)
    capacity = run.scenario.entry_limit or len(moves) + 1
    for cell, own in stays.items():
        place = run.scenario.area.place_of_cell(cell)
        for one, others in _meetings(own):
            if one.is_entry and sum(other.is_entry for other in others) >= capacity:
                text = f"robot {one.robot} is one too many to enter destination {place}"
                yield _conflict("capacity", one, (one.robot,), run, cell, text)
            for other in others:
                if other.robot != one.robot and not (one.is_entry and other.is_entry):
                    text = f"robots {other.robot} and {one.robot} both own cell {place}"
                    yield _conflict("cell", one, (other.robot, one.robot), run, cell, text)
    passings: dict[int, list[tuple[Stay, int]]] = defaultdict(list)
    for move in moves if run.scenario.forbids_crossing else ():
        if move.vertex >= 0:
            end = _end_of(run, move.robot, 2 * move.end)
            passings[move.vertex].append((Stay(2 * move.begin, end, move.robot, False), move.here))
    for passing in passings.values():
        cell_of = dict(passing)
        for one, others in _meetings(list(cell_of)):
            for other in others:
                text = f"robots {other.robot} and {one.robot} pass one vertex at a time"
                yield _conflict("crossing", one, (other.robot, one.robot), run, cell_of[one], text)
    yield from _exchanges(run, moves)


def _conflict(kind: str, one: Stay, robots: tuple[int, ...], run: Run, cell: int, text: str) -> Conflict:
    width = run.scenario.area.width
    return Conflict(kind, one.begin // 2 + 1, robots, ((cell % width, cell // width),), text)


def _meetings(stays: list[Stay]) -> Iterator[tuple[Stay, list[Stay]]]:
    """Yield each stay with those that have begun before it and have not ended, if there are any."""
    there: list[Stay] = []
    for one in sorted(stays):
        there = [other for other in there if other.end > one.begin]
        if there and one.end > one.begin:
            yield one, there
        there.append(one)


def _exchanges(run: Run, moves: list[Move]) -> Iterator[Conflict]:
    by_way = defaultdict(list)
    for move in moves:
        by_way[min(move.here, move.there), max(move.here, move.there)].append(move)
    for (low, high), own in by_way.items():
        stays = {Stay(2 * m.begin, _end_of(run, m.robot, 2 * m.end), m.robot, m.here == low) for m in own}
        for one, others in _meetings(list(stays)):
            for other in others:
                if other.is_entry != one.is_entry:  # that is, they go the other way
                    text = f"robots {other.robot} and {one.robot} exchange cells"
                    yield _conflict("exchange", one, (other.robot, one.robot), run, low if one.is_entry else high, text)


def _end_of(run: Run, robot: int, half_tick: int) -> int:
    """Return until when a robot owns what it would own up to a half tick: who leaves owns nothing any more.

    Who breaks down owns nothing where following is forbidden, since its cells are barriers; else its move ends.
    """
    ends_early = run.state_of_robot[robot] == LEFT
    ends_early |= run.state_of_robot[robot] == BROKEN and run.scenario.following == "forbid"
    return min(half_tick, 2 * int(run.ended[robot])) if ends_early else half_tick


def stays_of(run: Run, moves: list[Move]) -> dict[int, list[Stay]]:
    """Return who owns each cell when; `moves` are in the order in which they begin."""
    duration_of = 1 if run.scenario.following == "allow" else 2
    stays: dict[int, list[Stay]] = defaultdict(list)
    last: dict[int, Move] = {}
    since = {robot: (2 * int(run.joined[robot]), int(cell)) for robot, cell in enumerate(run.robots)}
    for move in moves:
        lasts, robot = move.end - move.begin, move.robot
        begin, cell = since[robot]
        leaves = 2 * move.begin + duration_of * lasts
        stays[cell].append(Stay(begin, _end_of(run, robot, leaves), robot, False, 2 * move.begin))
        since[robot] = 2 * move.begin + (lasts if duration_of == 1 else 0), move.there
        last[robot] = move
    for robot, (begin, cell) in since.items():
        final = last.get(robot)
        end = _EVER if run.ended[robot] < 0 else max(2 * int(run.ended[robot]), 0 if final is None else 2 * final.end)
        end = _end_of(run, robot, end)
        if final is None or final.entry is None:
            stays[cell].append(Stay(begin, end, robot, False))
            continue
        entry = max(begin, final.entry)
        stays[cell].append(Stay(begin, min(entry, end), robot, False))
        stays[cell].append(Stay(entry, end, robot, True))
    return stays


def judge_doors(run: Run, moves: list[Move]) -> Iterator[Conflict]:
    """Find robots that come into a cell in a step (tick) in which its door lets in fewer."""
    schedule, width = run.scenario.schedule, run.scenario.area.width
    door_of_cell = {cell: number for number, cell in enumerate(schedule.cells.tolist())}
    came: dict[tuple[int, int], int] = defaultdict(int)
    for move in sorted(moves, key=lambda move: (move.end, move.robot)):
        door = door_of_cell.get(move.there)
        if door is None or move.there == move.here:
            continue
        came[door, move.end] += 1
        if came[door, move.end] > int(schedule.openings_at(np.array([door]), np.array([move.end]))[0]):
            text = f"robot {move.robot} enters the door {run.scenario.area.place_of_cell(move.there)} while it is shut"
            yield Conflict("capacity", move.end, (move.robot,), ((move.there % width, move.there // width),), text)


def judge_arrivals(run: Run, moves: list[Move]) -> Iterator[Conflict]:
    """Find robots that go on after they have entered a destination, and those that vanish elsewhere."""
    area, last = run.scenario.area, {move.robot: move for move in moves}
    for move in moves:
        state, ended = run.state_of_robot[move.robot], int(run.ended[move.robot])
        is_broken_off = state != ARRIVED and (0 <= ended < move.end or (ended < 0 and move.end > run.steps))
        if move.entry is not None and not is_broken_off and (ended != move.end or state != ARRIVED):
            where = area.place_of_cell(move.there)
            text = f"robot {move.robot} acts on after it has entered destination {where}"
            yield Conflict("arrival", move.end, (move.robot,), (), text)
    opened = {(one.event.step, cell) for one in run.occurrences if one.is_accepted for cell in one.opened}
    for robot in np.flatnonzero(run.arrived & (run.ended > run.joined)).tolist():
        final, ended = last.get(robot), int(run.ended[robot])
        cell = int(run.robots[robot]) if final is None else final.there
        enters = final is not None and final.entry is not None and final.end == ended
        stands = (ended + 1, cell) in opened and (final is None or final.end <= ended)
        if not enters and not stands:
            where = area.place_of_cell(cell)
            text = f"robot {robot} is said to arrive, but is in {where}, which is no destination"
            yield Conflict("arrival", ended, (robot,), (), text)


def moves_of(run: Run) -> tuple[list[Move], list[Conflict]]:
    """Return all moves in the order in which they begin, and what robots do while they are under way, or as if so."""
    area, layout, tessellation = run.scenario.area, run.scenario.area.layout, run.scenario.area.tessellation
    duration, count = run.scenario.duration_of_direction, run.robots.size
    cell, due = run.robots.copy(), np.zeros(count, dtype=np.int64)
    moves: list[Move] = []
    open_moves: list[int] = []
    conflicts: list[Conflict] = []
    opened = {(one.event.step, cell) for one in run.occurrences if one.is_accepted for cell in one.opened}
    for step, (_, destinations) in enumerate(run.worlds(), 1):
        goals, tick = set(destinations.tolist()), step - 1
        open_moves = [i for i in open_moves if moves[i].end > tick]
        for i in open_moves:
            if moves[i].entry is None and (step, moves[i].there) in opened:
                moves[i] = moves[i]._replace(entry=2 * tick)
        for robot in np.flatnonzero((run.joined < step) & ((run.ended >= step) | (run.ended < 0))).tolist():
            action = int(run.actions[tick, robot])
            if (action == UNDERWAY) != (due[robot] > tick):
                text = f"robot {robot} acts at the wrong time: its move ends at tick {due[robot]}"
                conflicts.append(Conflict("time", step, (robot,), (), text))
            if action >= UNDERWAY or due[robot] > tick:
                continue
            here = int(cell[robot])
            x, y = here % area.width, here // area.width
            side = int(tessellation.orientation_of_cell(x, y))
            dx, dy = tessellation.step_of_direction[side, action].tolist()
            if not (0 <= x + dx < area.width and 0 <= y + dy < area.height):
                continue  # charged as a move out of the area
            there, vertex = (y + dy) * area.width + x + dx, -1
            if action >= tessellation.edge_count:
                site = int(layout.cell_to_site(np.array([here]))[0])
                vertex = site + int(layout.vertex_of_direction[side, action])
            due[robot], cell[robot] = tick + duration[action], there
            entry = 2 * tick if there in goals else None
            open_moves.append(len(moves))
            moves.append(Move(tick, int(due[robot]), robot, here, there, vertex, entry))
    return moves, conflicts


def judge_events(run: Run, moves: list[Move]) -> Iterator[Conflict]:
    """Find events that put a barrier or a robot where a robot was, which it entered, or which it left."""
    stays, area = stays_of(run, moves), run.scenario.area
    robots = iter(np.flatnonzero(run.joined >= 0)[run.scenario.robot_count :].tolist())
    count = run.scenario.robot_count
    coming = defaultdict(list)
    for move in moves:
        end = _end_of(run, move.robot, 2 * move.end)
        coming[move.there].append(Stay(2 * move.begin, end, move.robot, move.entry is not None))
    for one in run.occurrences:
        if not one.is_accepted:
            continue
        event, at = one.event, 2 * (one.event.step - 1)
        own = next(robots) if event.kind == "join" else event.robot
        count += event.kind == "join"
        wanted = [int(run.robots[own])] if event.kind == "join" and own is not None else list(one.blocked)
        for cell in wanted:
            # Who starts here at this moment is there; who begins to come at it comes after the event.
            starts = [stay for stay in stays[cell] if stay.begin == at == 2 * int(run.joined[stay.robot])]
            for stay in (*stays[cell], *coming[cell]):
                is_there = stay.begin < at < stay.end or (stay in starts and at < stay.end)
                excused = stay.is_entry if event.kind == "join" else event.kind == "break" and stay.leaves < at
                if is_there and not excused and stay.robot != own and stay.robot < count:
                    text = f"event {event.kind!r} at {area.name_of_cell(cell)}, which is robot {stay.robot}'s"
                    xy = cell % area.width, cell // area.width
                    yield Conflict("event", event.step, (stay.robot,), (xy,), text)
