"""Fresh: distances and best directions of a whole area, made anew in arrays that are there already."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Layout
from trihex.fields.settling import settle
from trihex.kernels.codes import NOT_REACHED

BLOCK = 1 << 24  # sites a kernel looks at in one call, even; Ctrl-C works in between


def fill_distances(
    distance: NDArray[np.int32],
    blocked: NDArray[np.bool_],
    layout: Layout,
    moves: NDArray[np.uint16] | None,
    sites: NDArray[np.int32],
) -> None:
    """Fill the distance of each site to the nearest of `sites`, `NOT_REACHED` where there is no way.

    Parameters
    ----------
    distance : int32 array, shape (layout.size,)
    blocked : bool array, shape (layout.size,)
        Where nobody can stand: barriers and the padding.
    layout : Layout
    moves : uint16 array, optional
        Open moves of each site. None: all that lead to a site that is not blocked.
    sites : int32 array
        The destinations.
    """
    from trihex.fields.kernels import front as kernels

    distance[:] = NOT_REACHED
    if sites.size == 0:
        return
    distance[blocked] = -1
    distance[sites] = 0
    horizon = settle(distance, layout, moves, sites, np.zeros_like(sites))
    for start in range(0, distance.size, BLOCK):
        kernels.finish(distance[start : start + BLOCK], horizon)


def fill_directions(
    distance: NDArray[np.int32], layout: Layout, moves: NDArray[np.uint16] | None, directions: NDArray[np.uint16]
) -> None:
    """Fill the best directions of each site, 0 where there are none; `moves` as for `fill_distances`."""
    from trihex.fields.kernels import directions as kernels

    end = layout.origin + layout.height * layout.pitch
    directions[: layout.origin] = directions[end:] = 0
    offset, cost = layout.offset_of_direction, layout.tessellation.cost_of_direction
    is_odd = np.arange(kernels.BLOCK, dtype=np.uint16) & 1
    rests = np.empty(kernels.BLOCK + 2 * int(np.abs(offset).max()), dtype=np.uint16)
    for start in range(layout.origin, end, BLOCK):
        stop = min(start + BLOCK, end)
        kernels.fill_directions(distance, offset, cost, start, stop, is_odd, rests, directions)
    if moves is not None:
        directions &= moves


def make_directions(
    distance: NDArray[np.int32], layout: Layout, moves: NDArray[np.uint16] | None
) -> NDArray[np.uint16]:
    """Return the best directions of each site, see `fill_directions`."""
    directions = np.empty(layout.size, dtype=np.uint16)
    fill_directions(distance, layout, moves, directions)
    return directions
