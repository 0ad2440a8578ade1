"""MAPF: plans on squares as text for mapf-visualizer, a line of cells for each step."""

from __future__ import annotations

import os
from collections.abc import Callable

import numpy as np

from trihex.errors import FormatError
from trihex.files import new_file
from trihex.plans import Motion


def write_mapf(
    motion: Motion, path: str | os.PathLike[str], *, progress: Callable[[int, int], None] | None = None
) -> None:
    """Write lines ``step:(x,y),(x,y),...,`` with the cell of each robot, (0, 0) in the north-west.

    The format knows no robots that leave: one that has arrived, left or broken down repeats its last cell,
    one that joins a run later its first.
    No progress is told.

    Raises
    ------
    FormatError
        If the cells are no squares, or moves last longer than a step.
    """
    area = motion.scenario.area
    if area.tessellation.name != "square":
        raise FormatError(f"{path}: mapf-visualizer draws squares only; the plan is {area.tessellation.name}")
    if (motion.scenario.duration_of_direction > 1).any():
        raise FormatError(f"{path}: mapf-visualizer draws moves that last one step; here clock is 'costs'")
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        for step, cells in enumerate(motion.cells_by_step()):
            elsewhere = np.where(step < motion.joined, motion.robots, motion.last_cell_of_robot)
            x, y = area.cell_to_xy(np.where(cells < 0, elsewhere, cells))
            places = "".join(f"({one},{other})," for one, other in zip(x.tolist(), y.tolist(), strict=True))
            file.write(f"{step}:{places}\n")
