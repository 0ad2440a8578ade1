"""Ways: where robots pass on their way from one cell to the next.

A move to a cell that shares but a corner passes that corner. Halfway between the centres of such cells lies the corner
on squares, but on triangles often another cell, perhaps a barrier: a straight line would lead across it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Claim
from trihex.pictures.scene import centres_of
from trihex.plans import Motion

_NONE = -1  # no move leads so far


def bends_of(area: Area, cells: NDArray[np.int64], later: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return how far the place that a move passes lies from the middle of its way, shape (moves, 2).

    Parameters
    ----------
    area : Area
    cells, later : arrays of cell numbers, shape (moves,)
        Where moves begin and end; what is no move of the tessellation, such as a wait or a jump, does not bend.
    """
    bends = np.zeros((cells.size, 2))
    if area.tessellation.name != "triangular":
        return bends
    side, k = _moves_of(area, cells, later)
    moves = k != _NONE
    bends[moves] = area.tessellation.bend_of_direction[side[moves], k[moves]]
    return bends


def places_between(
    area: Area, cells: NDArray[np.int64], later: NDArray[np.int64], share: float | NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return where robots are, in edge steps, that have gone a share of the way, each its own, to later cells."""
    share = np.reshape(share, (-1, 1))
    here, there = (np.stack(centres_of(area, own), axis=-1) for own in (cells, later))
    place = here + share * (there - here) + (1 - abs(2 * share - 1)) * bends_of(area, cells, later)
    return place[:, 0], place[:, 1]


def robot_paths(motion: Motion, area: Area | None = None) -> tuple[NDArray[np.float64], ...]:
    """Return the way of each robot, shape (points, 2), through the lattice vertices that it passes.

    Each is a little aside, so that paths in one cell do not hide, but not where a barrier stands at the vertex; `area`
    has the barriers that are shown. Default: those at the beginning.
    """
    area = motion.scenario.area if area is None else area
    cells = np.stack(list(motion.cells_by_step()))
    closed = Claim(area, np.zeros(1, dtype=np.int64)).moves_closed_by("no-cut")  # wherever the destinations are
    paths = []
    for robot, end in enumerate(motion.last_cell_of_robot.tolist()):
        own = np.append(cells[:, robot][cells[:, robot] >= 0], end)
        own = own[np.append(True, own[1:] != own[:-1])]
        turn = 2.399963 * robot  # the golden angle: no two robots of a few are aside alike
        aside = 0.13 * np.array([np.cos(turn), np.sin(turn)]) * (motion.robots.size > 1)
        paths.append(_path_of(area, own, aside, closed))
    return tuple(paths)


def _path_of(
    area: Area, cells: NDArray[np.int64], aside: NDArray[np.float64], closed: NDArray[np.uint16]
) -> NDArray[np.float64]:
    centres = np.stack(centres_of(area, cells), axis=-1)
    path = np.empty((2 * cells.size - 1, 2))
    path[::2] = centres + aside
    here, there = cells[:-1], cells[1:]
    _, k = _moves_of(area, here, there)
    has_barrier = (k != _NONE) & (closed[area.layout.cell_to_site(here)] >> np.maximum(k, 0) & 1 == 1)
    bends = bends_of(area, here, there)
    path[1::2] = (centres[:-1] + centres[1:]) / 2 + bends + np.where(has_barrier[:, None], 0.0, aside)
    keep = np.ones(len(path), dtype=bool)
    keep[1::2] = has_barrier | bends.any(axis=1)  # a straight line needs no point in its middle
    return path[keep]


def _moves_of(
    area: Area, cells: NDArray[np.int64], later: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the orientation of each cell, and the direction that leads to the later one, or _NONE."""
    (x, y), (to_x, to_y) = area.cell_to_xy(cells), area.cell_to_xy(later)
    side, step = area.tessellation.orientation_of_cell(x, y), np.stack([to_x - x, to_y - y], axis=-1)
    fits = (area.tessellation.step_of_direction[side] == step[:, None]).all(axis=-1)
    return side, np.where(fits.any(axis=1), np.argmax(fits, axis=1), _NONE)
