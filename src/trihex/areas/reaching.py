"""Reaching: how far a way of so many moves leads at least, in the direction in which moves lead least far."""

from __future__ import annotations

import numpy as np

from trihex.areas.tessellation import Tessellation

_DIRECTIONS = 1440
_ROUNDING = 0.9999  # directions between those looked at


def least_advance(tessellation: Tessellation) -> float:
    """Return how many edge steps a robot comes forward for each move in the open, in the worst direction.

    So whoever walks straight on for L edge steps passes cells that are no more than L / `least_advance` moves apart,
    but for a move at either end.

    Examples
    --------
    >>> [round(least_advance(Tessellation(name)), 3) for name in ("hexagonal", "square", "triangular")]
    [0.866, 1.0, 1.5]
    """
    moves = []  # of a cell of either orientation: where they lead, and to which orientation
    for side in range(2):
        here = np.array(tessellation.centre_of_cell(side, 0))
        steps = tessellation.step_of_direction[side]
        there = np.stack(tessellation.centre_of_cell(side + steps[:, 0], steps[:, 1]), axis=-1) - here
        moves.append((there, tessellation.orientation_of_cell(side + steps[:, 0], steps[:, 1])))
    # Two moves that end in a cell of the orientation in which they began can be repeated for ever; what they reach
    # together is the hull of their ends.
    ends = [
        first + moves[other][0][moves[other][1] == side]
        for side in range(2)
        for first, other in zip(*moves[side], strict=True)
    ]
    angle = np.linspace(0, 2 * np.pi, _DIRECTIONS, endpoint=False)
    farthest = np.max(np.concatenate(ends) @ np.stack([np.cos(angle), np.sin(angle)]), axis=0)
    return float(_ROUNDING * farthest.min() / 2)
