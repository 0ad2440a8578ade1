"""Standing: the cells on which robots and destinations are, checked or drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas.area import Area
from trihex.areas.nearest import nearest_free_cell
from trihex.areas.places import cells_from
from trihex.errors import ScenarioError, check_type, check_whole

MOST = 2**30  # the largest whole number that a parameter may be: sums of a few fit into int32


def random_robots(area: Area, count: int, seed: int = 0, *, avoid: Any = ()) -> NDArray[np.int64]:
    """Return the cell numbers of `count` robots on distinct free cells, drawn uniformly, in the order drawn.

    Parameters
    ----------
    area : Area
    count : int
    seed : int
        The same seed gives the same robots.
    avoid : sequence of (x, y), or cell numbers
        Cells to keep free, usually the destinations.

    Raises
    ------
    ScenarioError
        If there are fewer free cells than robots.
    """
    check_type("area", area, Area)
    check_whole("robots", count, 0, MOST, ScenarioError)
    check_whole("seed", seed, 0, MOST, ScenarioError)
    is_free = ~area.barriers.reshape(-1)
    is_free[cells_from(area, avoid, "avoid", ScenarioError)] = False
    free = np.flatnonzero(is_free)
    if count > free.size:
        raise ScenarioError(f"robots must be at most the number of free cells, {free.size}, not {count}")
    return np.random.default_rng(seed).choice(free, size=count, replace=False).astype(np.int64)


def check_free(area: Area, cells: NDArray[np.int64], one: str) -> None:
    """Raise ScenarioError if one of `cells`, each called `one`, is a barrier."""
    stuck = np.flatnonzero(area.is_barrier(cells)) if cells.size else cells
    if stuck.size:
        number, where, why = int(stuck[0]), area.place_of_cell(int(cells[stuck[0]])), ""
        if area.frame is not None:
            radius = area.frame.robot_radius
            why = (
                f": something stands too near for robots of radius {radius:g}" if radius else ": something stands there"
            )
        x, y = area.tessellation.centre_of_cell(*area.cell_to_xy(cells[number]))
        near = nearest_free_cell(area.tessellation, area.barriers, float(x), float(y))
        hint = "; no cell of the area is free"
        if near is not None:
            hint = f"; the nearest free cell is {area.place_of_cell(int(area.xy_to_cell(*near)))}"
        raise ScenarioError(f"{one} {number} must stand on a free cell; {where} is a barrier{why}{hint}")


def check_distinct(area: Area, robots: NDArray[np.int64]) -> None:
    """Raise ScenarioError if two robots start in one cell."""
    order = np.argsort(robots, kind="stable")
    same = np.flatnonzero(robots[order][1:] == robots[order][:-1])
    if same.size:
        one, other = int(order[same[0]]), int(order[same[0] + 1])
        where = area.name_of_cell(int(robots[one]))
        raise ScenarioError(f"two robots must not share a cell; robots {one} and {other} both start at {where}")


def without_repeats(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return each cell once, in the order in which they come first."""
    _, first = np.unique(cells, return_index=True)
    return cells[np.sort(first)]
