"""Sensing: which cells robots see from where they stand."""

from typing import NamedTuple

from numba import types

from trihex.kernels.signatures import HELPER, IN_BOOL, IN_I32, OUT_I32, TABLE_I32, declared, kernel


class Sight(NamedTuple):
    """What can be seen from a cell of either orientation, row o of the tables for orientation o."""

    dx: TABLE_I32  # columns from a cell to each that it sees
    dy: TABLE_I32  # rows
    first: TABLE_I32  # the i-th is seen if none of the cells first[o, i] .. first[o, i + 1] - 1 between is blocked
    between_dx: IN_I32  # columns from a cell to those between
    between_dy: IN_I32  # rows


class SeenWorld(NamedTuple):
    """Where cells are among the sites, and what is on them."""

    origin: types.int64  # site of cell (0, 0)
    pitch: types.int64  # sites in a row
    height: types.int64  # rows of cells
    width: types.int64  # cells in a row
    blocked: IN_BOOL  # of each site: whether nobody sees past it


@HELPER
def _site_at(x, y, world):
    """Return the site of a cell, -1 if it lies outside the world."""
    if x < 0 or y < 0 or x >= world.width or y >= world.height:
        return -1
    return world.origin + y * world.pitch + x


@HELPER
def _is_hidden(x, y, side, i, sight, world):
    """Tell whether a barrier stands between a cell and the i-th that it can see."""
    for j in range(sight.first[side, i], sight.first[side, i + 1]):
        site = _site_at(x + sight.between_dx[j], y + sight.between_dy[j], world)
        if site >= 0 and world.blocked[site]:
            return True
    return False


@kernel(types.int64(IN_I32, declared(Sight), declared(SeenWorld), types.int32, OUT_I32, OUT_I32))
def look(sites, sight, world, step, since, news):
    """Stamp `since` with `step` where robots at `sites` see a cell for the first time; list and count those in `news`.

    `since` is -1 where nobody has seen a cell; `news` has room for all cells.
    """
    count = 0
    for robot in range(len(sites)):
        y, x = divmod(sites[robot] - world.origin, world.pitch)
        side = sites[robot] & 1
        for i in range(sight.dx.shape[1]):
            target = _site_at(x + sight.dx[side, i], y + sight.dy[side, i], world)
            if target < 0 or since[target] >= 0 or _is_hidden(x, y, side, i, sight, world):
                continue
            since[target] = step
            news[count] = target
            count += 1
    return count
