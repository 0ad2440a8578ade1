"""Rows: where robots are after each of their actions."""

from numba import types

from trihex.kernels.actions import ACTIONS, site_after
from trihex.kernels.signatures import IN_I32, IN_I64, OUT_I32, kernel


@kernel(types.void(IN_I32, ACTIONS, types.int64, types.int64, IN_I64, OUT_I32))
def fill_rows(start, actions, first_robot, last_robot, first_row, site):
    """Fill `site` from first_row[r] on with where robot r is at the start and after each action, and then stays."""
    for robot in range(first_robot, last_robot):
        at = start[robot]
        row = first_row[robot]
        site[row] = at
        for i in range(actions.first[robot], actions.first[robot + 1]):
            at = site_after(at, i, actions)
            row += 1
            site[row] = at
        for later in range(row + 1, first_row[robot + 1]):
            site[later] = at
