"""Marks: what pictures put into cells, robots, letters, numbers, arrows, paths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario
from trihex.kernels.codes import NOT_REACHED
from trihex.pictures.palette import DESTINATION, INK, PAGE, STRANDED, Colour, is_light
from trihex.pictures.scene import Discs, Mark, Texts, centres_of, ink_on
from trihex.pictures.setting import Setting
from trihex.pictures.sheet import width_of

# In pixels per edge step, the diameter of the circle inside a cell.
LETTERS_FROM = 20.0
ROBOT_RADIUS = 0.34  # in edge steps
LEAST_ROBOT = 1.3  # pixels
_LEAST_NUMBER = 7.0  # size of letters, in pixels
LETTERS = "abcdefghijklmnopqrstuvwxyz"


def destination_marks(
    scenario: Scenario | Setting, scale: float, *, letters: bool = True, over_lines: bool = False
) -> list[Mark]:
    """Return a D for each destination; where cells are too small, a disc in a white ring, so that it is found.

    `over_lines` puts the D onto such a disc as well, where lines would hide the cell.
    """
    x, y = centres_of(scenario.area, scenario.destinations)
    if scale < LETTERS_FROM:
        return [Discs(x, y, 0.65, PAGE, 5.0), Discs(x, y, 0.5, DESTINATION, 3.5)]
    if not letters:
        return []
    discs: list[Mark] = [Discs(x, y, 0.47, PAGE), Discs(x, y, 0.4, DESTINATION)] if over_lines else []
    return [*discs, Texts(x, y, ("D",) * x.size, round(0.5 * scale), PAGE)]


def robot_marks(scenario: Scenario | Setting, robots: NDArray[np.int64], colour: Colour, scale: float) -> list[Mark]:
    """Return a disc at the start of each of `robots`; where they are few, with the letter of the paper."""
    if not robots.size:
        return []
    x, y = centres_of(scenario.area, scenario.robots[robots])
    marks: list[Mark] = [Discs(x, y, ROBOT_RADIUS, colour, LEAST_ROBOT)]
    if has_letters(scenario, scale):
        marks.append(Texts(x, y, tuple(LETTERS[r] for r in robots), round(0.46 * scale), ink_on(colour)))
    return marks


def has_letters(scenario: Scenario | Setting, scale: float) -> bool:
    """Tell whether robots are few and cells large enough for the letters of the paper."""
    return scale >= LETTERS_FROM and scenario.robot_count <= len(LETTERS)


def stranded_marks(scenario: Scenario | Setting, robots: NDArray[np.int64], scale: float) -> list[Mark]:
    """Return a disc for each of `robots`, which never arrive, with its letter or, where that fits, its number."""
    if not robots.size:
        return []
    size = 0.0 if has_letters(scenario, scale) else _size_of_number(int(robots.max(initial=0)), scale)
    if size < _LEAST_NUMBER:
        return robot_marks(scenario, robots, STRANDED, scale)
    x, y = centres_of(scenario.area, scenario.robots[robots])
    return [Discs(x, y, 0.48, STRANDED), Texts(x, y, tuple(map(str, robots.tolist())), round(size, 1), PAGE)]


def leave_room(scenario: Scenario | Setting, scale: float) -> bool:
    """Tell whether discs for all robots leave half of the picture free, or are no larger than cells."""
    radius = max(ROBOT_RADIUS * scale, LEAST_ROBOT)
    pixels = scenario.area.cell_count * scale * scale
    return radius <= 0.5 * scale or 3.14 * radius * radius * scenario.robot_count <= 0.5 * pixels


def number_marks(
    area: Area,
    numbers: NDArray[np.integer],
    colour_of_cell: NDArray[np.uint8],
    colours: NDArray[np.uint8],
    scale: float,
) -> list[Mark]:
    """Return the numbers (height, width) of cells that are reached, if they fit into the cells."""
    is_shown = numbers != NOT_REACHED
    size = min(0.36 * scale, _size_of_number(int(numbers.max(initial=0, where=is_shown)), scale))
    if size < _LEAST_NUMBER:
        return []
    light = np.array([is_light(tuple(colour)) for colour in colours.tolist()])
    marks: list[Mark] = []
    for ink, wanted in ((INK, True), (PAGE, False)):
        cells = np.flatnonzero(is_shown & (light[colour_of_cell] == wanted))
        words = tuple(map(str, numbers.reshape(-1)[cells].tolist()))
        marks.append(Texts(*centres_of(area, cells), words, round(size, 1), ink))
    return marks


def _size_of_number(most: int, scale: float) -> float:
    """Return the size of letters, half a cell at most, at which numbers up to `most` fit into the circle in a cell."""
    # At size 100 the widest number is so wide; the diagonal of its box must fit.
    wide = width_of("0" * len(str(most)), 100) / 100
    return min(0.5 * scale, 0.96 * scale / float(np.hypot(wide, 0.72)))


def _units(area: Area) -> NDArray[np.float64]:
    """Return the way from a cell to each neighbour as a vector of length 1, shape (2 orientations, directions, 2)."""
    step, x = area.tessellation.step_of_direction, np.array([[0], [1]])
    here = area.tessellation.centre_of_cell(x, 0 * x)
    there = area.tessellation.centre_of_cell(x + step[..., 0], step[..., 1])
    way = np.stack([there[0] - here[0], there[1] - here[1]], axis=-1)
    return np.asarray(way / np.linalg.norm(way, axis=-1, keepdims=True))


def arrow_paths(area: Area, directions: NDArray[np.uint16]) -> tuple[NDArray[np.float64], ...]:
    """Return an arrow, a polyline of 5 points, for each bit set in `directions` (height, width)."""
    unit, cells = _units(area), np.flatnonzero(directions)
    bits = directions.reshape(-1)[cells]
    orientation = area.tessellation.orientation_of_cell(*area.cell_to_xy(cells))
    # Arrows of one cell begin apart and end where the cell does, or, 30 degrees apart on triangles, they look like one.
    start = np.where(bits & (bits - 1), 0.15, 0.0)[:, None]
    length = np.minimum(0.88 * _room(area, unit), 0.72)
    arrows = []
    for k in range(unit.shape[1]):
        has = np.flatnonzero(bits >> k & 1)
        centre = np.stack(centres_of(area, cells[has]), axis=-1)
        way, long = unit[orientation[has], k], length[orientation[has], k][:, None]
        side = 0.055 * np.stack([-way[:, 1], way[:, 0]], axis=-1)
        tip, neck = centre + long * way, centre + (long - 0.12) * way
        arrows.append(np.stack([centre + start[has] * way, tip, neck + side, tip, neck - side], axis=1))
    return tuple(np.concatenate(arrows))


def _room(area: Area, unit: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far it is from the centre of a cell to its border in each direction, shape (2, directions)."""
    edges = unit[:, : area.tessellation.edge_count]
    # Half an edge step lies between the centre and each edge.
    return np.asarray(0.5 / np.einsum("okc,oec->oke", unit, edges).max(axis=-1))


