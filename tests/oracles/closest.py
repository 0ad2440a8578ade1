"""How near two robots on piecewise straight ways ever come: exact, for all pairs, and no word of cells."""

import numpy as np
from numba import njit


@njit
def _nearest(first, t, x, y):
    """Return the square of the least distance of two robots while both are in the world, when, and of whom."""
    best, when, who, whom = np.inf, 0.0, -1, -1
    for one in range(len(first) - 1):
        for other in range(one + 1, len(first) - 1):
            i, j = first[one], first[other]
            end_i, end_j = first[one + 1] - 1, first[other + 1] - 1
            begin = max(t[i], t[j])
            end = min(t[end_i], t[end_j])
            while begin <= end:
                while i < end_i and t[i + 1] <= begin:
                    i += 1
                while j < end_j and t[j + 1] <= begin:
                    j += 1
                until = end
                if i < end_i:
                    until = min(until, t[i + 1])
                if j < end_j:
                    until = min(until, t[j + 1])
                # Both go straight from `begin` to `until`.
                speed_x = speed_y = 0.0
                gap_x, gap_y = x[j] - x[i], y[j] - y[i]
                if i < end_i:
                    own = (x[i + 1] - x[i]) / (t[i + 1] - t[i]), (y[i + 1] - y[i]) / (t[i + 1] - t[i])
                    gap_x, gap_y = gap_x - own[0] * (begin - t[i]), gap_y - own[1] * (begin - t[i])
                    speed_x, speed_y = -own[0], -own[1]
                if j < end_j:
                    own = (x[j + 1] - x[j]) / (t[j + 1] - t[j]), (y[j + 1] - y[j]) / (t[j + 1] - t[j])
                    gap_x, gap_y = gap_x + own[0] * (begin - t[j]), gap_y + own[1] * (begin - t[j])
                    speed_x, speed_y = speed_x + own[0], speed_y + own[1]
                square = speed_x * speed_x + speed_y * speed_y
                after = 0.0
                if square > 0:
                    after = min(max(-(gap_x * speed_x + gap_y * speed_y) / square, 0.0), until - begin)
                near = (gap_x + after * speed_x) ** 2 + (gap_y + after * speed_y) ** 2
                if near < best:
                    best, when, who, whom = near, begin + after, one, other
                if until >= end:
                    break
                begin = until
    return best, when, who, whom


def closest(tracks):
    """Return the least distance of two centres, and when and of which robots; infinite if two never meet.

    `tracks` has rows (t, x, y) for each robot; it is in the world from its first to its last row.
    """
    first = np.cumsum([0, *map(len, tracks)])
    t, x, y = np.array([row for own in tracks for row in own], dtype=float).reshape(-1, 3).T.copy()
    best, when, who, whom = _nearest(first, t, x, y)
    return float(np.sqrt(best)), when, who, whom
