"""Settling: the fixed point of the distance rule, spread from cells whose values are known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from trihex.errors import ScenarioError
from trihex.kernels import NOT_REACHED
from trihex.kernels.fields_table import make_front_table
from trihex.tessellation import Layout

_BUDGET = 1 << 16  # cells settled in one call of a kernel, about 1 ms
_LEAST_LIST = 1 << 12


def settle(
    distance: NDArray[np.int32],
    layout: Layout,
    moves: NDArray[np.uint16] | None,
    sites: NDArray[np.int32],
    values: NDArray[np.int32],
    look: Callable[[int], bool] | None = None,
) -> int:
    """Lower `distance` in place to the fixed point that `values` at `sites` bring about.

    Parameters
    ----------
    distance : int32 array, shape (layout.size,)
        `NOT_REACHED`, or what is known so far, at free cells; -1 at barriers and in the padding.
    layout : Layout
    moves : uint16 array, shape (layout.size,), optional
        Open moves of each site. None: all that lead to a free cell.
    sites, values : arrays
        Where the field spreads from, in any order.
    look : callable, optional
        Called now and then with the value below which all is settled; settling ends early if it returns True.

    Returns
    -------
    int
        All distances below it are settled; `NOT_REACHED` if all are.

    Raises
    ------
    ScenarioError
        If a cell is farther than 2 000 000 000 and yet can be reached.
    """
    from trihex.kernels import fields as kernels

    tessellation = layout.tessellation
    table, direction, slots, first = make_front_table(
        tessellation.step_of_direction,
        layout.offset_of_direction,
        tessellation.cost_of_direction,
        tessellation.edge_count,
        moves is None,
    )
    cost = np.unique(tessellation.cost_of_direction)
    seeds, value_of_seed = _seeds(sites, values, first)
    lists = np.empty((3, _LEAST_LIST), dtype=np.uint64)
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    if moves is None:
        open_moves, kernel = np.empty(0, dtype=np.uint16), kernels.make_settle(slots, False)
    else:
        open_moves, kernel = moves, kernels.make_settle(slots, True)
    while True:
        kernel(
            state, lists.reshape(-1), seeds, value_of_seed, table, direction, cost, open_moves, distance,
            layout.pitch, _BUDGET,
        )  # fmt: skip
        if state[kernels.REASON] == kernels.DONE:
            return NOT_REACHED
        if state[kernels.REASON] == kernels.TOO_FAR:
            raise ScenarioError(f"distances must stay below {kernels.FARTHEST}; a cell that can be reached is farther")
        if state[kernels.REASON] == kernels.LISTS_FULL:
            lists = np.concatenate([lists, np.empty_like(lists)], axis=1)
        if look is not None and look(int(state[kernels.BUCKET_END])):
            return int(state[kernels.BUCKET_END])


def _seeds(
    sites: NDArray[np.int32], values: NDArray[np.int32], first: tuple[list[int], list[int]]
) -> tuple[NDArray[np.uint64], NDArray[np.int32]]:
    """Return the entries that try all moves from `sites`, with their values, ascending."""
    order = np.argsort(values, kind="stable")
    sites, values = sites[order].astype(np.int64), values[order].astype(np.int32)
    if first[0] == first[1]:
        rows = np.asarray(first[0], dtype=np.int64)
    else:  # both orientations have equally many, one list being the mirror image of the other
        rows = np.asarray(first, dtype=np.int64)[sites & 1]
    entries = sites[:, None] + (rows << 32)
    return entries.reshape(-1).astype(np.uint64), np.repeat(values, entries.shape[1])
