"""Tile: one part of a field larger than memory, read with what surrounds it, settled and written back.

Whatever is in the files at any moment is either `NOT_REACHED` or the cost of some real path, so tiles may be solved in
any order and at the same time, and a tile that was written by halves does no harm: it is solved afresh.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Layout, Scenario, Tessellation
from trihex.errors import FormatError, MissingExtraError
from trihex.fields.settling import settle
from trihex.kernels.codes import NOT_REACHED

SUFFIXES = (".npy", ".zarr")
# Moves lead at most two columns away, and corner rules look at cells two further on. Even, so that the orientation of
# a cell is that of its place in the tile.
HALO, MARGIN = 2, 4
Neighbour = tuple[int, int]


@dataclass(frozen=True)
class Ground:
    """What every tile of a field has in common; all that a worker is told, besides which tile.

    Parameters
    ----------
    barriers, distance : str
        Files of the area and of the field, both (height, width).
    tessellation : Tessellation
    corners : str
    destinations : tuple of (x, y)
    side : int
        Cells along a tile, even; tiles at the east and south may be smaller.
    """

    barriers: str
    distance: str
    tessellation: Tessellation
    corners: str
    destinations: tuple[tuple[int, int], ...]
    side: int


def open_cells(path: str | Path, mode: Literal["r", "r+"] = "r") -> Any:
    """Return the two-dimensional array in a .npy file or a .zarr folder, without reading it.

    Raises
    ------
    FormatError
        If there is no such array in it.
    MissingExtraError
        If it is a .zarr and zarr is not installed.
    """
    path = Path(path)
    if ".zarr" in path.suffixes:
        cells = _open_zarr(path, mode)
    else:
        try:
            cells = np.load(path, mmap_mode=mode)
        except (ValueError, EOFError) as error:
            raise FormatError(f"{path}: must be an array in numpy's format .npy: {error}") from None
    if getattr(cells, "ndim", 0) != 2 or cells.shape[0] * cells.shape[1] == 0 or cells.dtype.kind not in "biu":
        kind = f"{getattr(cells, 'dtype', '?')} of shape {getattr(cells, 'shape', '?')}"
        raise FormatError(f"{path}: must hold booleans or whole numbers of shape (height, width), not {kind}")
    return cells


def _open_zarr(path: Path, mode: Literal["r", "r+"]) -> Any:
    try:
        import zarr
    except ImportError:
        raise MissingExtraError(f"{path} needs zarr: pip install 'trihex[scale]'") from None
    try:
        return zarr.open_array(path, mode=mode)
    except (ValueError, KeyError, zarr.errors.NodeNotFoundError) as error:
        raise FormatError(f"{path}: must be an array in zarr's format: {error!s:.100}") from None


def settle_tile(ground: Ground, row: int, column: int, visited: NDArray[np.bool_]) -> dict[Neighbour, int]:
    """Settle one tile to its local fixed point, write it, and tell which neighbours can be lowered through it.

    Parameters
    ----------
    ground : Ground
    row, column : int
        Which tile.
    visited : bool array, shape (3, 3)
        Of which tiles around it, itself in the middle, the file holds distances; in others nothing is reached.

    Returns
    -------
    dict
        By neighbour, as (rows south, columns east) of the tile: the least value that its cells next to it can take.
    """
    from trihex.fields.kernels import front as kernels

    barriers, field = open_cells(ground.barriers), open_cells(ground.distance, "r+")
    height, width = barriers.shape
    top, left = row * ground.side, column * ground.side
    bottom, right = min(height, top + ground.side), min(width, left + ground.side)
    blocked = _blocked(barriers, top, left, bottom, right)
    if blocked[MARGIN:-MARGIN, MARGIN:-MARGIN].all():
        field[top:bottom, left:right] = NOT_REACHED
        return {}
    layout = ground.tessellation.layout(*blocked.shape)
    distance, cells = _unsettled(blocked, layout)
    _recall(cells, field, visited, top, left)
    around, sides = _ring(blocked.shape)
    sites = (layout.origin + around[0] * layout.pitch + around[1]).astype(np.int32)
    before = distance[sites]
    own = [(y - top, x - left) for x, y in ground.destinations if top <= y < bottom and left <= x < right]
    own_sites = [layout.origin + (MARGIN + y) * layout.pitch + MARGIN + x for y, x in own]
    is_seed = (before >= 0) & (before < NOT_REACHED)
    seeds = np.concatenate([sites[is_seed], own_sites]).astype(np.int32)
    values = np.concatenate([before[is_seed], np.zeros(len(own), dtype=np.int32)])
    settle(distance, layout, _moves(ground, blocked), seeds, values)
    is_lower = distance[sites] < before
    woken = {side: int(distance[sites[at]].min()) for side, at in _by_side(sides, is_lower).items()}
    kernels.finish(distance, NOT_REACHED)
    field[top:bottom, left:right] = cells[MARGIN:-MARGIN, MARGIN:-MARGIN]
    return woken


def _blocked(barriers: Any, top: int, left: int, bottom: int, right: int) -> NDArray[np.bool_]:
    """Return the barriers of a tile and of a margin around it; outside of the area all is barrier."""
    blocked = np.ones((bottom - top + 2 * MARGIN, right - left + 2 * MARGIN), dtype=bool)
    north, west = max(top - MARGIN, 0), max(left - MARGIN, 0)
    part = np.asarray(barriers[north : bottom + MARGIN, west : right + MARGIN])
    y, x = north - top + MARGIN, west - left + MARGIN
    np.not_equal(part, 0, out=blocked[y : y + part.shape[0], x : x + part.shape[1]])
    return blocked


def _unsettled(blocked: NDArray[np.bool_], layout: Layout) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return a padded array as `settle` wants it, and a view of its cells; what lies beyond the halo is closed."""
    from trihex.fields.kernels import front as kernels

    distance = np.empty(layout.size, dtype=np.int32)
    distance[: layout.origin] = distance[layout.origin + layout.height * layout.pitch :] = -1
    kernels.prepare(blocked, layout.origin, layout.pitch, distance)
    cells = layout.view_of(distance)
    beyond = MARGIN - HALO
    cells[:beyond] = cells[-beyond:] = cells[:, :beyond] = cells[:, -beyond:] = -1
    return distance, cells


