"""Maps: where robots lose time, and where they crowd, as arrays of the area."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.errors import check_type
from trihex.plans.motion import Motion
from trihex.plans.rows import rows_of_motion
from trihex.record import read_only


def make_waiting_map(plan: Motion, *, before_start: bool = False) -> NDArray[np.int64]:
    """Return how many steps (ticks) robots lost in each cell, shape (height, width): those in which they stood there.

    What they wait until their start times is no loss; with `before_start` it is that, and nothing else, that is
    counted. Robots that cannot arrive stand for ever; they are left out. In a place in metres `step_seconds` of the
    report makes seconds of them.

    Parameters
    ----------
    plan : Plan or Run
    before_start : bool

    Examples
    --------
    >>> from trihex import Area, Scenario, make_plan
    >>> scenario = Scenario(Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0), (1, 0)], destination_capacity=1)
    >>> make_waiting_map(make_plan(scenario, "greedy")).tolist()
    [[0, 0, 0]]
    """
    check_type("plan", plan, Motion)
    first_row, step, cell = rows_of_motion(plan)
    stood = np.append(False, cell[1:] == cell[:-1])[: cell.size]
    stood[first_row[:-1]] = False
    stood &= np.repeat(plan.ended >= 0, np.diff(first_row))
    start_times = np.zeros(first_row.size - 1, dtype=np.int64)  # of those that joined a run, too
    start_times[: plan.scenario.robot_count] = plan.scenario.start_times
    stood &= (step <= np.repeat(start_times, np.diff(first_row))) == before_start
    return _by_cell(plan, cell[stood])


def make_density_map(plan: Motion) -> NDArray[np.float64]:
    """Return how many robots were in each cell in the mean over all steps, shape (height, width).

    In a place in metres: on each square metre. A robot counts from the step in which it is there to that in which it
    arrives, that one not included, so that destinations stay empty; on its way in the cell that it leaves.

    Parameters
    ----------
    plan : Plan or Run
    """
    check_type("plan", plan, Motion)
    first_row, step, cell = rows_of_motion(plan)
    last = first_row[1:] - 1
    lasts = np.append(np.diff(step), 0)[: step.size]  # until the next row
    lasts[last] = np.where(plan.arrived, 0, 1)
    area = plan.scenario.area
    unit = 1.0 if area.frame is None else area.tessellation.area_of_cell * area.frame.cell_size**2
    return read_only(_by_cell(plan, cell, lasts) / (max(plan.steps, 1) * unit))


def _by_cell(plan: Motion, cell: NDArray[np.int64], count: NDArray[np.int64] | None = None) -> NDArray[np.int64]:
    area = plan.scenario.area
    total = np.bincount(cell, count, minlength=area.cell_count)
    return read_only(total.reshape(area.height, area.width).astype(np.int64))
