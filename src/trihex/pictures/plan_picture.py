"""Plan picture: the paths of robots, or how often each cell is visited."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trihex.areas import Area, Ground, Scenario
from trihex.errors import check_type
from trihex.pictures import marks as make, palette
from trihex.pictures.legend import barrier_colour, barrier_keys, colours_of
from trihex.pictures.palette import DESTINATION, FREE, MOVING, SERIES, STRANDED
from trihex.pictures.picture import Picture, titled
from trihex.pictures.scene import Key, Lines, Mark, Ramp, Scene, colour_rows, scale_for
from trihex.pictures.setting import setting_of
from trihex.pictures.ways import robot_paths
from trihex.plans import Motion, Plan, visits_of

PATHS_FROM = 8.0  # pixels per edge step
MOST_PATHS, MOST_PATH_STEPS = 26, 10_000
_SHADES = 240


def picture_of_plan(
    plan: Motion,
    *,
    width: int | None = None,
    title: str | None = None,
    legend: bool = True,
    paths: bool | None = None,
    ground: Ground | None = None,
    crop: bool = False,
) -> Picture:
    """Return the picture of a plan or a run: the paths of its robots, or how often each cell is visited.

    Parameters
    ----------
    plan : Plan or Run
        A run with barriers and destinations as they were in its last step.
    width, title, legend, ground
        As for `picture_of_area`.
    paths : bool, optional
        Whether to draw a line for each robot, not the visits. Default: if there are 26 at most and cells are large.
    crop : bool
        Whether to show only the part of the area that holds free cells, if that is less than half of it.
    """
    check_type("plan", plan, Motion)
    whole = plan.scenario.area
    if crop and isinstance(plan, Plan):
        plan = _cropped(plan)
    scenario = setting_of(plan)
    area, is_plan = scenario.area, isinstance(plan, Plan)
    scale = scale_for(area, width)
    if paths is None:
        paths = scenario.robot_count <= MOST_PATHS and plan.steps <= MOST_PATH_STEPS and scale >= PATHS_FROM
    arrived, stranded = np.flatnonzero(plan.arrived), np.flatnonzero(~plan.arrived)
    shades = palette.visits_ramp(_SHADES)
    first = _SHADES
    cells = make.base_cells(scenario, first, first + 1, first + 2)
    keys: list[Key | Ramp] = [*barrier_keys(area, ground), Key("cell", DESTINATION, "destination")]
    marks: list[Mark] = make.destination_marks(scenario, scale, over_lines=paths)
    if paths:
        for robot, path in enumerate(robot_paths(plan, area)):
            colour = SERIES[robot % len(SERIES)] if plan.arrived[robot] else STRANDED
            marks.append(Lines((path,), max(2.0, 0.06 * scale), colour))
            if plan.arrived[robot]:
                marks += make.robot_marks(scenario, np.array([robot]), colour, scale)
        marks += make.stranded_marks(scenario, stranded, scale)
        keys += [Key("disc", MOVING, "robot and its path")] if arrived.size else []
    else:
        visits = visits_of(plan)
        most = max(1, int(visits[cells == first].max(initial=0)))
        is_shaded = (visits > 0) & (cells == first)
        cells[is_shaded] = np.rint(np.log(visits[is_shaded]) * ((_SHADES - 1) / max(np.log(most), 1e-9)))
        starts = arrived if make.leave_room(scenario, scale) else arrived[:0]
        marks += make.robot_marks(scenario, starts, MOVING, scale) + make.stranded_marks(scenario, stranded, scale)
        keys += [Key("disc", MOVING, "start")] if starts.size else []
        keys += [Ramp(colours_of(shades), "visits (log)", "1", str(most))] if is_shaded.any() else []
    keys += [Key("disc", STRANDED, "never arrives")] if stranded.size else []
    colours = np.vstack([shades, colour_rows([FREE, barrier_colour(ground), DESTINATION])])
    bold = (*range(first), first + 1, first + 2)
    scene = Scene(area, cells, colours, scale, bold, tuple(marks), tuple(keys), ground=ground)
    part = "" if area.cell_count == whole.cell_count else f" of {whole.width} x {whole.height}"
    more = f"{part}, {arrived.size} of {scenario.robot_count} robots arrive"
    more += f", {plan.steps} {plan.scenario.step_word}s, total time {plan.total_time}"
    what = "Plan" if is_plan else "Run"
    return titled(scene, title, f"{what} ({plan.planner})" if plan.planner else what, more, legend)


def _cropped(plan: Plan) -> Plan:
    """Return the plan on the box around all free cells, two cells wider, if it is less than half."""
    scenario, area = plan.scenario, plan.scenario.area
    rows, columns = (np.flatnonzero(~area.barriers.all(axis=axis)) for axis in (1, 0))
    if plan.jumps.size or rows.size == 0:
        return plan
    # Even steps leave the orientation of cells as it is.
    top, left = (max(0, (int(first[0]) - 2) // 2 * 2) for first in (rows, columns))
    barriers = area.barriers[top : rows[-1] + 3, left : columns[-1] + 3]
    if 2 * barriers.size > area.cell_count:
        return plan
    x, y = (
        float(end - start)
        for end, start in zip(
            area.tessellation.centre_of_cell(left, top), area.tessellation.centre_of_cell(0, 0), strict=True
        )
    )
    frame = area.frame
    if frame is not None:
        corner_x, corner_y = (float(metres) for metres in frame.point_to_metres(x, y))
        frame = replace(frame, origin=(corner_x, corner_y))
    part = Area(area.tessellation, barriers, area.name, frame)
    destinations, robots = (
        np.stack(area.cell_to_xy(cells), axis=-1) - (left, top) for cells in (scenario.destinations, scenario.robots)
    )
    moved = Scenario(part, destinations, robots, waiting_cost=scenario.waiting_cost, following=scenario.following)
    return Plan(moved, plan.actions, plan.first_action, plan.planner, plan.optimal)
