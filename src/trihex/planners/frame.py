"""Frame: the places around the start of a window, and what ways between them cost where there is no barrier."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Tessellation

# What cannot be reached costs so much.
_FAR = 1 << 30


@cache
def make_frame(name: str, neighbourhood: str, costs: str, waiting_cost: int, steps: int) -> Any:
    """Return the `Frame` of kernels for windows of so many steps on a tessellation, made once."""
    from trihex.kernels.signatures import given
    from trihex.planners.kernels.frame import Frame
    from trihex.planners.kernels.ways import ROW

    tessellation = Tessellation(name, neighbourhood, costs)
    move, cost = tessellation.step_of_direction, tessellation.cost_of_direction
    # A step more than the window has: what leads beyond it is looked up, too.
    wide, high = (int(np.abs(move[..., axis]).max()) * (steps + 1) for axis in range(2))
    shape = (2 * high + 1, 2 * wide + 1)
    offset = np.zeros((2, 1 << ROW), dtype=np.int32)
    offset[:, : cost.size] = move[..., 1] * shape[1] + move[..., 0]
    least = np.full((steps + 1, 2, *shape), _FAR, dtype=np.int64)
    least[0, :, high, wide] = 0
    by_first = np.full((steps + 1, 2, 1 + cost.size, *shape), _FAR, dtype=np.int64)
    for left in range(1, steps + 1):
        for side in range(2):
            by_first[left, side, 0] = least[left - 1, side] + waiting_cost
            for k, (dx, dy) in enumerate(move[side].tolist()):
                there = int(tessellation.orientation_of_cell(side + dx, dy))
                by_first[left, side, 1 + k] = _shifted(least[left - 1, there], dx, dy) + cost[k]
        least[left] = np.minimum(by_first[left].min(axis=1), _FAR)
    beyond = np.where(by_first < _FAR, by_first - least[:, :, None], _FAR)
    quantum = int(beyond[beyond > 0].min())
    bit = (1 << np.arange(1 + cost.size))[:, None, None]
    first = [((beyond < part * quantum) * bit).sum(axis=2) for part in (1, 2)]
    bits = (shape[0] * shape[1] - 1).bit_length()
    return given(
        Frame,
        offset=offset.reshape(-1),
        least=_in_rows(least, bits).astype(np.int32),
        first=np.concatenate([_in_rows(table, bits) for table in first]).astype(np.uint16),
        quantum=quantum,
        bits=bits,
        centre=high * shape[1] + wide,
    )


def _shifted(table: NDArray[np.int64], dx: int, dy: int) -> NDArray[np.int64]:
    """Return a table in which what was at (x, y) is at (x + dx, y + dy)."""
    high, wide = table.shape
    shifted = np.full_like(table, _FAR)
    shifted[max(0, dy) : high + min(0, dy), max(0, dx) : wide + min(0, dx)] = table[
        max(0, -dy) : high + min(0, -dy), max(0, -dx) : wide + min(0, -dx)
    ]
    return shifted


def _in_rows(tables: NDArray[np.int64], bits: int) -> NDArray[np.int64]:
    """Return tables by (steps, orientation, y, x) in rows of a power of 2, one after the other."""
    rows = np.zeros((*tables.shape[:2], 1 << bits), dtype=np.int64)
    rows[..., : tables[0, 0].size] = tables.reshape(*tables.shape[:2], -1)
    return rows.reshape(-1)
