"""Table of a front: the moves worth trying after the move that led to a cell."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Layout

Step = tuple[int, int]


class FrontTable(NamedTuple):
    """The moves worth trying after the move that led to a cell.

    Attributes
    ----------
    table : uint64 array
        One row for each kind of move (orientation of the source, direction): the moves worth trying after it, by
        group, padded with moves that go nowhere; then what lies four such moves ahead. A move is what to add to a
        site to get an entry of the queue: the site it leads to in the low half, the start of its row in the high.
    direction : uint64 array
        The direction of each move of `table`.
    slots : tuple of int
        How many columns each group has.
    first : two lists of int
        Starts of rows that between them try all moves from a cell of orientation 0 and 1, to begin with.
    """

    table: NDArray[np.uint64]
    direction: NDArray[np.uint64]
    slots: tuple[int, ...]
    first: tuple[list[int], list[int]]


def make_front_table(layout: Layout, is_free_to_turn: bool) -> FrontTable:
    """Return which moves may be the first to reach a cell, given the move that reached the cell before.

    A robot that came from p to c and goes on to n might as well have gone from p to n, if n is p or a neighbour of p:
    no move costs more than two others. So c need not try n. Of 8 or 12 moves, 3 to 7 are left. Directions of equal
    cost form a *group*.

    Parameters
    ----------
    layout : Layout
    is_free_to_turn : bool
        Whether every move to a free cell is open. If not, only edge moves are sure to be open from p to n.
    """
    tessellation, offset = layout.tessellation, layout.offset_of_direction
    step, cost = tessellation.step_of_direction, tessellation.cost_of_direction
    steps = tuple(tuple((dx, dy) for dx, dy in side) for side in step.tolist())
    parities = tuple(tuple(o & 1 for o in side) for side in offset.tolist())
    kind, direction, slots, first = _kinds_of_moves(
        steps, parities, tuple(cost.tolist()), tessellation.edge_count, is_free_to_turn
    )
    columns = kind.shape[1]
    flat = offset.astype(np.int64).reshape(-1)
    table = np.where(kind < 0, 0, (kind * columns << 32) + flat[kind])
    table[:, -1] = 4 * flat[: len(kind)]
    return FrontTable(table.astype(np.uint64).reshape(-1), direction.reshape(-1), slots, first)


@lru_cache
def _kinds_of_moves(
    steps: tuple[tuple[Step, ...], ...],
    parities: tuple[tuple[int, ...], ...],
    costs: tuple[int, ...],
    edge_count: int,
    is_free_to_turn: bool,
) -> tuple[NDArray[np.int64], NDArray[np.uint64], tuple[int, ...], tuple[list[int], list[int]]]:
    """Return what of the table does not depend on the pitch: moves by the number of their kind, -1 for none."""
    if costs[-1] > 2 * costs[0]:
        raise ValueError("no move may cost more than two others")
    orientations = 1 if steps[0] == steps[1] else 2
    directions = range(len(costs))
    kinds = [(o, k) for o in range(orientations) for k in directions]
    target = [(o + parities[o][k]) % orientations for o, k in kinds]
    after = []
    for (o, k), t in zip(kinds, target, strict=True):
        near = {(0, 0), *(steps[o][j] for j in directions if is_free_to_turn or j < edge_count)}
        dx, dy = steps[o][k]
        after.append([j for j in directions if (dx + steps[t][j][0], dy + steps[t][j][1]) not in near])
    groups = [[[j for j in moves if costs[j] == c] for c in sorted(set(costs))] for moves in after]
    slots = tuple(max(map(len, group)) for group in zip(*groups, strict=True))
    columns = sum(slots) + 1
    kind = np.full((len(kinds), columns), -1, dtype=np.int64)
    direction = np.zeros((len(kinds), columns), dtype=np.uint64)
    for row, t in enumerate(target):
        for g, moves in enumerate(groups[row]):
            start = sum(slots[:g])
            kind[row, start : start + len(moves)] = [t * len(costs) + j for j in moves]
            direction[row, start : start + len(moves)] = moves
    first = tuple([columns * row for row in _cover(after, target, o)] for o in (0, orientations - 1))
    return kind, direction, slots, (first[0], first[1])


def _cover(after: list[list[int]], target: list[int], orientation: int) -> list[int]:
    """Return a few rows that lead to cells of `orientation` and between them try all moves from there."""
    rows = [row for row, t in enumerate(target) if t == orientation]
    missing = {j for row in rows for j in after[row]}
    chosen: list[int] = []
    while missing:
        chosen.append(max(rows, key=lambda row: len(missing.intersection(after[row]))))
        missing.difference_update(after[chosen[-1]])
    return chosen
