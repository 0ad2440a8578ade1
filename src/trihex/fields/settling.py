"""Settling: the fixed point of the distance rule, spread from cells whose values are known."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import COSTS, NEIGHBOURHOODS, TESSELLATIONS, Layout, Tessellation
from trihex.errors import ScenarioError
from trihex.fields.front import FrontTable, make_front_table
from trihex.kernels.codes import NOT_REACHED
from trihex.kernels.needs import Kernels

_BUDGET = 1 << 16  # cells settled in one call of a kernel, about 1 ms
_FIRST_BUDGET = 1 << 13  # enough to see how long the fronts are
_LEAST_LIST = 1 << 12
_THIN = 32  # cells a bucket, below which one queue is faster


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
    from trihex.fields.kernels import buckets as kernels, front
    from trihex.kernels.signatures import given

    steps = _steps_of(layout, moves, distance)
    settle_some = kernels.make_settle(steps.table.slots, moves is not None)
    seeds, value_of_seed = _seeds(sites, values, steps.table.first)
    lists = np.empty((3, _LEAST_LIST), dtype=np.uint64)
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    buckets = given(kernels.Buckets, state, lists.reshape(-1), seeds, value_of_seed)
    width = int(steps.moves.cost[0])
    budget, in_queue = _FIRST_BUDGET, layout.height * layout.width
    while True:
        start = int(state[kernels.BUCKET_END])
        settle_some(buckets, steps.moves, steps.cells, budget)
        end, reason = int(state[kernels.BUCKET_END]), state[kernels.REASON]
        if reason == front.DONE:
            return NOT_REACHED
        if reason == front.TOO_FAR:
            raise ScenarioError(f"distances must stay below {front.FARTHEST}; a cell that can be reached is farther")
        if reason == front.LISTS_FULL:
            lists = np.concatenate([lists, np.empty_like(lists)], axis=1)
            buckets = buckets._replace(lists=lists.reshape(-1))
        if look is not None and look(end):
            return end
        are_thin = reason == front.GO_ON and budget * width < _THIN * (end - start)
        if are_thin and state[kernels.SEED] == len(seeds) and in_queue > 0 and end < front.FARTHEST // 2:
            entries, expanded, horizon = _spread(steps, _waiting(state, lists), look, in_queue)
            if entries.size == 0 or horizon is not None:
                return NOT_REACHED if horizon is None else horizon
            in_queue -= expanded
            seeds, value_of_seed = _sorted(entries, distance)
            buckets = given(kernels.Buckets, state, lists.reshape(-1), seeds, value_of_seed)
            state[:] = 0
        budget = _BUDGET


def needs_moves(tessellation: Tessellation, corners: str) -> bool:
    """Tell whether moves depend on more than barriers: corner rules concern vertex moves alone."""
    return corners != "allow" and tessellation.edge_count < tessellation.direction_count


def field_kernels(tessellation: Tessellation, corners: str = "allow") -> Kernels:
    """Return which kernel settles fields on a tessellation under a corner rule; each shape of moves has its own."""
    is_masked = needs_moves(tessellation, corners)
    return _kernels_of_shape(tessellation.name, tessellation.neighbourhood, tessellation.costs, is_masked, "buckets")


def every_field_kernels() -> list[Kernels]:
    """Return the kernels of all shapes of moves, those that settle by buckets and those that spread by a queue."""
    shapes = product(TESSELLATIONS, NEIGHBOURHOODS, COSTS, (False, True), ("buckets", "queue"))
    return list(dict.fromkeys(_kernels_of_shape(*shape) for shape in shapes))


@cache
def _kernels_of_shape(name: str, neighbourhood: str, costs: str, is_masked: bool, way: str) -> Kernels:
    slots = make_front_table(Tessellation(name, neighbourhood, costs).layout(1, 1), not is_masked).slots
    maker = {"buckets": "make_settle", "queue": "make_spread"}[way]
    return Kernels(f"trihex.fields.kernels.{way}", maker, json.dumps([slots, is_masked]))


class _Steps(NamedTuple):
    """What both ways of settling are told of the moves and the cells."""

    table: FrontTable
    moves: Any  # `trihex.fields.kernels.front.FrontMoves`
    cells: Any  # `trihex.fields.kernels.front.FrontCells`


def _steps_of(layout: Layout, moves: NDArray[np.uint16] | None, distance: NDArray[np.int32]) -> _Steps:
    from trihex.fields.kernels.front import FrontCells, FrontMoves
    from trihex.kernels.signatures import given

    table = make_front_table(layout, moves is None)
    cost = np.unique(layout.tessellation.cost_of_direction)
    open_moves = np.empty(0, dtype=np.uint16) if moves is None else moves
    return _Steps(
        table,
        given(FrontMoves, table.table, table.direction, cost, layout.pitch),
        given(FrontCells, distance, open_moves),
    )


def _spread(
    steps: _Steps, entries: NDArray[np.uint64], look: Callable[[int], bool] | None, most: int
) -> tuple[NDArray[np.uint64], int, int | None]:
    """Spread from `entries` through one queue for as long as it is short.

    Where ways of few moves cost more than others of many, the queue expands cells again and again; so it gives up
    after about `most` of them, all that there are.

    Returns
    -------
    entries, expanded, horizon
        What waits now, how many entries were expanded, and what is settled if `look` put an end to it.
    """
    from trihex.fields.kernels import front, queue as kernels

    distance = steps.cells.distance
    spread_some = kernels.make_spread(steps.table.slots, steps.cells.moves.size > 0)
    queue = np.empty(max(kernels.QUEUE_SIZE, 2 * entries.size), dtype=np.uint64)
    queue[: entries.size] = entries
    state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
    state[kernels.TAIL] = entries.size
    waiting = kernels.FrontQueue(state, queue)
    expanded = 0
    while True:
        spread_some(waiting, steps.moves, steps.cells, _BUDGET)
        expanded += _BUDGET
        entries = queue[state[kernels.AT] : state[kernels.TAIL]]
        if entries.size == 0:
            return entries, expanded, None
        values = distance[entries & np.uint64(2**32 - 1)]
        horizon = int(values.min())
        if look is not None and look(horizon):
            return entries, expanded, horizon
        # Far from the least distance that is too far, so that no sum in this kernel overflows.
        if state[kernels.REASON] == front.LISTS_FULL or expanded >= most or values.max() > front.FARTHEST // 2:
            return entries, expanded, None


def _waiting(state: NDArray[np.int64], lists: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return the entries that wait in the three lists, in the order of their turns."""
    from trihex.fields.kernels import buckets as kernels

    turns = [(state[kernels.LIST] + turn) % 3 for turn in range(3)]
    starts = (state[kernels.AT], 0, 0)
    return np.concatenate([lists[turns[turn], starts[turn] : state[kernels.COUNT + turn]] for turn in range(3)])


def _sorted(entries: NDArray[np.uint64], distance: NDArray[np.int32]) -> tuple[NDArray[np.uint64], NDArray[np.int32]]:
    """Return entries with the distances of their sites, ascending."""
    values = distance[entries & np.uint64(2**32 - 1)]
    order = np.argsort(values, kind="stable")
    return entries[order], values[order]


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
