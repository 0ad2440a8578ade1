"""Plan as CSV: one row for each robot and action, from its start to its arrival."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, Tessellation, claimed
from trihex.errors import FormatError
from trihex.files import new_file
from trihex.formats.plans.columns import columns_of, words_of_actions
from trihex.formats.registry import PLAN_HEADER
from trihex.formats.table import check_inside, parse_table, spelling_of
from trihex.formats.text import Text
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans import Motion, Plan, actions_of

_BUFFER = 4 << 20  # bytes that the kernel fills in one call, some 10 ms


def write_plan_csv(
    motion: Motion, path: str | os.PathLike[str], *, progress: Callable[[int, int], None] | None = None
) -> None:
    """Write header `robot,step,x,y,action,time` and a row for each robot and action.

    step is that in which the action ends, x, y the cell after it, time the running t_r. Where moves last as long as
    they cost, steps are ticks and rise by more than one. A robot that cannot arrive, or starts on a destination, has
    its row of step 0 only. Area, destinations and rules are not kept: whoever reads the file must name them again.

    In a run the rows of a robot begin with the step after which it joined, and end when it is not there any more or all
    is over; `late` is an action, too.
    """
    if isinstance(motion, Plan):
        _write_plan(motion, path, progress)
        return
    columns, rows = columns_of(motion), 50_000
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        file.write(f"{PLAN_HEADER}\n")
        for first in range(0, columns.robot.size, rows):
            some = [column[first : first + rows].tolist() for column in columns[:6]]
            file.writelines(f"{r},{s},{x},{y},{columns.words[a]},{t}\n" for r, s, x, y, a, t in zip(*some, strict=True))
            if progress is not None:
                progress(min(first + rows, columns.robot.size), columns.robot.size)


def _write_plan(plan: Plan, path: str | os.PathLike[str], progress: Callable[[int, int], None] | None) -> None:
    from trihex.formats.kernels import table_text
    from trihex.kernels.signatures import given

    layout, tessellation = plan.scenario.area.layout, plan.scenario.area.tessellation
    table = given(
        table_text.PlanTable,
        start=layout.cell_to_site(plan.scenario.robots),
        cost=tessellation.cost_of_direction,
        duration=plan.duration_of_action,
        waiting_cost=plan.scenario.waiting_cost,
        origin=layout.origin,
        pitch=layout.pitch,
    )
    state = np.zeros(5, dtype=np.int64)
    text = np.empty(_BUFFER, dtype=np.uint8)
    with new_file(path) as part, open(part, "wb") as file:
        file.write(f"{PLAN_HEADER}\n".encode())
        actions, spelling = actions_of(plan), spelling_of(words_of_actions(tessellation))
        length = -1
        while length:
            length = table_text.write_plan_rows(table, actions, spelling, state, text)
            file.write(text[:length].data)
            if progress is not None:
                progress(int(state[0]), plan.scenario.robot_count)


def parse_plan_csv(
    text: Text,
    path: str | os.PathLike[str],
    scenario: Scenario,
    progress: Callable[[int, int], None] | None = None,
) -> Plan:
    """Return the plan that a CSV file holds for the area, the destinations and the rules of `scenario`.

    The robots are those of the file; if they are those of `scenario` its start times and slowness are theirs. Rows may
    come in any order. A row whose action does not lead from the robot's last cell to this one becomes `JUMP`, which no
    audit lets pass.

    Parameters
    ----------
    text : Text
    path : path
        For messages.
    scenario : Scenario
    progress : callable, optional
        Called with (rows read, all rows).

    Raises
    ------
    FormatError
        If a line is not of the form, a cell lies outside the area, a robot or step is missing or there twice, or a
        step or time does not follow from the moves by the clock and the costs of `scenario`; the message names the
        line.
    """
    words = words_of_actions(scenario.area.tessellation)
    return plan_of_table(parse_table(text, path, PLAN_HEADER, {"action": words}, progress), scenario, path)


def plan_of_table(table: NDArray[np.int64], scenario: Scenario, path: object) -> Plan:
    """Return the plan that a table of the columns of `PLAN_HEADER` holds, shape (6, rows); see `parse_plan_csv`."""
    area, tessellation = scenario.area, scenario.area.tessellation
    words = words_of_actions(tessellation)
    check_inside(table[2], table[3], area, path)
    line = np.arange(2, table.shape[1] + 2)
    order = _order(table)
    if order is not None:
        table, line = table[:, order], line[order]
    robot, step, x, y, word, time = table
    start, wait = len(words) - 3, len(words) - 2
    actions, lasts = _actions(tessellation, x, y, word, wait)
    cells = y * area.width + x
    times = _times_of_rows(scenario, robot, cells, word < start)
    lasts = lasts * times
    is_start = _check_steps(robot, step, lasts, scenario, line, path)
    _check_rows(
        is_start != (word == start), "action must be 'start' at step 0, and only there", words, word, line, path
    )
    _check_rows(is_start & (time != 0), "time must be 0 at step 0", time, time, line, path)
    cost = _by_action(tessellation.cost_of_direction, 0)[actions] * times
    wrong = (
        ~is_start
        & (actions != JUMP)
        & (np.diff(time, prepend=0) != np.where(actions == WAIT, scenario.waiting_cost, cost))
    )
    if wrong.any():
        row = int(np.argmax(wrong))
        right = scenario.waiting_cost if actions[row] == WAIT else cost[row]
        raise FormatError(
            f"{path}: line {line[row]}: time must rise by {right} for {words[word[row]]!r}, not by "
            f"{time[row] - time[row - 1]}; the plan was made with other costs or another waiting cost"
        )
    own = actions[~is_start]
    jumps = np.flatnonzero(own == JUMP)
    firsts = np.flatnonzero(is_start)
    given = {field.name: getattr(scenario, field.name) for field in fields(scenario)}
    given |= {"robots": cells[is_start], "seed": None}
    if not np.array_equal(given["robots"], scenario.robots):
        given["start_times"] = given["slowness"] = ()
    return Plan(
        claimed(lambda kind: kind(**given)),
        own,
        np.append(firsts - np.arange(firsts.size), own.size),
        jumps=np.stack([jumps, cells[~is_start][jumps]], axis=1),
    )


def _order(table: NDArray[np.int64]) -> NDArray[np.int64] | None:
    """Return the order of the rows by robot and step, None if they have it."""
    robot, step = table[0], table[1]
    rises = (robot[1:] > robot[:-1]) | ((robot[1:] == robot[:-1]) & (step[1:] > step[:-1]))
    return None if rises.all() else np.lexsort((step, robot))


def _times_of_rows(
    scenario: Scenario, robot: NDArray[np.int64], cells: NDArray[np.int64], is_move: NDArray[np.bool_]
) -> NDArray[np.int64]:
    """Return the slowness of the robot of each row that is a move, else 1; 1 if robots are not those of `scenario`."""
    starts = cells[np.append(True, robot[1:] != robot[:-1])[: robot.size]]
    if not scenario.has_slowness or not np.array_equal(starts, scenario.robots):
        return np.ones((), dtype=np.int64)
    return np.where(is_move, scenario.slowness[np.clip(robot, 0, starts.size - 1)], 1)


def _check_steps(
    robot: NDArray[np.int64],
    step: NDArray[np.int64],
    lasts: NDArray[np.int64],
    scenario: Scenario,
    line: NDArray[np.int64],
    path: object,
) -> NDArray[np.bool_]:
    """Return which rows begin a robot; raise unless robots count up from 0, and steps as their actions last."""
    before_robot, before_step = np.append(-1, robot[:-1]), np.append(-1, step[:-1])
    begins = np.asarray(robot != before_robot)
    begins[:1] = True
    wrong = np.where(begins, (robot != before_robot + 1) | (step != 0), step != before_step + lasts)
    if not wrong.any():
        return begins
    row = int(np.argmax(wrong))
    where = f"{path}: line {line[row]}"
    if begins[row] and robot[row] != before_robot[row] + 1:
        raise FormatError(
            f"{where}: robots must be numbered 0, 1, 2, ...; robot {before_robot[row] + 1} must come next, "
            f"not {robot[row]}"
        )
    if begins[row]:
        raise FormatError(f"{where}: robot {robot[row]} must begin with step 0, not {step[row]}")
    if step[row] == before_step[row]:
        raise FormatError(f"{where}: robot {robot[row]} has step {step[row]} twice")
    lasts = np.broadcast_to(lasts, step.shape)
    tessellation = scenario.area.tessellation
    if tessellation.clock == "costs" or scenario.has_slowness:
        raise FormatError(
            f"{where}: step must rise by {lasts[row]}, as long as the action lasts, not by "
            f"{step[row] - before_step[row]}; the plan was made with another clock, other costs or slowness"
        )
    is_in_ticks = step[row] - before_step[row] in replace(tessellation, clock="costs").duration_of_direction
    raise FormatError(
        f"{where}: robot {robot[row]} lacks step {before_step[row] + 1}; here is step {step[row]}"
        f"{', as by clock costs' if is_in_ticks else ''}"
    )


def _actions(
    tessellation: Tessellation, x: NDArray[np.int64], y: NDArray[np.int64], word: NDArray[np.int64], wait: int
) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return the action of each row, `JUMP` if word and cells disagree, and how long lasts what the word says."""
    from_x, from_y = np.append(x[:1], x[:-1]), np.append(y[:1], y[:-1])
    orientation = tessellation.orientation_of_cell(from_x, from_y)
    # What a name means depends on the cell that is left.
    number_of_name = [{name: k for k, name in enumerate(names)} for names in tessellation.direction_names]
    direction_of_word = np.array(
        [[number.get(name, JUMP) for name in words_of_actions(tessellation)] for number in number_of_name],
        dtype=np.uint8,
    )
    direction_of_word[:, wait] = WAIT
    actions = direction_of_word[orientation, word]
    lasts = np.ones((), dtype=np.int64)
    if (tessellation.duration_of_direction != 1).any():
        # A name of the other orientation means no move here, but tells how long it would last.
        names = np.arange(wait - 1) % tessellation.direction_count
        said = np.where(direction_of_word[:, : wait - 1] == JUMP, names, direction_of_word[:, : wait - 1])
        of_word = np.ones(direction_of_word.shape, dtype=np.int64)
        of_word[:, : wait - 1] = tessellation.duration_of_direction[said]
        lasts = of_word[orientation, word]
    steps = np.concatenate([tessellation.step_of_direction, np.zeros((2, WAIT, 2), dtype=np.int32)], axis=1)
    step = steps[orientation, actions]
    actions[(step[:, 0] != x - from_x) | (step[:, 1] != y - from_y)] = JUMP
    return actions, lasts


def _by_action(of_direction: NDArray[np.int32], of_others: int) -> NDArray[np.int64]:
    """Return a table by the byte of an action: what it is of directions, and of waits and jumps."""
    table = np.full(WAIT + 1, of_others, dtype=np.int64)
    table[: of_direction.size] = of_direction
    return table


def _check_rows(
    wrong: NDArray[np.bool_], rule: str, names: object, value: NDArray[np.int64], line: NDArray[np.int64], path: object
) -> None:
    if wrong.any():
        row = int(np.argmax(wrong))
        shown = names[value[row]] if isinstance(names, list) else int(value[row])
        raise FormatError(f"{path}: line {line[row]}: {rule}, not {shown!r}")