def _recall(cells: NDArray[np.int32], field: Any, visited: NDArray[np.bool_], top: int, left: int) -> None:
    """Lower the cells of a tile and its halo to what the file holds of the tiles that were visited."""
    spans = []  # along y and x: before, in and behind the tile, as (first, last) in `cells`
    for length in cells.shape:
        edges = (MARGIN - HALO, MARGIN, length - MARGIN, length - MARGIN + HALO)
        spans.append(list(pairwise(edges)))
    for south, east in np.argwhere(visited).tolist():
        (y, y_end), (x, x_end) = spans[0][south], spans[1][east]
        down, across = top - MARGIN, left - MARGIN
        known = np.asarray(field[y + down : y_end + down, x + across : x_end + across])
        here = cells[y : y + known.shape[0], x : x + known.shape[1]]  # the last tiles may be narrower than the halo
        np.minimum(here, known, out=here)


def _moves(ground: Ground, blocked: NDArray[np.bool_]) -> NDArray[np.uint16] | None:
    """Return the open moves, if corner rules close some that lead to free cells."""
    if ground.corners == "allow" or ground.tessellation.edge_count == ground.tessellation.direction_count:
        return None
    anywhere = np.argmin(blocked.reshape(-1))  # a scenario needs a destination; moves do not depend on it
    area = Area(ground.tessellation, blocked)
    return Scenario(area, np.array([anywhere]), corners=ground.corners).moves


def _ring(shape: tuple[int, ...]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return (y, x) of the cells of the halo, and likewise (rows south, columns east) of the tile that each lies in."""
    parts, sides = [], []
    edges = [(MARGIN - HALO, MARGIN, length - MARGIN, length - MARGIN + HALO) for length in shape]
    for south in range(3):
        for east in range(3):
            if (south, east) != (1, 1):
                y, x = np.arange(edges[0][south], edges[0][south + 1]), np.arange(edges[1][east], edges[1][east + 1])
                parts.append(np.stack([np.repeat(y, x.size), np.tile(x, y.size)]))
                sides.append(np.full((y.size * x.size, 2), (south - 1, east - 1)))
    return np.concatenate(parts, axis=1), np.concatenate(sides)


def _by_side(sides: NDArray[np.int64], is_lower: NDArray[np.bool_]) -> dict[Neighbour, NDArray[np.int64]]:
    """Return which places of the halo were lowered, by the tile they lie in."""
    at = np.flatnonzero(is_lower)
    found = {}
    for south, east in np.unique(sides[at], axis=0).tolist():
        found[south, east] = at[(sides[at] == (south, east)).all(axis=1)]
    return found