def compass_of(area: Area, directions: NDArray[np.uint16], count: int) -> NDArray[np.uint8]:
    """Return where the mean of the directions of each cell points, 0..count - 1 clockwise from north."""
    unit = _units(area)
    bits = np.arange(1 << unit.shape[1])[:, None] >> np.arange(unit.shape[1]) & 1
    # All sets of directions are few beside the cells: look them up.
    mean = bits @ unit
    first = np.take_along_axis(unit, np.argmax(bits, axis=1)[None, :, None], axis=1)
    mean = np.where(np.linalg.norm(mean, axis=-1, keepdims=True) < 1e-9, first, mean)
    turn = np.arctan2(mean[..., 0], -mean[..., 1]) / (2 * np.pi)
    index = (np.round(turn * count).astype(np.int64) % count).astype(np.uint8)
    y, x = np.ogrid[: area.height, : area.width]
    return np.asarray(index[area.tessellation.orientation_of_cell(x, y), directions])


def base_cells(record: Area | Scenario | Setting, free: int, barrier: int, destination: int) -> NDArray[np.uint8]:
    """Return which of the three each cell is, shape (height, width)."""
    area = record if isinstance(record, Area) else record.area
    cells = np.where(area.barriers, np.uint8(barrier), np.uint8(free))
    if not isinstance(record, Area):
        cells.reshape(-1)[record.destinations] = destination
    return cells
